// The order of a wide node's slots: what any hit looks at first.
#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/shared/collapse_math.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/wide.h"
#include "support/wide_shapes.h"
#include "support/wide_slots.h"

using gnomon::WideBvh;
using gnomon::test::is_leaf;
using gnomon::test::slot_half_area;

namespace {

// What triangles below a slot show along the three axes, in double precision.
double shown_below(const WideBvh& wide, std::uint32_t link) {
  double shown = 0.0;
  if (!is_leaf(link)) {
    for (const std::uint32_t below : wide.nodes[link].links)
      if (below != GN_NONE) shown += shown_below(wide, below);
    return shown;
  }
  const GnLeaf leaf = gn_leaf_at(wide.leaves.data(), link);
  for (std::uint32_t i = 0; i < leaf.count; ++i) {
    const GnTriangle triangle = gnomon::triangle_in(wide, gn_seat_in(leaf, i));
    const auto edge = [&triangle](const float* to, std::size_t k) {
      return double{to[k % 3]} - double{triangle.v0[k % 3]};
    };
    for (std::size_t k = 0; k < 3; ++k)
      shown += 0.5 * std::fabs(edge(triangle.v1, k) * edge(triangle.v2, k + 1) -
                               edge(triangle.v1, k + 1) * edge(triangle.v2, k));
  }
  return shown;
}

}  // namespace

TEST_CASE(
    "slots are in order of the share of their area that shows and of a quarter of the area, as logarithms") {
  const auto triangles = gnomon::test::soup(3000, 1880, 1.0F);
  const WideBvh wide =
      gnomon::collapse_reference(gnomon::build_reference(triangles, gnomon::test::leaves_of(4)), triangles);
  std::uint32_t ordered = 0;
  std::uint32_t against_area = 0;
  for (const gnomon::WideNode& node : wide.nodes) {
    double last = -INFINITY;
    double last_area = 0.0;
    for (std::uint32_t slot = 0; slot < GN_WIDTH && node.links[slot] != GN_NONE; ++slot) {
      const double area = slot_half_area(node, slot);
      const double shown = shown_below(wide, node.links[slot]);
      const double key = std::log2(shown / (area + shown)) + 0.25 * std::log2(area);
      // Bits of floats run straight between powers of two, at most 0.0861 below the logarithm.
      CAPTURE(slot, key, last);
      REQUIRE(key > last - 2.25 * 0.0861);
      ordered += key > last + 2.25 * 0.0861 ? 1 : 0;
      against_area += area < last_area ? 1 : 0;
      last = key;
      last_area = area;
    }
  }
  REQUIRE(ordered > 200);
  REQUIRE(against_area > 100);
}

TEST_CASE("slot keys are numbers whatever the areas") {
  for (const float area : {0.0F, 1e-45F, 1e-30F, 1.0F, 3e38F, INFINITY}) {
    for (const float shown : {0.0F, 1e-45F, 1e-30F, 1.0F, 3e38F, INFINITY}) {
      CAPTURE(area, shown);
      REQUIRE(std::isfinite(gn_slot_key(area, shown)));
    }
  }
  REQUIRE(gn_slot_key(1.0F, 0.5F) < gn_slot_key(1.0F, 2.0F));
  REQUIRE(gn_slot_key(1.0F, 1.0F) < gn_slot_key(4.0F, 4.0F));
  REQUIRE(gn_slot_key(4.0F, 0.5F) < gn_slot_key(1.0F, 0.5F));
}
