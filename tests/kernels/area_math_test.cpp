// The float arithmetic of areas against the double one of host/areas: safe, and not wasteful.
#include "gnomon/shared/area_math.h"

#include <catch2/catch.hpp>

#include "gnomon/areas/shared_area.h"
#include "support/area_shapes.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

// How deep inside a point is: the least distance to a face, negative outside.
double depth_of(const InfluenceArea& area, const Vec3d& p) {
  if (const auto* ball = std::get_if<Ball>(&area.region())) return ball->radius - length(p - ball->centre);
  double depth = std::numeric_limits<double>::infinity();
  for (const Plane& plane : area.planes()) depth = smaller(depth, signed_distance(plane, p));
  return depth;
}

// The note's R: what the margin is measured by.
double reach_of(const GnArea& area, const GnRayStart& start) {
  return static_cast<double>(std::max(area.size, start.reach));
}

struct Tally {
  int contained = 0;
  int refused = 0;
};

// A ray that the float code calls inside is inside, from one ulp before tmin to one ulp after the exit.
void require_safe(const InfluenceArea& area, const GnRay& ray, const GnArea& shared, Tally& tally) {
  const GnRayStart start = gn_ray_start(&ray);
  const Vec3d exact_start = point_at(ray, static_cast<double>(ray.tmin));
  CAPTURE(ray.origin, ray.direction, ray.tmin);
  if (gn_area_contains(&shared, &start) == 0) {
    // Only for starts outside or nearer to a face than twice the margin.
    const double margin = (area.kind() == AreaKind::kOmni ? 0x1p-16 : 0x1p-18) * reach_of(shared, start);
    REQUIRE(depth_of(area, exact_start) <= margin);
    tally.refused += 1;
    return;
  }
  tally.contained += 1;
  REQUIRE(area.contains(exact_start));
  const float exit = gn_area_exit(&shared, &start);
  REQUIRE(exit >= ray.tmin);
  REQUIRE(depth_of(area, point_at(ray, static_cast<double>(std::nextafter(ray.tmin, -kInf)))) >= 0.0);
  if (exit < kInf)
    REQUIRE(depth_of(area, point_at(ray, static_cast<double>(std::nextafter(exit, kInf)))) >= 0.0);
  const std::optional<double> true_exit = area.exit_distance({exact_start, to_ray3d(ray).direction});
  REQUIRE(true_exit.has_value());
  REQUIRE(static_cast<double>(exit) <= static_cast<double>(ray.tmin) + *true_exit);
}

// The exit is at a face, or within 2^-16 of R of it.
void require_close(const InfluenceArea& area, const GnRay& ray, const GnArea& shared) {
  const GnRayStart start = gn_ray_start(&ray);
  if (gn_area_contains(&shared, &start) == 0) return;
  const float exit = gn_area_exit(&shared, &start);
  if (!(exit < kInf)) return;
  CAPTURE(ray.origin, ray.direction, ray.tmin, exit);
  REQUIRE(depth_of(area, point_at(ray, static_cast<double>(exit))) <= 0x1p-15 * reach_of(shared, start));
}

}  // namespace

TEST_CASE("what float calls inside is inside, and what leaves later than float says leaves by a margin") {
  Source source(91);
  for (const Vec3d& offset : {Vec3d{0, 0, 0}, Vec3d{300, -20, 7}, Vec3d{-1e5, 1e5, 4e4}}) {
    for (const double scale : {1.0, 0.01, 1000.0}) {
      Tally tally;
      for (const auto& [name, area] : areas_of_every_kind(offset, scale)) {
        const GnArea shared = to_shared(area);
        CAPTURE(name, offset, scale);
        for (int i = 0; i < 300; ++i) {
          const GnRay ray = ray_near(area, source);
          require_safe(area, ray, shared, tally);
          require_close(area, ray, shared);
        }
      }
      // Far from the origin regions of a hundredth of a unit are all margin.
      if (magnitude(offset) < 1e4 || scale > 0.1) REQUIRE(tally.contained > 2000);
      REQUIRE(tally.refused > 200);
    }
  }
}

TEST_CASE("directions of any length leave a region at the same place") {
  Source source(92);
  Tally tally;
  for (const float length : {1e-30F, 1e-12F, 1e-3F, 1e6F, 1e30F}) {
    for (const auto& [name, area] : areas_of_every_kind()) {
      const GnArea shared = to_shared(area);
      CAPTURE(name, length);
      for (int i = 0; i < 40; ++i) {
        GnRay ray = ray_near(area, source);
        if (ray.tmin != 0.0F) continue;
        for (float& d : ray.direction) d *= length;
        require_safe(area, ray, shared, tally);
      }
    }
  }
  REQUIRE(tally.contained > 2000);
}

TEST_CASE("along a face's plane and just inside, a ray leaves by the other faces") {
  const InfluenceArea area = InfluenceArea::plane(PlaneWindow{});  // [-1, 1] x [-1, 1] x [0, 1]
  const GnArea shared = to_shared(area);
  const auto exit_of = [&](const GnRay& r) {
    const GnRayStart start = gn_ray_start(&r);
    return gn_area_contains(&shared, &start) != 0 ? gn_area_exit(&shared, &start) : -1.0F;
  };
  const float inside = 1.0F - 0x1p-16F;
  REQUIRE(exit_of(ray({inside, 0, 0.5F}, {0, 1, 0})) == Approx(1.0F).epsilon(1e-4));
  REQUIRE(exit_of(ray({0, 0, 0.25F}, {0, 0, 1})) == Approx(0.75F).epsilon(1e-4));
  REQUIRE(exit_of(ray({0, 0, 0.25F}, {0, 0, -4})) == Approx(0.0625F).epsilon(1e-3));
  REQUIRE(exit_of(ray({0, 0, 0.5F}, {0, 0, 1}, 0.25F)) == Approx(0.5F).epsilon(1e-4));
  REQUIRE(exit_of(ray({0, 0, -3}, {0, 0, 1}, 3.25F)) == Approx(4.0F).epsilon(1e-4));
  REQUIRE(exit_of(ray({1.0F, 0, 0.5F}, {-1, 0, 0})) == -1.0F);
  REQUIRE(exit_of(ray({0, 0, 0.0F}, {0, 0, 1})) == -1.0F);
}

TEST_CASE("a tmin that is infinite or beyond the region starts in no area") {
  const GnArea shared = to_shared(InfluenceArea::omni({0, 0, 0}, 2.0));
  for (const float tmin : {kInf, -kInf, 3.0F, -3.0F, 1e30F}) {
    const GnRay r = ray({0, 0, 0}, {0, 0, 1}, tmin);
    const GnRayStart start = gn_ray_start(&r);
    CAPTURE(tmin);
    REQUIRE(gn_area_contains(&shared, &start) == 0);
  }
  const GnRay backwards = ray({0, 0, 0}, {0, 0, 1}, -1.0F);
  const GnRayStart start = gn_ray_start(&backwards);
  REQUIRE(gn_area_contains(&shared, &start) == 1);
  REQUIRE(gn_area_exit(&shared, &start) == Approx(2.0F).epsilon(1e-4));
}

TEST_CASE("affinity in float is that of the double code but for rounding at the limit") {
  Source source(93);
  int affine = 0;
  for (const auto& [name, area] : areas_of_every_kind()) {
    for (const double tolerance : {0.0001, 0.01, 0.3, 1.0, 1.5}) {
      const GnArea shared = to_shared(area, tolerance);
      for (int i = 0; i < 100; ++i) {
        const GnRay r = ray_near(area, source);
        const Vec3d exact_start = point_at(r, static_cast<double>(r.tmin));
        if (!area.contains(exact_start)) continue;
        const Ray3d exact{exact_start, to_ray3d(r).direction};
        const GnRayStart start = gn_ray_start(&r);
        const bool in_float = gn_area_is_affine(&shared, &start) != 0;
        const double slack = 1e-3 * static_cast<double>(start.reach / shared.size + 1.0F);
        CAPTURE(name, tolerance, r.origin, r.direction, r.tmin);
        if (in_float) REQUIRE((tolerance >= 1.0 || area.is_affine(exact, tolerance + slack)));
        if (tolerance >= 1.0) REQUIRE(in_float);
        if (tolerance > slack && area.is_affine(exact, tolerance - slack)) REQUIRE(in_float);
        affine += in_float ? 1 : 0;
      }
    }
  }
  REQUIRE(affine > 3000);
}

TEST_CASE("the shared record names what it cannot hold") {
  REQUIRE_THROWS_WITH(to_shared(InfluenceArea::omni({0, 0, 0}, 1e20)), Catch::Contains("2^48"));
  REQUIRE_THROWS_WITH(to_shared(InfluenceArea::omni({0, 0, 0}, 1e-15)), Catch::Contains("2^-40"));
  const InfluenceArea fine = InfluenceArea::omni({0, 0, 0}, 1.0);
  REQUIRE_THROWS_WITH(to_shared(fine, -0.1), Catch::Contains("affinity_tolerance"));
  REQUIRE_THROWS_WITH(to_shared(fine, std::nan("")), Catch::Contains("affinity_tolerance"));
  REQUIRE(to_shared(fine).root == GN_NONE);
}

TEST_CASE("the float box holds the double one and no float less would") {
  Source source(94);
  for (int i = 0; i < 2000; ++i) {
    const Box3d box = source.box(-1e3, 1e3);
    const FloatBox around = float_box_around(box);
    for (std::size_t k = 0; k < 3; ++k) {
      REQUIRE(static_cast<double>(around.lo[k]) <= box.lo[k]);
      REQUIRE(static_cast<double>(around.hi[k]) >= box.hi[k]);
      REQUIRE(static_cast<double>(std::nextafter(around.lo[k], kInf)) > box.lo[k]);
      REQUIRE(static_cast<double>(std::nextafter(around.hi[k], -kInf)) < box.hi[k]);
    }
  }
}
