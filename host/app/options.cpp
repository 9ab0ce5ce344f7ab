#include "options.h"

#include <map>

#include "numbers.h"

namespace gnomon::app {
namespace {

// Turns a count as people write it into plain digits.
CLI::Validator count_reader() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        const auto count = parse_count(text);
        if (!count) return "\"" + text + "\" is not a count; write 250000, 250k, 1M or 1e6";
        text = std::to_string(*count);
        return {};
      },
      "");
}

template <typename Number>
CLI::Option* add_number(CLI::App& command, const std::string& flags, Number& value, const std::string& help) {
  return command.add_option(flags, value, help)
      ->transform(count_reader())
      ->type_name("N")
      ->capture_default_str();
}

}  // namespace

CLI::Option* add_count(CLI::App& command, const std::string& flags, std::uint64_t& value,
                       const std::string& help) {
  return add_number(command, flags, value, help);
}
CLI::Option* add_count(CLI::App& command, const std::string& flags, std::uint32_t& value,
                       const std::string& help) {
  return add_number(command, flags, value, help);
}

void add_output_options(CLI::App& command, OutputOptions& options) {
  const std::string group = "Output";
  command.add_flag("--json", options.json, "print one JSON document on stdout instead of text")->group(group);
  command.add_flag("-q,--quiet", options.quiet, "no notes and no progress on stderr, only errors")
      ->group(group);
  command.add_option("--color", options.color, "auto, always or never; auto heeds NO_COLOR")
      ->check(CLI::IsMember({"auto", "always", "never"}))
      ->type_name("WHEN")
      ->group(group)
      ->capture_default_str();
}

void add_device_options(CLI::App& command, DeviceOptions& options) {
  const std::string group = "Device";
  command
      .add_option("--device", options.choice,
                  "an index, platform:device, cpu, gpu or a part of the name (see gnomon devices); default: "
                  "the first "
                  "GPU, else the first CPU")
      ->envname("GNOMON_DEVICE")
      ->type_name("D")
      ->group(group);
  command
      .add_flag("--no-cache", options.no_cache,
                "keep no compiled kernels on disk and take none from there; what PoCL keeps, it keeps")
      ->group(group);
}

void add_scene_options(CLI::App& command, SceneOptions& options) {
  command.add_option("scene", options.source, "a .gltf, .glb or .obj file, or gen:NAME[:TRIANGLES[:SEED]]")
      ->required()
      ->type_name("SCENE");
  command
      .add_option("--invalid", options.invalid,
                  "triangles that cannot be traced (NaN, infinite, no area): drop and count them, or reject "
                  "the scene")
      ->check(CLI::IsMember({"reject", "drop"}))
      ->type_name("POLICY")
      ->capture_default_str();
}

void add_build_options(CLI::App& command, BuildOptions& options) {
  const std::string tree = kTreeGroup;
  const std::map<std::string, Builder> builders{{to_string(Builder::kBalanced), Builder::kBalanced},
                                                {to_string(Builder::kFast), Builder::kFast},
                                                {to_string(Builder::kBest), Builder::kBest}};
  command
      .add_option_function<std::string>(
          "--builder", [&options, builders](const std::string& name) { options.builder = builders.at(name); },
          "balanced: top down by the heuristic; fast: along the Morton curve, by surface area; best: "
          "balanced over "
          "parts of large triangles, then optimised")
      ->check(CLI::IsMember(
          {to_string(Builder::kBalanced), to_string(Builder::kFast), to_string(Builder::kBest)}))
      ->type_name("B")
      ->group(tree)
      ->default_str(to_string(options.builder));
  add_count(command, "--bins", options.bins, "split candidates per axis, 2 to 64")->group(tree);
  add_count(command, "--max-leaf", options.max_leaf_size, "triangles in a leaf at most, 1 to 255")
      ->group(tree);
  command
      .add_option("--cost-traversal", options.cost_traversal,
                  "of visiting a node, for the surface area heuristic")
      ->type_name("C")
      ->group(tree)
      ->capture_default_str();
  command.add_option("--cost-triangle", options.cost_triangle, "of testing a triangle")
      ->type_name("C")
      ->group(tree)
      ->capture_default_str();
  add_count(command, "--median-depth", options.median_depth,
            "from here on nodes are halved by count, 1 to 64")
      ->group(tree);
  const std::string work = "How the device works (never changes the tree; 0: it decides)";
  add_count(command, "--work-group-size", options.work_group_size,
            "a power of two up to 256; 1: serial kernels")
      ->group(work);
  add_count(command, "--subtree-size", options.subtree_size,
            "triangles one work-group builds alone, 32 to 1M")
      ->group(work);
  add_count(command, "--chunk-size", options.chunk_size,
            "triangles one work-group bins in a large node, 64 to 1M")
      ->group(work);
}

}  // namespace gnomon::app
