#include "reproduce_rows.h"

#include "gnomon/measure/prediction.h"
#include "version.h"

namespace gnomon::app {
namespace {

Json json_of(const MeanCost& cost) {
  return {{"mean", cost.mean}, {"standard_error", cost.standard_error}};
}

Json json_of(const Work& work) {
  return {{"boxes", work.boxes}, {"triangles", work.triangles}};
}

Json predictions_of(const TreeRun& run) {
  const auto one = [&](double predicted) {
    return Json{{"cost", predicted}, {"error", prediction_error(run.local.mean, predicted)}};
  };
  return {{"pah_published", one(run.predicted_published)},
          {"pah_matching", one(run.predicted_matching)},
          {"sah", one(run.predicted_surface)}};
}

Json overlaps_of(const std::array<double, 5>& overlap) {
  return {{"4", overlap[0]}, {"7", overlap[1]}, {"10", overlap[2]}, {"15", overlap[3]}, {"all", overlap[4]}};
}

// Of the three axes.
Json json_of(const std::array<double, 3>& shares) {
  return {{"x", shares[0]}, {"y", shares[1]}, {"z", shares[2]}};
}

Json json_of(const PublishedRow& row) {
  return {{"flag", row.flag},
          {"local", row.local_cost},
          {"total", row.total_cost},
          {"global", row.global_cost},
          {"hit_share", row.hit_share},
          {"pah", row.predicted_pah},
          {"sah", row.predicted_sah},
          {"max_level", row.max_level},
          {"planes_tried", row.planes_tried},
          {"overlap",
           overlaps_of({row.overlap_4, row.overlap_7, row.overlap_10, row.overlap_15, row.overlap_all})}};
}

Json json_of(const Duel& duel) {
  return {{"builder", duel.builder}, {"against", duel.against}, {"geomean", duel.geomean},
          {"worst", duel.worst},     {"wins", duel.wins},       {"count", duel.count}};
}

}  // namespace

Json row_start(const SetUp& set_up, const ReproduceScene& scene, const ReproduceOptions& options) {
  return {{"schema", 1},
          {"bench", "reproduce"},
          {"commit", commit()},
          {"scene", set_up.scene},
          {"scene_hash", scene.hash},
          {"scene_triangles", scene.scene.triangles.size()},
          {"area", set_up.area_name},
          {"orientation", set_up.orientation},
          {"seed", options.seed}};
}

Json tree_row(const Json& start, const TreeRun& run, const PublishedRow* published,
              const ReproduceOptions& options) {
  Json row = start;
  row["task"] = "cost";
  row["variant"] = run.builder;
  row["heuristics"] = run.heuristics;
  row["members"] = run.members;
  row["rays"] = to_string(run.rays);
  row["ray_count"] = options.rays;
  row["triangles"] = run.triangles;
  row["nodes"] = run.stats.nodes;
  row["leaves"] = run.stats.leaves;
  row["max_depth"] = run.stats.max_depth;
  row["largest_leaf"] = run.stats.largest_leaf;
  row["build_ms"] = run.build_ms;
  row["planes_tried"] = run.planes_tried;
  row["axis_share"] = json_of(run.axis_share);
  row["axis_fallback_share"] = json_of(run.axis_fallback_share);
  row["local"] = json_of(run.local);
  row["predicted"] = predictions_of(run);
  row["closest"] = json_of(run.closest);
  row["any"] = json_of(run.any);
  row["local_hit_share"] = run.local_hit_share;
  row["fallback_share"] = 1.0 - run.local_hit_share;
  row["hit_share"] = run.global_hit_share;
  row["global"] = json_of(run.global);
  row["miss_cost"] = run.miss_cost;
  row["total"] = json_of(run.total);
  row["total_over_global"] = run.global.mean > 0.0 ? Json(run.total.mean / run.global.mean) : Json(nullptr);
  row["break_even_hit_share"] = run.break_even_hit_share ? Json(*run.break_even_hit_share) : Json(nullptr);
  row["overlap"] = overlaps_of(run.overlap);
  row["published"] = published == nullptr ? Json(nullptr) : json_of(*published);
  row["ratio"] = published == nullptr ? Json(nullptr) : Json(run.local.mean / published->local_cost);
  return row;
}

Json prediction_row(const Json& start, const PredictionRun& run, const ReproduceOptions& options) {
  Json row = start;
  row["task"] = "prediction";
  row["variant"] = "PAH3";
  row["rays"] = to_string(run.rays);
  row["ray_count"] = options.prediction_rays;
  row["measure"] = run.surface ? "surface_area" : to_string(run.measure);
  row["real"] = json_of(run.real);
  row["predicted"] = run.predicted;
  row["error"] = prediction_error(run.real.mean, run.predicted);
  return row;
}

Json to_json(const ReproduceSummary& summary) {
  Json out;
  out["compared"] = summary.compared(false);
  out["median_deviation"] = summary.median_deviation(false);
  out["rms_standard_errors"] = summary.rms_errors_off();
  out["sah_estimates_within"] = {{"0.00001", summary.estimates_within(1e-5)},
                                 {"0.001", summary.estimates_within(1e-3)},
                                 {"0.01", summary.estimates_within(1e-2)}};
  out["compared_flagged"] = summary.compared(true);
  out["median_deviation_flagged"] = summary.median_deviation(true);
  out["large_deviations"] = Json::array();
  for (const Comparison& row : summary.large_deviations()) {
    out["large_deviations"].push_back({{"set_up", row.set_up},
                                       {"variant", row.variant},
                                       {"flag", row.flag},
                                       {"published", row.published},
                                       {"measured", row.measured},
                                       {"ratio", row.ratio()}});
  }
  out["variants"] = Json::array();
  for (const Duel& duel : summary.variant_duels()) out["variants"].push_back(json_of(duel));
  out["three_axes"] = json_of(summary.three_axes_duel());
  out["three_axes_by_rays"] = Json::array();
  for (const Duel& duel : summary.three_axes_duels_by_measure()) {
    Json row = json_of(duel);
    row["rays"] = to_string(duel.rays);
    out["three_axes_by_rays"].push_back(row);
  }
  out["prediction_errors"] = Json::array();
  for (const PredictionErrors& errors : summary.prediction_errors()) {
    out["prediction_errors"].push_back(
        {{"rays", to_string(errors.rays)},
         {"measure", errors.surface ? "surface_area" : to_string(errors.measure)},
         {"mean", errors.mean},
         {"median", errors.median},
         {"max", errors.max},
         {"noise", errors.noise},
         {"max_beyond_noise", errors.max_beyond_noise},
         {"count", errors.count}});
  }
  return out;
}

}  // namespace gnomon::app
