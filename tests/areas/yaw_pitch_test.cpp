// Areas in the (yaw, pitch) plane.
#include "gnomon/areas/yaw_pitch.h"

#include <catch2/catch.hpp>

#include "area_test_tools.h"
#include "gnomon/areas/convex_polygon.h"
#include "gnomon/areas/projection.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

// The same by brute force: strips of constant yaw, each cut from the polygon's pitches there.
double by_strips(const Polygon3d& polygon, double half_yaw, double half_pitch, int strips) {
  double sum = 0.0;
  const double width = 2.0 * half_yaw / strips;
  for (int i = 0; i < strips; ++i) {
    const double yaw = -half_yaw + (i + 0.5) * width;
    double lowest = 10.0;
    double highest = -10.0;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vec3d& p = polygon[k];
      const Vec3d& q = polygon[(k + 1) % polygon.size()];
      const double p_side = p[0] * std::cos(yaw) - p[2] * std::sin(yaw);
      const double q_side = q[0] * std::cos(yaw) - q[2] * std::sin(yaw);
      if ((p_side < 0.0) == (q_side < 0.0)) continue;
      const Vec3d at = p + p_side / (p_side - q_side) * (q - p);
      const double pitch = std::atan(at[1] / std::hypot(at[0], at[2]));
      lowest = std::min(lowest, pitch);
      highest = std::max(highest, pitch);
    }
    if (lowest > highest) continue;
    sum += width * std::max(0.0, std::min(highest, half_pitch) - std::max(lowest, -half_pitch));
  }
  return sum;
}

}  // namespace

TEST_CASE("a wall that spans all pitches covers its yaw times the window's pitch, exactly") {
  for (const double half_yaw : {0.01, 0.5, 1.5}) {
    for (const double half_pitch : {0.01, 0.5, 1.5}) {
      const double x = std::tan(half_yaw);
      const double y = 1.01 * std::tan(half_pitch) / std::cos(half_yaw);
      CAPTURE(half_yaw, half_pitch);
      REQUIRE(yaw_pitch_area_of({{-x, -y, 1}, {x, -y, 1}, {x, y, 1}, {-x, y, 1}}, half_pitch) ==
              Approx(4.0 * half_yaw * half_pitch).epsilon(1e-11));
      // Upper half only, and turned round.
      REQUIRE(yaw_pitch_area_of({{-x, y, 1}, {x, y, 1}, {x, 0, 1}, {-x, 0, 1}}, half_pitch) ==
              Approx(2.0 * half_yaw * half_pitch).epsilon(1e-11));
    }
  }
}

TEST_CASE("polygons between yaws and pitches known in closed form") {
  // A floor at y = -1 between z = 1 and z = 2, as far as yaw a: pitch = -atan(cos(yaw) / z); to first order
  // in a small a its height is atan(1) - atan(1/2).
  const double a = 1e-4;
  const double x = std::tan(a);
  REQUIRE(yaw_pitch_area_of({{-x, -1, 1}, {x, -1, 1}, {2 * x, -1, 2}, {-2 * x, -1, 2}}, 1.5) ==
          Approx(2.0 * a * (std::atan(1.0) - std::atan(0.5))).epsilon(1e-7));
  REQUIRE(yaw_pitch_area_of({}, 1.0) == 0.0);
  REQUIRE(yaw_pitch_area_of({{0, -1, 1}, {0, 1, 1}, {0, 1, 2}}, 1.0) == 0.0);  // upright, edge-on
}

TEST_CASE("areas agree with strips of constant yaw, cut by the cones or not") {
  Source source(61);
  int cut = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec3d centre =
        unit_of({source.between(-1.0, 1.0), source.between(-1.0, 1.0), source.between(0.8, 1.6)});
    const Vec3d u = source.direction();
    const Vec3d v = unit_of(cross(u, source.direction()));
    const double size = std::exp2(source.between(-6.0, -0.5));
    Polygon3d polygon;
    for (int k = 0; k < 5; ++k)
      polygon.push_back(centre + size * std::cos(1.2 * k) * u + size * std::sin(1.2 * k) * v);
    if (!std::all_of(polygon.begin(), polygon.end(), [](const Vec3d& p) { return p[2] > 0.02; })) continue;
    const double half_pitch = source.between(0.05, 1.4);
    CAPTURE(i, polygon, half_pitch);
    const double expected = by_strips(polygon, kPiD / 2.0, half_pitch, 20000);
    REQUIRE(yaw_pitch_area_of(polygon, half_pitch) == Approx(expected).epsilon(1e-3).margin(1e-6));
    cut += expected < 0.9 * by_strips(polygon, kPiD / 2.0, 1.57, 2000) ? 1 : 0;
  }
  REQUIRE(cut > 50);
}

TEST_CASE("a box's faces together cover what its outline does") {
  // Split boxes: parts that lie side by side as the eye sees them must add up to the whole.
  Source source(62);
  for (const auto& [name, view] : point_views()) {
    const InfluenceArea area = InfluenceArea::point(view);
    const Frustum& frustum = std::get<Frustum>(area.region());
    for (int i = 0; i < 30; ++i) {
      // A flat wall seen from the eye, cut in two.
      Box3d wall = source.box(-3.0, 3.0);
      const std::size_t axis = static_cast<std::size_t>(i) % 3;
      wall.hi[axis] = wall.lo[axis];
      const std::size_t along = (axis + 1) % 3;
      Box3d first = wall;
      Box3d second = wall;
      const double s = source.between(0.0, 1.0);
      first.hi[along] = second.lo[along] = wall.lo[along] + s * (wall.hi[along] - wall.lo[along]);
      CAPTURE(name, i, wall.lo, wall.hi, s, frustum.tan_x);
      for (const RayMeasure measure :
           {RayMeasure::kSolidAngle, RayMeasure::kNearPlane, RayMeasure::kYawPitch}) {
        const double whole = culled_measure(area, wall, measure, RayStart::kEye);
        const double parts = culled_measure(area, first, measure, RayStart::kEye) +
                             culled_measure(area, second, measure, RayStart::kEye);
        const double window = window_measure(area, measure);
        CAPTURE(to_string(measure), window);
        REQUIRE(parts == Approx(whole).epsilon(1e-9).margin(1e-10 * window));
      }
    }
  }
}
