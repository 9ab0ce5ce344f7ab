#include "gnomon/areas/detect_lights.h"

#include <algorithm>
#include <limits>

#include "gnomon/areas/line_model.h"
#include "gnomon/areas/membership.h"
#include "gnomon/areas/ray_regions.h"

namespace gnomon {
namespace {

constexpr double kAsksWithin = 1e-3;  // radians, and of the distance to a panel
constexpr std::size_t kFewest = 16;
constexpr double kOutside = 0.0025;
constexpr double kNone = std::numeric_limits<double>::infinity();

Vec3d to_double(const float* v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

// A light as rays know it.
class Asked {
 public:
  Asked(const Scene& scene, const LightArea& light)
      : scene_(scene), light_(scene.lights[light.light]), index_(light.light), area_(light.area) {
    model_.kind =
        light_.kind == LightKind::kDirectional ? LineModel::Kind::kBundle : LineModel::Kind::kConverging;
    model_.apex = to_double(light_.position.data());
    if (light_.kind == LightKind::kDirectional) model_.axis = -unit_of(to_double(light_.direction.data()));
    for (const std::uint32_t i : light_.triangles) {
      for (const float* v : {scene.triangles[i].v0, scene.triangles[i].v1, scene.triangles[i].v2})
        extend(panel_, to_double(v));
    }
  }

  // How far off the ray is, at most kAsksWithin; infinite if it does not ask this light.
  [[nodiscard]] double miss_of(const RayLine& line) const {
    if (light_.kind == LightKind::kArea) return miss_of_panel(line);
    if (light_.kind != LightKind::kDirectional) {
      // It must not end before the lamp, nor go on beyond it by more than a little.
      const double distance = length(model_.apex - line.origin);
      if (std::abs(line.end - distance) > 0.01 * distance) return kNone;
    } else if (std::isfinite(line.end)) {
      return kNone;
    }
    const double miss = 2.0 * std::sqrt(model_.share_of(line));
    return miss <= kAsksWithin ? miss : kNone;
  }

  void add(const RayLine& line) { lines_.push_back(line); }

  [[nodiscard]] LightRegion region(std::size_t all, const Box3d& bounds) {
    end_within(lines_, bounds);
    LightRegion out{index_, area_, area_};
    out.count = lines_.size();
    out.coverage = all == 0 ? 0.0 : static_cast<double>(lines_.size()) / static_cast<double>(all);
    out.spread = spread_about(model_, lines_).angle;
    if (lines_.size() >= kFewest) {
      if (const auto around = rays_region()) {
        out.region = *around;
        out.shrunk = true;
      }
    }
    out.inside = share_inside(out.region, lines_);
    return out;
  }

 private:
  [[nodiscard]] double miss_of_panel(const RayLine& line) const {
    if (!std::isfinite(line.end) || light_.triangles.empty()) return kNone;
    // Shadow rays stop a little short of the panel: they are followed on for a hundredth of their length.
    const Vec3d end = line.at(line.end);
    double nearest = kNone;
    const double reach = 0.001 * (line.end - line.begin);
    Box3d about = panel_;
    for (std::size_t k = 0; k < 3; ++k) {
      about.lo[k] -= reach;
      about.hi[k] += reach;
    }
    if (!contains(about, end)) return kNone;
    for (const std::uint32_t i : light_.triangles) {
      const Triangle& t = scene_.triangles[i];
      nearest =
          smaller(nearest, distance_to_triangle(end, to_double(t.v0), to_double(t.v1), to_double(t.v2)));
    }
    return nearest <= reach ? nearest / larger(line.end, 1e-300) : kNone;
  }

  // A panel's area serves the rays that begin in front of it: those alone say how deep it must be.
  [[nodiscard]] std::optional<InfluenceArea> rays_region() const {
    if (area_.kind() != AreaKind::kPlane) return frustum_about(lines_, model_.apex, kOutside);
    if (light_.kind == LightKind::kDirectional) return box_about(lines_, area_.frame().forward, kOutside);
    std::vector<RayLine> in_front;
    for (const RayLine& line : lines_) {
      if (area_.contains(line.at(line.begin))) in_front.push_back(line);
    }
    return box_about(in_front, area_.frame().forward, kOutside);
  }

  const Scene& scene_;
  const Light& light_;
  std::size_t index_;
  InfluenceArea area_;
  LineModel model_;
  Box3d panel_;
  std::vector<RayLine> lines_;
};

}  // namespace

std::vector<LightRegion> detect_lights(const Scene& scene, std::span<const GnRay> rays) {
  std::vector<Asked> lights;
  for (const LightArea& light : areas_of_lights(scene)) lights.emplace_back(scene, light);
  const std::vector<RayLine> lines = lines_of(rays);
  for (const RayLine& line : lines) {
    Asked* nearest = nullptr;
    double least = kNone;
    for (Asked& light : lights) {
      const double miss = light.miss_of(line);
      if (miss < least) {
        least = miss;
        nearest = &light;
      }
    }
    if (nearest != nullptr) nearest->add(line);
  }
  const Bounds of_scene = bounds_of(scene);
  const Box3d bounds{to_double(of_scene.lo.data()), to_double(of_scene.hi.data())};
  std::vector<LightRegion> out;
  for (Asked& light : lights) out.push_back(light.region(lines.size(), bounds));
  return out;
}

}  // namespace gnomon
