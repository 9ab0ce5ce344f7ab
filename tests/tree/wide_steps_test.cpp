// Steps that the wide reference counts: what a device's ray by itself takes.
#include <catch2/catch.hpp>

#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/trace_wide_reference.h"
#include "gnomon/tree/wide.h"

using gnomon::WideBvh;

TEST_CASE("a ray by itself takes a step for each node and each block of eight triangles") {
  // 20 triangles behind each other, in one leaf: three blocks.
  std::vector<GnTriangle> triangles;
  for (int i = 0; i < 20; ++i) {
    const auto z = static_cast<float>(i);
    triangles.push_back({{-1.0F, -1.0F, z}, {3.0F, -1.0F, z}, {-1.0F, 3.0F, z}});
  }
  gnomon::BuildOptions one_leaf;
  one_leaf.max_leaf_size = 20;
  one_leaf.cost_traversal = 1000.0F;
  const WideBvh wide = gnomon::collapse_reference(gnomon::build_reference(triangles, one_leaf), triangles);
  REQUIRE(wide.nodes.size() == 1);
  REQUIRE(wide.places() == 20);
  const std::vector<GnRay> rays{{{0, 0, -1}, 0, {0, 0, 1}, 100}, {{9, 9, -1}, 0, {0, 0, 1}, 100}};
  std::vector<gnomon::WideSteps> steps;
  const auto closest = gnomon::trace_wide_reference(wide, rays, false, &steps);
  REQUIRE(closest.hits[0].primitive == 0);
  REQUIRE(steps.size() == 2);
  CHECK(steps[0].nodes == 1);
  CHECK(steps[0].blocks == 3);
  CHECK(steps[0].exact == 0);
  CHECK(steps[1].nodes == 1);
  CHECK(steps[1].blocks == 0);
  // Any hit ends with the first.
  CHECK(gnomon::trace_wide_reference(wide, rays, true, &steps).hits[0].primitive != GN_NONE);
  CHECK(steps[0].blocks == 1);
  // One triangle twice: floats cannot rank them. Across an axis numbers do, else both are worked out.
  for (const bool across : {true, false}) {
    CAPTURE(across);
    triangles.assign(2, triangles[0]);
    if (!across) triangles[0].v2[2] = triangles[1].v2[2] = 1.0F;
    const WideBvh twice = gnomon::collapse_reference(gnomon::build_reference(triangles, one_leaf), triangles);
    REQUIRE(gnomon::trace_wide_reference(twice, rays, false, &steps).hits[0].primitive == 0);
    CHECK(steps[0].exact == (across ? 0 : 1));
  }
}
