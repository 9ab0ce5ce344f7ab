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

// A seat of the first leaf of at least `count` triangles.
std::uint32_t seat_in_first(const WideBvh& wide, std::uint32_t i, std::uint32_t count) {
  for (const auto& node : wide.nodes) {
    for (const std::uint32_t link : node.links) {
      if (!names_leaf(link)) continue;
      const GnLeaf leaf = gn_leaf_at(wide.leaves.data(), link);
      if (leaf.count >= count) return gn_seat_in(leaf, i);
    }
  }
  FAIL("no such leaf");
  return 0;
}

std::uint32_t& number_word(WideBvh& wide, std::uint32_t seat) {
  return wide.leaves[gn_seat_word(seat) + 9 * gn_seat_stride(seat)];
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
  REQUIRE_THAT(link_to(gn_leaf_link(GN_MAX_PLACES - 1, 8)), Catch::Contains("a leaf begins at place"));
  REQUIRE_THAT(link_to(gn_leaf_link(299, 8)), Catch::Contains("places end at 307 of 300"));
  REQUIRE_THAT(fault_of([](Sample& s) { s.wide.nodes.push_back(s.wide.nodes.back()); }),
               Catch::Contains("referenced twice") || Catch::Contains("never referenced") ||
                   Catch::Contains("two leaves"));
  REQUIRE_THAT(fault_of([](Sample& s) { s.wide.nodes.push_back({}); }), Catch::Contains("never referenced"));
  REQUIRE_THAT(fault_of([](Sample& s) { s.wide.leaves.resize(s.wide.leaves.size() + GN_TRIANGLE_WORDS); }),
               Catch::Contains("is in no leaf"));
  REQUIRE_THAT(fault_of([](Sample& s) { s.wide.leaves.resize(s.wide.leaves.size() - GN_TRIANGLE_WORDS); }),
               Catch::Contains("places end at"));
  REQUIRE(fault_of([](Sample& s) { s.wide.leaves.pop_back(); }) == "sizes: part of a place");
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
  const auto number_of_first = [](Sample& s) -> std::uint32_t& {
    return number_word(s.wide, seat_in_first(s.wide, 0, 1));
  };
  REQUIRE_THAT(
      fault_of([&](Sample& s) { number_of_first(s) = number_word(s.wide, seat_in_first(s.wide, 1, 2)); }),
      Catch::Contains("is another") || Catch::Contains("appears twice"));
  REQUIRE_THAT(fault_of([&](Sample& s) { number_of_first(s) = GN_NUMBER + 300; }),
               Catch::Contains("triangles: number 300 of 300"));
  REQUIRE_THAT(fault_of([&](Sample& s) { number_of_first(s) = 0; }), Catch::Contains("of 300"));
  REQUIRE_THAT(fault_of([](Sample& s) { s.triangles.push_back(s.triangles[0]); }),
               Catch::Contains("300 is in no leaf"));
  for (std::size_t k = 0; k < 9; ++k) {
    CAPTURE(k);
    REQUIRE_THAT(fault_of([&](Sample& s) {
                   const std::uint32_t seat = seat_in_first(s.wide, 9, 10);
                   s.wide.leaves[gn_seat_word(seat) + k * gn_seat_stride(seat)] ^= 1U;
                 }),
                 Catch::Contains("is another"));
  }
  REQUIRE_THAT(fault_of([](Sample& s) {
                 std::vector<GnTriangle> doubled = s.triangles;
                 for (GnTriangle& t : doubled) t = doubled[0];
                 s.triangles = doubled;
                 number_word(s.wide, seat_in_first(s.wide, 1, 2)) =
                     number_word(s.wide, seat_in_first(s.wide, 0, 2));
               }),
               Catch::Contains("is another") || Catch::Contains("appears twice"));
}

TEST_CASE("a triangle in two seats is reported as doubled") {
  const auto triangles = gnomon::test::repeated(gnomon::test::triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 5);
  WideBvh wide = gnomon::collapse_reference(gnomon::build_reference(triangles), triangles);
  REQUIRE_FALSE(gnomon::check_wide(wide, triangles));
  number_word(wide, seat_in_first(wide, 3, 4)) = number_word(wide, seat_in_first(wide, 0, 4));
  REQUIRE_THAT(gnomon::check_wide(wide, triangles)->what, Catch::Contains("appears twice"));
}

TEST_CASE("what begins a long leaf is looked at") {
  const auto triangles = gnomon::test::soup(300, 31);
  const WideBvh good = gnomon::collapse_reference(
      gnomon::build_reference(triangles, gnomon::test::lazy_leaves_of(60)), triangles);
  REQUIRE_FALSE(gnomon::check_wide(good, triangles));
  std::size_t begin = 0;  // its first word
  for (const auto& node : good.nodes) {
    for (const std::uint32_t link : node.links)
      if (names_leaf(link) && gn_leaf_at(good.leaves.data(), link).count >= GN_LONG_LEAF)
        begin = std::size_t{gn_link_place(link)} * GN_TRIANGLE_WORDS;
  }
  REQUIRE(good.leaves[begin] >= GN_LONG_LEAF);
  REQUIRE(good.leaves[begin] <= 60);
  const auto fault_with = [&](std::size_t word, std::uint32_t value) {
    WideBvh wide = good;
    wide.leaves[begin + word] = value;
    const auto fault = gnomon::check_wide(wide, triangles);
    return fault ? fault->what : "none";
  };
  REQUIRE(fault_with(0, GN_LONG_LEAF - 1) == "leaves: a long one of 31 triangles");
  REQUIRE(fault_with(0, GN_MAX_WIDE_LEAF + 1) == "leaves: a long one of 257 triangles");
  REQUIRE(fault_with(0, 0xffffffffU) == "leaves: a long one of 4294967295 triangles");
  REQUIRE_THAT(fault_with(0, good.leaves[begin] + 1),
               Catch::Contains("two leaves") || Catch::Contains("places end at"));
  REQUIRE_THAT(fault_with(0, good.leaves[begin] - 1),
               Catch::Contains("in no leaf") || Catch::Contains("long one of 31"));
  for (std::size_t word = 1; word < GN_TRIANGLE_WORDS; ++word)
    REQUIRE(fault_with(word, 1) == "leaves: something behind a long one's count");
}

TEST_CASE("empty slots are looked at") {
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
                              : std::as_writable_bytes(std::span(s.wide.leaves));
      const std::uint32_t word = random.below(static_cast<std::uint32_t>(bytes.size() / 4));
      const std::uint32_t value = random.below(3) == 0 ? random.below(100) : random.below(0xffffffffU);
      std::memcpy(bytes.data() + std::size_t{word} * 4, &value, 4);
    }
    static_cast<void>(gnomon::check_wide(s.wide, s.triangles));
  }
  for (int i = 0; i < 300; ++i) {
    WideBvh noise;
    noise.nodes.resize(random.below(9));
    noise.leaves.resize(std::size_t{GN_TRIANGLE_WORDS} * random.below(9));
    const auto fill = [&](std::span<std::byte> bytes) {
      for (std::byte& b : bytes) b = static_cast<std::byte>(random.below(8) == 0 ? random.below(256) : 0);
    };
    fill(std::as_writable_bytes(std::span(noise.nodes)));
    fill(std::as_writable_bytes(std::span(noise.leaves)));
    REQUIRE(gnomon::check_wide(noise, good.triangles));
  }
}
