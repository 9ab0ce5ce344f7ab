// Refitted trees: unmoved triangles change no byte, moved ones give the reference's bytes, boxes as check_bvh
// and check_wide compute them anew, and the oracle's hits.
#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/device/refit_device.h"
#include "gnomon/device/trace_device.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/bvh_check.h"
#include "gnomon/tree/oracle.h"
#include "gnomon/tree/refit.h"
#include "support/device.h"
#include "support/wide_shapes.h"

using gnomon::Bvh;
using gnomon::WideBvh;
using gnomon::test::context;

namespace {

using Triangles = std::vector<GnTriangle>;

// Every corner elsewhere, some far, some with coordinates -0.
Triangles moved(Triangles triangles, std::uint32_t seed) {
  gnomon::test::Random random(seed);
  for (GnTriangle& t : triangles) {
    for (float* v : {t.v0, t.v1, t.v2}) {
      for (std::size_t k = 0; k < 3; ++k) v[k] += random.between(-2.0F, 2.0F);
      if (random.below(8) == 0) v[random.below(3)] = -0.0F;
      if (random.below(50) == 0) v[random.below(3)] *= 100.0F;
    }
  }
  return triangles;
}

void require_refitted(const Triangles& before, const Triangles& after, const gnomon::BuildOptions& options) {
  auto tree = gnomon::build_device(context(), before, options);
  Bvh expected = download_bvh(context(), tree);
  const std::string unmoved = tree_hash(expected);
  gnomon::refit_device(context(), tree, before);
  REQUIRE(tree_hash(download_bvh(context(), tree)) == unmoved);
  gnomon::refit_device(context(), tree, after);
  const Bvh refitted = download_bvh(context(), tree);
  if (const auto fault = gnomon::check_bvh(refitted, after, options)) FAIL(fault->what);
  gnomon::refit_reference(expected, after);
  REQUIRE(tree_hash(refitted) == tree_hash(expected));
  const auto corners = context().download_values<GnLeafTriangle>(tree.leaf_triangles, before.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    CAPTURE(i);
    REQUIRE(corners[i].primitive == refitted.primitives[i]);
    for (int k = 0; k < 3; ++k) REQUIRE(corners[i].v2[k] == after[corners[i].primitive].v2[k]);
  }
}

void require_refitted_wide(const Triangles& before, const Triangles& after,
                           const gnomon::BuildOptions& options) {
  auto wide = collapse_device(context(), gnomon::build_device(context(), before, options));
  WideBvh expected = download_wide(context(), wide);
  const std::string unmoved = tree_hash(expected);
  gnomon::refit_device(context(), wide, before);
  REQUIRE(tree_hash(download_wide(context(), wide)) == unmoved);
  gnomon::refit_device(context(), wide, after);
  const WideBvh refitted = download_wide(context(), wide);
  if (const auto fault = gnomon::check_wide(refitted, after)) FAIL(fault->what);
  gnomon::refit_reference(expected, after);
  REQUIRE(tree_hash(refitted) == tree_hash(expected));
}

}  // namespace

TEST_CASE("a refitted tree has the boxes of its moved triangles, and its own where none moved",
          "[serial][portable][refit]") {
  for (const auto& shape : gnomon::test::wide_shapes()) {
    // Devices that end loops build no leaves this large.
    if (context().device().loop_limit != 0 && shape.options.max_leaf_size > 100) continue;
    CAPTURE(shape.name);
    require_refitted(shape.triangles, moved(shape.triangles, 121), shape.options);
  }
}

TEST_CASE("a refitted wide tree has them too",
          "[portable][unlimited][refit]") {
  for (const auto& shape : gnomon::test::wide_shapes()) {
    CAPTURE(shape.name);
    require_refitted_wide(shape.triangles, moved(shape.triangles, 122), shape.options);
  }
}

TEST_CASE("small trees are refitted within their buffers", "[memcheck][refit]") {
  const auto triangles = gnomon::test::soup(150, 123);
  require_refitted(triangles, moved(triangles, 124), gnomon::test::leaves_of(2));
  if (context().device().loop_limit == 0)
    require_refitted_wide(triangles, moved(triangles, 125), gnomon::test::leaves_of(2));
}

TEST_CASE("a tree of thousands is refitted in many subtrees", "[unlimited][refit]") {
  const auto triangles = gnomon::test::soup(20000, 126);
  require_refitted(triangles, moved(triangles, 127), {});
  require_refitted_wide(triangles, moved(triangles, 127), {});
}

TEST_CASE("rays through refitted trees hit what the oracle hits", "[portable][unlimited][refit]") {
  const auto before = gnomon::test::soup(800, 128);
  const auto after = moved(before, 129);
  const auto rays = gnomon::test::random_rays(400, 130);
  auto tree = gnomon::build_device(context(), before);
  auto wide = collapse_device(context(), tree);
  gnomon::refit_device(context(), tree, after);
  gnomon::refit_device(context(), wide, after);
  gnomon::TraceOptions thread;
  thread.flavour = gnomon::TraceFlavour::kThread;
  const auto binary_hits = gnomon::Tracer(context(), tree, thread).closest(rays).hits;
  const auto wide_hits = gnomon::Tracer(context(), wide).closest(rays).hits;
  std::size_t hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CAPTURE(i);
    const auto expected = gnomon::oracle_closest(rays[i], after);
    REQUIRE(binary_hits[i].primitive == expected.primitive);
    REQUIRE(wide_hits[i].primitive == expected.primitive);
    hits += expected.primitive != GN_NONE ? 1 : 0;
  }
  REQUIRE(hits > 50);
}

TEST_CASE("a refit to another number of triangles, or to bad coordinates, is refused and changes nothing",
          "[portable][refit]") {
  const auto before = gnomon::test::soup(200, 131);
  auto tree = gnomon::build_device(context(), before);
  const std::string hash = tree_hash(download_bvh(context(), tree));
  REQUIRE_THROWS_WITH(gnomon::refit_device(context(), tree, gnomon::test::soup(199, 131)),
                      Catch::Contains("200 triangles cannot be refitted to 199"));
  auto after = moved(before, 132);
  after[150].v1[1] = std::nanf("");
  after[170].v0[0] = INFINITY;
  REQUIRE_THROWS_WITH(gnomon::refit_device(context(), tree, after), Catch::Contains("triangle 150"));
  REQUIRE(tree_hash(download_bvh(context(), tree)) == hash);
  if (context().device().loop_limit != 0) return;
  auto wide = collapse_device(context(), tree);
  const std::string wide_hash = tree_hash(download_wide(context(), wide));
  REQUIRE_THROWS_AS(gnomon::refit_device(context(), wide, gnomon::test::soup(201, 131)), gnomon::Error);
  REQUIRE_THROWS_WITH(gnomon::refit_device(context(), wide, after), Catch::Contains("triangle 150"));
  REQUIRE(tree_hash(download_wide(context(), wide)) == wide_hash);
}
