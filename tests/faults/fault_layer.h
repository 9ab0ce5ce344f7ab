// Between gnomon and the OpenCL loader, in tests: makes any one call fail, and counts the objects that are
// alive. Linked into a test program it takes the place of the loader's functions there; as a library that is
// preloaded, in any program (then GNOMON_FAULT_AT names the call, and GNOMON_FAULT_REPORT a file for what
// came of it).
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace fault_layer {

// The n-th call from now on fails, once, with CL_OUT_OF_RESOURCES and without reaching the driver; a release
// is done all the same. 0: none.
void arm(std::uint64_t nth);

// The call that was made to fail since arm(); empty: none was reached.
[[nodiscard]] std::string failed();

// Calls since arm().
[[nodiscard]] std::uint64_t calls();

// References that gnomon holds: contexts, queues, buffers, programs, kernels, events.
using Live = std::array<std::int64_t, 6>;
[[nodiscard]] Live live();

}  // namespace fault_layer
