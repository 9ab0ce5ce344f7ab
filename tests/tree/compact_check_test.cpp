// check_compact reports each broken promise, and survives any bytes.
#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>

#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/compact.h"
#include "support/wide_shapes.h"

using gnomon::CompactBvh;
using gnomon::test::Random;

namespace {

struct Sample {
  std::vector<GnTriangle> triangles;
  CompactBvh compact;
};

// A soup shares no corners, a mesh does.
Sample sample(bool apart) {
  Sample s;
  s.triangles = apart ? gnomon::test::soup(300, 621) : gnomon::test::grid(12, 1.0F);
  s.compact = gnomon::compact_reference(
      gnomon::collapse_reference(gnomon::build_reference(s.triangles), s.triangles));
  REQUIRE(s.compact.nodes.size() > 2);
  for (const auto& node : s.compact.nodes)
    if (gn_leaf_triangles(node.counts) != 0)
      REQUIRE((gn_pack_width(s.compact.leaves[node.leaves], GN_PLACE_COLUMN) == 0) == apart);
  return s;
}

std::string fault_of(bool apart, const std::function<void(Sample&)>& change) {
  Sample s = sample(apart);
  change(s);
  const auto fault = gnomon::check_compact(s.compact, s.triangles);
  return fault ? fault->what : "none";
}

// A slot of the root that holds a leaf.
std::uint32_t leaf_slot(const gnomon::CompactNode& node) {
  std::uint32_t slot = 0;
  while (slot < 8 && gn_byte_of(node.counts, slot) == 0) ++slot;
  return slot;
}

// The first node that has a leaf.
gnomon::CompactNode& node_with_leaf(CompactBvh& compact) {
  for (auto& node : compact.nodes)
    if (leaf_slot(node) < 8) return node;
  FAIL("no leaf");
  return compact.nodes[0];
}

}  // namespace

TEST_CASE("compact trees without fault have none; sizes and depths that do not fit are reported") {
  for (const bool apart : {false, true}) {
    CAPTURE(apart);
    REQUIRE(fault_of(apart, [](Sample&) {}) == "none");
    REQUIRE(fault_of(apart, [](Sample& s) { s.compact.nodes.clear(); }) == "sizes: no root");
    REQUIRE_THAT(fault_of(apart, [](Sample& s) { s.compact.depth += 1; }), Catch::Contains("depth"));
    REQUIRE_THAT(fault_of(apart, [](Sample& s) { s.triangles.pop_back(); }), Catch::Contains("sizes: "));
    REQUIRE_THAT(fault_of(apart, [](Sample& s) { s.compact.nodes.emplace_back(); }),
                 Catch::Contains("never referenced"));
  }
}

TEST_CASE("leaves that are others, in another place or wider than they need be are reported") {
  const auto with_leaves = [](bool apart, const std::function<void(Sample&, std::uint32_t*)>& change) {
    return fault_of(
        apart, [&](Sample& s) { change(s, s.compact.leaves.data() + node_with_leaf(s.compact).leaves); });
  };
  using Words = std::uint32_t*;
  for (const bool apart : {false, true}) {
    CAPTURE(apart);
    REQUIRE_THAT(fault_of(apart, [](Sample& s) { s.compact.leaves.pop_back(); }),
                 Catch::Contains("beyond") || Catch::Contains("words"));
    REQUIRE_THAT(fault_of(apart, [](Sample& s) { s.compact.leaves.back() = 1; }), Catch::Contains("words"));
    REQUIRE_THAT(fault_of(apart, [](Sample& s) { s.compact.leaves.push_back(0); }), Catch::Contains("words"));
    REQUIRE_THAT(fault_of(apart, [](Sample& s) { s.compact.leaves.clear(); }), Catch::Contains("leaves: "));
    REQUIRE_THAT(with_leaves(apart, [](Sample&, Words words) { words[0] |= 1U << 30U; }),
                 Catch::Contains("more fields"));
    REQUIRE_THAT(with_leaves(apart, [](Sample&, Words words) { words[0] |= 63U; }),
                 Catch::Contains("too wide"));
    for (int axis = 0; axis < 3; ++axis) {
      REQUIRE_THAT(with_leaves(apart, [&](Sample&, Words words) { words[1 + axis] += 1; }),
                   Catch::Contains("corner of"));
    }
    REQUIRE_THAT(with_leaves(apart, [](Sample&, Words words) { words[4] += 1000; }),
                 Catch::Contains(" of ") && Catch::Contains("triangles: number"));
  }
  // The lowest bits of the first record of a mesh are the place of its first corner, 0.
  REQUIRE_THAT(with_leaves(false, [](Sample&, Words words) { words[5] |= 1U; }),
               Catch::Contains("used before"));
  REQUIRE_THAT(
      with_leaves(false, [](Sample&, Words words) { words[0] = (words[0] & 0x00ffffffU) | 9U << 24U; }),
      Catch::Contains("too wide"));
}

// The same triangles in leaves that are made otherwise.
std::string fault_of_other(bool apart,
                           const std::function<void(std::vector<std::uint32_t>&, GnPackHead&)>& change) {
  return fault_of(apart, [&](Sample& s) {
    std::vector<std::uint32_t> made;
    for (auto& node : s.compact.nodes) {
      const std::uint32_t count = gn_leaf_triangles(node.counts);
      if (count == 0) continue;
      GnPackedLeaves leaves;
      gn_open_leaves(s.compact.leaves.data() + node.leaves, count, &leaves);
      std::vector<GnPlainTriangle> plain;
      for (std::uint32_t i = 0; i < count; ++i) plain.push_back(gn_packed_triangle(&leaves, i));
      std::vector<std::uint32_t> places;
      for (std::uint32_t corner = 0; corner < 3 * count; ++corner)
        places.push_back(gn_first_equal(plain.data(), corner));
      GnPackHead head;
      gn_measure_leaves(plain.data(), places.data(), count, &head);
      change(places, head);
      node.leaves = static_cast<std::uint32_t>(made.size());
      const std::uint32_t vertices = *std::max_element(places.begin(), places.end()) + 1;
      const std::uint32_t bits =
          count * gn_triangle_bits(head.widths) + vertices * gn_vertex_bits(head.widths);
      made.resize(made.size() + 5 + (bits + 31) / 32);
      gn_write_leaves(plain.data(), places.data(), count, &head, made.data() + node.leaves);
    }
    made.push_back(0);
    s.compact.leaves = made;
  });
}

TEST_CASE("leaves that could be smaller are reported") {
  const auto no_change = [](std::vector<std::uint32_t>&, GnPackHead&) {};
  REQUIRE(fault_of_other(false, no_change) == "none");
  REQUIRE(fault_of_other(true, no_change) == "none");
  const auto wider = [](std::uint32_t column) {
    return [column](std::vector<std::uint32_t>&, GnPackHead& head) { head.widths += 1U << (6 * column); };
  };
  for (std::uint32_t column = 0; column < 3; ++column)
    REQUIRE_THAT(fault_of_other(true, wider(column)), Catch::Contains("corners could be narrower"));
  REQUIRE_THAT(fault_of_other(true, wider(GN_NUMBER_COLUMN)), Catch::Contains("numbers could be narrower"));
  REQUIRE_THAT(fault_of_other(false, wider(GN_PLACE_COLUMN)), Catch::Contains("other form"));
  const auto all_apart = [](std::vector<std::uint32_t>& places) {
    for (std::uint32_t i = 0; i < places.size(); ++i) places[i] = i;
  };
  REQUIRE_THAT(fault_of_other(false,
                              [&](std::vector<std::uint32_t>& places, GnPackHead& head) {
                                all_apart(places);
                                head.widths &= 0x00ffffffU;
                              }),
               Catch::Contains("other form"));
  REQUIRE_THAT(fault_of_other(true,
                              [&](std::vector<std::uint32_t>& places, GnPackHead& head) {
                                all_apart(places);
                                head.widths |= 8U << 24U;
                              }),
               Catch::Contains("other form"));
}

TEST_CASE("links of compact nodes out of range, doubled or lost are reported") {
  for (const bool apart : {false, true}) {
    CAPTURE(apart);
    REQUIRE_THAT(fault_of(apart, [](Sample& s) { s.compact.nodes[0].first_node = 0; }),
                 Catch::Contains("twice or is the root"));
    REQUIRE_THAT(fault_of(apart, [](Sample& s) { s.compact.nodes[0].first_node = 0xfffffff0U; }),
                 Catch::Contains("links: node"));
    REQUIRE_THAT(fault_of(apart, [](Sample& s) { node_with_leaf(s.compact).leaves += 1; }),
                 Catch::Contains("leaves: at word"));
    REQUIRE_THAT(fault_of(apart,
                          [](Sample& s) {
                            auto& node = node_with_leaf(s.compact);
                            const std::uint32_t slot = leaf_slot(node);
                            node.counts[slot / 4] -= 1U << (8 * (slot % 4));
                          }),
                 Catch::Contains("leaves: "));
    REQUIRE_THAT(fault_of(apart,
                          [](Sample& s) {
                            auto& node = node_with_leaf(s.compact);
                            node.scales |= 1U << (24 + leaf_slot(node));
                          }),
                 Catch::Contains("a node and triangles"));
  }
}

TEST_CASE("each plane of a compact box that cuts off a triangle is reported") {
  for (std::uint32_t plane = 0; plane < 6; ++plane) {
    CAPTURE(plane);
    const std::string found = fault_of(true, [&](Sample& s) {
      // The root's extreme slot: its outer plane, moved inwards by a fifth of the extent.
      auto& node = s.compact.nodes[0];
      for (std::uint32_t slot = 0; slot < 8; ++slot) {
        const std::uint32_t shift = 8 * (slot % 4);
        const std::uint32_t step = node.planes[plane][slot / 4] >> shift & 255U;
        if (plane % 2 == 0 ? step > 30 : step < 100) continue;
        node.planes[plane][slot / 4] ^= step << shift;
        node.planes[plane][slot / 4] |= (plane % 2 == 0 ? step + 60 : step - 60) << shift;
      }
    });
    REQUIRE_THAT(found, Catch::Contains("reaches beyond slot"));
  }
  REQUIRE_THAT(fault_of(true, [](Sample& s) { s.compact.nodes[0].scales -= 1; }),
               Catch::Contains("reaches beyond"));
  REQUIRE_THAT(fault_of(true, [](Sample& s) { s.compact.nodes[0].origin[1] += 1.0F; }),
               Catch::Contains("reaches beyond"));
}

TEST_CASE("check_compact survives any bytes") {
  Random random(622);
  for (const bool apart : {false, true}) {
    const Sample whole = sample(apart);
    int reported = 0;
    for (int i = 0; i < 2000; ++i) {
      CAPTURE(apart, i);
      Sample s = whole;
      const bool in_leaves = i % 2 != 0;
      const std::size_t bytes = in_leaves ? s.compact.leaves.size() * sizeof(std::uint32_t)
                                          : s.compact.nodes.size() * sizeof(GnCompactNode);
      auto* raw = in_leaves ? reinterpret_cast<unsigned char*>(s.compact.leaves.data())
                            : reinterpret_cast<unsigned char*>(s.compact.nodes.data());
      for (std::uint32_t k = 0; k <= random.below(4); ++k)
        raw[random.below(static_cast<std::uint32_t>(bytes))] = static_cast<unsigned char>(random.below(256));
      reported += gnomon::check_compact(s.compact, s.triangles).has_value() ? 1 : 0;
    }
    REQUIRE(reported > 1000);
  }
}

TEST_CASE("a byte of any part changes a compact tree's hash") {
  for (const bool apart : {false, true}) {
    Sample s = sample(apart);
    const std::string before = tree_hash(s.compact);
    REQUIRE(before.size() == 16);
    s.compact.nodes.back().planes[5][1] ^= 1U;
    REQUIRE(tree_hash(s.compact) != before);
    s.compact.nodes.back().planes[5][1] ^= 1U;
    s.compact.leaves.front() ^= 1U;
    REQUIRE(tree_hash(s.compact) != before);
  }
}
