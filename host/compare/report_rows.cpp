#include "gnomon/compare/report_rows.h"

#include <algorithm>

#include "gnomon/base/stats.h"
#include "gnomon/compare/analysis.h"
#include "gnomon/compare/answer_counts.h"
#include "gnomon/compare/method.h"

namespace gnomon::compare {
namespace {

void put_rounds(Json& row, const Rounds& rounds, double items) {
  row["wall_s"] = rounds.wall_s;
  row["cpu_s"] = rounds.cpu_s;
  if (rounds.wall_s.empty() || items <= 0.0) return;
  row["real_time"] = 1e9 * spread_of(rounds.wall_s).median / items;
  row["cpu_time"] = 1e9 * spread_of(rounds.cpu_s).median / items;
  row["time_unit"] = "ns";
}

Rounds get_rounds(const Json& row) {
  return {row.at("wall_s").get<std::vector<double>>(), row.at("cpu_s").get<std::vector<double>>()};
}

Json spread_json(const Spread& s) {
  if (s.count == 0) return nullptr;
  return {{"median", s.median}, {"min", s.min}, {"max", s.max}, {"n", s.count}};
}

class Rows {
 public:
  Rows(const Report& report, const DeviceReport& device) : report_(report), device_(device) {}

  [[nodiscard]] Json all() const {
    Json rows = Json::array();
    for (const BuildRow& row : device_.builds) rows.push_back(build(row));
    for (const TraceRow& row : device_.traces) rows.push_back(trace(row));
    for (const AccuracyRow& row : device_.accuracies) rows.push_back(accuracy(row));
    for (const PredictionRow& row : device_.predictions) rows.push_back(prediction(row));
    for (const DecisionRow& row : device_.decisions) rows.push_back(decision(row));
    for (const SizeRow& row : device_.sizes) rows.push_back(size(row));
    for (const AreaRow& row : device_.areas) rows.push_back(area(row));
    for (const AcrossRow& row : device_.across) rows.push_back(across(row));
    for (const LeftOut& row : device_.left_out) rows.push_back(left_out(row));
    return rows;
  }

 private:
  [[nodiscard]] Json start(const std::string& task, const std::string& method,
                           const std::string& kind) const {
    return {{"schema", kSchema},
            {"bench", "compare"},
            {"task", task},
            {"name", task + "/" + report_.scene + "/" + kind + (kind.empty() ? "" : "/") + method},
            {"commit", report_.commit},
            {"device", device_.name},
            {"driver", device_.driver},
            {"scene", report_.scene},
            {"scene_hash", report_.scene_hash},
            {"triangles", report_.triangles},
            {"clock", report_.clock},
            {"method", text_or_null(method)}};
  }

  [[nodiscard]] Json build(const BuildRow& r) const {
    Json row = start("build", r.method, "");
    put_rounds(row, r.rounds, static_cast<double>(report_.triangles));
    row["ratio"] = spread_json(build_gain(device_, kBaseline, r.method, report_.clock));
    row["bytes"] = r.bytes;
    row["scratch_bytes"] = r.scratch_bytes;
    row["tree_hash"] = text_or_null(r.tree_hash);
    row["nodes"] = r.nodes;
    row["max_depth"] = r.max_depth;
    row["sah_cost"] = r.sah_cost;
    row["flavour"] = r.flavour;
    return row;
  }

  [[nodiscard]] Json trace(const TraceRow& r) const {
    Json row = start("trace", r.method, r.kind);
    row["rays"] = r.kind;
    row["query"] = r.any_hit ? "any" : "closest";
    row["ray_count"] = r.rays;
    row["hits"] = r.hits;
    row["passes"] = r.passes;
    put_rounds(row, r.rounds, static_cast<double>(r.rays));
    row["ratio"] = spread_json(trace_gain(device_, kBaseline, r.method, r.kind, report_.clock));
    row["boxes_per_ray"] = r.counted ? Json(r.boxes_per_ray) : Json(nullptr);
    row["triangles_per_ray"] = r.counted ? Json(r.triangles_per_ray) : Json(nullptr);
    return row;
  }

  [[nodiscard]] Json accuracy(const AccuracyRow& r) const {
    Json row = start("accuracy", r.method, r.kind);
    row["rays"] = r.kind;
    row["judged"] = r.judged;
    put_answer_counts(row, r);
    row["max_t_error_ulp"] = r.max_t_error_ulp;
    row["t_error_steps"] = Json::array();
    for (const auto& [end, hits] : r.t_error_steps)
      row["t_error_steps"].push_back(Json::array({end > 0.0 ? Json(end) : Json(nullptr), hits}));
    row["same_as"] = text_or_null(r.same_as);
    return row;
  }

  [[nodiscard]] Json prediction(const PredictionRow& r) const {
    Json row = start("prediction", r.method, r.kind);
    row["rays"] = r.kind;
    row["ray_count"] = r.rays;
    row["predicted"] = r.predicted;
    row["measured"] = r.measured;
    row["standard_error"] = r.standard_error;
    return row;
  }

  [[nodiscard]] Json decision(const DecisionRow& r) const {
    Json row = start("decision", r.method, r.kind);
    row["rays"] = r.kind;
    row["query"] = r.query;
    row["expected_rays"] = r.expected;
    row["kept"] = r.kept;
    row["reason"] = r.reason;
    row["probes"] = r.probes;
    row["baseline_cost"] = r.baseline_cost;
    row["cost"] = r.cost;
    row["planning_share"] = r.planning_share;
    return row;
  }

  [[nodiscard]] Json size(const SizeRow& r) const {
    Json row = start("size", r.method, r.kind + "/" + std::to_string(r.triangles));
    row["rays"] = r.kind;
    row["size"] = r.triangles;
    row["ray_count"] = r.rays;
    row["thinned"] = r.thinned;
    row["build_wall_s"] = r.build.wall_s;
    row["build_cpu_s"] = r.build.cpu_s;
    row["trace_wall_s"] = r.trace.wall_s;
    row["trace_cpu_s"] = r.trace.cpu_s;
    const auto base = std::find_if(device_.sizes.begin(), device_.sizes.end(), [&](const SizeRow& other) {
      return other.method == kBaseline && other.triangles == r.triangles;
    });
    const bool has_base = base != device_.sizes.end();
    row["build_ratio"] = has_base ? ratio(base->build, r.build) : Json(nullptr);
    row["trace_ratio"] = has_base ? ratio(base->trace, r.trace) : Json(nullptr);
    return row;
  }

  [[nodiscard]] Json area(const AreaRow& r) const {
    Json row = start("area", r.method, r.area);
    row["area"] = r.area;
    row["ray_count"] = r.rays;
    row["boxes_per_ray"] = r.boxes_per_ray;
    row["triangles_per_ray"] = r.triangles_per_ray;
    return row;
  }

  [[nodiscard]] Json across(const AcrossRow& r) const {
    Json row = start("across", kBaseline, r.kind);
    row["rays"] = text_or_null(r.kind);
    row["ray_count"] = r.rays;
    row["wall_s"] = r.rounds.wall_s;
    row["cpu_s"] = r.rounds.cpu_s;
    row["first_device"] = report_.devices.front().name;
    row["ratio"] = spread_json(across_gain(report_, device_, r.kind));
    return row;
  }

  // The baseline's time over this one's, round by round.
  [[nodiscard]] Json ratio(const Rounds& base, const Rounds& own) const {
    return spread_json(ratios(seconds_of(base, report_.clock), seconds_of(own, report_.clock)));
  }

  [[nodiscard]] Json left_out(const LeftOut& r) const {
    Json row = start("left_out", r.method, r.what);
    row["what"] = r.what;
    row["reason"] = r.reason;
    return row;
  }

  const Report& report_;
  const DeviceReport& device_;
};

}  // namespace

Json rows_of(const Report& report, const DeviceReport& device) {
  return Rows(report, device).all();
}

void read_row(const Json& row, DeviceReport& device) {
  const std::string task = row.at("task");
  const std::string method = text_of(row.at("method"));
  if (task == "build") {
    device.builds.push_back({method, get_rounds(row), row.at("bytes"), row.at("scratch_bytes"),
                             text_of(row.at("tree_hash")), row.at("nodes"), row.at("max_depth"),
                             row.at("sah_cost"), row.at("flavour")});
  } else if (task == "trace") {
    const bool counted = !row.at("boxes_per_ray").is_null();
    device.traces.push_back({method, row.at("rays"), row.at("query") == "any", row.at("ray_count"),
                             row.at("hits"), row.value("passes", std::uint64_t{1}), get_rounds(row), counted,
                             counted ? row.at("boxes_per_ray").get<double>() : 0.0,
                             counted ? row.at("triangles_per_ray").get<double>() : 0.0});
  } else if (task == "accuracy") {
    AccuracyRow r{method,
                  row.at("rays"),
                  text_of(row.at("same_as")),
                  row.at("judged"),
                  row.at("hits"),
                  row.at("lost"),
                  row.at("false_hits"),
                  row.at("wrong_primitive"),
                  row.at("any_closest_disagree"),
                  row.at("max_t_error_ulp"),
                  {}};
    for (const Json& step : row.at("t_error_steps"))
      r.t_error_steps.emplace_back(step.at(0).is_null() ? 0.0 : step.at(0).get<double>(), step.at(1));
    device.accuracies.push_back(std::move(r));
  } else if (task == "prediction") {
    device.predictions.push_back({method, row.at("rays"), row.at("ray_count"), row.at("predicted"),
                                  row.at("measured"), row.at("standard_error")});
  } else if (task == "decision") {
    device.decisions.push_back({method, row.at("rays"), row.at("query"), row.at("expected_rays"),
                                row.at("kept"), row.at("reason"), row.at("probes"), row.at("baseline_cost"),
                                row.at("cost"), row.at("planning_share")});
  } else if (task == "size") {
    device.sizes.push_back({method,
                            row.at("rays"),
                            row.at("size"),
                            row.at("ray_count"),
                            row.at("thinned"),
                            {row.at("build_wall_s"), row.at("build_cpu_s")},
                            {row.at("trace_wall_s"), row.at("trace_cpu_s")}});
  } else if (task == "area") {
    device.areas.push_back(
        {method, row.at("area"), row.at("ray_count"), row.at("boxes_per_ray"), row.at("triangles_per_ray")});
  } else if (task == "across") {
    device.across.push_back({text_of(row.at("rays")), row.at("ray_count"), get_rounds(row)});
  } else if (task == "left_out") {
    device.left_out.push_back({method, row.at("what"), row.at("reason")});
  }
}

Json text_or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}
std::string text_of(const Json& value) {
  return value.is_null() ? std::string() : value.get<std::string>();
}

}  // namespace gnomon::compare
