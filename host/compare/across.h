// The same method on several devices beside each other: rounds in which each device runs once, so that ratios
// of devices are of times next to each other. Feeds the command line.
#pragma once

#include <functional>
#include <span>

#include "gnomon/compare/method.h"
#include "gnomon/compare/run_device.h"

namespace gnomon::compare {

struct AcrossDevice {
  const cl::Context* context = nullptr;
  DeviceReport* report = nullptr;
};

// kBaseline's builds and traces of each kind on all devices, as many rays and rounds as fit options.seconds
// on all of them, never less than one round of kLeastRays rays; rows go to each device's report, of which
// after_step tells. Nothing for a single device, or where the rows are there. Rays are those of the first
// device's hits. Throws Error as run_device does.
void run_across(std::span<const AcrossDevice> devices, const Scene& scene, const RunOptions& options,
                const std::function<void()>& after_step, const Progress& progress);

}  // namespace gnomon::compare
