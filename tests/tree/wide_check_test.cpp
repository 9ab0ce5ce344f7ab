// check_wide reports each broken promise, and survives any bytes.
#include <catch2/catch.hpp>
#include <cstring>
#include <functional>

#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/wide.h"
#include "support/wide_shapes.h"

using gnomon::WideBvh;
using gnomon::test::Random;

namespace {

struct Sample {
  std::vector<GnTriangle> triangles;
  WideBvh wide;
};

// Nodes below the root, leaves of more than a block, blocks that are not full.
Sample sample() {
  Sample s;
  s.triangles = gnomon::test::soup(300, 31);
  s.wide = gnomon::collapse_reference(gnomon::build_reference(s.triangles, gnomon::test::lazy_leaves_of(13)),
                                      s.triangles);
  REQUIRE(s.wide.nodes.size() > 2);
  return s;
}

std::string fault_of(const std::function<void(Sample&)>& change) {
  Sample s = sample();
  change(s);
  const auto fault = gnomon::check_wide(s.wide, s.triangles);
  return fault ? fault->what : "none";
}

// A link for which `wanted` holds.
std::uint32_t& link_where(WideBvh& wide, const std::function<bool(std::uint32_t)>& wanted) {
  for (auto& node : wide.nodes) {
    for (std::uint32_t& link : node.links)
      if (wanted(link)) return link;
  }
  FAIL("no such link");
  return wide.nodes[0].links[0];
}

bool names_node(std::uint32_t link) {
  return (link & GN_LEAF_LINK) == 0;
}
bool names_leaf(std::uint32_t link) {
  return link != GN_NONE && (link & GN_LEAF_LINK) != 0;
}
bool names_part_of_a_block(std::uint32_t link) {
  return names_leaf(link) && gn_link_triangles(link) % GN_WIDTH != 0;
}

// The first slot of the root that is a leaf, or a node.
std::uint32_t slot_where(const gnomon::WideNode& node, bool (*wanted)(std::uint32_t)) {
  std::uint32_t slot = 0;
  while (slot < GN_WIDTH && !wanted(node.links[slot])) ++slot;
  REQUIRE(slot < GN_WIDTH);
  return slot;
}

// A node with an empty slot, and which.
std::pair<std::uint32_t, std::uint32_t> empty_slot(const WideBvh& wide) {
  for (std::uint32_t node = 0; node < wide.nodes.size(); ++node) {
    for (std::uint32_t slot = 1; slot < GN_WIDTH; ++slot)
      if (wide.nodes[node].links[slot] == GN_NONE) return {node, slot};
  }
  FAIL("no empty slot");
  return {0, 0};
}

// Slots a and b of a node change places.
void swap_slots(gnomon::WideNode& node, std::uint32_t a, std::uint32_t b) {
  for (auto& plane : node.planes) std::swap(plane[a], plane[b]);
  std::swap(node.links[a], node.links[b]);
}

void swap_lanes(gnomon::TriangleBlock& block, std::uint32_t a, std::uint32_t b) {
  for (auto& corner : block.corners) std::swap(corner[a], corner[b]);
  std::swap(block.primitives[a], block.primitives[b]);
}

}  // namespace

TEST_CASE("links out of range, doubled or lost are reported") {
  REQUIRE(fault_of([](Sample&) {}) == "none");
  REQUIRE(fault_of([](Sample& s) { s.wide.nodes.clear(); }) == "sizes: no root");
  const auto link_to = [](std::uint32_t target) {
    return fault_of([&](Sample& s) { link_where(s.wide, names_node) = target; });
  };
  REQUIRE_THAT(link_to(0), Catch::Contains("referenced twice or is the root"));
  REQUIRE_THAT(link_to(2), Catch::Contains("referenced twice"));
  REQUIRE_THAT(link_to(1000000), Catch::Contains("links: node 1000000 of"));
  REQUIRE_THAT(link_to(gn_leaf_link(GN_MAX_BLOCKS - 1, 8)), Catch::Contains("blocks end at"));
  REQUIRE_THAT(fault_of([](Sample& s) { s.wide.nodes.push_back(s.wide.nodes.back()); }),
               Catch::Contains("referenced twice") || Catch::Contains("never referenced") ||
                   Catch::Contains("two leaves"));
  REQUIRE_THAT(fault_of([](Sample& s) { s.wide.nodes.push_back({}); }), Catch::Contains("never referenced"));
  REQUIRE_THAT(fault_of([](Sample& s) { s.wide.blocks.push_back(s.wide.blocks.back()); }),
               Catch::Contains("is in no leaf"));
  REQUIRE_THAT(fault_of([](Sample& s) { s.wide.blocks.pop_back(); }), Catch::Contains("blocks end at"));
  REQUIRE_THAT(fault_of([](Sample& s) {
                 std::uint32_t& link = link_where(s.wide, names_leaf);
                 link ^= 1U;
               }),
               Catch::Contains("two leaves") || Catch::Contains("in no leaf"));
}

TEST_CASE("boxes that do not hold what is below them are reported") {
  const auto shrunk = [](bool (*wanted)(std::uint32_t), std::size_t plane) {
    return fault_of([&](Sample& s) {
      for (auto& node : s.wide.nodes) {
        for (std::uint32_t slot = 0; slot < GN_WIDTH; ++slot) {
          if (!wanted(node.links[slot])) continue;
          node.planes[plane][slot] = std::nextafter(node.planes[plane][slot], node.planes[plane ^ 1U][slot]);
          return;
        }
      }
      FAIL("no such slot");
    });
  };
  for (std::size_t plane = 0; plane < 6; ++plane) {
    CAPTURE(plane);
    // A slightly smaller box may also come to stand behind a smaller one.
    for (const std::string& found : {shrunk(names_leaf, plane), shrunk(names_node, plane)})
      REQUIRE_THAT(found, Catch::StartsWith("box: ") || Catch::StartsWith("slots: "));
  }
  REQUIRE_THAT(fault_of([](Sample& s) { s.wide.nodes[0].planes[2][1] = std::nanf(""); }),
               Catch::Contains("NaN or inverted"));
  REQUIRE_THAT(
      fault_of([](Sample& s) { std::swap(s.wide.nodes[0].planes[2][1], s.wide.nodes[0].planes[3][1]); }),
      Catch::Contains("NaN or inverted"));
}

TEST_CASE("triangles lost, doubled or changed are reported") {
  const auto lane_of_first = [](Sample& s) -> std::uint32_t& { return s.wide.blocks[0].primitives[0]; };
  REQUIRE_THAT(fault_of([&](Sample& s) { lane_of_first(s) = s.wide.blocks[1].primitives[0]; }),
               Catch::Contains("is another") || Catch::Contains("appears twice"));
  REQUIRE_THAT(fault_of([&](Sample& s) { lane_of_first(s) = 300; }),
               Catch::Contains("triangles: number 300 of 300"));
  REQUIRE_THAT(fault_of([&](Sample& s) { lane_of_first(s) = GN_NONE; }), Catch::Contains("of 300"));
  REQUIRE_THAT(fault_of([](Sample& s) { s.triangles.push_back(s.triangles[0]); }),
               Catch::Contains("300 is in no leaf"));
  for (std::size_t k = 0; k < 9; ++k) {
    CAPTURE(k);
    REQUIRE_THAT(fault_of([&](Sample& s) {
                   float& x = s.wide.blocks[1].corners[k][0];
                   x = std::nextafter(x, 100.0F);
                 }),
                 Catch::Contains("is another"));
  }
  REQUIRE_THAT(fault_of([](Sample& s) {
                 std::vector<GnTriangle> doubled = s.triangles;
                 for (GnTriangle& t : doubled) t = doubled[0];
                 s.triangles = doubled;
                 gnomon::TriangleBlock& block = s.wide.blocks[0];
                 block.primitives[1] = block.primitives[0];
               }),
               Catch::Contains("is another") || Catch::Contains("appears twice"));
}

TEST_CASE("a triangle in two lanes is reported as doubled") {
  const auto triangles = gnomon::test::repeated(gnomon::test::triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 5);
  WideBvh wide = gnomon::collapse_reference(gnomon::build_reference(triangles), triangles);
  REQUIRE_FALSE(gnomon::check_wide(wide, triangles));
  wide.blocks[0].primitives[3] = wide.blocks[0].primitives[0];
  REQUIRE_THAT(gnomon::check_wide(wide, triangles)->what, Catch::Contains("appears twice"));
}

TEST_CASE("places behind a leaf's last triangle, and empty slots are looked at") {
  const auto behind = [](const std::function<void(gnomon::TriangleBlock&)>& change) {
    return fault_of([&](Sample& s) {
      const std::uint32_t link = link_where(s.wide, names_part_of_a_block);
      change(s.wide.blocks[gn_link_block(link) + gn_blocks_of(gn_link_triangles(link)) - 1]);
    });
  };
  REQUIRE_THAT(behind([](gnomon::TriangleBlock& b) { b.primitives[7] = 0; }), Catch::StartsWith("blocks: "));
  REQUIRE_THAT(behind([](gnomon::TriangleBlock& b) { b.corners[4][7] = 1.0F; }),
               Catch::StartsWith("blocks: "));
  REQUIRE_THAT(behind([](gnomon::TriangleBlock& b) { swap_lanes(b, 0, 7); }), Catch::Contains("of 300"));

  REQUIRE_THAT(fault_of([](Sample& s) {
                 const auto [node, slot] = empty_slot(s.wide);
                 s.wide.nodes[node].planes[0][slot] = 0.0F;
               }),
               Catch::Contains("the box of empty slot"));
  REQUIRE_THAT(fault_of([](Sample& s) {
                 const auto [node, slot] = empty_slot(s.wide);
                 s.wide.nodes[node].planes[5][slot] = std::nanf("");
               }),
               Catch::Contains("the box of empty slot"));
  REQUIRE_THAT(fault_of([](Sample& s) {
                 const auto [node, slot] = empty_slot(s.wide);
                 swap_slots(s.wide.nodes[node], slot, slot - 1);
               }),
               Catch::Contains("an empty one before slot"));
  REQUIRE_THAT(fault_of([](Sample& s) {
                 gnomon::WideNode& root = s.wide.nodes[0];
                 const std::uint32_t below = root.links[slot_where(root, names_node)];
                 for (std::uint32_t& link : s.wide.nodes[below].links) link = GN_NONE;
               }),
               Catch::StartsWith("links: "));
}

TEST_CASE("a node without children and a wrong depth are reported") {
  const auto triangles = gnomon::test::soup(1, 1);
  WideBvh wide = gnomon::collapse_reference(gnomon::build_reference(triangles), triangles);
  wide.depth = 2;
  REQUIRE_THAT(gnomon::check_wide(wide, triangles)->what, Catch::StartsWith("depth: 2 instead of 1"));
  wide.depth = 1;
  REQUIRE_FALSE(gnomon::check_wide(wide, triangles));
  wide.nodes.push_back(gnomon::collapse_reference({}, {}).nodes[0]);
  wide.nodes[0].links[1] = 1;
  for (int k = 0; k < 6; ++k) wide.nodes[0].planes[k][1] = wide.nodes[0].planes[k][0];
  REQUIRE(gnomon::check_wide(wide, triangles)->what == "slots: no child");
}

TEST_CASE("any bytes end in a verdict") {
  Random random(32);
  const Sample good = sample();
  for (int i = 0; i < 3000; ++i) {
    Sample s = good;
    const std::uint32_t changes = 1 + random.below(4);
    for (std::uint32_t c = 0; c < changes; ++c) {
      const bool node = random.below(2) == 0;
      const auto bytes = node ? std::as_writable_bytes(std::span(s.wide.nodes))
                              : std::as_writable_bytes(std::span(s.wide.blocks));
      const std::uint32_t word = random.below(static_cast<std::uint32_t>(bytes.size() / 4));
      const std::uint32_t value = random.below(3) == 0 ? random.below(100) : random.below(0xffffffffU);
      std::memcpy(bytes.data() + std::size_t{word} * 4, &value, 4);
    }
    static_cast<void>(gnomon::check_wide(s.wide, s.triangles));
  }
  for (int i = 0; i < 300; ++i) {
    WideBvh noise;
    noise.nodes.resize(random.below(9));
    noise.blocks.resize(random.below(9));
    const auto fill = [&](std::span<std::byte> bytes) {
      for (std::byte& b : bytes) b = static_cast<std::byte>(random.below(8) == 0 ? random.below(256) : 0);
    };
    fill(std::as_writable_bytes(std::span(noise.nodes)));
    fill(std::as_writable_bytes(std::span(noise.blocks)));
    REQUIRE(gnomon::check_wide(noise, good.triangles));
  }
}
