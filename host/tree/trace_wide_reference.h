// Traversal of the wide tree in plain C++, no vectors: what the wide tracer is tested against, visit by
// visit. Not the judge of correctness (oracle.h is). Feeds tests.
#pragma once

#include <span>

#include "gnomon/tree/trace_reference.h"
#include "gnomon/tree/wide.h"

namespace gnomon {

// What a ray does in the wide tree, in steps as the tracer takes them: eight boxes or eight triangles at
// once.
struct WideSteps {
  std::uint32_t nodes = 0;
  std::uint32_t blocks = 0;
  std::uint32_t exact = 0;  // triangles that floats cannot rank
};

// Closest hits; with any_hit, each ray stops at the first hit that floats or exact arithmetic find:
// hits[i].primitive then says whether there is one, and is one that is met, but its t, u and v are not filled
// in. Counters: boxes are the filled slots of visited nodes, triangles those of visited leaves. steps:
// receives what each ray does, unless null.
[[nodiscard]] ReferenceTrace trace_wide_reference(const WideBvh& wide, std::span<const Ray> rays,
                                                  bool any_hit, std::vector<WideSteps>* steps = nullptr);

}  // namespace gnomon
