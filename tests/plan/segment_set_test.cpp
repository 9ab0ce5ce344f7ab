// Segments against boxes, many at a time: the same answers as one by one.
#include "gnomon/plan/segment_set.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "gnomon/plan/met_part.h"
#include "gnomon/shared/ray_math.h"
#include "gnomon/tree/build_reference.h"
#include "support/bundles.h"
#include "support/shapes.h"

using gnomon::Ray;
using gnomon::SegmentMask;
using gnomon::SegmentSet;

namespace {

GnBox box(float x, float y, float z, float size) {
  return {{x, y, z}, {x + size, y + size, z + size}};
}

bool meets(const Ray& ray, const GnBox& b) {
  const GnRayFrame frame = gn_ray_frame(&ray);
  return gn_box_entry(&frame, b.lo, b.hi, gn_finite_tmin(ray.tmin), gn_slab_limit(gn_finite_tmax(ray.tmax))) <
         GN_INFINITY;
}

// Rays of all sorts: along axes, in faces' planes, backwards, short ones, endless ones.
std::vector<Ray> awkward_rays(std::uint32_t count) {
  std::vector<Ray> rays = gnomon::test::random_rays(count, 81);
  for (std::uint32_t i = 0; i < count; ++i) {
    Ray& ray = rays[i];
    if (i % 5 == 1) ray.direction[i % 3] = 0.0F;
    if (i % 5 == 2) ray.direction[i % 3] = -0.0F;
    if (i % 7 == 3) ray.origin[i % 3] = 2.0F;
    if (i % 11 == 4) ray.direction[i % 3] = 1e-42F;
    if (i % 3 == 0) ray.tmax = 0.25F * static_cast<float>(i % 13);
    if (i % 13 == 5) ray.tmin = -INFINITY;
  }
  return rays;
}

}  // namespace

TEST_CASE("a mask of segments is what each of them says") {
  for (const std::uint32_t count : {1U, 6U, 7U, 63U, 64U, 65U, 200U, 512U}) {
    SegmentSet set(awkward_rays(count), box(0, 0, 0, 10));
    REQUIRE(set.size() <= count);
    REQUIRE(set.all().count() == set.size());
    std::uint32_t met = 0;
    for (std::uint32_t i = 0; i < 300; ++i) {
      const auto at = [&](std::uint32_t k) { return static_cast<float>((i * k) % 17) * 0.5F; };
      // Boxes whose faces rays lie in, flat ones among them.
      const GnBox b = box(at(3), at(5), at(7), i % 4 == 0 ? 0.0F : 0.5F * static_cast<float>(i % 9));
      CAPTURE(count, i);
      SegmentMask within;
      for (std::size_t w = 0; w < SegmentMask::kWords; ++w)
        within.words[w] = set.all().words[w] & (i % 3 == 0 ? 0x00010000f0000101U : ~std::uint64_t{0});
      SegmentMask known;
      set.meet(b, within, known);
      for (std::size_t r = 0; r < set.size(); ++r) {
        const bool open = (within.words[r / 64] >> (r % 64) & 1U) != 0;
        REQUIRE((known.words[r / 64] >> (r % 64) & 1U) == (open && meets(set.rays()[r], b) ? 1U : 0U));
      }
      met += known.count();
    }
    if (count > 60) REQUIRE(met > 100);
  }
}

TEST_CASE("what is known to meet a box is not tested again") {
  SegmentSet set(gnomon::test::random_rays(128, 82), box(0, 0, 0, 10));
  SegmentMask known = set.all();
  set.meet(box(20, 20, 20, 1), set.all(), known);
  REQUIRE(known.words == set.all().words);
  REQUIRE(set.wide_tests() + set.single_tests() == 0);
}

TEST_CASE("the part of a tree that segments meet, put back, is the tree") {
  for (const auto& [name, triangles] : gnomon::test::awkward_inputs()) {
    if (triangles.empty()) continue;
    for (const std::uint32_t most : {1U, 4U}) {
      CAPTURE(name, most);
      gnomon::BuildOptions options;
      options.max_leaf_size = most;
      const gnomon::Bvh bvh = gnomon::build_reference(triangles, options);
      for (const std::uint32_t least : {1U, 3U, 1000U}) {
        SegmentSet set(gnomon::test::random_rays(100, 83), gnomon::box_of(bvh.nodes[0]));
        const gnomon::MetPart part = gnomon::met_part(bvh, set, least);
        REQUIRE(part.met.size() == part.top.nodes.size());
        const gnomon::Grafted whole = gnomon::graft(bvh, part, part.top);
        REQUIRE(gnomon::tree_hash(whole.bvh) == gnomon::tree_hash(bvh));
        for (std::size_t i = 0; i < part.top.nodes.size(); ++i) {
          const gnomon::Node& node = part.top.nodes[i];
          REQUIRE((node.count > 0 || part.met[i].count() >= least));
          REQUIRE(std::equal(node.lo, node.lo + 3, whole.bvh.nodes[whole.numbers[i]].lo));
        }
      }
    }
  }
}
