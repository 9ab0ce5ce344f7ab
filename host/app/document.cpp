#include "document.h"

#include "device_choice.h"
#include "gnomon/device/build_plan.h"
#include "numbers.h"
#include "version.h"

namespace gnomon::app {

Json start_document(const std::string& command) {
  return {{"version", version()}, {"commit", commit()}, {"command", command}};
}

void add_device(Json& document, const cl::DeviceInfo* device) {
  for (const char* key : {"device", "driver", "platform", "opencl", "device_kind", "device_index"})
    document[key] = nullptr;
  if (device == nullptr) return;
  document["device"] = device->name;
  document["driver"] = device->driver;
  document["platform"] = device->platform_name;
  document["opencl"] = device->version;
  document["device_kind"] = kind_of(*device);
  document["device_index"] = device->index;
}

void add_scene(Json& document, const SceneOptions& options, const Scene& scene) {
  document["scene"] = options.source;
  document["scene_name"] = scene.name;
  document["scene_hash"] = scene_hash(scene);
  document["triangles"] = scene.triangles.size();
  document["dropped"] = scene.report.dropped();
  document["dropped_non_finite"] = scene.report.non_finite_dropped;
  document["dropped_zero_area"] = scene.report.zero_area_dropped;
  document["primitives_skipped"] = scene.report.primitives_skipped;
  document["import_notes"] = scene.report.notes;
  document["options"]["invalid"] = options.invalid;
}

void add_tree_options(Json& document, const cl::DeviceInfo& device, std::uint64_t triangles,
                      const BuildOptions& options) {
  const BuildPlan plan = plan_build(device, triangles, options);
  Json& out = document["options"];
  const bool balanced = options.builder == Builder::kBalanced;
  out["builder"] = to_string(options.builder);
  out["heuristic"] = heuristic_name(options);
  out["bins"] = options.bins;
  out["max_leaf"] = options.max_leaf_size;
  out["cost_traversal"] = options.cost_traversal;
  out["cost_triangle"] = options.cost_triangle;
  out["median_depth"] = options.median_depth;
  out["work_group_size"] = plan.work_group_size;
  out["subtree_size"] = balanced ? Json(plan.subtree_size) : Json(nullptr);
  out["chunk_size"] = balanced ? Json(plan.chunk_size) : Json(nullptr);
}

void add_build(Json& document, const TimedBuild& build) {
  Json stages = Json::object();
  for (const auto& [stage, ms] : build.median.stages) stages[stage] = ms;
  document["build"] = {{"total_ms", build.total_ms.median},
                       {"total_ms_min", build.total_ms.min},
                       {"total_ms_max", build.total_ms.max},
                       {"runs", build.runs.repeat},
                       {"warm_up", build.runs.warm_up},
                       {"stages", stages},
                       {"scratch_bytes", build.median.scratch_bytes}};
  Json& tree = document["tree"];
  tree = {{"hash", build.hash},   {"sah_cost", nullptr},        {"nodes", build.host.nodes.size()},
          {"leaves", nullptr},    {"max_depth", nullptr},       {"largest_leaf", nullptr},
          {"mean_leaf", nullptr}, {"bytes", build.tree.bytes()}};
  if (build.fault) return;  // such a tree has no measures
  tree["sah_cost"] = build.stats.sah_cost;
  tree["leaves"] = build.stats.leaves;
  tree["max_depth"] = build.stats.max_depth;
  tree["largest_leaf"] = build.stats.largest_leaf;
  tree["mean_leaf"] = build.stats.mean_leaf;
}

Json to_json(const Spread& spread) {
  return {{"median", spread.median}, {"min", spread.min}, {"max", spread.max}, {"n", spread.count}};
}

std::string describe(const cl::DeviceInfo& device) {
  return device.name + " (" + device.platform_name + ")";
}

const char* kind_name(LightKind kind) {
  switch (kind) {
    case LightKind::kPoint:
      return "point";
    case LightKind::kSpot:
      return "spot";
    case LightKind::kDirectional:
      return "directional";
    case LightKind::kArea:
      return "area";
  }
  return "?";
}

std::string describe(const Scene& scene) {
  std::string text = std::to_string(scene.triangles.size()) + " triangles, hash " + scene_hash(scene);
  if (scene.report.dropped() > 0) text += ", " + std::to_string(scene.report.dropped()) + " dropped";
  return text;
}

std::string describe(const TimedBuild& build) {
  if (build.fault) return "hash " + build.hash + ", " + std::to_string(build.host.nodes.size()) + " nodes";
  return "hash " + build.hash + ", SAH cost " + fixed(build.stats.sah_cost, 2) + ", " +
         std::to_string(build.stats.nodes) + " nodes, " + std::to_string(build.stats.leaves) +
         " leaves, depth " + std::to_string(build.stats.max_depth) +
         (build.file.empty() ? "" : ", from " + build.file);
}

}  // namespace gnomon::app
