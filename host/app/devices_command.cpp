// gnomon devices: what OpenCL offers here, and which device the other subcommands would take.
#include <cstdlib>

#include "commands.h"
#include "device_choice.h"
#include "document.h"
#include "numbers.h"

namespace gnomon::app {
namespace {

std::string environment_choice() {
  const char* const value = std::getenv("GNOMON_DEVICE");
  return value == nullptr ? std::string() : value;
}

// The device the other subcommands would use; with a choice in the environment that fits none, a note and
// nothing.
const cl::DeviceInfo* default_device(const std::vector<cl::DeviceInfo>& devices, Console& console) {
  try {
    return &cl::choose_device(devices, environment_choice());
  } catch (const Error&) {
    if (devices.empty()) throw;
    console.note("GNOMON_DEVICE is \"" + environment_choice() + "\", which fits none of these");
    return nullptr;
  }
}

Json to_json(const cl::DeviceInfo& d) {
  return {{"index", d.index},
          {"address", std::to_string(d.platform_index) + ":" + std::to_string(d.device_index)},
          {"kind", kind_of(d)},
          {"name", d.name},
          {"vendor", d.vendor},
          {"platform", d.platform_name},
          {"opencl", d.version},
          {"driver", d.driver},
          {"available", d.available},
          {"compute_units", d.compute_units},
          {"global_memory", d.global_memory},
          {"max_allocation", d.max_allocation},
          {"local_memory", d.local_memory},
          {"max_work_group", d.max_work_group},
          {"unified_memory", d.unified_memory},
          {"fp64", d.fp64},
          {"int64_atomics", d.int64_atomics}};
}

std::string describe_all(const std::vector<cl::DeviceInfo>& devices, const cl::DeviceInfo* chosen,
                         const Console& console) {
  std::string out;
  for (const cl::DeviceInfo& d : devices) {
    const std::string address = std::to_string(d.platform_index) + ":" + std::to_string(d.device_index);
    out += "[" + std::to_string(d.index) + "] " + address + " " + kind_of(d) + "  " +
           console.paint(Paint::kBold, d.name) + (&d == chosen ? "  (default)" : "") +
           (d.available ? "" : "  (not available)") + "\n";
    Facts facts;
    facts.add("    platform", d.platform_name + ", " + d.version + ", driver " + d.driver);
    facts.add("    memory", format_bytes(d.global_memory) +
                                (d.unified_memory ? " shared with the host" : "") + ", at most " +
                                format_bytes(d.max_allocation) + " in one buffer, " +
                                format_bytes(d.local_memory) + " local");
    facts.add("    work", std::to_string(d.compute_units) + " compute units, groups up to " +
                              std::to_string(d.max_work_group) + (d.fp64 ? ", fp64" : ", no fp64") +
                              (d.int64_atomics ? ", int64 atomics" : ""));
    out += facts.text();
  }
  return out;
}

int run(Console& console) {
  const auto devices = cl::list_devices();
  const cl::DeviceInfo* const chosen = default_device(devices, console);
  Json document = start_document("devices");
  add_device(document, chosen);
  document["default_index"] = chosen != nullptr ? Json(chosen->index) : Json(nullptr);
  document["devices"] = Json::array();
  for (const cl::DeviceInfo& device : devices) document["devices"].push_back(to_json(device));
  console.print(document);
  console.print(describe_all(devices, chosen, console));
  return 0;
}

}  // namespace

void add_devices_command(CLI::App& program, OutputOptions& output, Action& action) {
  CLI::App* const command =
      program.add_subcommand("devices", "List the OpenCL devices and what each can do.");
  add_output_options(*command, output);
  command->footer(
      "The number in brackets, platform:device, cpu, gpu or any part of a name can be given to --device of "
      "the other\n"
      "subcommands, or in the environment variable GNOMON_DEVICE.\n\n"
      "Examples:\n  gnomon devices\n  gnomon devices --json");
  command->callback([&action] { action = run; });
}

}  // namespace gnomon::app
