// gnomon info: what is in a scene, and what a build of it would ask of a device. Works without any device.
#include <algorithm>
#include <array>
#include <memory>
#include <optional>

#include "commands.h"
#include "document.h"
#include "gnomon/device/build_device.h"
#include "numbers.h"
#include "scene_source.h"
#include "tree_source.h"

namespace gnomon::app {
namespace {

struct Options {
  SceneOptions scene;
  DeviceOptions device;
  std::string tree_file;
};

// Sums over the buffers of a build, and why it would be refused, if so.
struct MemoryNeed {
  std::uint64_t scratch = 0;
  std::uint64_t tree = 0;
  std::optional<std::string> refusal;
};

MemoryNeed memory_need(const cl::DeviceInfo& device, std::uint64_t triangles, Builder builder) {
  MemoryNeed need;
  BuildOptions options;
  options.builder = builder;
  try {
    for (const BufferNeed& buffer : build_memory(device, triangles, options)) {
      (buffer.scratch ? need.scratch : need.tree) += buffer.bytes;
      if (!need.refusal) need.refusal = cl::why_not_fit(device, buffer.name, buffer.bytes);
    }
  } catch (const Error& error) {  // a device that ends loops, more triangles than are indexed
    need.refusal = error.what();
  }
  if (!need.refusal && need.scratch + need.tree > device.global_memory) {
    need.refusal = device.name + " has only " + format_bytes(device.global_memory) + " of memory";
  }
  return need;
}

using LightCounts = std::array<std::uint64_t, 4>;

LightCounts count_lights(const Scene& scene) {
  LightCounts counts{};
  for (const Light& light : scene.lights) counts.at(static_cast<std::size_t>(light.kind)) += 1;
  return counts;
}

std::string describe(const Vec3& v) {
  return fixed(v[0], 3) + " " + fixed(v[1], 3) + " " + fixed(v[2], 3);
}

std::string camera_names(const Scene& scene) {
  std::string names;
  for (const Camera& camera : scene.cameras) {
    names += (names.empty() ? " (" : ", ") + (camera.name.empty() ? "unnamed" : camera.name);
  }
  return std::to_string(scene.cameras.size()) + (names.empty() ? "" : names + ")");
}

// With their numbers, as --light takes them; of many the first.
std::string light_list(const Scene& scene) {
  constexpr std::size_t kMostListed = 8;
  std::string list;
  for (std::size_t i = 0; i < std::min(scene.lights.size(), kMostListed); ++i)
    list += (list.empty() ? " (" : ", ") + std::to_string(i) + " " + kind_name(scene.lights[i].kind);
  if (scene.lights.size() > kMostListed) list += ", ...";
  return std::to_string(scene.lights.size()) + (list.empty() ? "" : list + ")");
}

std::string describe(const MemoryNeed& need, const cl::DeviceInfo& device) {
  return format_bytes(need.tree) + " tree and " + format_bytes(need.scratch) + " scratch on " + device.name +
         (need.refusal ? "; does not fit: " + *need.refusal : "; fits");
}

Json to_json(const MemoryNeed& need) {
  return {{"tree_bytes", need.tree},
          {"scratch_bytes", need.scratch},
          {"fits", !need.refusal.has_value()},
          {"reason", need.refusal ? Json(*need.refusal) : Json(nullptr)}};
}

Json to_json(const Scene& scene) {
  Json lights = Json::object();
  const LightCounts counts = count_lights(scene);
  for (std::size_t i = 0; i < counts.size(); ++i) lights[kind_name(static_cast<LightKind>(i))] = counts[i];
  Json cameras = Json::array();
  for (const Camera& camera : scene.cameras) cameras.push_back(camera.name);
  const Bounds bounds = bounds_of(scene);
  Json box = nullptr;
  if (!scene.triangles.empty()) box = {{"lo", bounds.lo}, {"hi", bounds.hi}};
  return {{"materials", scene.materials.size()}, {"cameras", cameras}, {"lights", lights}, {"bounds", box}};
}

// A tree of the scene that a file holds.
struct KeptTree {
  std::string file;
  StoredTree tree;
  std::string hash;
  BvhStats stats;
};

std::optional<KeptTree> kept_tree(const Options& options, const Scene& scene) {
  if (options.tree_file.empty()) return std::nullopt;
  KeptTree kept{options.tree_file, load_tree_of(scene, options.tree_file), {}, {}};
  kept.hash = tree_hash(kept.tree.bvh);
  kept.stats = stats_of(kept.tree.bvh, kept.tree.options);
  return kept;
}

Json to_json(const KeptTree& kept) {
  const BuildOptions& options = kept.tree.options;
  return {{"file", kept.file},
          {"hash", kept.hash},
          {"builder", to_string(options.builder)},
          {"heuristic", heuristic_name(options)},
          {"fitted_to_rays", kept.tree.fitted},
          {"bins", options.bins},
          {"max_leaf", options.max_leaf_size},
          {"cost_traversal", options.cost_traversal},
          {"cost_triangle", options.cost_triangle},
          {"sah_cost", kept.stats.sah_cost},
          {"nodes", kept.stats.nodes},
          {"leaves", kept.stats.leaves},
          {"max_depth", kept.stats.max_depth},
          {"largest_leaf", kept.stats.largest_leaf},
          {"mean_leaf", kept.stats.mean_leaf}};
}

std::string describe(const KeptTree& kept) {
  return kept.file + ": hash " + kept.hash + ", builder " + to_string(kept.tree.options.builder) +
         ", heuristic " + heuristic_name(kept.tree.options) +
         (kept.tree.fitted ? ", fitted to rays by a plan" : "") + ", SAH cost " +
         fixed(kept.stats.sah_cost, 2) + ", " + std::to_string(kept.stats.nodes) + " nodes, depth " +
         std::to_string(kept.stats.max_depth);
}

std::string facts_of(const Options& options, const Scene& scene) {
  Facts facts;
  facts.add("scene", options.scene.source + (scene.name.empty() ? "" : " (" + scene.name + ")"));
  facts.add("triangles", std::to_string(scene.triangles.size()));
  facts.add("dropped", std::to_string(scene.report.dropped()) + " (" +
                           std::to_string(scene.report.non_finite_dropped) + " not finite, " +
                           std::to_string(scene.report.zero_area_dropped) + " without area)");
  facts.add("hash", scene_hash(scene));
  if (!scene.triangles.empty()) {
    const Bounds bounds = bounds_of(scene);
    facts.add("bounds", describe(bounds.lo) + "  to  " + describe(bounds.hi));
  }
  facts.add("materials", std::to_string(scene.materials.size()));
  facts.add("cameras", camera_names(scene));
  facts.add("lights", light_list(scene));
  return facts.text();
}

int run(const Options& options, Console& console) {
  const auto devices = cl::list_devices();
  const cl::DeviceInfo* const device =
      devices.empty() ? nullptr : &cl::choose_device(devices, options.device.choice);
  const Scene scene = load_scene(options.scene, console);
  const std::optional<KeptTree> kept = kept_tree(options, scene);
  Json document = start_document("info");
  add_device(document, device);
  add_scene(document, options.scene, scene);
  document.update(to_json(scene));
  document["tree"] = kept ? to_json(*kept) : Json(nullptr);
  document["build_memory"] = nullptr;
  document["best_build_memory"] = nullptr;
  std::string memory = "no OpenCL device here to ask";
  std::string best_memory;
  if (device != nullptr) {
    const MemoryNeed need = memory_need(*device, scene.triangles.size(), Builder::kBalanced);
    const MemoryNeed best = memory_need(*device, scene.triangles.size(), Builder::kBest);
    document["build_memory"] = to_json(need);
    document["best_build_memory"] = to_json(best);
    memory = describe(need, *device);
    best_memory = "with --builder best  " + describe(best, *device) + "\n";
  }
  console.print(document);
  console.print(facts_of(options, scene) + "build needs  " + memory + "\n" + best_memory +
                (kept ? "tree         " + describe(*kept) + "\n" : ""));
  return 0;
}

}  // namespace

void add_info_command(CLI::App& program, OutputOptions& output, Action& action) {
  const auto options = std::make_shared<Options>();
  CLI::App* const command =
      program.add_subcommand("info", "Say what is in a scene and what building it will need.");
  add_scene_options(*command, options->scene);
  command
      ->add_option("--device", options->device.choice,
                   "the device whose memory to compare with, as for build")
      ->envname("GNOMON_DEVICE")
      ->type_name("D");
  add_tree_file_option(*command, options->tree_file);
  add_output_options(*command, output);
  command->footer(
      "Needs no OpenCL device; with one, it says whether a build would fit.\n\n"
      "Examples:\n  gnomon info model.glb\n  gnomon info gen:forest:1M --json\n  gnomon info model.glb "
      "--tree model.gnb");
  command->callback(
      [&action, options] { action = [options](Console& console) { return run(*options, console); }; });
}

}  // namespace gnomon::app
