#include "gnomon/areas/ray_lines.h"

#include <algorithm>
#include <bit>
#include <string>

#include "gnomon/areas/ray_tests.h"
#include "gnomon/base/error.h"
#include "gnomon/scene/steady_random.h"

namespace gnomon {
namespace {

std::uint64_t hash_of(const GnRay& ray, std::uint64_t seed) {
  std::uint64_t hash = mix_bits(seed + 0x9e3779b97f4a7c15ULL);
  const auto add = [&](float value) { hash = mix_bits(hash ^ std::bit_cast<std::uint32_t>(value)); };
  for (const float value : ray.origin) add(value);
  for (const float value : ray.direction) add(value);
  add(ray.tmin);
  add(ray.tmax);
  return hash;
}

struct Draw {
  std::uint64_t number;
  std::size_t ray;
};

void sort_by_number(std::vector<Draw>& draws) {
  std::sort(draws.begin(), draws.end(), [](const Draw& a, const Draw& b) { return a.number < b.number; });
}

}  // namespace

std::vector<RayLine> lines_of(std::span<const GnRay> rays) {
  std::vector<RayLine> lines;
  lines.reserve(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto refuse = [&](const char* why) {
      throw Error(ErrorCode::kInvalidArgument,
                  "ray " + std::to_string(i) + " of " + std::to_string(rays.size()) + ": " + why);
    };
    const Ray3d ray = to_ray3d(rays[i]);
    const auto tmin = static_cast<double>(rays[i].tmin);
    const auto tmax = static_cast<double>(rays[i].tmax);
    if (!is_finite(ray.origin)) refuse("its origin is not finite");
    if (!is_finite(ray.direction)) refuse("its direction is not finite");
    if (!(magnitude(ray.direction) > 0.0)) refuse("its direction is zero");
    if (!std::isfinite(tmin) || std::isnan(tmax)) refuse("its range is not a number");
    const Vec3d direction = unit_of(ray.direction);
    const double scale = dot(ray.direction, direction);
    lines.push_back({ray.origin, direction, tmin * scale, larger(tmin, tmax) * scale});
  }
  return lines;
}

std::vector<GnRay> unordered_sample(std::span<const GnRay> rays, std::size_t most, std::uint64_t seed) {
  std::vector<Draw> draws(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) draws[i] = {hash_of(rays[i], seed), i};
  sort_by_number(draws);
  // Equal rays have drawn equal numbers; the second and later ones draw again, or all or none would be taken.
  bool repeated = false;
  for (std::size_t first = 0; first < draws.size();) {
    const std::uint64_t number = draws[first].number;
    std::size_t last = first + 1;
    for (; last < draws.size() && draws[last].number == number; ++last) {
      draws[last].number = mix_bits(number + (last - first) * 0x9e3779b97f4a7c15ULL);
      repeated = true;
    }
    first = last;
  }
  if (repeated) sort_by_number(draws);
  std::vector<GnRay> out;
  out.reserve(std::min(most, draws.size()));
  for (std::size_t i = 0; i < draws.size() && i < most; ++i) out.push_back(rays[draws[i].ray]);
  return out;
}

Box3d extent_of(std::span<const RayLine> lines) {
  Box3d box;
  for (const RayLine& line : lines) {
    extend(box, line.at(line.begin));
    if (std::isfinite(line.end)) extend(box, line.at(line.end));
  }
  return box;
}

void end_within(std::span<RayLine> lines, const Box3d& bounds) {
  for (RayLine& line : lines) {
    if (std::isfinite(line.end)) continue;
    const auto inside = intersect({line.origin, line.direction}, bounds);
    line.end = inside ? larger(line.begin, inside->exit) : line.begin;
  }
}

}  // namespace gnomon
