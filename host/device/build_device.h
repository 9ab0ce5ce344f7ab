// Building a tree on a device: from triangles, or from a buffer already there, to a tree that stays there.
// Not for tracing it (trace_device.h) or for other layouts. Feeds the command line, tracers, benches.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gnomon/base/progress.h"
#include "gnomon/cl/context.h"
#include "gnomon/tree/bvh.h"

namespace gnomon {

using Triangle = GnTriangle;

// A tree in device memory, ready to trace. Buffers hold GnNode, uint32 and GnLeafTriangle; all have at least
// one entry: an empty tree is one node with an inverted box that no ray meets.
struct DeviceBvh {
  cl::Buffer nodes;
  cl::Buffer order;           // leaf order -> index in the caller's triangles
  cl::Buffer leaf_triangles;  // triangles in leaf order
  std::uint32_t triangle_count =
      0;  // entries of the leaf order: Builder::kBest may name a triangle in several leaves
  std::uint32_t node_count = 0;
  std::uint32_t max_depth = 0;
  std::optional<BoxFrame> frame{};  // Bvh's
  [[nodiscard]] std::uint64_t bytes() const { return nodes.bytes + order.bytes + leaf_triangles.bytes; }
};

// Where a build's time and memory went.
struct BuildReport {
  double total_ms = 0.0;  // wall clock, upload included
  std::vector<std::pair<std::string, double>>
      stages;  // device milliseconds by stage (events); empty without profiling
  std::uint64_t scratch_bytes = 0;
};

// One buffer a build will ask for.
struct BufferNeed {
  std::string name;
  std::uint64_t bytes = 0;
  bool scratch = false;  // gone when the build is over
};

// Every buffer a build of `triangle_count` triangles needs, before anything is allocated. Throws as
// options.check().
[[nodiscard]] std::vector<BufferNeed> build_memory(const cl::DeviceInfo& device, std::uint64_t triangle_count,
                                                   const BuildOptions& options);

// Builds from host memory, which on CPUs is read where it is: returns, or throws, only once all that was
// enqueued before is complete. The tree's bytes depend on triangles and options' heuristic values only: not
// on the device, its work-group size or how the work was cut. Throws Error: kInvalidArgument (options),
// kBadScene (a coordinate not finite or beyond 2^48; names the triangle), kOutOfMemory (names buffer and
// size), kDevice, kCancelled.
[[nodiscard]] DeviceBvh build_device(const cl::Context& context, std::span<const Triangle> triangles,
                                     const BuildOptions& options = {}, BuildReport* report = nullptr,
                                     const Progress& progress = {});

// Builds from the caller's buffer of packed 36-byte triangles, which is only read. Commands go to the
// context's queue; the host waits for its own events, never for the whole queue.
[[nodiscard]] DeviceBvh build_device(const cl::Context& context, cl_mem triangles,
                                     std::uint32_t triangle_count, const BuildOptions& options = {},
                                     BuildReport* report = nullptr, const Progress& progress = {});

// Copies a tree to the host, or one from the host to a device.
[[nodiscard]] Bvh download_bvh(const cl::Context& context, const DeviceBvh& tree);
[[nodiscard]] DeviceBvh upload_bvh(const cl::Context& context, const Bvh& bvh,
                                   std::span<const Triangle> triangles);

}  // namespace gnomon
