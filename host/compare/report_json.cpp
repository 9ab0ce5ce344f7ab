#include "gnomon/compare/report_json.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "gnomon/base/error.h"
#include "gnomon/base/stats.h"
#include "gnomon/compare/answer_counts.h"

namespace gnomon::compare {
namespace {

using Json = nlohmann::ordered_json;

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

Json text_or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}
std::string text_of(const Json& value) {
  return value.is_null() ? std::string() : value.get<std::string>();
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
            {"method", text_or_null(method)}};
  }

  [[nodiscard]] Json build(const BuildRow& r) const {
    Json row = start("build", r.method, "");
    put_rounds(row, r.rounds, static_cast<double>(report_.triangles));
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
    put_rounds(row, r.rounds, static_cast<double>(r.rays));
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

  [[nodiscard]] Json left_out(const LeftOut& r) const {
    Json row = start("left_out", r.method, r.what);
    row["what"] = r.what;
    row["reason"] = r.reason;
    return row;
  }

  const Report& report_;
  const DeviceReport& device_;
};

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
                             row.at("hits"), get_rounds(row), counted,
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
  } else if (task == "left_out") {
    device.left_out.push_back({method, row.at("what"), row.at("reason")});
  }
}

Json device_json(const Report& report, const DeviceReport& device) {
  Json out{{"device", device.name},       {"driver", device.driver},
           {"platform", device.platform}, {"opencl", device.opencl},
           {"device_kind", device.kind},  {"compute_units", device.compute_units},
           {"complete", device.complete}, {"done", device.done}};
  out["methods"] = Json::array();
  for (const MethodFacts& m : device.methods)
    out["methods"].push_back({{"name", m.name},
                              {"family", to_string(m.family)},
                              {"what", m.what},
                              {"options", m.options},
                              {"exact", m.exact}});
  out["rows"] = Rows(report, device).all();
  Json png = Json::object();
  for (const auto& [name, bytes] : device.pictures.png) png[name] = to_base64(bytes);
  out["pictures"] = {{"width", device.pictures.width},
                     {"height", device.pictures.height},
                     {"white", device.pictures.white},
                     {"mean", device.pictures.mean},
                     {"png", png}};
  return out;
}

Family family_from(const std::string& name) {
  for (const Family family : {Family::kSurface, Family::kRays, Family::kMixture, Family::kPeer})
    if (name == to_string(family)) return family;
  throw Error(ErrorCode::kBadScene, "\"" + name + "\" is no family of methods");
}

DeviceReport read_device(const Json& in) {
  DeviceReport device;
  device.name = in.at("device");
  device.driver = in.at("driver");
  device.platform = in.at("platform");
  device.opencl = in.at("opencl");
  device.kind = in.at("device_kind");
  device.compute_units = in.at("compute_units");
  device.complete = in.at("complete");
  device.done = in.at("done").get<std::vector<std::string>>();
  for (const Json& m : in.at("methods"))
    device.methods.push_back(
        {m.at("name"), family_from(m.at("family")), m.at("what"), m.at("options"), m.at("exact")});
  for (const Json& row : in.at("rows")) read_row(row, device);
  const Json& pictures = in.at("pictures");
  device.pictures.width = pictures.at("width");
  device.pictures.height = pictures.at("height");
  device.pictures.white = pictures.at("white");
  device.pictures.mean = pictures.at("mean").get<std::map<std::string, double>>();
  for (const auto& [name, text] : pictures.at("png").items()) device.pictures.png[name] = from_base64(text);
  return device;
}

}  // namespace

std::string to_json_text(const Report& report) {
  Json out{{"schema", kSchema},
           {"bench", "compare"},
           {"complete", report.complete()},
           {"version", report.version},
           {"commit", report.commit},
           {"command", report.command},
           {"scene", report.scene},
           {"scene_name", report.scene_name},
           {"scene_hash", report.scene_hash},
           {"triangles", report.triangles},
           {"clock", report.clock},
           {"peer_note", text_or_null(report.peer_note)}};
  out["options"] = Json::object();
  for (const auto& [name, value] : report.options) out["options"][name] = value;
  out["devices"] = Json::array();
  for (const DeviceReport& device : report.devices) out["devices"].push_back(device_json(report, device));
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Report from_json_text(const std::string& text, const std::string& source) {
  try {
    const Json in = Json::parse(text);
    if (in.at("bench") != "compare") throw Error(ErrorCode::kBadScene, "it is of another bench");
    if (in.at("schema") != kSchema)
      throw Error(ErrorCode::kBadScene, "its schema is " + in.at("schema").dump() + ", this program reads " +
                                            std::to_string(kSchema));
    Report report;
    report.version = in.at("version");
    report.commit = in.at("commit");
    report.command = in.at("command");
    report.scene = in.at("scene");
    report.scene_name = in.at("scene_name");
    report.scene_hash = in.at("scene_hash");
    report.triangles = in.at("triangles");
    report.clock = in.at("clock");
    report.peer_note = text_of(in.at("peer_note"));
    for (const auto& [name, value] : in.at("options").items()) report.options.emplace_back(name, value);
    for (const Json& device : in.at("devices")) report.devices.push_back(read_device(device));
    return report;
  } catch (const std::exception& error) {
    throw Error(ErrorCode::kBadScene, source + " is not a report that can be gone on from: " + error.what() +
                                          "; move it away, or choose another name with -o");
  }
}

}  // namespace gnomon::compare
