// Plans' trees built by a device, the same bytes as in plain C++. Feeds the subcommands, and benches of
// plans.
#pragma once

#include "gnomon/cl/context.h"
#include "gnomon/plan/choose.h"

namespace gnomon::app {

// The bytes of reference_builder(). The context must outlive it.
[[nodiscard]] PlanBuilder device_builder(const cl::Context& context);

}  // namespace gnomon::app
