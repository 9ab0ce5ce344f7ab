// Learnt child order: changes no answer, costs what it says, and puts what stops rays first.
#include "gnomon/plan/child_order.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/base/error.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/trace_wide_reference.h"
#include "gnomon/tree/wide.h"
#include "support/bundles.h"
#include "support/shapes.h"

using gnomon::Bvh;
using gnomon::ChildOrder;
using gnomon::learn_order;
using gnomon::Query;

namespace {

std::vector<GnTriangle> scene() {
  return gnomon::test::soup(800, 51, 0.8F);
}

double mean_cost(const gnomon::OrderedTree& tree, const std::vector<GnTriangle>& triangles,
                 const std::vector<GnRay>& rays) {
  double sum = 0.0;
  for (const double cost : gnomon::ray_costs(tree, triangles, rays, Query::kAny)) sum += cost;
  return sum / static_cast<double>(rays.size());
}

}  // namespace

TEST_CASE("the learnt order changes no answer, in the binary and in the wide tree") {
  const auto triangles = scene();
  const Bvh bvh = gnomon::build_reference(triangles);
  const auto fit = gnomon::test::random_rays(200, 52);
  const auto rays = gnomon::test::random_rays(1000, 53);
  const ChildOrder order = learn_order(bvh, triangles, fit);
  const auto expected = gnomon::trace_reference(bvh, triangles, rays, true).hits;
  const auto got = gnomon::trace_reference(bvh, triangles, rays, true, order.ranks).hits;
  const gnomon::WideBvh wide = gnomon::collapse_reference(bvh, triangles, {}, order.ranks);
  if (const auto fault = gnomon::check_wide(wide, triangles)) FAIL(fault->what);
  const auto wide_any = gnomon::trace_wide_reference(wide, rays, true).hits;
  const auto wide_closest = gnomon::trace_wide_reference(wide, rays, false).hits;
  const auto closest = gnomon::trace_reference(bvh, triangles, rays, false).hits;
  std::size_t stopped = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CAPTURE(i);
    const bool hit = expected[i].primitive != GN_NONE;
    stopped += hit ? 1 : 0;
    REQUIRE((got[i].primitive != GN_NONE) == hit);
    REQUIRE((wide_any[i].primitive != GN_NONE) == hit);
    REQUIRE(wide_closest[i].primitive == closest[i].primitive);
    REQUIRE(wide_closest[i].t == closest[i].t);
  }
  REQUIRE(stopped > 100);
  REQUIRE(stopped < 900);
}

TEST_CASE("the sample's cost is what its rays cost in the learnt order") {
  for (const std::uint32_t leaf : {1U, 8U}) {
    CAPTURE(leaf);
    gnomon::BuildOptions options;
    options.max_leaf_size = leaf;
    const auto triangles = scene();
    const Bvh bvh = gnomon::build_reference(triangles, options);
    auto rays = gnomon::test::random_rays(300, 54);
    const ChildOrder order = learn_order(bvh, triangles, rays);
    REQUIRE(order.sample_cost == Approx(mean_cost({bvh, order.ranks}, triangles, rays)).epsilon(1e-5));
    REQUIRE(order.sample_cost < 0.98 * mean_cost({bvh, {}}, triangles, rays));
  }
}

TEST_CASE("what stops rays is looked at before what does not") {
  // Rays go up through a thicket of slivers, which stops none of them, then meet a roof.
  std::vector<GnTriangle> triangles;
  for (int i = 0; i < 64; ++i) {
    const float x = 0.15F * static_cast<float>(i);
    triangles.push_back(gnomon::test::triangle({x, 1, 0}, {x, 2, 10}, {x, 2, 9.99F}));
  }
  triangles.push_back(gnomon::test::triangle({-20, 8, -20}, {40, 8, -20}, {0, 8, 60}));
  gnomon::BuildOptions options;
  options.max_leaf_size = 1;
  const Bvh bvh = gnomon::build_reference(triangles, options);
  std::vector<GnRay> rays;
  for (int i = 0; i < 100; ++i)
    rays.push_back(gnomon::test::ray({0.07F + 0.09F * static_cast<float>(i), 0, 5}, {0.01F, 1, 0.02F}));
  const ChildOrder order = learn_order(bvh, triangles, rays);
  REQUIRE(mean_cost({bvh, {}}, triangles, rays) > 5.0);
  // The root's children, the roof.
  REQUIRE(mean_cost({bvh, order.ranks}, triangles, rays) < 3.5);
}

TEST_CASE("where no ray came the areas' word stands, and it is a number") {
  for (const auto& [name, triangles] : gnomon::test::awkward_inputs()) {
    CAPTURE(name);
    const Bvh bvh = gnomon::build_reference(triangles);
    const ChildOrder order = learn_order(bvh, triangles, {});
    REQUIRE(order.ranks.size() == bvh.nodes.size());
    for (const float rank : order.ranks) REQUIRE((std::isfinite(rank) && rank >= 0.0F));
    REQUIRE(order.sample_cost == 0.0);
  }
  // Many sampled rays outweigh it; rays elsewhere leave it as it is.
  const auto triangles = scene();
  const Bvh bvh = gnomon::build_reference(triangles);
  const ChildOrder prior = learn_order(bvh, triangles, {});
  const std::vector<GnRay> elsewhere(50, gnomon::test::ray({100, 100, 100}, {1, 0, 0}));
  REQUIRE(learn_order(bvh, triangles, elsewhere).ranks == prior.ranks);
  REQUIRE(learn_order(bvh, triangles, gnomon::test::random_rays(50, 55)).ranks != prior.ranks);
}

TEST_CASE("rays that cannot be traced teach nothing") {
  const auto triangles = scene();
  const Bvh bvh = gnomon::build_reference(triangles);
  auto rays = gnomon::test::random_rays(50, 56);
  const auto expected = learn_order(bvh, triangles, rays);
  rays.push_back(gnomon::test::ray({NAN, 0, 0}, {0, 1, 0}));
  rays.push_back(gnomon::test::ray({0, 0, 0}, {0, 0, 0}));
  const auto got = learn_order(bvh, triangles, rays);
  REQUIRE(got.ranks == expected.ranks);
  REQUIRE(got.sample_cost == expected.sample_cost);
}

TEST_CASE("orders and ranks that make no sense are refused") {
  const auto triangles = scene();
  const Bvh bvh = gnomon::build_reference(triangles);
  gnomon::OrderOptions options;
  options.prior_rays = 0.0F;
  REQUIRE_THROWS_WITH(learn_order(bvh, triangles, {}, options), Catch::Contains("prior_rays"));
  options = {};
  options.face_weights[1] = -1.0F;
  REQUIRE_THROWS_WITH(learn_order(bvh, triangles, {}, options), Catch::Contains("face_weights"));
  const std::vector<float> few(3, 1.0F);
  const auto rays = gnomon::test::random_rays(1, 57);
  REQUIRE_THROWS_WITH(gnomon::trace_reference(bvh, triangles, rays, true, few), Catch::Contains("3 ranks"));
  REQUIRE_THROWS_WITH(gnomon::collapse_reference(bvh, triangles, {}, few), Catch::Contains("3 slot keys"));
  const std::vector<float> nan(bvh.nodes.size(), NAN);
  REQUIRE_THROWS_WITH(gnomon::collapse_reference(bvh, triangles, {}, nan), Catch::Contains("NaN"));
}
