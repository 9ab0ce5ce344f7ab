// When a local tree's answer is final, and that the thesis' rule gives wrong ones.
#include <catch2/catch.hpp>

#include "gnomon/scene/generators.h"
#include "gnomon/shared/area_math.h"
#include "support/forest_rig.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

}  // namespace

TEST_CASE("a ray that starts in its window is served by the local tree") {
  const std::vector<GnTriangle> triangles = soup(300, 145, 1.0F);
  const std::vector<InfluenceArea> areas = areas_of({{5, 5, 5}, 5.0}, {0.3, -0.2, 1}, 1.0);
  for (const InfluenceArea& area : areas) {
    const Rig rig(triangles, local_trees_of({area}));
    const std::vector<GnRay> rays = rays_of(area, 500, 146);
    const Tally tally = rig.require_same_answers(rays);
    REQUIRE(tally.outcomes[GN_OUTCOME_GLOBAL] == 0);
  }
  // A camera: the eye of a view that begins right in front of it.
  PointView view;
  view.eye = {5, 5, -8};
  view.near_distance = 1e-6;
  view.far_distance = 25.0;
  const InfluenceArea camera = InfluenceArea::point(view);
  const Rig rig(triangles, local_trees_of({camera}));
  const std::vector<GnRay> rays =
      area_rays(camera, RayMeasure::kNearPlane, 500, 147, {RayStart::kEye, false});
  REQUIRE(rig.require_same_answers(rays).outcomes[GN_OUTCOME_GLOBAL] == 0);
}

TEST_CASE("a ray that ends where it leaves, before or behind, is asked the right trees") {
  // A wall in the region and one behind it.
  const std::vector<GnTriangle> triangles = {triangle({-9, -9, 0.5F}, {9, -9, 0.5F}, {0, 18, 0.5F}),
                                             triangle({-9, -9, 3}, {9, -9, 3}, {0, 18, 3})};
  const InfluenceArea area = InfluenceArea::plane(PlaneWindow{});  // z from 0 to 1
  const Rig rig(triangles, local_trees_of({area}));
  const GnArea& shared = rig.forest().shared_areas.front();
  const GnRay behind_wall = ray({0, 0, 0.75F}, {0, 0, 1});
  const GnRayStart start = gn_ray_start(&behind_wall);
  const float exit = gn_area_exit(&shared, &start);
  REQUIRE(exit == Approx(0.25F).epsilon(1e-3));
  const auto outcome_of = [&](const GnRay& r) {
    const Tally tally = rig.require_same_answers({r});
    return std::find(tally.outcomes, tally.outcomes + 4, 1) - tally.outcomes;
  };
  const auto with_end = [&](float tmax) { return ray({0, 0, 0.75F}, {0, 0, 1}, 0, tmax); };
  REQUIRE(outcome_of(with_end(0.1F)) == GN_OUTCOME_INSIDE);
  REQUIRE(outcome_of(with_end(exit)) == GN_OUTCOME_INSIDE);
  REQUIRE(outcome_of(with_end(std::nextafter(exit, kInf))) == GN_OUTCOME_FALLBACK);
  REQUIRE(outcome_of(with_end(2.25F)) == GN_OUTCOME_FALLBACK);
  REQUIRE(outcome_of(with_end(-1.0F)) == GN_OUTCOME_INSIDE);
  REQUIRE(outcome_of(ray({0, 0, 0.25F}, {0, 0, 1})) == GN_OUTCOME_LOCAL);
  REQUIRE(outcome_of(ray({0, 0, -4}, {0, 0, 1}, 4.25F)) == GN_OUTCOME_LOCAL);
  REQUIRE(outcome_of(ray({0, 0, -4}, {0, 0, 1}, 5.5F)) == GN_OUTCOME_GLOBAL);
  REQUIRE(outcome_of(ray({0, 0, 0.25F}, {0, 1, 1})) == GN_OUTCOME_GLOBAL);  // not affine
}

TEST_CASE("triangles between the region and the grown one belong to the local tree") {
  const InfluenceArea area = InfluenceArea::plane(PlaneWindow{});  // z from 0 to 1
  const float beyond = 1.0F + 0x1p-18F;
  const std::vector<GnTriangle> triangles = {
      triangle({-9, -9, 3}, {9, -9, 3}, {0, 18, 3}),
      triangle({-0.1F, -0.1F, beyond}, {0.1F, -0.1F, beyond}, {0, 0.2F, beyond})};
  const Rig rig(triangles, local_trees_of({area}));
  REQUIRE(rig.forest().local[0].triangle_count == 1);
  const Tally tally = rig.require_same_answers({ray({0, 0, 0.5F}, {0, 0, 1})});
  REQUIRE(tally.outcomes[GN_OUTCOME_LOCAL] == 1);
}

namespace {

// Wrong hits of the published rule over areas of a scene, for each rule of membership; the exit rule has
// none.
struct WrongHits {
  std::uint64_t rays = 0;
  std::uint64_t exact = 0;
  std::uint64_t vertices = 0;
};

WrongHits wrong_hits_of(const Scene& scene, double size) {
  WrongHits sum;
  for (const Vec3d& direction : {Vec3d{0, 0, 1}, Vec3d{-0.55, -0.9, 1}}) {
    for (const InfluenceArea& area : areas_of(extent_of(scene.triangles), direction, size)) {
      const std::vector<GnRay> rays = rays_of(area, 2000, 148);
      std::vector<LocalTree> trees = local_trees_of({area});
      const Rig rig(scene.triangles, trees);
      static_cast<void>(rig.require_same_answers(rays));
      sum.rays += rays.size();
      sum.exact += rig.by_the_published_rule(rays).wrong_hits;
      trees[0].membership = Membership::kVertices;
      sum.vertices += Rig(scene.triangles, trees).by_the_published_rule(rays).wrong_hits;
    }
  }
  return sum;
}

}  // namespace

TEST_CASE(
    "the published rule gives wrong hits where regions are cut, and by vertices anywhere; the exit rule "
    "none",
    "[large]") {
  for (const auto& [name, count] : {std::pair{"random1000", 1000}, {"cottage", 7000}}) {
    const Scene scene = generate_scene(name, static_cast<std::uint64_t>(count), 1);
    const WrongHits spanning = wrong_hits_of(scene, 1.0);
    const WrongHits cut = wrong_hits_of(scene, 0.5);  // regions end in the scene's middle
    CAPTURE(name, spanning.rays, spanning.exact, spanning.vertices, cut.rays, cut.exact, cut.vertices);
    REQUIRE(cut.exact > 0);
    REQUIRE(cut.vertices > 0);
    // A region around the whole scene hides nothing, if only its tree holds all of it.
    REQUIRE(spanning.exact == 0);
    if (name == std::string("cottage")) REQUIRE(spanning.vertices > 0);
  }
}

TEST_CASE("triangles that stick out and hide others: the published rule is wrong, the exit rule is not",
          "[portable]") {
  // A long roof slants down out of the region; the ray meets a screen outside before it meets the roof.
  const std::vector<GnTriangle> triangles = {triangle({-0.9F, -4, 0.9F}, {10, -4, 0}, {-0.9F, 20, 0.9F}),
                                             triangle({2, -4, 0}, {2, 8, 0}, {2, -4, 30})};
  const InfluenceArea area = InfluenceArea::plane(PlaneWindow{});
  const Rig rig(triangles, local_trees_of({area}, 1.0));
  REQUIRE(rig.forest().local[0].triangle_count == 1);
  const std::vector<GnRay> rays = {ray({0.5F, 0, 0.3F}, {1, 0, 0})};
  static_cast<void>(rig.require_same_answers(rays));
  REQUIRE(rig.by_the_published_rule(rays).wrong_hits == 1);
  REQUIRE(rig.by_the_published_rule(rays).wrong_any == 0);
}
