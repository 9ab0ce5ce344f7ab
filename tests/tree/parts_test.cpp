// Parts of triangles: together they hold the triangle, they are few, and only what wastes much is divided.
#include "gnomon/tree/parts.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/cover.h"
#include "support/shapes.h"

namespace {

using Triangles = std::vector<GnTriangle>;

GnNode box_of(const GnPrimitive& p) {
  GnNode node{};
  std::copy_n(p.lo, 3, node.lo);
  std::copy_n(p.hi, 3, node.hi);
  return node;
}

double half_area(const GnNode& n) {
  const double x = double{n.hi[0]} - n.lo[0];
  const double y = double{n.hi[1]} - n.lo[1];
  const double z = double{n.hi[2]} - n.lo[2];
  return x * y + y * z + z * x;
}

// Small triangles, and one in twenty that reaches across the scene.
Triangles with_large_ones(std::uint32_t count, std::uint32_t seed, float offset = 0.0F) {
  Triangles triangles = gnomon::test::soup(count, seed, 0.05F, offset);
  gnomon::test::Random random(seed + 1);
  for (std::size_t i = 0; i < triangles.size(); i += 20) {
    for (float* v : {triangles[i].v0, triangles[i].v1, triangles[i].v2})
      for (std::size_t k = 0; k < 3; ++k) v[k] = offset + random.between(0.0F, 10.0F);
  }
  return triangles;
}

void require_covered(const Triangles& triangles, const std::vector<GnPrimitive>& parts) {
  gnomon::TriangleBoxes boxes(triangles.size());
  for (const GnPrimitive& part : parts) boxes.add(part.index, box_of(part));
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    CAPTURE(i);
    REQUIRE(gnomon::boxes_cover(triangles[i], boxes.of(i)));
  }
}

}  // namespace

TEST_CASE("parts hold their triangles, in order and within the budget, whatever the input") {
  auto inputs = gnomon::test::awkward_inputs();
  inputs.emplace_back("large ones", with_large_ones(1000, 301));
  inputs.emplace_back("large ones far off", with_large_ones(1000, 302, 3.0e5F));
  inputs.emplace_back("large only", gnomon::test::soup(300, 303, 8.0F));
  for (const auto& [name, triangles] : inputs) {
    for (const float budget : {0.0F, 0.3F, 5.0F}) {
      CAPTURE(name, budget);
      const auto parts = gnomon::parts_of(triangles, budget);
      REQUIRE(parts.size() <= gnomon::most_parts(triangles.size(), budget));
      REQUIRE(std::is_sorted(parts.begin(), parts.end(), [](auto& a, auto& b) { return a.index < b.index; }));
      require_covered(triangles, parts);
      for (const GnPrimitive& part : parts) {
        const GnPrimitive whole = gnomon::primitive_of(triangles[part.index], part.index);
        for (int k = 0; k < 3; ++k) {
          REQUIRE(part.lo[k] <= part.hi[k]);
          REQUIRE(part.lo[k] >= whole.lo[k]);
          REQUIRE(part.hi[k] <= whole.hi[k]);
          REQUIRE_FALSE((part.lo[k] == 0.0F && std::signbit(part.lo[k])));
          REQUIRE_FALSE((part.hi[k] == 0.0F && std::signbit(part.hi[k])));
        }
      }
    }
  }
}

TEST_CASE("a diagonal triangle's parts are a fraction of its box") {
  Triangles triangles = gnomon::test::soup(2000, 304, 0.1F);
  for (std::size_t i = 0; i < 30; ++i)
    triangles[i] = gnomon::test::triangle({0, 0, 0}, {10, 10, 10}, {10, 10, 9.9F});
  const auto parts = gnomon::parts_of(triangles, 0.3F);
  double sum = 0.0;
  std::size_t count = 0;
  for (const GnPrimitive& part : parts) {
    if (part.index != 0) continue;
    sum += half_area(box_of(part));
    count += 1;
  }
  REQUIRE(count > 10);
  REQUIRE(count <= GN_MOST_PARTS);
  REQUIRE(sum < 0.15 * 300.0);
}

TEST_CASE("walls along the axes waste nothing but their halves, and small triangles are left whole") {
  const Triangles walls = gnomon::test::grid(30);
  REQUIRE(gnomon::parts_of(walls, 0.3F).size() == walls.size());
  const Triangles triangles = with_large_ones(2000, 305);
  std::vector<std::uint32_t> count(triangles.size());
  for (const GnPrimitive& part : gnomon::parts_of(triangles, 0.3F)) count[part.index] += 1;
  for (std::size_t i = 0; i < count.size(); ++i) {
    CAPTURE(i);
    if (i % 20 != 0) REQUIRE(count[i] == 1);
  }
  REQUIRE(*std::max_element(count.begin(), count.end()) > 3);
}

TEST_CASE("more is divided the lower the floor, as the square root of what boxes waste") {
  const std::uint32_t floor = gn_waste_bin(1.0F);
  REQUIRE(gn_splits_of(floor - 1, floor) == 0);
  REQUIRE(gn_splits_of(floor, floor) == 1);
  REQUIRE(gn_splits_of(gn_waste_bin(4.0F), floor) == 2);
  REQUIRE(gn_splits_of(gn_waste_bin(9.0F), floor) == 3);
  REQUIRE(gn_splits_of(gn_waste_bin(1e6F), floor) == GN_MOST_PARTS - 1);
  REQUIRE(gn_splits_of(gn_waste_bin(1e6F), GN_NONE) == 0);
}

TEST_CASE("the floor keeps to the budget and to triangles that it pays to divide") {
  std::vector<std::uint32_t> bins(GN_WASTE_BINS);
  bins[gn_waste_bin(1.0F)] = 900;
  bins[gn_waste_bin(64.0F)] = 100;
  // 0.3 of 1000: four splits each of the hundred are 400, three 300.
  const std::uint32_t floor = gnomon::waste_floor(bins, 1.0F, 0.3F);
  REQUIRE(floor > gn_waste_bin(1.0F));
  REQUIRE(100 * gn_splits_of(gn_waste_bin(64.0F), floor) <= 300);
  REQUIRE(100 * gn_splits_of(gn_waste_bin(64.0F), floor - 1) > 300);
  REQUIRE(gnomon::waste_floor(bins, 1.0F, 0.0F) == GN_NONE);
  REQUIRE(gnomon::waste_floor(bins, 0.0F, 0.3F) == GN_NONE);
  // Of a thousand triangles those that waste 0.0064 of the scene, where that is the mean.
  bins[gn_waste_bin(1.0F)] = 700;
  bins[gn_waste_bin(64.0F)] = 100;
  bins[gn_waste_bin(1024.0F)] = 200;
  REQUIRE(gnomon::waste_floor(bins, 0.01F / 64.0F, 0.85F) == gn_waste_bin(72.0F));
  REQUIRE(gnomon::waste_floor(bins, 0.01F / 64.0F, 30.0F) == gn_waste_bin(44.0F));
  bins[gn_waste_bin(1024.0F)] = 30;
  bins[gn_waste_bin(1.0F)] = 870;
  REQUIRE(gnomon::waste_floor(bins, 0.01F / 64.0F, 30.0F) == GN_NONE);
}

TEST_CASE("where an edge passes a plane is bounded for certain") {
  gnomon::test::Random random(306);
  for (int i = 0; i < 20000; ++i) {
    CAPTURE(i);
    const float scale = std::ldexp(1.0F, static_cast<int>(random.below(60)) - 30);
    float a[3];
    float b[3];
    for (int k = 0; k < 3; ++k) {
      a[k] = random.between(-1.0F, 1.0F) * scale + (i % 3 == 0 ? 1000.0F : 0.0F);
      b[k] = random.between(-1.0F, 1.0F) * scale + (i % 3 == 0 ? 1000.0F : 0.0F);
    }
    if (!(a[0] < b[0])) std::swap(a[0], b[0]);
    const float plane = a[0] + random.between(0.0F, 1.0F) * (b[0] - a[0]);
    if (!(a[0] < plane && plane < b[0]) || b[0] - a[0] < GN_SMALLEST_EXTENT) continue;
    float lo[3];
    float hi[3];
    gn_edge_at(a, b, 0, plane, lo, hi);
    const long double share =
        (static_cast<long double>(plane) - a[0]) / (static_cast<long double>(b[0]) - a[0]);
    for (int k = 0; k < 3; ++k) {
      const long double at = a[k] + share * (static_cast<long double>(b[k]) - a[k]);
      REQUIRE(static_cast<long double>(lo[k]) <= at + (k == 0 ? 1e-18L * scale : 0.0L) + 1e-18L * fabsl(at));
      REQUIRE(static_cast<long double>(hi[k]) >= at - (k == 0 ? 1e-18L * scale : 0.0L) - 1e-18L * fabsl(at));
    }
  }
}

TEST_CASE("a corner exactly in a plane belongs to both of its sides") {
  using Place = std::array<float, 3>;
  const Place low{0, 0, 0};
  const Place high{4, 0, 1};
  const Place within{2, 4, 7};
  const Place beside{2, 1, 5};
  struct Cut {
    std::array<Place, 3> corners;
    bool has_left, has_right;
    Place left_lo, left_hi, right_lo,
        right_hi;  // boxes that the sides' must hold, along the plane's axis theirs
  };
  const std::vector<Cut> cuts{
      {{low, high, within}, true, true, {0, 0, 0}, {2, 4, 7}, {2, 0, 0.5F}, {4, 4, 7}},
      {{low, within, beside}, true, true, {0, 0, 0}, {2, 4, 7}, {2, 1, 5}, {2, 4, 7}},  // an edge in the
                                                                                        // plane
      {{high, within, beside}, true, true, {2, 1, 5}, {2, 4, 7}, {2, 0, 1}, {4, 4, 7}},
      {{low, {1, 3, 3}, within}, true, true, {0, 0, 0}, {2, 4, 7}, {2, 4, 7}, {2, 4, 7}},  // touched by one
                                                                                           // corner
      {{within, beside, {2, 9, 2}}, true, true, {2, 1, 2}, {2, 9, 7}, {2, 1, 2}, {2, 9, 7}}};  // all in the
                                                                                               // plane
  for (std::size_t c = 0; c < cuts.size(); ++c) {
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t first = 0; first < 3; ++first) {
        CAPTURE(c, axis, first);
        const Cut& cut = cuts[c];
        GnCut t{};
        for (std::size_t i = 0; i < 3; ++i) {
          for (int k = 0; k < 3; ++k) t.corner[(first + i) % 3][(k + axis) % 3] = cut.corners[i][k];
        }
        GnPart left;
        GnPart right;
        gn_cut_triangle(&t, axis, 2.0F, &left, &right);
        for (int k = 0; k < 3; ++k) {
          const int at = (k + axis) % 3;
          CAPTURE(k);
          REQUIRE(left.lo[at] <= cut.left_lo[k]);
          REQUIRE(left.hi[at] >= cut.left_hi[k]);
          REQUIRE(right.lo[at] <= cut.right_lo[k]);
          REQUIRE(right.hi[at] >= cut.right_hi[k]);
        }
        REQUIRE(left.hi[axis] == 2.0F);
        REQUIRE(right.lo[axis] == 2.0F);
        REQUIRE(left.lo[axis] == cut.left_lo[0]);
        REQUIRE(right.hi[axis] == cut.right_hi[0]);
      }
    }
  }
}

TEST_CASE("parts hold triangles whose corners lie exactly in the planes that divide them") {
  const Triangles triangles = gnomon::test::corners_in_planes(2000, 200, 307);
  const auto parts = gnomon::parts_of(triangles, 5.0F);
  require_covered(triangles, parts);
  std::size_t at_corners =
      0;  // parts that end in a plane with a corner of the triangle, which reaches beyond
  for (const GnPrimitive& part : parts) {
    const GnTriangle& t = triangles[part.index];
    const GnPrimitive whole = gnomon::primitive_of(t, part.index);
    for (int k = 0; k < 3; ++k) {
      const bool ends = part.hi[k] < whole.hi[k];
      const auto in_plane = [&](const float* v) { return v[k] == part.hi[k]; };
      if (ends && (in_plane(t.v0) || in_plane(t.v1) || in_plane(t.v2))) at_corners += 1;
    }
  }
  REQUIRE(at_corners > 100);
}

TEST_CASE("covers are told from gaps") {
  const GnTriangle t = gnomon::test::triangle({0, 0, 0}, {4, 0, 1}, {0, 4, 1});
  const GnNode left{{0, 0, 0}, 0, {2, 4, 1}, 1};
  GnNode right{{2, 0, 0.5F}, 0, {4, 2, 1}, 1};
  REQUIRE(gnomon::boxes_cover(t, std::vector<GnNode>{left, right}));
  REQUIRE_FALSE(gnomon::boxes_cover(t, std::vector<GnNode>{left}));
  REQUIRE_FALSE(gnomon::boxes_cover(t, {}));
  right.lo[0] = std::nextafter(2.0F, 3.0F);
  REQUIRE_FALSE(gnomon::boxes_cover(t, std::vector<GnNode>{left, right}));
  right.lo[0] = 2.0F;
  right.hi[1] = 1.9F;  // a corner of what is right of x = 2 sticks out
  REQUIRE_FALSE(gnomon::boxes_cover(t, std::vector<GnNode>{left, right}));
}
