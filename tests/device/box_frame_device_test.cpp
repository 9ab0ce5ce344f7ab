// Trees whose boxes stand in a frame, on the device: the bits of any other tree's hits, the reference's
// visits, and a clear word from what cannot trace them.
#include <catch2/catch.hpp>
#include <cstring>

#include "gnomon/base/error.h"
#include "gnomon/device/optimise_device.h"
#include "gnomon/device/refit_device.h"
#include "support/bundles.h"
#include "support/flavours.h"
#include "support/framed.h"

using gnomon::TraceFlavour;
using gnomon::test::context;
using gnomon::test::framed_tree;
using gnomon::test::Rays;
using gnomon::test::rays_at_corners;
using gnomon::test::Traced;
using gnomon::test::Triangles;

namespace {

Traced trace(const gnomon::DeviceBvh& tree, const Rays& rays, const gnomon::TraceOptions& options) {
  const gnomon::Tracer tracer(context(), tree, options);
  REQUIRE(tracer.flavour() == options.flavour);
  return {tracer.closest(rays), tracer.any(rays)};
}

// By the instructions of the device's compiler and without, sorted and not; counted, with the reference's
// visits. Returns how many rays hit.
std::size_t require_other_trees_answers(const Triangles& triangles, const gnomon::test::Direction& direction,
                                        const Rays& rays, const gnomon::BuildOptions& options) {
  const auto framed = gnomon::upload_bvh(context(), framed_tree(triangles, direction, options), triangles);
  const auto plain = gnomon::build_device(context(), triangles);
  const Traced expected = gnomon::test::trace(plain, rays, TraceFlavour::kThread);
  for (const bool portable : {false, true}) {
    gnomon::TraceOptions how;
    how.flavour = TraceFlavour::kPacket;
    how.portable = portable;
    if (gnomon::test::takes_packets()) gnomon::test::require_same_answers(expected, trace(framed, rays, how));
    how.flavour = TraceFlavour::kWide;
    gnomon::test::require_same_answers(expected, trace(framed, rays, how));
    how.sort_rays = true;
    gnomon::test::require_same_answers(expected, trace(framed, rays, how));
    how.sort_rays = false;
    how.counters = true;
    const Traced counted = trace(framed, rays, how);
    gnomon::test::require_same_answers(expected, counted);
    gnomon::test::require_reference_work(framed, triangles, rays, counted);
  }
  std::size_t met = 0;
  for (const std::uint32_t occluded : expected.any.occluded) met += occluded;
  return met;
}

}  // namespace

TEST_CASE("framed trees give other trees' bits on a small soup", "[portable][memcheck]") {
  const auto triangles = gnomon::test::soup(120, 420, 1.0F);
  const auto tree = framed_tree(triangles, {1, 1, 1});
  const Rays rays = rays_at_corners(triangles, *tree.frame, 60, 421, 2.0F);
  const auto plain = gnomon::build_device(context(), triangles);
  const auto framed = gnomon::upload_bvh(context(), tree, triangles);
  const Traced expected = gnomon::test::trace(plain, rays, TraceFlavour::kThread);
  gnomon::TraceOptions how;
  how.flavour = TraceFlavour::kWide;
  gnomon::test::require_same_answers(expected, trace(framed, rays, how));
}

TEST_CASE("framed trees give other trees' bits and the reference's visits, from near and far",
          "[unlimited]") {
  std::uint32_t seed = 430;
  for (const float offset : {0.0F, 1e4F}) {
    for (const std::uint32_t leaf : {1U, 8U, 40U}) {
      const auto triangles = gnomon::test::soup(800, seed++, 0.5F, offset);
      for (const auto& direction : gnomon::test::frame_directions()) {
        const auto frame = gnomon::frame_along(direction, triangles);
        CAPTURE(offset, leaf, direction[0]);
        Rays rays = rays_at_corners(triangles, frame, 600, seed++, 2.0F);
        const Rays far = rays_at_corners(triangles, frame, 200, seed++, 1e5F);
        rays.insert(rays.end(), far.begin(), far.end());
        const Rays awkward = gnomon::test::awkward_rays(200, seed++);
        rays.insert(rays.end(), awkward.begin(), awkward.end());
        REQUIRE(require_other_trees_answers(triangles, direction, rays, gnomon::test::lazy_leaves_of(leaf)) >
                100);
      }
    }
  }
}

TEST_CASE("framed trees give other trees' bits on every shape, huge and tiny, and from beyond all bounds",
          "[unlimited]") {
  for (const auto& shape : gnomon::test::wide_shapes()) {
    CAPTURE(shape.name);
    const auto frame = gnomon::frame_along({0.3, -0.9, 0.2}, shape.triangles);
    Rays rays = gnomon::test::awkward_rays(60, 440);
    if (!shape.triangles.empty()) {
      const Rays aimed = rays_at_corners(shape.triangles, frame, 100, 441, 3.0F);
      rays.insert(rays.end(), aimed.begin(), aimed.end());
    }
    for (const float huge : {1e30F, 3.4e38F})
      rays.push_back(gnomon::test::ray({huge, -huge, huge}, {-1, 1, -1}));
    require_other_trees_answers(shape.triangles, {0.3, -0.9, 0.2}, rays, shape.options);
  }
  for (const float scale : {1e12F, 1e-18F}) {
    CAPTURE(scale);
    const auto triangles = gnomon::test::scaled(gnomon::test::soup(300, 442), scale, 3.0F * scale);
    const auto frame = gnomon::frame_along({1, 1, 1}, triangles);
    REQUIRE(require_other_trees_answers(triangles, {1, 1, 1},
                                        rays_at_corners(triangles, frame, 500, 443, 2.0F), {}) > 100);
  }
}

TEST_CASE("packets of a sun's rays give other trees' bits in framed trees", "[unlimited][packets]") {
  for (const float offset : {0.0F, 1e3F}) {
    auto triangles = gnomon::test::scaled(gnomon::test::soup(1500, 445, 0.4F), 1.0F, offset);
    const auto floor = gnomon::test::scaled(gnomon::test::grid(10), 1.0F, offset);
    triangles.insert(triangles.end(), floor.begin(), floor.end());
    for (auto [name, rays] : gnomon::test::bundles(3)) {
      for (GnRay& ray : rays) {
        for (float& x : ray.origin) x += offset;
      }
      const gnomon::test::Direction along{double{rays[0].direction[0]}, double{rays[0].direction[1]},
                                          double{rays[0].direction[2]}};
      for (const auto& direction : {along, gnomon::test::Direction{1, 1, 1}}) {
        CAPTURE(name, offset, direction[0], direction[1], direction[2]);
        const std::size_t met = require_other_trees_answers(triangles, direction, rays, {});
        if (name != "camera") REQUIRE(met > 20);
      }
    }
  }
}

TEST_CASE("packets of a sun's rays at corners, where leaves' boxes end, lose none in framed trees",
          "[unlimited][packets]") {
  const std::array<float, 3> way{0.4F, -0.8F, 0.45F};
  gnomon::test::Random random(447);
  for (const float offset : {0.0F, 1e3F}) {
    const auto triangles = gnomon::test::soup(3000, 448, 0.3F, offset);
    Rays rays;
    while (rays.size() < 64 * 60) {
      // Those of a neighbourhood: a bundle must be narrow beside its scene.
      const GnTriangle& middle = triangles[random.below(3000)];
      std::vector<const float*> corners;
      for (const GnTriangle& t : triangles) {
        float apart = 0.0F;
        for (int k = 0; k < 3; ++k) apart = std::max(apart, std::fabs(t.v0[k] - middle.v0[k]));
        if (apart < 0.8F) corners.insert(corners.end(), {t.v0, t.v1, t.v2});
      }
      for (int i = 0; i < 64; ++i) {
        const float* corner = corners[random.below(static_cast<std::uint32_t>(corners.size()))];
        const float back = random.between(0.0F, 12.0F);
        std::array<float, 3> origin{};
        for (std::size_t k = 0; k < 3; ++k) origin[k] = corner[k] - back * way[k];
        rays.push_back(gnomon::test::ray(origin, way));
      }
    }
    CAPTURE(offset);
    REQUIRE(require_other_trees_answers(triangles, {0.4, -0.8, 0.45}, rays, gnomon::test::leaves_of(1)) >
            1000);
  }
}

TEST_CASE("a sun's rays are traced as packets in a frame along them", "[unlimited][packets]") {
  if (!gnomon::test::takes_packets()) return;
  const auto triangles = gnomon::test::soup(1500, 446, 0.4F);
  const Rays rays = gnomon::test::sun_rays(4, {0.4F, -0.8F, 0.45F}, 6.0F);
  const auto tree = gnomon::upload_bvh(context(), framed_tree(triangles, {0.4, -0.8, 0.45}, {}), triangles);
  const auto first_boxes = [&](TraceFlavour flavour) {
    gnomon::TraceOptions how;
    how.flavour = flavour;
    how.counters = true;
    std::vector<std::uint32_t> boxes;
    for (const GnRayCounters& counters : gnomon::Tracer(context(), tree, how).closest(rays).counters)
      boxes.push_back(counters.boxes);
    return boxes;
  };
  // What is tested for all of a packet counts as its first ray's; the other fifteen of its group have equal
  // counts.
  const auto packet = first_boxes(TraceFlavour::kPacket);
  std::size_t groups = 0;
  for (std::size_t i = 0; i + 16 <= packet.size(); i += 16) {
    bool equal = true;
    for (std::size_t k = 2; k < 16; ++k) equal &= packet[i + k] == packet[i + 1];
    groups += equal ? 1 : 0;
  }
  REQUIRE(groups == packet.size() / 16);
  REQUIRE(first_boxes(TraceFlavour::kWide) != packet);
}

TEST_CASE("frames go with a tree through the device, and are refused where they would be lost",
          "[unlimited]") {
  const auto triangles = gnomon::test::soup(200, 450);
  const auto host = framed_tree(triangles, {1, 2, 3});
  auto tree = gnomon::upload_bvh(context(), host, triangles);
  REQUIRE(tree_hash(download_bvh(context(), tree)) == tree_hash(host));
  const auto moved = download_bvh(context(), gnomon::optimise_device(context(), tree));
  REQUIRE(moved.frame);
  REQUIRE(tree_hash(moved) == tree_hash(gnomon::optimise_reference(host)));
  auto wide = collapse_device(context(), tree);
  REQUIRE(tree_hash(download_wide(context(), wide)) ==
          tree_hash(gnomon::collapse_reference(host, triangles)));
  gnomon::TraceOptions how;
  for (const auto flavour : {TraceFlavour::kThread, TraceFlavour::kCompact}) {
    how.flavour = flavour;
    CAPTURE(to_string(flavour));
    REQUIRE_THROWS_WITH(gnomon::Tracer(context(), tree, how),
                        Catch::Contains(to_string(flavour)) && Catch::Contains("frame"));
    REQUIRE_THROWS_WITH(gnomon::Tracer(context(), wide, how),
                        Catch::Contains("frame") || Catch::Contains("thread"));
  }
  how = {};
  const bool packets = context().device().is_cpu && context().device().loop_limit == 0;
  REQUIRE(gnomon::Tracer(context(), tree, how).flavour() ==
          (packets ? TraceFlavour::kPacket : TraceFlavour::kWide));
  how.step_limit = 100;
  REQUIRE_THROWS_WITH(gnomon::Tracer(context(), tree, how), Catch::Contains("step_limit"));
  REQUIRE_THROWS_WITH(gnomon::refit_device(context(), tree, triangles), Catch::Contains("refitting"));
  REQUIRE_THROWS_WITH(gnomon::refit_device(context(), wide, triangles), Catch::Contains("refitting"));
  REQUIRE_THROWS_WITH(gnomon::compact_device(context(), wide), Catch::Contains("compact"));
}
