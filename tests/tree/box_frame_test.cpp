// Boxes in a frame: frames are what they promise, no hit is lost or found by them, whatever the scene's size
// and place, and the margin is what the ray's own rounding needs.
#include "gnomon/tree/box_frame.h"

#include <catch2/catch.hpp>
#include <cstring>

#include "gnomon/base/error.h"
#include "gnomon/shared/hit_math.h"
#include "gnomon/tree/bvh_check.h"
#include "gnomon/tree/compact.h"
#include "gnomon/tree/merge_leaves.h"
#include "gnomon/tree/optimise.h"
#include "gnomon/tree/oracle.h"
#include "gnomon/tree/refit.h"
#include "gnomon/tree/trace_wide_reference.h"
#include "support/framed.h"

using gnomon::BoxFrame;
using gnomon::Bvh;
using gnomon::frame_along;
using gnomon::test::frame_directions;
using gnomon::test::framed_tree;
using gnomon::test::rays_at_corners;
using gnomon::test::soup;
using Triangles = std::vector<GnTriangle>;

namespace {

double dot(const float* a, const float* b) {
  return double{a[0]} * double{b[0]} + double{a[1]} * double{b[1]} + double{a[2]} * double{b[2]};
}

bool same(const GnHit& a, const GnHit& b) {
  return std::memcmp(&a, &b, sizeof(GnHit)) == 0;
}

// How many rays hit; all as in a tree without a frame, by the binary and the wide tree.
std::size_t require_same_hits(const Triangles& triangles, const Bvh& framed, const std::vector<GnRay>& rays) {
  const Bvh plain = gnomon::build_reference(triangles);
  const auto expected = gnomon::trace_reference(plain, triangles, rays, false).hits;
  const auto closest = gnomon::trace_reference(framed, triangles, rays, false).hits;
  const auto any = gnomon::trace_reference(framed, triangles, rays, true).hits;
  const gnomon::WideBvh wide = gnomon::collapse_reference(framed, triangles);
  if (const auto fault = gnomon::check_wide(wide, triangles)) FAIL(fault->what);
  const auto wide_closest = gnomon::trace_wide_reference(wide, rays, false).hits;
  const auto wide_any = gnomon::trace_wide_reference(wide, rays, true).hits;
  std::size_t met = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CAPTURE(i, expected[i].primitive, expected[i].t, closest[i].primitive, closest[i].t);
    REQUIRE(same(closest[i], expected[i]));
    REQUIRE(same(wide_closest[i], expected[i]));
    const bool hit = expected[i].primitive != GN_NONE;
    REQUIRE((any[i].primitive != GN_NONE) == hit);
    REQUIRE((wide_any[i].primitive != GN_NONE) == hit);
    met += hit ? 1 : 0;
  }
  return met;
}

}  // namespace

TEST_CASE("a frame is half a rotation with z along the direction") {
  const Triangles triangles = soup(50, 300);
  for (const auto& direction : frame_directions()) {
    const BoxFrame frame = frame_along(direction, triangles);
    CAPTURE(direction[0], direction[1], direction[2]);
    REQUIRE_FALSE(gnomon::fault_of(frame, triangles));
    for (int row = 0; row < 3; ++row) {
      for (int other = 0; other < 3; ++other)
        REQUIRE(dot(frame.rows + 3 * row, frame.rows + 3 * other) ==
                Approx(row == other ? 0.25 : 0.0).margin(1e-7));
    }
    const double size =
        std::sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
    for (std::size_t k = 0; k < 3; ++k)
      REQUIRE(double{frame.rows[6 + k]} == Approx(0.5 * direction[k] / size).margin(1e-7));
    // x is at a right angle to one of the world's axes: what stands along that is narrow.
    REQUIRE((frame.rows[0] == 0.0F || frame.rows[1] == 0.0F || frame.rows[2] == 0.0F));
  }
  REQUIRE_THROWS_WITH(frame_along({0, 0, 0}, triangles), Catch::Contains("not zero"));
  REQUIRE_THROWS_WITH(frame_along({0, NAN, 1}, triangles), Catch::Contains("finite"));
}

TEST_CASE("of the three upright frames that is taken in which triangles show least") {
  // Masts along y, seen obliquely: only where y leaves no trace in x are their boxes narrow.
  Triangles masts;
  for (int i = 0; i < 40; ++i) {
    const auto x = static_cast<float>(i);
    masts.push_back(gnomon::test::triangle({x, 0, 0.3F * x}, {x + 0.01F, 0, 0.3F * x}, {x, 9, 0.3F * x}));
  }
  REQUIRE(frame_along({0.5, -0.6, 0.7}, masts).rows[1] == 0.0F);
  REQUIRE(frame_along({-0.5, -0.6, 0.1}, masts).rows[1] == 0.0F);
  for (GnTriangle& t : masts) {
    for (float* v : {t.v0, t.v1, t.v2}) std::swap(v[1], v[2]);
  }
  REQUIRE(frame_along({0.5, -0.6, 0.7}, masts).rows[2] == 0.0F);
}

TEST_CASE("framed trees meet what others do, whatever the scene's size and place") {
  struct Place {
    float scale, offset;
  };
  std::uint32_t seed = 310;
  for (const Place place : {Place{1.0F, 0.0F},
                            {1.0F, 1e3F},
                            {1.0F, 1e6F},
                            {1e12F, 0.0F},
                            {1e13F, -1e14F},
                            {1e-18F, 0.0F},
                            {1e-18F, 1e-15F},
                            {1e-37F, 0.0F}}) {
    const Triangles triangles = gnomon::test::scaled(soup(200, seed++), place.scale, place.offset);
    for (const auto& direction : frame_directions()) {
      const Bvh tree = framed_tree(triangles, direction);
      for (const float far : {2.0F, 1e3F, 1e6F}) {
        CAPTURE(place.scale, place.offset, direction[0], direction[1], direction[2], far);
        const auto rays = rays_at_corners(triangles, *tree.frame, 400, seed++, far);
        const std::size_t met = require_same_hits(triangles, tree, rays);
        if (far < 10.0F && place.scale > 1e-30F) REQUIRE(met > 40);
      }
    }
  }
}

TEST_CASE("framed trees meet what others do on shapes builders go wrong on, and from beyond all bounds") {
  for (const auto& [name, triangles] : gnomon::test::awkward_inputs()) {
    for (const auto& direction : frame_directions()) {
      const Bvh tree = framed_tree(triangles, direction, {});
      CAPTURE(name, direction[0]);
      gnomon::BuildOptions options;
      if (const auto fault = gnomon::check_bvh(tree, triangles, options)) FAIL(fault->what);
      std::vector<GnRay> rays;
      if (!triangles.empty()) rays = rays_at_corners(triangles, *tree.frame, 100, 330, 3.0F);
      for (const float huge : {1e30F, 3.4e38F}) {
        for (const float sign : {1.0F, -1.0F}) {
          GnRay ray{{sign * huge, huge, -huge}, 0.0F, {-sign, -1.0F, 1.0F}, INFINITY};
          rays.push_back(ray);
          ray.tmin = -INFINITY;
          rays.push_back(ray);
          ray.direction[0] = 1e-40F;
          rays.push_back(ray);
        }
      }
      require_same_hits(triangles, tree, rays);
    }
  }
}

TEST_CASE("the judge finds nothing lost and nothing added by framed trees") {
  const Triangles triangles = soup(300, 340, 1.0F, 40.0F);
  const Bvh tree = framed_tree(triangles, {0.4, -0.7, 0.6});
  const auto rays = rays_at_corners(triangles, *tree.frame, 3000, 341, 2.0F);
  const auto hits = gnomon::trace_reference(tree, triangles, rays, false).hits;
  std::vector<std::uint32_t> occluded;
  for (const GnHit& hit : gnomon::trace_reference(tree, triangles, rays, true).hits)
    occluded.push_back(hit.primitive != GN_NONE ? 1 : 0);
  gnomon::OracleOptions options;
  options.max_rays = rays.size();
  const auto report = gnomon::judge(triangles, rays, hits, occluded, options);
  REQUIRE(report.rays_judged == rays.size());
  REQUIRE(report.lost == 0);
  REQUIRE(report.mismatches() == 0);
}

TEST_CASE("the margin covers what corners and rays are off by, reckoned in double") {
  // A point box where the exact ray is at t, moved by the most a turned corner may be off, must be met at t.
  const double off = 3.0 * 0.875 * std::ldexp(1.0, -24);
  gnomon::test::Random random(350);
  for (int i = 0; i < 200'000; ++i) {
    const std::size_t which = random.below(static_cast<std::uint32_t>(frame_directions().size()));
    BoxFrame frame = frame_along(frame_directions()[which], {});
    const double scale = std::ldexp(1.0, static_cast<int>(random.below(120)) - 60);
    const double apart = std::ldexp(1.0, static_cast<int>(random.below(24)) - 4);
    GnRay ray{};
    double point[3];
    frame.size = 0.0F;
    double t = 0.0;
    const bool axis_parallel = random.below(2) == 0;
    for (std::size_t k = 0; k < 3; ++k) {
      ray.direction[k] = axis_parallel ? frame.rows[6 + k] : random.between(-1.0F, 1.0F);
      ray.origin[k] = static_cast<float>(scale * apart * random.between(-1.0F, 1.0F));
    }
    if (!gn_ray_is_valid(&ray)) continue;
    t = scale * apart * random.between(-2.0F, 2.0F);
    for (std::size_t k = 0; k < 3; ++k) {
      point[k] = double{ray.origin[k]} + t * double{ray.direction[k]};
      frame.size = std::max(frame.size, static_cast<float>(std::fabs(point[k]) * (1.0 + 1e-7)));
    }
    float box[3];
    for (std::size_t k = 0; k < 3; ++k) {
      double turned = 0.0;
      for (std::size_t j = 0; j < 3; ++j) turned += double{frame.rows[3 * k + j]} * point[j];
      const double sign = random.below(2) == 0 ? 1.0 : -1.0;
      // Half an ulp of the float that it becomes is no more than half of u size.
      box[k] = static_cast<float>(turned + sign * (off - std::ldexp(1.0, -25)) * double{frame.size});
    }
    const GnBoxRay in = gn_box_ray(&frame, &ray);
    const float limit = gn_slab_limit(static_cast<float>(t));
    const float entry = gn_framed_box_entry(&in, box, box, -INFINITY, limit);
    CAPTURE(i, which, scale, apart, t, entry, axis_parallel);
    REQUIRE(entry <= limit);
  }
}

TEST_CASE("the margin is small beside a scene's size") {
  const Triangles triangles = soup(100, 360);
  const BoxFrame frame = frame_along({1, 1, 1}, triangles);
  const GnRay ray{{5, 5, 5}, 0.0F, {1, 2, 3}, INFINITY};
  const GnBoxRay in = gn_box_ray(&frame, &ray);
  for (int k = 0; k < 3; ++k) {
    const double apart = std::fabs(double{in.near_origin[k]} - double{in.far_origin[k]});
    REQUIRE(apart > 0.0);
    REQUIRE(apart < 2e-5 * double{frame.size});
  }
}

TEST_CASE("what changes a framed tree keeps its frame, and hashes tell frames apart") {
  const Triangles triangles = soup(200, 370);
  const Bvh tree = framed_tree(triangles, {1, 1, 1});
  const Bvh merged = gnomon::merge_leaves(tree, gnomon::face_measures(tree, {1, 1, 1}));
  const Bvh moved = gnomon::optimise_reference(tree);
  gnomon::BuildOptions options;
  options.max_leaf_size = 4;
  for (const Bvh* const some : {&merged, &moved}) {
    REQUIRE(some->frame);
    REQUIRE(std::memcmp(&*some->frame, &*tree.frame, sizeof(BoxFrame)) == 0);
    if (const auto fault = gnomon::check_bvh(*some, triangles, options)) FAIL(fault->what);
  }
  Bvh other = tree;
  other.frame.reset();
  REQUIRE(tree_hash(other) != tree_hash(tree));
  const auto wide = gnomon::collapse_reference(tree, triangles);
  auto plain = wide;
  plain.frame.reset();
  REQUIRE(tree_hash(plain) != tree_hash(wide));
}

TEST_CASE("frames that no bound holds for are found, and what takes no framed trees says so") {
  const Triangles triangles = soup(50, 380);
  const Bvh tree = framed_tree(triangles, {1, 2, 3});
  const auto fault_with = [&](auto&& change) {
    Bvh broken = tree;
    change(*broken.frame);
    const auto fault = gnomon::check_bvh(broken, triangles, gnomon::test::leaves_of(1));
    return fault ? fault->what : std::string();
  };
  REQUIRE(fault_with([](BoxFrame&) {}).empty());
  REQUIRE_THAT(fault_with([](BoxFrame& frame) { frame.size *= 0.5F; }), Catch::Contains("size"));
  REQUIRE_THAT(fault_with([](BoxFrame& frame) { frame.size = NAN; }), Catch::Contains("size"));
  REQUIRE_THAT(fault_with([](BoxFrame& frame) { frame.rows[8] = 0.6F; }), Catch::Contains("beyond 1/2"));
  REQUIRE_THAT(fault_with([](BoxFrame& frame) { frame.rows[3] = frame.rows[4] = frame.rows[5] = 0.4F; }),
               Catch::Contains("7/8"));
  REQUIRE_THAT(fault_with([](BoxFrame& frame) { frame.rows[0] = frame.rows[1] = frame.rows[2] = 0.0F; }),
               Catch::Contains("half a rotation"));
  REQUIRE_THAT(fault_with([](BoxFrame& frame) { std::swap(frame.rows[3], frame.rows[4]); }),
               Catch::Contains("box"));
  auto wide = gnomon::collapse_reference(tree, triangles);
  REQUIRE_FALSE(gnomon::check_wide(wide, triangles));
  REQUIRE_THROWS_WITH(gnomon::compact_reference(wide), Catch::Contains("compact"));
  REQUIRE_THROWS_WITH(gnomon::refit_reference(wide, triangles), Catch::Contains("refitting"));
  Bvh copy = tree;
  REQUIRE_THROWS_WITH(gnomon::refit_reference(copy, triangles), Catch::Contains("refitting"));
  wide.frame->size *= 0.5F;
  REQUIRE_THAT(gnomon::check_wide(wide, triangles)->what, Catch::Contains("size"));
}
