#include "gnomon/device/build_plan.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "gnomon/device/build_best.h"
#include "gnomon/device/build_fast.h"
#include "gnomon/shared/build_layout.h"

namespace gnomon {

namespace {

constexpr std::uint32_t ceil_div(std::uint64_t a, std::uint64_t b) {
  return static_cast<std::uint32_t>((a + b - 1) / b);
}

// Enough subtrees that every compute unit gets several, none so large that it leaves the cache.
std::uint32_t serial_subtree_size(const cl::DeviceInfo& device, std::uint64_t count) {
  const std::uint64_t share = count / (8ULL * std::max(1U, device.compute_units));
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(share, 1024, 16384));
}

// What the stack in subtree.cl has room for.
constexpr std::uint32_t kMostInOneSubtree = 1U << 22U;

// How many triangles a subtree, a chunk may have where the device ends long loops. A node's bins are cleared,
// read back and swept in about 6 turns a bin, 48 more shared by a cooperative group's work-items; a triangle
// makes up to two nodes, and half of the limit stays in reserve.
void heed_loop_limit(BuildPlan& plan, const cl::DeviceInfo& device, const BuildOptions& options) {
  const std::uint32_t limit = device.loop_limit;
  if (plan.kind != GN_MEASURE_LINEAR) {
    throw Error(ErrorCode::kInvalidArgument,
                device.name + " ends loops after " + std::to_string(limit) + " turns, and " +
                    heuristic_name(options) +
                    " takes more for a single node; use a measure without window or "
                    "point, or another device");
  }
  const std::uint32_t width = plan.work_group_size;
  const std::uint32_t turns_per_triangle = 4 * plan.bins * (6 + (width == 1 ? 0 : 48 / width));
  const std::uint32_t subtree = limit / turns_per_triangle;
  if (subtree < options.max_leaf_size) {
    throw Error(ErrorCode::kInvalidArgument,
                device.name + " ends loops after " + std::to_string(limit) + " turns: with " +
                    std::to_string(plan.bins) + " bins leaves may hold at most " + std::to_string(subtree) +
                    " triangles there, not " + std::to_string(options.max_leaf_size) +
                    "; use fewer bins or another device");
  }
  plan.subtree_size = std::min(plan.subtree_size, subtree);
  // One work-item sums up all chunks of a task in about bins turns each: few chunks, and none too long to
  // walk through.
  plan.chunk_size = std::max(plan.chunk_size, ceil_div(std::uint64_t{plan.count} * 2 * plan.bins, limit));
  if (plan.chunk_size > limit / 4) {
    throw Error(ErrorCode::kOutOfMemory, std::to_string(plan.count) + " triangles are too many for " +
                                             device.name + ", which ends loops after " +
                                             std::to_string(limit) +
                                             " turns; use a smaller scene or another device");
  }
}

}  // namespace

std::string BuildPlan::program_options() const {
  return "-DGN_WGS=" + std::to_string(work_group_size) + " -DGN_BINS=" + std::to_string(bins) +
         " -DGN_ORDERED_AXES=" + (ordered_axes ? "1" : "0") +
         " -DGN_PUBLISHED_BINS=" + (published_bins ? "1" : "0") + " -DGN_KIND=" + std::to_string(kind) + "u";
}

std::vector<BufferNeed> BuildPlan::buffers() const {
  const std::uint64_t n = std::max(1U, count);
  const std::uint64_t bins_per_chunk = 3ULL * bins;
  // In each of at most 64 + 32 levels every large node has at most two small children.
  const std::uint64_t max_roots = std::min<std::uint64_t>(n, 192ULL * max_tasks + 1);
  return {
      {"primitives_a", n * sizeof(GnPrimitive), true},
      {"primitives_b", n * sizeof(GnPrimitive), true},
      {"sparse_nodes", 2 * n * sizeof(GnNode), true},
      {"inner_rank", n * sizeof(std::uint32_t), true},
      {"rank_sums", (ceil_div(n, compact_chunk) + 1ULL) * sizeof(std::uint32_t), true},
      {"status", 2 * sizeof(std::uint32_t), true},
      {"chunk_bounds", 4ULL * std::max(max_chunks, ceil_div(n, chunk_size)) * sizeof(GnBounds), true},
      {"chunk_bins", max_chunks * bins_per_chunk * sizeof(GnBin), true},
      {"chunk_counts", max_chunks * bins_per_chunk * sizeof(std::uint32_t), true},
      {"chunks", std::uint64_t{max_chunks} * sizeof(GnChunk), true},
      {"tasks", std::uint64_t{max_tasks} * sizeof(GnTask), true},
      {"first_chunk", (max_tasks + 1ULL) * sizeof(std::uint32_t), true},
      {"children", std::uint64_t{max_tasks} * sizeof(GnChildren), true},
      {"heuristic", sizeof(GnHeuristic), true},
      {"subtree_roots", max_roots * sizeof(GnTask), true},
      {"triangles", n * sizeof(Triangle), true},
      {"nodes", 2 * n * sizeof(GnNode), false},
      {"order", n * sizeof(std::uint32_t), false},
      {"leaf_triangles", n * sizeof(GnLeafTriangle), false},
  };
}

std::uint64_t BuildPlan::bytes_of(const std::string& name) const {
  for (const BufferNeed& need : buffers()) {
    if (need.name == name) return need.bytes;
  }
  return 0;
}

BuildPlan plan_build(const cl::DeviceInfo& device, std::uint64_t count, const BuildOptions& options) {
  options.check();
  if (count > std::numeric_limits<std::int32_t>::max()) {
    throw Error(ErrorCode::kOutOfMemory,
                std::to_string(count) + " triangles: at most 2147483647 can be indexed; split the scene");
  }
  BuildPlan plan;
  plan.count = static_cast<std::uint32_t>(count);
  plan.bins = options.bins;
  plan.ordered_axes = options.axes != AxisPolicy::kAll;
  plan.published_bins = options.published_leaves.on;
  plan.kind = options.measure.kind;
  const auto widest =
      static_cast<std::uint32_t>(std::bit_floor(std::min<std::uint64_t>(device.max_work_group, 256)));
  const std::uint32_t wanted = options.work_group_size != 0 ? options.work_group_size
                               : device.is_cpu              ? 1
                                                            : 128;
  if (options.work_group_size > widest) {
    throw Error(ErrorCode::kInvalidArgument, "work_group_size " + std::to_string(options.work_group_size) +
                                                 ", but " + device.name + " allows at most " +
                                                 std::to_string(widest));
  }
  plan.work_group_size = std::min(wanted, widest);
  plan.item_group_size = std::min(64U, widest);
  const bool serial = plan.work_group_size == 1;
  const std::uint32_t subtree = serial ? serial_subtree_size(device, count) : 1024;
  // Large nodes must hold more than a leaf may, so that they always divide.
  plan.subtree_size =
      std::max(options.subtree_size != 0 ? options.subtree_size : subtree, options.max_leaf_size);
  plan.chunk_size = options.chunk_size != 0 ? options.chunk_size : serial ? 8192 : 2048;
  // Where any node may be a leaf, however large, one work-group must see all of them.
  if (options.published_leaves.on) plan.subtree_size = std::max(plan.subtree_size, plan.count);
  if (plan.subtree_size > kMostInOneSubtree) {
    throw Error(ErrorCode::kInvalidArgument, std::to_string(plan.count) +
                                                 " triangles: the published leaf rule takes at most " +
                                                 std::to_string(kMostInOneSubtree));
  }
  if (device.loop_limit != 0) heed_loop_limit(plan, device, options);
  plan.compact_chunk = serial ? 4096 : 512;
  plan.max_tasks = plan.count / plan.subtree_size + 1;
  plan.max_chunks = plan.count / plan.chunk_size + plan.max_tasks + 1;
  return plan;
}

std::vector<BufferNeed> build_memory(const cl::DeviceInfo& device, std::uint64_t triangle_count,
                                     const BuildOptions& options) {
  if (options.builder == Builder::kFast) return fast_memory(device, triangle_count, options);
  if (options.builder == Builder::kBest) return best_memory(device, triangle_count, options);
  return plan_build(device, triangle_count, options).buffers();
}

}  // namespace gnomon
