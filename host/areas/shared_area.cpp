#include "gnomon/areas/shared_area.h"

#include <algorithm>
#include <string>

#include "gnomon/base/error.h"

namespace gnomon {
namespace {

constexpr double kLargest = 0x1p48;
constexpr double kSmallest = 0x1p-40;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

float float_below(double x) {
  const auto nearest = static_cast<float>(x);
  return static_cast<double>(nearest) > x ? std::nextafter(nearest, -kInfinity) : nearest;
}

void copy(const Vec3d& from, float* to) {
  for (std::size_t axis = 0; axis < 3; ++axis) to[axis] = static_cast<float>(from[axis]);
}

}  // namespace

FloatBox float_box_around(const Box3d& box) {
  FloatBox around{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    around.lo[axis] = float_below(box.lo[axis]);
    around.hi[axis] = -float_below(-box.hi[axis]);
  }
  return around;
}

GnArea to_shared(const InfluenceArea& area, double tolerance) {
  const Box3d box = area.enclosing_box();
  const double size = larger(magnitude(box.lo), magnitude(box.hi));
  if (!(size <= kLargest && size >= kSmallest)) {
    throw Error(ErrorCode::kInvalidArgument,
                "an influence area's largest coordinate must be between 2^-40 and 2^48");
  }
  if (!(tolerance >= 0.0)) {
    throw Error(ErrorCode::kInvalidArgument,
                "affinity_tolerance must be at least 0, but is " + std::to_string(tolerance));
  }
  GnArea out{};
  const std::span<const Plane> planes = area.planes();
  for (std::size_t i = 0; i < planes.size(); ++i) {
    copy(planes[i].normal, out.planes + 4 * i);
    out.planes[4 * i + 3] = static_cast<float>(planes[i].offset);
  }
  const FloatBox around = float_box_around(box);
  std::copy_n(around.lo.data(), 3, out.lo);
  std::copy_n(around.hi.data(), 3, out.hi);
  for (std::size_t axis = 0; axis < 3; ++axis)
    out.size = std::max({out.size, std::abs(out.lo[axis]), std::abs(out.hi[axis])});
  out.kind = static_cast<std::uint32_t>(area.kind());
  copy(area.kind() == AreaKind::kPlane ? area.frame().forward : area.frame().origin, out.focus);
  const double cosine = larger(1.0 - tolerance, 0.0);
  out.affinity = static_cast<float>(cosine * cosine);
  if (const auto* ball = std::get_if<Ball>(&area.region())) out.radius = static_cast<float>(ball->radius);
  out.root = GN_NONE;
  return out;
}

GnRegion to_region(const InfluenceArea& area, const Box3d& scene) {
  if (area.kind() == AreaKind::kOmni) {
    throw Error(ErrorCode::kInvalidArgument,
                "rays are tested against a region's planes, and a ball has none: take the box around it");
  }
  const GnArea shared = to_shared(area);
  GnRegion out{};
  for (float& offset : out.planes[3]) offset = GN_EVERYWHERE;
  for (std::size_t i = 0; i < GN_AREA_PLANES; ++i) {
    for (std::size_t k = 0; k < 4; ++k) out.planes[k][i] = shared.planes[4 * i + k];
  }
  const FloatBox around = float_box_around(scene);
  std::copy_n(around.lo.data(), 3, out.lo);
  std::copy_n(around.hi.data(), 3, out.hi);
  out.size = shared.size;
  out.root = GN_NONE;
  return out;
}

}  // namespace gnomon
