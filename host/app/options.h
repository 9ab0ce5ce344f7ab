// Options that several subcommands share, and how they look on the command line. Feeds the subcommands.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <string>

#include "console.h"
#include "gnomon/scene/scene.h"
#include "gnomon/tree/build_options.h"

namespace gnomon::app {

// What a parsed command line asks for; returns the exit status.
using Action = std::function<int(Console&)>;

struct DeviceOptions {
  std::string choice;  // as choose_device takes it
  bool no_cache = false;
};

struct SceneOptions {
  std::string source;  // a file or gen:NAME[:TRIANGLES[:SEED]]
  std::string invalid = "drop";
  bool keep_flat = false;  // not on the command line
  [[nodiscard]] InvalidPolicy policy() const {
    if (invalid == "reject") return InvalidPolicy::kReject;
    return keep_flat ? InvalidPolicy::kKeepFlat : InvalidPolicy::kDrop;
  }
};

// Groups of --help whose options say which tree to build.
inline constexpr const char* kTreeGroup = "Tree";
inline constexpr const char* kRaysGroup = "Rays the tree is for";

void add_output_options(CLI::App& command, OutputOptions& options);
void add_device_options(CLI::App& command, DeviceOptions& options);
void add_scene_options(CLI::App& command, SceneOptions& options);
void add_build_options(CLI::App& command, BuildOptions& options);

// An option that holds a whole number, given as parse_count reads it.
CLI::Option* add_count(CLI::App& command, const std::string& flags, std::uint64_t& value,
                       const std::string& help);
CLI::Option* add_count(CLI::App& command, const std::string& flags, std::uint32_t& value,
                       const std::string& help);

}  // namespace gnomon::app
