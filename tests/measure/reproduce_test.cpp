// A set-up run from its triangles to its figures, and the figures against one another.
#include "gnomon/measure/reproduce.h"

#include <catch2/catch.hpp>

#include "gnomon/areas/area_rays.h"
#include "gnomon/areas/membership.h"
#include "gnomon/measure/overlap.h"
#include "gnomon/measure/prediction.h"
#include "gnomon/scene/generators.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/trace_reference.h"
#include "support/shapes.h"

using gnomon::RayMeasure;

namespace {

gnomon::Bvh build(std::span<const GnTriangle> triangles, const gnomon::BuildOptions& options) {
  return gnomon::build_reference(triangles, options);
}

gnomon::SetUp plane_set_up(std::vector<std::string> variants) {
  gnomon::PlaneWindow window;
  window.point = {5, 5, -4};
  window.direction = {0.3, 0.1, 1};
  window.half_width = 5;
  window.half_height = 4;
  window.depth = 20;
  return {"Random1000", "plane", "parallel", std::move(variants), gnomon::InfluenceArea::plane(window)};
}

gnomon::SetUp point_set_up(std::vector<std::string> variants) {
  gnomon::PointView view;
  view.eye = {5, 5, -4};
  view.direction = {0, 0, 1};
  view.fov_x = 1.4;
  view.fov_y = 0.9;
  view.near_distance = 1;
  view.far_distance = 20;
  return {"Random1000", "point", "parallel", std::move(variants), gnomon::InfluenceArea::point(view)};
}

const std::vector<std::string> kAll = {"Standard", "Longest", "Facing", "Full"};

gnomon::ReproduceOptions few() {
  gnomon::ReproduceOptions options;
  options.rays = 400;
  options.prediction_rays = 600;
  options.seed = 5;
  return options;
}

std::vector<std::string> names_of(const gnomon::SetUpReport& report) {
  std::vector<std::string> names;
  for (const auto& run : report.trees) names.push_back(run.builder);
  return names;
}

std::vector<GnTriangle> picked(const std::vector<GnTriangle>& all, const std::vector<std::uint32_t>& which) {
  std::vector<GnTriangle> out;
  for (const auto i : which) out.push_back(all[i]);
  return out;
}

}  // namespace

TEST_CASE("every variant runs once, ours for every measure of rays") {
  const auto scene = gnomon::prepare_scene(gnomon::generate_scene("random1000", 1000, 1), build);
  using Names = std::vector<std::string>;
  REQUIRE(names_of(run_set_up(plane_set_up(kAll), scene, few(), build)) ==
          Names{"Full", "Facing", "Standard", "Longest", "SAH3", "PAH3"});
  const auto point = run_set_up(point_set_up(kAll), scene, few(), build);
  REQUIRE(names_of(point) == Names{"Full", "Facing", "Standard", "Longest", "TrueLongest", "SAH3", "PAH3",
                                   "SAH3", "PAH3", "SAH3", "PAH3"});
  REQUIRE(point.trees[0].rays == RayMeasure::kYawPitch);
  REQUIRE(point.trees[5].rays == RayMeasure::kYawPitch);
  REQUIRE(point.trees[7].rays == RayMeasure::kNearPlane);
  REQUIRE(point.trees[9].rays == RayMeasure::kSolidAngle);
  REQUIRE(point.predictions.size() == 3 * 4);
  // On yaw and pitch's tree: by its own measure, by the near plane as published, by solid angle, by surface.
  REQUIRE(point.predictions[0].predicted == Approx(point.trees[6].predicted_matching));
  REQUIRE(point.predictions[1].measure == RayMeasure::kNearPlane);
  REQUIRE(point.predictions[1].predicted == Approx(point.trees[6].predicted_published));
  REQUIRE(point.predictions[1].predicted != Approx(point.predictions[0].predicted));
  REQUIRE(point.predictions[2].predicted != Approx(point.predictions[0].predicted));
  REQUIRE(point.predictions[3].predicted == Approx(point.trees[6].predicted_surface));
  // A set-up with another window for one variant repeats nothing else.
  const auto other = run_set_up(plane_set_up({"Longest"}), scene, few(), build);
  REQUIRE(names_of(other) == Names{"Longest"});
  REQUIRE(other.predictions.empty());
  REQUIRE_THROWS_AS(run_set_up(plane_set_up({"Shortest"}), scene, few(), build), gnomon::Error);
  auto elsewhere = plane_set_up(kAll);
  elsewhere.area = gnomon::InfluenceArea::plane({});
  gnomon::ReproduceScene far{{}, "", {}};
  far.scene.triangles = {gnomon::test::triangle({900, 0, 0}, {901, 0, 0}, {900, 1, 0})};
  REQUIRE_THROWS_AS(run_set_up(elsewhere, far, few(), build), gnomon::Error);
}

TEST_CASE("a run's figures are those of its tree, triangles and rays") {
  const auto scene = gnomon::prepare_scene(gnomon::generate_scene("random1000", 1000, 1), build);
  const auto& all = scene.scene.triangles;
  for (const auto& set_up : {plane_set_up(kAll), point_set_up(kAll)}) {
    const auto& area = set_up.area;
    const bool plane = area.kind() == gnomon::AreaKind::kPlane;
    const RayMeasure measure = plane ? RayMeasure::kParallel : RayMeasure::kYawPitch;
    const RayMeasure flat = plane ? RayMeasure::kParallel : RayMeasure::kNearPlane;
    const auto report = run_set_up(set_up, scene, few(), build);
    const auto rays = gnomon::area_rays(area, measure, 400, 5);
    const auto options = gnomon::published_options(gnomon::PublishedVariant::kFacing, area);
    const auto triangles = picked(all, gnomon::published_members(area, all));
    gnomon::SplitTally tally;
    const auto tree = gnomon::build_reference(triangles, options, &tally);
    const auto hits = gnomon::trace_reference(tree, triangles, rays, false);
    const auto any = gnomon::trace_reference(tree, triangles, rays, true);
    const auto of_all = gnomon::trace_reference(scene.global, all, rays, false);
    double local = 0, global = 0, total = 0, missed = 0, met = 0, met_global = 0;
    double boxes = 0, tests = 0, any_boxes = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto ray = gnomon::to_ray3d(rays[i]);
      const double here = gnomon::all_pierced_cost(tree, ray);
      const double there = gnomon::all_pierced_cost(scene.global, ray);
      const bool hit = hits.hits[i].primitive != GN_NONE;
      local += here / 400;
      global += there / 400;
      total += (here + (hit ? 0.0 : there)) / 400;
      missed += hit ? 0.0 : there;
      met += hit ? 1.0 : 0.0;
      met_global += of_all.hits[i].primitive != GN_NONE ? 1.0 / 400 : 0.0;
      boxes += hits.counters[i].boxes / 400.0;
      tests += hits.counters[i].triangles / 400.0;
      any_boxes += any.counters[i].boxes / 400.0;
    }
    const gnomon::TreeRun& run = report.trees[1];
    CAPTURE(set_up.label());
    REQUIRE(run.builder == "Facing");
    REQUIRE(run.heuristics == "SAH+SPFH@0.4");
    REQUIRE(run.members == "octree-vertices");
    REQUIRE(run.triangles == triangles.size());
    REQUIRE(run.stats.nodes == tree.nodes.size());
    REQUIRE(run.local.mean == Approx(local));
    REQUIRE(run.global.mean == Approx(global));
    REQUIRE(run.total.mean == Approx(total));
    REQUIRE(met > 20);
    REQUIRE(met < 390);
    REQUIRE(run.miss_cost == Approx(missed / (400 - met)));
    REQUIRE(run.miss_cost != Approx(global));
    REQUIRE(run.local_hit_share == Approx(met / 400));
    REQUIRE(run.global_hit_share == Approx(met_global));
    REQUIRE(run.closest.boxes == Approx(boxes));
    REQUIRE(run.closest.triangles == Approx(tests));
    REQUIRE(run.any.boxes == Approx(any_boxes));
    REQUIRE(any_boxes < boxes);
    // At the break-even share h, local + (1 - h) miss = global.
    REQUIRE(run.break_even_hit_share.has_value());
    REQUIRE(local + (1.0 - *run.break_even_hit_share) * run.miss_cost == Approx(global));
    REQUIRE(run.predicted_published == Approx(gnomon::predicted_cost(tree, area, flat)));
    REQUIRE(run.predicted_matching == Approx(gnomon::predicted_cost(tree, area, measure)));
    REQUIRE(run.predicted_surface == Approx(gnomon::predicted_surface_cost(tree)));
    const std::array<std::uint32_t, 5> levels{4, 7, 10, 15, gnomon::kAllLevels};
    for (std::size_t i = 0; i < 5; ++i)
      REQUIRE(run.overlap[i] == Approx(gnomon::sibling_overlap(tree, area, flat, levels[i])));
    REQUIRE(run.overlap[0] != run.overlap[4]);
    const auto inner = static_cast<double>(tally.inner_nodes);
    REQUIRE(run.planes_tried == Approx(static_cast<double>(tally.axes_tried) / inner));
    for (std::size_t k = 0; k < 3; ++k) {
      REQUIRE(run.axis_share[k] == Approx(static_cast<double>(tally.split_on[k]) / inner));
      REQUIRE(run.axis_fallback_share[k] == Approx(static_cast<double>(tally.fallback_on[k]) / inner));
    }
  }
}

TEST_CASE("three-axis trees hold what touches the area, and predictions are of rays of their own") {
  auto source = gnomon::generate_scene("random1000", 1000, 1);
  const auto whole = gnomon::prepare_scene(source, build);
  // Triangles without area, in the midst of the others: they belong to the thesis' trees, not to ours.
  for (int i = 0; i < 30; ++i) {
    source.triangles.push_back(source.triangles[static_cast<std::size_t>(i)]);
    std::copy_n(source.triangles.back().v0, 3, source.triangles.back().v1);
  }
  const auto with_flat = gnomon::prepare_scene(source, build);
  const auto set_up = plane_set_up(kAll);
  const auto clean = run_set_up(set_up, whole, few(), build);
  const auto flat = run_set_up(set_up, with_flat, few(), build);
  REQUIRE(flat.trees[0].triangles > clean.trees[0].triangles);
  REQUIRE(flat.trees[0].local_hit_share == clean.trees[0].local_hit_share);
  for (const std::size_t i : {4U, 5U}) {
    REQUIRE(clean.trees[i].members == "exact");
    REQUIRE(clean.trees[i].triangles == gnomon::members(set_up.area, whole.scene.triangles).size());
    REQUIRE(flat.trees[i].triangles == clean.trees[i].triangles);
    REQUIRE(flat.trees[i].local.mean == clean.trees[i].local.mean);
  }
  const auto& predicted = clean.predictions;
  REQUIRE(predicted.size() == 2);
  REQUIRE_FALSE(predicted[0].surface);
  REQUIRE(predicted[1].surface);
  REQUIRE(predicted[0].predicted == Approx(clean.trees[5].predicted_matching));
  REQUIRE(predicted[1].predicted == Approx(clean.trees[5].predicted_surface));
  // Other rays than the costs', as many as asked for.
  REQUIRE(predicted[0].real.mean != clean.trees[5].local.mean);
  REQUIRE(predicted[0].real.standard_error ==
          Approx(clean.trees[5].local.standard_error * std::sqrt(400.0 / 600.0)).epsilon(0.15));
  const auto alone = gnomon::check_predictions(set_up.area, whole, few(), build);
  REQUIRE(alone.size() == 2);
  REQUIRE(alone[0].real.mean == predicted[0].real.mean);
  REQUIRE(gnomon::check_predictions(set_up.area, with_flat, few(), build)[0].real.mean ==
          predicted[0].real.mean);
}

TEST_CASE("the global tree is the thesis' own") {
  const auto scene = gnomon::prepare_scene(gnomon::generate_scene("random1000", 1000, 1), build);
  REQUIRE(gnomon::tree_hash(scene.global) ==
          gnomon::tree_hash(build(scene.scene.triangles, gnomon::published_global_options())));
  REQUIRE(scene.hash == gnomon::scene_hash(scene.scene));
}
