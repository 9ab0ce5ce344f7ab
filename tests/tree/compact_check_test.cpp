// check_compact reports each broken promise, and survives any bytes.
#include <catch2/catch.hpp>
#include <cstring>
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

Sample sample(bool plain) {
  Sample s;
  s.triangles = plain ? gnomon::test::soup(300, 621) : gnomon::test::grid(12, 1.0F);
  s.compact = gnomon::compact_reference(
      gnomon::collapse_reference(gnomon::build_reference(s.triangles), s.triangles));
  REQUIRE(s.compact.nodes.size() > 2);
  REQUIRE(s.compact.plain.empty() != plain);
  return s;
}

std::string fault_of(bool plain, const std::function<void(Sample&)>& change) {
  Sample s = sample(plain);
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
  for (const bool plain : {false, true}) {
    CAPTURE(plain);
    REQUIRE(fault_of(plain, [](Sample&) {}) == "none");
    REQUIRE(fault_of(plain, [](Sample& s) { s.compact.nodes.clear(); }) == "sizes: no root");
    REQUIRE_THAT(fault_of(plain, [](Sample& s) { s.compact.depth += 1; }), Catch::Contains("depth"));
    REQUIRE_THAT(fault_of(plain, [](Sample& s) { s.triangles.pop_back(); }), Catch::Contains("sizes: "));
    REQUIRE_THAT(fault_of(plain, [](Sample& s) { s.compact.nodes.push_back(s.compact.nodes.back()); }),
                 Catch::Contains("never referenced"));
  }
  REQUIRE_THAT(fault_of(true, [](Sample& s) { s.compact.vertices.push_back({}); }),
               Catch::Contains("both forms"));
}

TEST_CASE("triangles and vertices that are others, doubled or out of order are reported") {
  REQUIRE_THAT(fault_of(true, [](Sample& s) { s.compact.plain[3].corners[4] += 1.0F; }),
               Catch::Contains("corner of"));
  REQUIRE_THAT(fault_of(true, [](Sample& s) { s.compact.plain[3] = s.compact.plain[4]; }),
               Catch::Contains("appears twice"));
  REQUIRE_THAT(fault_of(true, [](Sample& s) { s.compact.plain[3].primitive = 300; }),
               Catch::Contains("300 of 300"));
  REQUIRE_THAT(fault_of(false, [](Sample& s) { s.compact.vertices[7].position[0] += 0.01F; }),
               Catch::Contains("corner of"));
  REQUIRE_THAT(fault_of(false, [](Sample& s) { s.compact.vertices[7] = s.compact.vertices[6]; }),
               Catch::Contains("copy of another"));
  REQUIRE_THAT(fault_of(false,
                        [](Sample& s) {
                          s.compact.vertices.push_back({{99, 99, 99}});
                        }),
               Catch::Contains("never used"));
  REQUIRE_THAT(fault_of(false, [](Sample& s) { s.compact.triangles[0].corners[0] = 2; }),
               Catch::Contains("used before"));
  REQUIRE_THAT(fault_of(false, [](Sample& s) { s.compact.triangles.back().corners[0] = 1U << 30U; }),
               Catch::Contains("used before"));
  REQUIRE_THAT(fault_of(false,
                        [](Sample& s) {
                          std::swap(s.compact.triangles[20].corners[0], s.compact.triangles[20].corners[1]);
                        }),
               Catch::Contains("corner of") || Catch::Contains("used before"));
}

TEST_CASE("the larger of the two forms is reported") {
  REQUIRE_THAT(fault_of(false,
                        [](Sample& s) {
                          for (const auto& t : s.compact.triangles) {
                            GnPlainTriangle plain{};
                            std::memcpy(plain.corners, &s.triangles[t.primitive], sizeof plain.corners);
                            plain.primitive = t.primitive;
                            s.compact.plain.push_back(plain);
                          }
                          s.compact.triangles.clear();
                          s.compact.vertices.clear();
                        }),
               Catch::Contains("shared corners would be smaller"));
  REQUIRE_THAT(fault_of(true,
                        [](Sample& s) {
                          for (const auto& plain : s.compact.plain) {
                            GnIndexedTriangle t{};
                            for (std::uint32_t corner = 0; corner < 3; ++corner) {
                              t.corners[corner] = static_cast<std::uint32_t>(s.compact.vertices.size());
                              GnVertex vertex{};
                              std::memcpy(&vertex, plain.corners + 3 * corner, sizeof vertex);
                              s.compact.vertices.push_back(vertex);
                            }
                            t.primitive = plain.primitive;
                            s.compact.triangles.push_back(t);
                          }
                          s.compact.plain.clear();
                        }),
               Catch::Contains("plain triangles would be smaller"));
}

TEST_CASE("links of compact nodes out of range, doubled or lost are reported") {
  for (const bool plain : {false, true}) {
    CAPTURE(plain);
    REQUIRE_THAT(fault_of(plain, [](Sample& s) { s.compact.nodes[0].first_node = 0; }),
                 Catch::Contains("twice or is the root"));
    REQUIRE_THAT(fault_of(plain, [](Sample& s) { s.compact.nodes[0].first_node = 0xfffffff0U; }),
                 Catch::Contains("links: node"));
    REQUIRE_THAT(fault_of(plain, [](Sample& s) { node_with_leaf(s.compact).first_triangle += 1; }),
                 Catch::Contains("links: "));
    REQUIRE_THAT(fault_of(plain, [](Sample& s) { node_with_leaf(s.compact).first_triangle = GN_NONE; }),
                 Catch::Contains("triangle place"));
    REQUIRE_THAT(fault_of(plain,
                          [](Sample& s) {
                            auto& node = node_with_leaf(s.compact);
                            const std::uint32_t slot = leaf_slot(node);
                            node.counts[slot / 4] -= 1U << (8 * (slot % 4));
                          }),
                 Catch::Contains("in no leaf"));
    REQUIRE_THAT(fault_of(plain,
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
  for (const bool plain : {false, true}) {
    const Sample whole = sample(plain);
    int reported = 0;
    for (int i = 0; i < 2000; ++i) {
      CAPTURE(plain, i);
      Sample s = whole;
      const std::size_t bytes = s.compact.nodes.size() * sizeof(GnCompactNode);
      auto* raw = reinterpret_cast<unsigned char*>(s.compact.nodes.data());
      for (std::uint32_t k = 0; k <= random.below(4); ++k)
        raw[random.below(static_cast<std::uint32_t>(bytes))] = static_cast<unsigned char>(random.below(256));
      reported += gnomon::check_compact(s.compact, s.triangles).has_value() ? 1 : 0;
    }
    REQUIRE(reported > 1000);
  }
}

TEST_CASE("a byte of any part changes a compact tree's hash") {
  for (const bool plain : {false, true}) {
    Sample s = sample(plain);
    const std::string before = tree_hash(s.compact);
    REQUIRE(before.size() == 16);
    s.compact.nodes.back().planes[5][1] ^= 1U;
    REQUIRE(tree_hash(s.compact) != before);
    s.compact.nodes.back().planes[5][1] ^= 1U;
    (plain ? s.compact.plain.back().primitive : s.compact.triangles.back().primitive) ^= 1U;
    REQUIRE(tree_hash(s.compact) != before);
  }
}
