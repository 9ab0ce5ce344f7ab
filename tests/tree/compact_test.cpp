// The compact tree: what the reference makes of every shape, and that quantised boxes hold what they stand
// for.
#include "gnomon/tree/compact.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/base/error.h"
#include "gnomon/shared/compact_math.h"
#include "gnomon/tree/build_reference.h"
#include "support/wide_shapes.h"

using gnomon::CompactBvh;
using gnomon::CompactNode;
using gnomon::WideBvh;
using gnomon::WideNode;
using gnomon::test::Random;

namespace {

WideBvh wide_of(const std::vector<GnTriangle>& triangles, const gnomon::BuildOptions& options = {}) {
  return gnomon::collapse_reference(gnomon::build_reference(triangles, options), triangles);
}

// A step's plane in double, rounded once to float: what traversal computes.
float plane_of(const CompactNode& node, std::uint32_t plane, std::uint32_t slot) {
  const std::uint32_t axis = plane / 2;
  const int exponent = static_cast<int>(node.scales >> (8 * axis) & 255U) - 127;
  const auto step = static_cast<double>(node.planes[plane][slot / 4] >> (8 * (slot % 4)) & 255U);
  return static_cast<float>(static_cast<double>(node.origin[axis]) + std::ldexp(step, exponent));
}

// A wide node with `count` children that are leaves and these boxes.
WideNode node_of(const std::vector<std::array<float, 6>>& boxes) {
  WideNode node{};
  for (std::uint32_t slot = 0; slot < GN_WIDTH; ++slot) {
    node.links[slot] = slot < boxes.size() ? gn_leaf_link(slot, 1 + slot) : GN_NONE;
    for (std::uint32_t plane = 0; plane < 6; ++plane) {
      node.planes[plane][slot] = slot < boxes.size() ? boxes[slot][plane]
                                 : plane % 2 == 0    ? INFINITY
                                                     : -INFINITY;
    }
  }
  return node;
}

CompactNode compact_of(const WideNode& node, std::uint32_t* child_of) {
  gn_assign_slots(&node, child_of);
  CompactNode out;
  gn_fill_compact_node(&node, nullptr, child_of, &out);  // no long leaves
  return out;
}

// Each child is in one slot, whose box holds the child's and is larger by no more than two steps and the
// rounding of a plane.
void require_conservative(const WideNode& node) {
  std::uint32_t child_of[8];
  const CompactNode compact = compact_of(node, child_of);
  std::uint32_t seen = 0;
  for (std::uint32_t slot = 0; slot < GN_WIDTH; ++slot) {
    const std::uint32_t child = child_of[slot];
    if (child == GN_NONE) {
      REQUIRE(gn_byte_of(compact.counts, slot) == 0);
      continue;
    }
    seen |= 1U << child;
    REQUIRE(gn_byte_of(compact.counts, slot) == 1 + child);
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const double lo = node.planes[2 * axis][child];
      const double hi = node.planes[2 * axis + 1][child];
      const double low = plane_of(compact, 2 * axis, slot);
      const double high = plane_of(compact, 2 * axis + 1, slot);
      const double step = std::ldexp(1.0, static_cast<int>(compact.scales >> (8 * axis) & 255U) - 127);
      const double slack =
          2.0 * step + std::ldexp(std::max(std::abs(low), std::abs(high)), -22) + std::ldexp(1.0, -100);
      CAPTURE(slot, child, axis, lo, low, hi, high, step);
      REQUIRE(low <= lo);
      REQUIRE(hi <= high);
      REQUIRE(lo - low <= slack);
      REQUIRE(high - hi <= slack);
    }
  }
  std::uint32_t children = 0;
  while (children < GN_WIDTH && node.links[children] != GN_NONE) ++children;
  REQUIRE(seen == (1U << children) - 1U);
}

}  // namespace

TEST_CASE("compact trees of every shape hold all triangles in conservative boxes") {
  for (const auto& shape : gnomon::test::wide_shapes()) {
    CAPTURE(shape.name);
    const WideBvh wide = wide_of(shape.triangles, shape.options);
    const CompactBvh compact = gnomon::compact_reference(wide);
    const auto fault = gnomon::check_compact(compact, shape.triangles);
    CAPTURE(fault ? fault->what : "none");
    REQUIRE(!fault);
    REQUIRE(compact.nodes.size() == wide.nodes.size());
    for (const WideNode& node : wide.nodes) {
      // Links to nodes count no triangles: only planes are looked at there.
      std::vector<std::array<float, 6>> boxes;
      for (std::uint32_t slot = 0; slot < GN_WIDTH && node.links[slot] != GN_NONE; ++slot) {
        boxes.emplace_back();
        for (std::uint32_t plane = 0; plane < 6; ++plane) boxes.back()[plane] = node.planes[plane][slot];
      }
      if (!boxes.empty()) require_conservative(node_of(boxes));
    }
  }
}

TEST_CASE("quantised boxes hold the exact ones at any size and place, and are hardly larger") {
  Random random(611);
  for (const int size : {-149, -140, -126, -110, -100, -60, -40, 0, 20, 40, 47}) {
    for (const int offset : {-140, -102, -101, -60, 0, 30, 47}) {
      for (int i = 0; i < 60; ++i) {
        CAPTURE(size, offset, i);
        std::vector<std::array<float, 6>> boxes(1 + random.below(8));
        const bool flat = random.below(4) == 0;
        float center[3];
        for (float& c : center) c = std::ldexp(random.between(-1.0F, 1.0F), offset);
        for (auto& box : boxes) {
          for (std::size_t axis = 0; axis < 3; ++axis) {
            const float a = center[axis] + std::ldexp(random.between(-1.0F, 1.0F), size);
            const float b = flat ? a : center[axis] + std::ldexp(random.between(-1.0F, 1.0F), size);
            box[2 * axis] = std::min(a, b);
            box[2 * axis + 1] = std::max(a, b);
          }
        }
        require_conservative(node_of(boxes));
      }
    }
  }
}

TEST_CASE("boxes at zeros of either sign, at powers of two and one float beside them are held") {
  std::vector<float> edges{0.0F, -0.0F};
  for (const int exponent : {-149, -126, -102, -101, -100, -92, -1, 0, 7, 8, 40, 48}) {
    const float power = std::ldexp(1.0F, exponent);
    for (const float x : {power, std::nextafter(power, 0.0F), std::nextafter(power, INFINITY)}) {
      edges.push_back(x);
      edges.push_back(-x);
    }
  }
  for (const float a : edges) {
    for (const float b : edges) {
      CAPTURE(a, b);
      const float lo = std::min(a, b);
      const float hi = std::max(a, b);
      require_conservative(node_of({{lo, hi, lo, lo, hi, hi}}));
      require_conservative(
          node_of({{lo, lo, lo, hi, lo, lo}, {hi, hi, lo, hi, lo, hi}, {lo, hi, hi, hi, hi, hi}}));
    }
  }
}

TEST_CASE("planes are never denormal, so that devices which flush compute the same") {
  Random random(612);
  for (int i = 0; i < 20000; ++i) {
    const float lo = std::ldexp(random.between(-1.0F, 1.0F), -static_cast<int>(random.below(149)));
    const float hi = lo + std::ldexp(random.between(0.0F, 1.0F), -static_cast<int>(random.below(149)));
    const float origin = gn_quantised_origin(lo);
    const std::uint32_t scale = gn_quantised_scale(origin, hi);
    for (const std::uint32_t step :
         {0U, 1U, 2U, gn_step_below(origin, scale, lo), gn_step_above(origin, scale, hi), 255U}) {
      CAPTURE(lo, hi, origin, scale, step);
      REQUIRE(std::fpclassify(gn_plane_at(origin, gn_float_of(scale << 23), step)) != FP_SUBNORMAL);
    }
  }
}

TEST_CASE("children get the slots of their octants") {
  std::vector<std::array<float, 6>> boxes;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const std::uint32_t octant = i * 5 % 8;
    std::array<float, 6> box{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box[2 * axis] = (octant >> axis & 1U) != 0 ? 10.0F : 0.0F;
      box[2 * axis + 1] = box[2 * axis] + 1.0F;
    }
    boxes.push_back(box);
  }
  const WideNode node = node_of(boxes);
  std::uint32_t child_of[8];
  gn_assign_slots(&node, child_of);
  for (std::uint32_t slot = 0; slot < 8; ++slot) REQUIRE(child_of[slot] * 5 % 8 == slot);
}

TEST_CASE("equal corners are stored once where that is smaller, and stay apart bit for bit") {
  // One node: fields are as wide as the differences of its keys, numbers and places.
  const auto fields_of = [](const CompactBvh& compact, std::uint32_t column) {
    return gn_pack_width(compact.leaves[compact.nodes[0].leaves], column);
  };
  const std::vector<GnTriangle> quad{gnomon::test::triangle({1, 1, 1}, {1.5, 1, 1}, {1, 1.5, 1}),
                                     gnomon::test::triangle({1.5, 1.5, 1}, {1, 1.5, 1}, {1.5, 1, 1})};
  const CompactBvh shared = gnomon::compact_reference(wide_of(quad));
  REQUIRE(shared.nodes.size() == 1);
  REQUIRE(fields_of(shared, 0) == 23);  // 1 and 1.5 are half of 2^23 floats apart
  REQUIRE(fields_of(shared, 1) == 23);
  REQUIRE(fields_of(shared, 2) == 0);
  REQUIRE(fields_of(shared, GN_NUMBER_COLUMN) == 1);
  REQUIRE(fields_of(shared, GN_PLACE_COLUMN) == 2);
  // 2 triangles of 3 * 2 + 1 bits and 4 vertices of 46: 198 bits.
  REQUIRE(shared.leaves.size() == 5 + 7 + 1);

  // Zeros of both signs are neighbours among floats, and two positions.
  std::vector<GnTriangle> zeros = quad;
  zeros[0].v0[2] = -0.0F;
  zeros[1].v1[2] = 0.0F;
  const CompactBvh signs = gnomon::compact_reference(wide_of(zeros));
  REQUIRE(!gnomon::check_compact(signs, zeros));
  REQUIRE(gn_pack_key(gn_bits_of(0.0F)) == gn_pack_key(gn_bits_of(-0.0F)) + 1);
}

TEST_CASE("meshes and soups take few bytes a triangle") {
  const auto bytes_per_triangle = [](const std::vector<GnTriangle>& triangles) {
    const CompactBvh compact = gnomon::compact_reference(wide_of(triangles));
    REQUIRE(!gnomon::check_compact(compact, triangles));
    REQUIRE(compact.bytes() == compact.nodes.size() * 80 + compact.leaves.size() * 4);
    return static_cast<double>(compact.bytes()) / static_cast<double>(triangles.size());
  };
  REQUIRE(bytes_per_triangle(gnomon::test::grid(20, 2.0F)) < 20.0);
  REQUIRE(bytes_per_triangle(gnomon::test::soup(3000, 613)) <= 36.0);
}

TEST_CASE("an integer stands for each float, in the floats' order, and gives its bits back") {
  std::vector<float> rising{-INFINITY, -3e38F, -1.0F, -1e-45F, -0.0F, 0.0F, 1e-45F, 1e-38F, 1.0F, INFINITY};
  for (std::size_t i = 0; i < rising.size(); ++i) {
    const std::uint32_t key = gn_pack_key(gn_bits_of(rising[i]));
    REQUIRE(gn_pack_key(key) == gn_bits_of(rising[i]));
    if (i > 0) REQUIRE(static_cast<int>(gn_pack_key(gn_bits_of(rising[i - 1]))) < static_cast<int>(key));
  }
}

TEST_CASE("fields of any width come back from any bit") {
  Random random(614);
  const auto any = [&random](std::uint32_t width) {
    std::uint32_t value = 0;
    for (std::uint32_t bit = 0; bit < width; ++bit) value |= random.below(2) << bit;
    return value;
  };
  for (int round = 0; round < 200; ++round) {
    std::vector<std::uint32_t> words(80, 0);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> fields;  // width and value
    GnFieldWriter to{words.data(), 0, 0};
    for (int i = 0; i < 70; ++i) {
      const std::uint32_t width = random.below(8) == 0 ? 32 : random.below(33);
      fields.emplace_back(width, any(width));
      gn_append(&to, fields.back().second, width);
    }
    if (to.used != 0) *to.next = to.word;
    std::uint32_t bit = 0;
    for (const auto& [width, value] : fields) {
      CAPTURE(round, bit, width);
      REQUIRE(gn_field_at(words.data(), bit, gn_field_mask(width)) == value);
      bit += width;
    }
  }
}

TEST_CASE("a leaf of 256 triangles is refused, one of 255 is not") {
  const auto triangles = gnomon::test::repeated(gnomon::test::triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 256);
  const auto single_leaf = [&](std::uint32_t count) {
    gnomon::Bvh bvh;
    gnomon::Node leaf{};
    for (float& hi : leaf.hi) hi = 1.0F;
    leaf.count = count;
    bvh.nodes = {leaf};
    for (std::uint32_t i = 0; i < count; ++i) bvh.primitives.push_back(i);
    return gnomon::collapse_reference(bvh, std::span(triangles).first(count));
  };
  REQUIRE(
      !gnomon::check_compact(gnomon::compact_reference(single_leaf(255)), std::span(triangles).first(255)));
  REQUIRE_THROWS_WITH(gnomon::compact_reference(single_leaf(256)), Catch::Contains("leaf of 256 triangles"));
}

TEST_CASE("sums of bytes") {
  const std::uint32_t bytes[2] = {0xff030201U, 0x0807ffffU};
  const std::uint32_t sums[8] = {0, 1, 3, 6, 261, 516, 771, 778};
  for (std::uint32_t slot = 0; slot < 8; ++slot) REQUIRE(gn_bytes_before(bytes, slot) == sums[slot]);
  REQUIRE(gn_leaf_triangles(bytes) == 786);
}
