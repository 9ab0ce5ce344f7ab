#include "gnomon/areas/areas_from_scene.h"

#include <algorithm>
#include <optional>

namespace gnomon {
namespace {

// Windows and depths get this much of the scene's size more on every side, so that what was measured in other
// roundings is inside, and so that flat scenes have windows at all.
constexpr double kMargin = 1e-6;
// Nearer to a spot than this share of its reach is outside its frustum, which must begin somewhere.
constexpr double kNearShare = 0x1p-10;
// Wider frusta have corners so far out that the ball is the smaller region: at 75 degrees to the side they
// are 5.4 times as far as the range.
constexpr double kWidestCone = 1.3089969389957472;  // half angle, 75 degrees

// Each takes a test of every sampled ray.
constexpr std::size_t kMostBounded = 64;

Vec3d to_double(const float* v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

Box3d to_double(const Bounds& bounds) {
  return {to_double(bounds.lo.data()), to_double(bounds.hi.data())};
}

void extend_in(const AreaFrame& frame, Box3d& extent, const Triangle& t) {
  for (const float* corner : {t.v0, t.v1, t.v2}) extend(extent, to_local(frame, to_double(corner)));
}

class LightAreas {
 public:
  explicit LightAreas(const Scene& scene) : scene_(scene), bounds_(to_double(bounds_of(scene))) {
    margin_ = kMargin * larger(length(bounds_.hi - bounds_.lo), magnitude(bounds_.hi));
    margin_ = larger(larger(margin_, kMargin * magnitude(bounds_.lo)), kMargin);
  }

  [[nodiscard]] std::optional<InfluenceArea> area_of(const Light& light) const {
    switch (light.kind) {
      case LightKind::kDirectional:
        return across(light);
      case LightKind::kPoint:
        return around(light);
      case LightKind::kSpot:
        return light.outer_cone > kWidestCone ? around(light) : within_cone(light);
      case LightKind::kArea:
        return in_front_of(light);
    }
    return std::nullopt;
  }

 private:
  // The window box of `extent`, given in the frame's local coordinates.
  [[nodiscard]] InfluenceArea window_around(const AreaFrame& frame, const Box3d& extent) const {
    const Vec3d size = extent.hi - extent.lo;
    PlaneWindow window;
    window.point = to_world(frame, {0.5 * (extent.lo[0] + extent.hi[0]), 0.5 * (extent.lo[1] + extent.hi[1]),
                                    extent.lo[2] - margin_});
    window.direction = frame.forward;
    window.up = frame.up;
    window.half_width = 0.5 * size[0] + margin_;
    window.half_height = 0.5 * size[1] + margin_;
    window.depth = size[2] + 2.0 * margin_;
    return InfluenceArea::plane(window);
  }

  // Every ray along a sun's direction that can meet the scene crosses this box, and no narrower one turned
  // alike will do.
  [[nodiscard]] InfluenceArea across(const Light& light) const {
    const AreaFrame frame =
        look_along(0.5 * (bounds_.lo + bounds_.hi), to_double(light.direction.data()), kWorldUp);
    Box3d extent;
    for (const Triangle& t : scene_.triangles) extend_in(frame, extent, t);
    return window_around(frame, extent);
  }

  // How far a light's rays matter: its range if it has one, but not beyond the scene.
  [[nodiscard]] double reach_of(const Light& light) const {
    const Vec3d from = to_double(light.position.data());
    double farthest = 0.0;
    for (unsigned i = 0; i < 8; ++i) farthest = larger(farthest, length(corner_of(bounds_, i) - from));
    const double range = static_cast<double>(light.range);
    return range > 0.0 ? smaller(range, farthest + margin_) : farthest + margin_;
  }

  // A bulb has no direction to look along, so no window: a ball, where each ray is measured by solid angle.
  [[nodiscard]] InfluenceArea around(const Light& light) const {
    return InfluenceArea::omni(to_double(light.position.data()), reach_of(light));
  }

  // The far plane touches the ball of the range where the axis meets it, so the whole cone is inside. A cone
  // of nearly no width still gets a window.
  [[nodiscard]] InfluenceArea within_cone(const Light& light) const {
    PointView view;
    view.eye = to_double(light.position.data());
    view.direction = to_double(light.direction.data());
    view.fov_x = view.fov_y = larger(2.0 * static_cast<double>(light.outer_cone), kMargin);
    view.far_distance = reach_of(light);
    view.near_distance = kNearShare * view.far_distance;
    return InfluenceArea::point(view);
  }

  // The parallel core of a panel's light: what its rays along the normal cross. Rays that leave it slantwise
  // are not affine and take the global tree. Both sides of a panel shine in gnomon's pictures, but its normal
  // says where it is meant to. A closed emitter has no mean normal and is a bulb.
  [[nodiscard]] std::optional<InfluenceArea> in_front_of(const Light& light) const {
    if (light.triangles.empty()) return std::nullopt;
    const Vec3d normal = to_double(light.direction.data());
    if (!(magnitude(normal) > 0.0)) return around(light);
    const AreaFrame frame = look_along(to_double(light.position.data()), normal, kWorldUp);
    Box3d extent;
    for (const std::uint32_t index : light.triangles) extend_in(frame, extent, scene_.triangles.at(index));
    double farthest = extent.hi[2];
    for (unsigned i = 0; i < 8; ++i) farthest = larger(farthest, to_local(frame, corner_of(bounds_, i))[2]);
    if (farthest <= extent.hi[2] + margin_) return std::nullopt;  // nothing stands in front
    extent.hi[2] = farthest;
    return window_around(frame, extent);
  }

  const Scene& scene_;
  Box3d bounds_;
  double margin_ = 0.0;
};

}  // namespace

std::vector<LightArea> areas_of_lights(const Scene& scene) {
  std::vector<LightArea> areas;
  if (scene.triangles.empty()) return areas;
  const LightAreas maker(scene);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    if (auto area = maker.area_of(scene.lights[i])) areas.push_back({i, *area});
  }
  return areas;
}

std::optional<InfluenceArea> area_of_light(const Scene& scene, const Light& light) {
  if (scene.triangles.empty()) return std::nullopt;
  return LightAreas(scene).area_of(light);
}

std::vector<InfluenceArea> bounded_areas_of_lights(const Scene& scene) {
  std::vector<InfluenceArea> areas;
  if (scene.triangles.empty()) return areas;
  const LightAreas maker(scene);
  for (std::size_t i = 0; i < std::min(kMostBounded, scene.lights.size()); ++i) {
    if (scene.lights[i].kind == LightKind::kDirectional) continue;
    if (auto area = maker.area_of(scene.lights[i])) areas.push_back(*area);
  }
  return areas;
}

}  // namespace gnomon
