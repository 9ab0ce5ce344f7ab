#include "gnomon/areas/influence_area.h"

#include <string>

#include "gnomon/base/error.h"
#include "gnomon/scene/steady_random.h"

namespace gnomon {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

[[noreturn]] void refuse(const char* area, const char* argument, const std::string& why) {
  throw Error(ErrorCode::kInvalidArgument, std::string(area) + " area: " + argument + " " + why);
}

void require_finite(const char* area, const char* argument, const Vec3d& value) {
  if (!is_finite(value)) refuse(area, argument, "must be finite");
}

void require_direction(const char* area, const char* argument, const Vec3d& value) {
  require_finite(area, argument, value);
  if (!(magnitude(value) > 0.0)) refuse(area, argument, "must not be zero");
}

void require_positive(const char* area, const char* argument, double value) {
  if (!(value > 0.0 && value < kInfinity))
    refuse(area, argument, "must be positive and finite, but is " + std::to_string(value));
}

void require_angle(const char* area, const char* argument, double value) {
  if (!(value > 0.0 && value < kPi))
    refuse(area, argument, "must be above 0 and below pi radians, but is " + std::to_string(value));
}

// Not std::tan: with this the same bits come out everywhere.
double tangent_of(double angle) {
  const double turns = angle / (2.0 * kPi);
  return sin_turns(turns) / cos_turns(turns);
}

}  // namespace

InfluenceArea::InfluenceArea(AreaKind kind, const AreaFrame& frame, const Vec2d& half_window,
                             const std::variant<OrientedBox, Frustum, Ball>& region)
    : kind_(kind), frame_(frame), half_window_(half_window), region_(region) {
  if (const auto* box = std::get_if<OrientedBox>(&region_)) planes_ = planes_of(*box);
  if (const auto* frustum = std::get_if<Frustum>(&region_)) planes_ = planes_of(*frustum);
}

InfluenceArea InfluenceArea::plane(const PlaneWindow& window) {
  require_finite("plane", "point", window.point);
  require_direction("plane", "direction", window.direction);
  require_direction("plane", "up", window.up);
  require_positive("plane", "half_width", window.half_width);
  require_positive("plane", "half_height", window.half_height);
  require_positive("plane", "depth", window.depth);
  const AreaFrame frame = look_along(window.point, window.direction, window.up);
  const OrientedBox region{frame.origin + 0.5 * window.depth * frame.forward,
                           {frame.right, frame.up, frame.forward},
                           {window.half_width, window.half_height, 0.5 * window.depth}};
  return {AreaKind::kPlane, frame, {window.half_width, window.half_height}, region};
}

InfluenceArea InfluenceArea::point(const PointView& view) {
  require_finite("point", "eye", view.eye);
  require_direction("point", "direction", view.direction);
  require_direction("point", "up", view.up);
  require_angle("point", "fov_x", view.fov_x);
  require_angle("point", "fov_y", view.fov_y);
  require_positive("point", "near_distance", view.near_distance);
  require_positive("point", "far_distance", view.far_distance);
  if (!(view.far_distance > view.near_distance))
    refuse("point", "far_distance", "must be greater than near_distance");
  const AreaFrame frame = look_along(view.eye, view.direction, view.up);
  const Frustum region{frame, tangent_of(0.5 * view.fov_x), tangent_of(0.5 * view.fov_y), view.near_distance,
                       view.far_distance};
  return {AreaKind::kPoint, frame, {0.5 * view.fov_x, 0.5 * view.fov_y}, region};
}

InfluenceArea InfluenceArea::omni(const Vec3d& centre, double radius) {
  require_finite("omni", "centre", centre);
  require_positive("omni", "radius", radius);
  AreaFrame frame;
  frame.origin = centre;
  return {AreaKind::kOmni, frame, {0.0, 0.0}, Ball{centre, radius}};
}

bool InfluenceArea::contains(const Vec3d& p) const {
  return std::visit([&](const auto& body) { return gnomon::contains(body, p); }, region_);
}

bool InfluenceArea::overlaps(const Box3d& box) const {
  return std::visit([&](const auto& body) { return overlap(body, box); }, region_);
}

bool InfluenceArea::fully_contains(const Box3d& box) const {
  if (is_empty(box)) return false;
  for (unsigned i = 0; i < 8; ++i) {
    if (!contains(corner_of(box, i))) return false;
  }
  return true;
}

Box3d InfluenceArea::enclosing_box() const {
  Box3d box;
  std::visit(
      [&](const auto& body) {
        if constexpr (std::is_same_v<decltype(body), const Ball&>) {
          const Vec3d reach{body.radius, body.radius, body.radius};
          box = {body.centre - reach, body.centre + reach};
        } else {
          for (const Vec3d& corner : corners_of(body)) extend(box, corner);
        }
      },
      region_);
  const double slack = 0x1p-49 * larger(magnitude(box.lo), magnitude(box.hi));
  return {box.lo - Vec3d{slack, slack, slack}, box.hi + Vec3d{slack, slack, slack}};
}

std::span<const Plane> InfluenceArea::planes() const {
  if (kind_ == AreaKind::kOmni) return {};
  return planes_;
}

Vec3d InfluenceArea::direction_at(const Vec3d& p) const {
  if (kind_ == AreaKind::kPlane || p == frame_.origin) return frame_.forward;
  return unit_of(p - frame_.origin);
}

bool InfluenceArea::is_affine(const Ray3d& ray, double tolerance) const {
  if (!contains(ray.origin) || !(magnitude(ray.direction) > 0.0)) return false;
  if (kind_ == AreaKind::kOmni && ray.origin == frame_.origin) return true;
  return std::abs(dot(unit_of(ray.direction), direction_at(ray.origin))) >= 1.0 - tolerance;
}

std::optional<double> InfluenceArea::exit_distance(const Ray3d& ray) const {
  if (!contains(ray.origin)) return std::nullopt;
  double exit = kInfinity;
  if (const auto* ball = std::get_if<Ball>(&region_)) {
    // |o + t d|^2 = r^2 about the centre; the form of the root in which nothing cancels.
    const Vec3d o = ray.origin - ball->centre;
    const double a = dot(ray.direction, ray.direction);
    const double b = dot(o, ray.direction);
    const double c = smaller(dot(o, o) - ball->radius * ball->radius, 0.0);
    const double root = std::sqrt(b * b - a * c);
    if (a > 0.0) exit = b > 0.0 ? -c / (b + root) : (root - b) / a;
    return exit;
  }
  for (const Plane& plane : planes()) {
    const double slope = dot(plane.normal, ray.direction);
    // Rounding may put an origin on the boundary a little outside: it leaves at once, not before it starts.
    if (slope < 0.0) exit = smaller(exit, larger(0.0, signed_distance(plane, ray.origin) / -slope));
  }
  return exit;
}

}  // namespace gnomon
