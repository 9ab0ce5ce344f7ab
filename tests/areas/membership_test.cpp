// Which triangles belong to an area.
#include "gnomon/areas/membership.h"

#include <catch2/catch.hpp>

#include "area_test_tools.h"
#include "support/shapes.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

Vec3d corner_at(const GnTriangle& t, std::size_t i) {
  const float* v = corner(t, i);
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

GnTriangle triangle_of(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const auto to_float = [](const Vec3d& v) {
    return std::array<float, 3>{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
  };
  return triangle(to_float(a), to_float(b), to_float(c));
}

// A lattice of points of the triangle, its corners and edges among them: some inside the area?
bool sampled_inside(const InfluenceArea& area, const GnTriangle& t, int steps) {
  const Vec3d a = corner_at(t, 0);
  const Vec3d u = corner_at(t, 1) - a;
  const Vec3d v = corner_at(t, 2) - a;
  for (int i = 0; i <= steps; ++i) {
    for (int k = 0; i + k <= steps; ++k) {
      if (area.contains(a + static_cast<double>(i) / steps * u + static_cast<double>(k) / steps * v))
        return true;
    }
  }
  return false;
}

GnTriangle random_triangle(Source& source, double spread) {
  const Vec3d centre = source.point(-5.0, 5.0);
  const double size = spread * std::exp2(source.between(-3.0, 2.0));
  return triangle_of(centre + source.point(-size, size), centre + source.point(-size, size),
                     centre + source.point(-size, size));
}

std::vector<std::pair<std::string, InfluenceArea>> some_areas() {
  std::vector<std::pair<std::string, InfluenceArea>> areas;
  for (const auto& [name, view] : point_views()) areas.emplace_back(name, InfluenceArea::point(view));
  for (const auto& [name, window] : plane_windows())
    areas.emplace_back("plane", InfluenceArea::plane(window));
  areas.emplace_back("omni", InfluenceArea::omni({0.5, -1.0, 2.0}, 1.5));
  return areas;
}

}  // namespace

TEST_CASE(
    "a triangle of which any sampled point is inside belongs, and what belongs is seen by finer samples") {
  Source source(81);
  int belong = 0;
  int missed_by_samples = 0;
  for (const auto& [name, area] : some_areas()) {
    for (int i = 0; i < 150; ++i) {
      const GnTriangle t = random_triangle(source, 1.0);
      CAPTURE(name, i, t.v0, t.v1, t.v2);
      const bool exact = touches(area, t);
      if (sampled_inside(area, t, 30)) {
        REQUIRE(exact);
      } else if (exact && !sampled_inside(area, t, 300)) {
        ++missed_by_samples;  // a corner or sliver of it only, finer than a 300th of its size
      }
      belong += exact ? 1 : 0;
    }
  }
  REQUIRE(belong > 500);
  REQUIRE(missed_by_samples < belong / 50);
}

TEST_CASE("triangles apart from the area by any plane do not belong") {
  Source source(82);
  int apart = 0;
  for (const auto& [name, area] : some_areas()) {
    for (int i = 0; i < 300; ++i) {
      const GnTriangle t = random_triangle(source, 0.5);
      bool separated = false;
      for (const Plane& plane : area.planes()) {
        separated |= signed_distance(plane, corner_at(t, 0)) < -1e-6 &&
                     signed_distance(plane, corner_at(t, 1)) < -1e-6 &&
                     signed_distance(plane, corner_at(t, 2)) < -1e-6;
      }
      if (!separated) continue;
      CAPTURE(name, i, t.v0, t.v1, t.v2);
      REQUIRE_FALSE(touches(area, t));
      ++apart;
    }
  }
  REQUIRE(apart > 1000);
}

TEST_CASE("a triangle much larger than the area, crossing it with no corner or edge inside, belongs to it") {
  for (const auto& [name, area] : some_areas()) {
    Vec3d middle = area.frame().origin;
    if (const auto* f = std::get_if<Frustum>(&area.region()))
      middle = to_world(f->frame, {0, 0, 0.5 * (f->near_distance + f->far_distance)});
    if (const auto* box = std::get_if<OrientedBox>(&area.region())) middle = box->centre;
    for (const auto& [u, v] : {std::pair{area.frame().right, area.frame().up},
                               {area.frame().up, area.frame().forward},
                               {area.frame().forward, area.frame().right}}) {
      const double size = 1e5;
      const GnTriangle big = triangle_of(middle - size * u - size * v, middle + 2.0 * size * u - size * v,
                                         middle - size * u + 2.0 * size * v);
      CAPTURE(name, big.v0, big.v1, big.v2);
      REQUIRE(touches(area, big, Membership::kExact));
      REQUIRE_FALSE(touches(area, big, Membership::kVertices));
      REQUIRE_FALSE(touches(area, big, Membership::kVerticesOrEdges));
      const Vec3d away = 2e3 * cross(u, v);
      REQUIRE_FALSE(touches(
          area, triangle_of(corner_at(big, 0) + away, corner_at(big, 1) + away, corner_at(big, 2) + away)));
    }
  }
}

TEST_CASE("an edge that crosses the area is found by the text's rule, not by the program's") {
  const InfluenceArea plane = InfluenceArea::plane(PlaneWindow{});
  const InfluenceArea ball = InfluenceArea::omni({0, 0, 0.5}, 0.5);
  const GnTriangle crossing = triangle({-5, 0, 0.5F}, {5, 0, 0.5F}, {0, 50, 0.5F});
  for (const InfluenceArea& area : {plane, ball}) {
    REQUIRE_FALSE(touches(area, crossing, Membership::kVertices));
    REQUIRE(touches(area, crossing, Membership::kVerticesOrEdges));
    REQUIRE(touches(area, crossing, Membership::kExact));
  }
}

TEST_CASE("each rule finds what the simpler one does") {
  Source source(83);
  std::vector<GnTriangle> triangles;
  for (int i = 0; i < 2000; ++i) triangles.push_back(random_triangle(source, 1.0));
  std::size_t gained = 0;
  for (const auto& [name, area] : some_areas()) {
    const auto vertices = members(area, triangles, Membership::kVertices);
    const auto edges = members(area, triangles, Membership::kVerticesOrEdges);
    const auto exact = members(area, triangles);
    CAPTURE(name);
    REQUIRE(std::is_sorted(exact.begin(), exact.end()));
    REQUIRE(std::includes(edges.begin(), edges.end(), vertices.begin(), vertices.end()));
    REQUIRE(std::includes(exact.begin(), exact.end(), edges.begin(), edges.end()));
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
      const bool listed = std::binary_search(exact.begin(), exact.end(), i);
      REQUIRE(listed == touches(area, triangles[i]));
    }
    gained += exact.size() - vertices.size();
  }
  REQUIRE(gained > 1000);
}

TEST_CASE("touching in one point belongs, also far from the origin; a float step apart does not") {
  for (const float offset : {0.0F, 1024.0F, 65536.0F}) {
    PlaneWindow window;
    window.point = {static_cast<double>(offset), 0, 0};
    const InfluenceArea plane = InfluenceArea::plane(window);
    const InfluenceArea ball = InfluenceArea::omni(window.point, 1.0);
    const float touching = offset + 1.0F;
    const float beyond = std::nextafter(touching, 1e9F);
    for (const Membership rule : {Membership::kExact, Membership::kVertices, Membership::kVerticesOrEdges}) {
      CAPTURE(offset, static_cast<int>(rule));
      REQUIRE(
          touches(plane, triangle({touching, 0, 0.5F}, {touching + 1, 0, 0}, {touching + 1, 1, 0}), rule));
      REQUIRE_FALSE(
          touches(plane, triangle({beyond, 0, 0.5F}, {beyond + 1, 0, 0}, {beyond + 1, 1, 0}), rule));
      REQUIRE(touches(ball, triangle({touching, 0, 0}, {touching + 1, 0, 0}, {touching + 1, 1, 0}), rule));
      REQUIRE_FALSE(touches(ball, triangle({beyond, 0, 0}, {beyond + 1, 0, 0}, {beyond + 1, 1, 0}), rule));
    }
    // An edge and a face against the side, no corner of the triangle near.
    REQUIRE(touches(plane, triangle({touching, -9, 0.5F}, {touching, 9, 0.5F}, {touching + 1, 0, 0.5F})));
    REQUIRE(touches(plane, triangle({touching, -90, -90}, {touching, 90, -90}, {touching, 0, 90})));
    REQUIRE(touches(ball, triangle({touching, -90, -90}, {touching, 90, -90}, {touching, 0, 90})));
    REQUIRE_FALSE(touches(ball, triangle({beyond, -90, -90}, {beyond, 90, -90}, {beyond, 0, 90})));
  }
}

TEST_CASE("triangles without area belong like their segment or point, corners that are not finite never") {
  const InfluenceArea area = InfluenceArea::omni({0, 0, 0}, 1.0);
  const InfluenceArea plane = InfluenceArea::plane(PlaneWindow{});
  for (const InfluenceArea& some : {area, plane}) {
    REQUIRE(touches(some, triangle({-5, 0, 0}, {5, 0, 0}, {9, 0, 0})));
    REQUIRE_FALSE(touches(some, triangle({-5, 2, 0}, {5, 2, 0}, {9, 2, 0})));
    REQUIRE(touches(some, triangle({0.5F, 0, 0}, {0.5F, 0, 0}, {0.5F, 0, 0})));
    REQUIRE_FALSE(touches(some, triangle({2, 0, 0}, {2, 0, 0}, {2, 0, 0})));
    for (const float bad : {std::nanf(""), INFINITY}) {
      GnTriangle sick = triangle({0, 0, 0}, {0.1F, 0, 0}, {0, 0.1F, 0});
      sick.v2[1] = bad;
      REQUIRE_FALSE(touches(some, sick));
    }
  }
  REQUIRE(members(area, {}).empty());
}

TEST_CASE("the distance to a triangle is the least over its points") {
  Source source(84);
  for (int i = 0; i < 2000; ++i) {
    const Vec3d a = source.point(-1.0, 1.0);
    const Vec3d b = source.point(-1.0, 1.0);
    const Vec3d c = source.point(-1.0, 1.0);
    const Vec3d p = source.point(-2.0, 2.0);
    double least = 1e9;
    constexpr int kSteps = 40;
    for (int k = 0; k <= kSteps; ++k) {
      for (int m = 0; k + m <= kSteps; ++m) {
        const Vec3d q =
            a + static_cast<double>(k) / kSteps * (b - a) + static_cast<double>(m) / kSteps * (c - a);
        least = std::min(least, length(p - q));
      }
    }
    CAPTURE(i, a, b, c, p);
    const double distance = distance_to_triangle(p, a, b, c);
    REQUIRE(distance <= least + 1e-12);
    REQUIRE(distance >= least - 3.5 / kSteps);
    if (least > 0.5) REQUIRE(distance >= least - 3.5 * 3.5 / (kSteps * kSteps) / least);
  }
}
