// Wide trees whose nodes have keys or weights, on the device: the reference's bytes, and the answers of any
// other wide tree.
#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/base/error.h"
#include "support/flavours.h"

using gnomon::test::context;

TEST_CASE("with keys the device's wide trees are the reference's too, and answer the same",
          "[portable][unlimited]") {
  for (const auto& shape : gnomon::test::wide_shapes()) {
    const auto tree = gnomon::build_device(context(), shape.triangles, shape.options);
    const auto bvh = download_bvh(context(), tree);
    std::vector<float> keys(bvh.nodes.size());
    gnomon::test::Random random(190);
    for (float& key : keys) key = random.between(0.0F, 1.0F);
    if (shape.triangles.empty()) keys.clear();
    const auto expected = gnomon::collapse_reference(bvh, shape.triangles, {}, keys);
    for (const std::uint32_t task : {0U, 5U}) {
      CAPTURE(shape.name, task);
      gnomon::CollapseOptions options;
      options.triangles_per_task = task;
      const auto wide = download_wide(context(), collapse_device(context(), tree, options, nullptr, keys));
      REQUIRE(tree_hash(wide) == tree_hash(expected));
      if (const auto fault = gnomon::check_wide(wide, shape.triangles)) FAIL(fault->what);
    }
  }
  const auto triangles = gnomon::test::soup(500, 191, 1.0F);
  const auto rays = gnomon::test::random_rays(500, 192);
  const auto tree = gnomon::build_device(context(), triangles);
  std::vector<float> keys(tree.node_count);
  for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = static_cast<float>(i % 7);
  const auto keyed = collapse_device(context(), tree, {}, nullptr, keys);
  const auto plain = collapse_device(context(), tree);
  REQUIRE(tree_hash(download_wide(context(), keyed)) != tree_hash(download_wide(context(), plain)));
  for (const auto flavour : {gnomon::TraceFlavour::kWide, gnomon::TraceFlavour::kPacket}) {
    gnomon::TraceOptions how;
    how.flavour = flavour;
    const gnomon::Tracer with(context(), keyed, how);
    const gnomon::Tracer without(context(), plain, how);
    CAPTURE(to_string(flavour));
    REQUIRE(with.any(rays).occluded == without.any(rays).occluded);
    const auto got = with.closest(rays).hits;
    const auto hits = without.closest(rays).hits;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      CAPTURE(i);
      REQUIRE(got[i].primitive == hits[i].primitive);
      REQUIRE(got[i].t == hits[i].t);
    }
  }
  REQUIRE_THROWS_WITH(collapse_device(context(), tree, {}, nullptr, std::span(keys).first(2)),
                      Catch::Contains("2 slot keys"));
  keys[3] = std::nanf("");
  REQUIRE_THROWS_WITH(collapse_device(context(), tree, {}, nullptr, keys),
                      Catch::Contains("slot key 3 is NaN"));
}

TEST_CASE("with weights the device's wide trees are the reference's too, and answer the same",
          "[portable][unlimited]") {
  for (const auto& shape : gnomon::test::wide_shapes()) {
    const auto tree = gnomon::build_device(context(), shape.triangles, shape.options);
    const auto bvh = download_bvh(context(), tree);
    std::vector<float> weights(bvh.nodes.size());
    std::vector<float> keys(bvh.nodes.size());
    gnomon::test::Random random(193);
    for (float& weight : weights) weight = std::max(0.0F, random.between(-0.3F, 1.0F));
    for (float& key : keys) key = random.between(0.0F, 1.0F);
    if (shape.triangles.empty()) weights.clear();
    if (shape.triangles.empty() || shape.triangles.size() % 2 == 0) keys.clear();
    const auto expected = gnomon::collapse_reference(bvh, shape.triangles, {}, keys, weights);
    for (const std::uint32_t task : {0U, 5U}) {
      CAPTURE(shape.name, task);
      gnomon::CollapseOptions options;
      options.triangles_per_task = task;
      const auto wide =
          download_wide(context(), collapse_device(context(), tree, options, nullptr, keys, weights));
      REQUIRE(tree_hash(wide) == tree_hash(expected));
    }
  }
  const auto triangles = gnomon::test::soup(500, 194, 1.0F);
  const auto rays = gnomon::test::random_rays(500, 195);
  const auto tree = gnomon::build_device(context(), triangles);
  std::vector<float> weights(tree.node_count);
  for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = static_cast<float>(i % 7);
  const auto weighed = collapse_device(context(), tree, {}, nullptr, {}, weights);
  const auto plain = collapse_device(context(), tree);
  REQUIRE(tree_hash(download_wide(context(), weighed)) != tree_hash(download_wide(context(), plain)));
  const auto hits = gnomon::Tracer(context(), plain).closest(rays).hits;
  const auto got = gnomon::Tracer(context(), weighed).closest(rays).hits;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CAPTURE(i);
    REQUIRE(got[i].primitive == hits[i].primitive);
    REQUIRE(got[i].t == hits[i].t);
  }
  REQUIRE_THROWS_WITH(collapse_device(context(), tree, {}, nullptr, {}, std::span(weights).first(2)),
                      Catch::Contains("2 weights"));
  weights[3] = -1.0F;
  REQUIRE_THROWS_WITH(collapse_device(context(), tree, {}, nullptr, {}, weights),
                      Catch::Contains("weight 3"));
}
