// The parts that all JSON documents share, and the same facts for people. Feeds the subcommands.
#pragma once

#include <string>

#include "build_timing.h"
#include "console.h"
#include "gnomon/cl/device.h"
#include "options.h"
#include "table.h"

namespace gnomon::app {

// Version, commit and command.
[[nodiscard]] Json start_document(const std::string& command);

// Device and driver; null where no device is used or found.
void add_device(Json& document, const cl::DeviceInfo* device);
void add_scene(Json& document, const SceneOptions& options, const Scene& scene);
// The tree options in effect, the device's own choices included.
void add_tree_options(Json& document, const cl::DeviceInfo& device, std::uint64_t triangles,
                      const BuildOptions& options);
void add_build(Json& document, const TimedBuild& build);

[[nodiscard]] Json to_json(const Spread& spread);

[[nodiscard]] std::string describe(const cl::DeviceInfo& device);
[[nodiscard]] std::string describe(const Scene& scene);
// "point", "spot", "directional", "area".
[[nodiscard]] const char* kind_name(LightKind kind);
[[nodiscard]] std::string describe(const TimedBuild& build);

}  // namespace gnomon::app
