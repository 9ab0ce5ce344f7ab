#include "gnomon/areas/area_rays.h"

#include <limits>

#include "gnomon/scene/steady_random.h"

namespace gnomon {
namespace {

// Rounding to float moves a point by up to sqrt(3) 2^-24 of its largest coordinate.
constexpr double kInset = 0x1p-22;

double sine(double angle) {
  return sin_turns(angle / (2.0 * kPi));
}
double cosine(double angle) {
  return cos_turns(angle / (2.0 * kPi));
}

double non_negative_root(double x) {
  return x > 0.0 ? std::sqrt(x) : 0.0;
}

Vec3d direction_of(double sin_yaw, double cos_yaw, double sin_pitch, double cos_pitch) {
  return {sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch};
}

// Uniform in solid angle within a window. At yaw y pitches up to sin p = t cos y / sqrt(1 + t^2 cos^2 y) are
// in it (t = tan half height), and the integral of that is asin(sin(half height) sin y): yaw is its inverse
// of a uniform number, and the sine of pitch is uniform up to its limit.
Vec3d even_direction(const Vec2d& half_window, double tan_y, double u, double v) {
  const double sin_half = sine(half_window[1]);
  const double whole = std::asin(sine(half_window[0]) * sin_half);
  const double sin_yaw = sine(u * whole) / sin_half;
  const double cos_yaw = non_negative_root(1.0 - sin_yaw * sin_yaw);
  const double slope = tan_y * cos_yaw;
  const double sin_pitch = v * slope / std::sqrt(1.0 + slope * slope);
  return direction_of(sin_yaw, cos_yaw, sin_pitch, non_negative_root(1.0 - sin_pitch * sin_pitch));
}

Vec3d direction_on_sphere(SteadyRandom& random) {
  const double z = random.between(-1.0, 1.0);
  const double turns = random.unit();
  const double radius = non_negative_root(1.0 - z * z);
  return {radius * cos_turns(turns), radius * sin_turns(turns), z};
}

// A ray in local coordinates; t counts lengths along the unit direction.
struct LocalRay {
  Vec3d origin;
  Vec3d direction;
  double end;
};

class RaySource {
 public:
  RaySource(const InfluenceArea& area, RayMeasure measure, RayStart start)
      : area_(area), measure_(measure), start_(start) {
    // The window's corners: of the region's eight those that are not at its far end.
    const auto add_corners = [&](double x, double y, double z) {
      for (const double u : {-x, x}) {
        for (const double v : {-y, y})
          inset_ = larger(inset_, kInset * magnitude(to_world(area.frame(), {u, v, z})));
      }
    };
    if (const auto* frustum = std::get_if<Frustum>(&area.region())) {
      const double near = frustum->near_distance;
      add_corners(near * frustum->tan_x, near * frustum->tan_y, near);
    } else {
      add_corners(area.half_window()[0], area.half_window()[1], 0.0);
    }
  }

  [[nodiscard]] LocalRay draw(SteadyRandom& random) const {
    if (const auto* ball = std::get_if<Ball>(&area_.region()))
      return {{0.0, 0.0, 0.0}, direction_on_sphere(random), ball->radius};
    const double u = random.between(-1.0, 1.0);
    const double v = random.between(-1.0, 1.0);
    if (const auto* frustum = std::get_if<Frustum>(&area_.region())) return through_window(*frustum, u, v);
    const auto [w, h] = area_.half_window();
    const double depth = 2.0 * std::get<OrientedBox>(area_.region()).half[2];
    const double z = smaller(inset_, 0.5 * depth);
    return {{kept_within(u * w, w, inset_), kept_within(v * h, h, inset_), z}, {0.0, 0.0, 1.0}, depth - z};
  }

 private:
  // Moves what is inside +-limit at least `inset` away from it; what is not (kYawPitch) stays.
  static double kept_within(double x, double limit, double inset) {
    const double most = larger(limit - inset, 0.0);
    if (!(std::abs(x) <= limit)) return x;
    return smaller(larger(x, -most), most);
  }

  [[nodiscard]] Vec3d direction_at(const Frustum& frustum, double u, double v) const {
    const auto [x, y] = area_.half_window();
    if (measure_ == RayMeasure::kNearPlane) return unit_of({u * frustum.tan_x, v * frustum.tan_y, 1.0});
    if (measure_ == RayMeasure::kSolidAngle) return even_direction({x, y}, frustum.tan_y, u, v);
    return direction_of(sine(u * x), cosine(u * x), sine(v * y), cosine(v * y));
  }

  [[nodiscard]] LocalRay through_window(const Frustum& frustum, double u, double v) const {
    const Vec3d d = direction_at(frustum, u, v);
    const double end = frustum.far_distance / d[2];
    if (start_ == RayStart::kEye) return {{0.0, 0.0, 0.0}, d, end};
    const double z =
        frustum.near_distance + smaller(inset_, 0.5 * (frustum.far_distance - frustum.near_distance));
    const double t = z / d[2];
    // An inset from a slanted side is longer across the window.
    const double inset_x = inset_ * std::sqrt(1.0 + frustum.tan_x * frustum.tan_x);
    const double inset_y = inset_ * std::sqrt(1.0 + frustum.tan_y * frustum.tan_y);
    return {{kept_within(t * d[0], z * frustum.tan_x, inset_x),
             kept_within(t * d[1], z * frustum.tan_y, inset_y), z},
            d,
            end - t};
  }

  const InfluenceArea& area_;
  RayMeasure measure_;
  RayStart start_;
  double inset_ = 0.0;
};

}  // namespace

std::vector<GnRay> area_rays(const InfluenceArea& area, RayMeasure measure, std::uint64_t count,
                             std::uint64_t seed, const AreaRayOptions& options) {
  require_measure(area, measure);
  const RaySource source(area, measure, options.start);
  AreaFrame turned = area.frame();
  turned.origin = {0.0, 0.0, 0.0};
  std::vector<GnRay> rays;
  rays.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    SteadyRandom random(seed, i);
    const LocalRay local = source.draw(random);
    const Vec3d origin = to_world(area.frame(), local.origin);
    const Vec3d direction = to_world(turned, local.direction);
    GnRay ray{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ray.origin[axis] = static_cast<float>(origin[axis]);
      ray.direction[axis] = static_cast<float>(direction[axis]);
    }
    ray.tmax =
        options.stop_at_far_end ? static_cast<float>(local.end) : std::numeric_limits<float>::infinity();
    rays.push_back(ray);
  }
  return rays;
}

}  // namespace gnomon
