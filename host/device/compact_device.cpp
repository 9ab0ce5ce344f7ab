#include "gnomon/device/compact_device.h"

#include <algorithm>
#include <bit>
#include <chrono>

#include "gnomon/cl/launch.h"
#include "gnomon/cl/program.h"
#include "gnomon/device/radix_sort.h"
#include "gnomon/tree/box_frame.h"
#include "gnomon/tree/regions.h"

namespace gnomon {
namespace {

// Of prefix sums over so many values; nothing is sorted.
SortPlan plan_for(const cl::DeviceInfo& device, const DeviceWideBvh& wide) {
  const std::uint32_t values = std::max(wide.place_count, wide.node_count);
  if (device.loop_limit != 0 && values > device.loop_limit) {
    throw Error(ErrorCode::kInvalidArgument,
                device.name + " ends loops after " + std::to_string(device.loop_limit) +
                    " turns, too few to make a compact tree of " + std::to_string(wide.triangle_count) +
                    " triangles; trace the binary tree there or use another device");
  }
  const auto widest =
      static_cast<std::uint32_t>(std::bit_floor(std::min<std::uint64_t>(device.max_work_group, 64)));
  return plan_sort(device, values, device.is_cpu && device.loop_limit == 0 ? 1 : widest, 0);
}

class Compactor {
 public:
  Compactor(const cl::Context& context, const DeviceWideBvh& wide)
      : context_(context), wide_(wide), plan_(plan_for(context.device(), wide)) {
    out_.triangle_count = wide.triangle_count;
    out_.node_count = wide.node_count;
    out_.depth = wide.depth;
  }

  DeviceCompactBvh run() {
    write_nodes();
    pack_leaves();
    return std::move(out_);
  }

  [[nodiscard]] const cl::StageTimes& times() const { return times_; }

 private:
  template <typename... Arguments>
  void launch(const char* name, std::uint32_t items, const Arguments&... arguments) {
    if (items == 0) return;
    const cl::Handle<cl_kernel> kernel = context_.programs().kernel({"quantise.cl"}, "", name);
    cl::set_arguments(kernel.get(), arguments..., items);
    const auto local = static_cast<std::size_t>(
        std::bit_floor(std::min<std::uint64_t>(context_.device().max_work_group, 64)));
    times_.add("compact",
               cl::enqueue(context_.queue(), kernel.get(), (items + local - 1) / local * local, local));
  }

  [[nodiscard]] cl::Buffer words(const char* name, std::size_t count) const {
    return context_.create_buffer(name, count * sizeof(std::uint32_t));
  }

  void write_nodes() {
    const cl::Buffer places = words("compact_node_places", wide_.node_count);
    const cl::Buffer largest = words("compact_largest_leaf", 1);
    const cl::Buffer counts_before = words("compact_counts_before", std::size_t{wide_.place_count} + 1);
    const cl::Buffer moves = context_.create_buffer("compact_moves", wide_.place_count * sizeof(cl_uint2));
    context_.fill(largest, 0);
    context_.fill(counts_before, 0);
    launch("place_nodes", wide_.node_count, wide_.nodes, wide_.leaves, places, largest, counts_before);
    const std::uint32_t most = context_.download_values<std::uint32_t>(largest, 1).front();
    if (most > GN_MAX_COMPACT_LEAF) throw_compact_leaf_too_large(most);
    scan_values(context_, plan_, counts_before, wide_.place_count, "compact", times_);
    out_.nodes = context_.create_buffer("compact_nodes", wide_.node_count * sizeof(CompactNode));
    spans_ = context_.create_buffer("compact_spans", wide_.node_count * sizeof(cl_uint2));
    first_of_ = words("compact_first_triangles", wide_.triangle_count);
    launch("write_nodes", wide_.node_count, wide_.nodes, wide_.leaves, places, counts_before, out_.nodes,
           spans_, moves, first_of_);
    plain_ = context_.create_buffer("plain_triangles", wide_.triangle_count * sizeof(GnPlainTriangle));
    launch("gather_plain", wide_.place_count, wide_.leaves, moves, counts_before, plain_);
  }

  void pack_leaves() {
    const cl::Buffer places = words("compact_corner_places", std::size_t{3} * wide_.triangle_count);
    const cl::Buffer heads = context_.create_buffer("pack_heads", wide_.node_count * sizeof(GnPackHead));
    const cl::Buffer words_before = words("packed_words", std::size_t{wide_.node_count} + 1);
    launch("find_equal_corners", 3 * wide_.triangle_count, plain_, first_of_, places);
    launch("measure_leaves", wide_.node_count, plain_, spans_, places, heads, words_before);
    scan_values(context_, plan_, words_before, wide_.node_count, "compact", times_);
    const std::uint32_t all =
        context_.download_values<std::uint32_t>(words_before, 1, wide_.node_count).front();
    out_.word_count = all + 1;
    out_.leaves = words("packed_leaves", out_.word_count);
    launch("write_leaves", wide_.node_count, plain_, spans_, places, heads, words_before, out_.nodes,
           out_.leaves);
    // The driver keeps what kernels read alive until they are done.
  }

  const cl::Context& context_;
  const DeviceWideBvh& wide_;
  SortPlan plan_;
  cl::Buffer spans_;     // of compact nodes: first triangle and number
  cl::Buffer first_of_;  // of triangles: the first of the same node
  cl::Buffer plain_;
  DeviceCompactBvh out_;
  cl::StageTimes times_;
};

}  // namespace

DeviceCompactBvh compact_device(const cl::Context& context, const DeviceWideBvh& tree, BuildReport* out) {
  const auto start = std::chrono::steady_clock::now();
  refuse_frame(tree.frame, "the compact layout");
  refuse_regions(tree.regions, "the compact layout");
  Compactor compactor(context, tree);
  DeviceCompactBvh compact = compactor.run();
  if (out != nullptr) {
    for (auto& stage : compactor.times().milliseconds()) out->stages.push_back(std::move(stage));
    out->total_ms +=
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  return compact;
}

CompactBvh download_compact(const cl::Context& context, const DeviceCompactBvh& tree) {
  CompactBvh out;
  out.nodes = context.download_values<CompactNode>(tree.nodes, tree.node_count);
  out.leaves = context.download_values<std::uint32_t>(tree.leaves, tree.word_count);
  out.depth = tree.depth;
  return out;
}

}  // namespace gnomon
