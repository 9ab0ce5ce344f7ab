#include "gnomon/device/compact_device.h"

#include <algorithm>
#include <bit>
#include <chrono>

#include "gnomon/cl/launch.h"
#include "gnomon/cl/program.h"
#include "gnomon/device/radix_sort.h"
#include "gnomon/tree/box_frame.h"

namespace gnomon {
namespace {

SortPlan plan_for(const cl::DeviceInfo& device, std::uint32_t corners) {
  const auto widest =
      static_cast<std::uint32_t>(std::bit_floor(std::min<std::uint64_t>(device.max_work_group, 64)));
  SortPlan plan = plan_sort(device, corners, device.is_cpu && device.loop_limit == 0 ? 1 : widest, 0);
  const std::uint64_t turns =
      std::max(std::uint64_t{plan.chunk_size}, std::uint64_t{plan.chunks()} << plan.digit_bits);
  if (device.loop_limit != 0 && std::max<std::uint64_t>(turns, corners) > device.loop_limit) {
    throw Error(ErrorCode::kInvalidArgument,
                device.name + " ends loops after " + std::to_string(device.loop_limit) +
                    " turns, too few to make a compact tree of " + std::to_string(corners / 3) +
                    " triangles; trace the binary tree there or use another device");
  }
  return plan;
}

class Compactor {
 public:
  Compactor(const cl::Context& context, const DeviceWideBvh& wide, const CompactOptions& options)
      : context_(context),
        wide_(wide),
        options_(options),
        corners_(3 * wide.triangle_count),
        plan_(plan_for(context.device(), corners_)) {
    out_.triangle_count = wide.triangle_count;
    out_.node_count = wide.node_count;
    out_.depth = wide.depth;
  }

  DeviceCompactBvh run() {
    write_nodes();
    share_corners();
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
    launch("write_nodes", wide_.node_count, wide_.nodes, wide_.leaves, places, counts_before, out_.nodes,
           moves);
    out_.triangles =
        context_.create_buffer("plain_triangles", wide_.triangle_count * sizeof(GnPlainTriangle));
    launch("write_triangles", wide_.place_count, wide_.leaves, moves, counts_before, out_.triangles);
  }

  // Where that pays, plain triangles give way to indexed ones.
  void share_corners() {
    const cl::Buffer first_of = words("compact_first_corners", corners_);
    const cl::Buffer ranks = words("compact_corner_ranks", std::size_t{corners_} + 1);
    find_first_corners(first_of, ranks);
    scan_values(context_, plan_, ranks, corners_, "compact", times_);
    const std::uint32_t vertices = context_.download_values<std::uint32_t>(ranks, 1, corners_).front();
    out_.shares_corners = gn_sharing_pays(wide_.triangle_count, vertices) != 0;
    out_.vertex_count = out_.shares_corners ? vertices : 0;
    out_.vertices = context_.create_buffer("vertices", out_.vertex_count * sizeof(GnVertex));
    if (!out_.shares_corners) return;
    const cl::Buffer plain = std::move(out_.triangles);
    out_.triangles =
        context_.create_buffer("indexed_triangles", wide_.triangle_count * sizeof(GnIndexedTriangle));
    launch("write_corners", corners_, plain, first_of, ranks, out_.triangles, out_.vertices);
    // The driver keeps `plain` alive until the kernel is done with it.
  }

  void find_first_corners(const cl::Buffer& first_of, const cl::Buffer& ranks) {
    const std::uint32_t mask = GN_NONE >> (32U - options_.key_bits);
    cl::Buffer pairs = context_.create_buffer("corner_keys", corners_ * 2 * sizeof(std::uint32_t));
    cl::Buffer spare = context_.create_buffer("spare_corner_keys", corners_ * 2 * sizeof(std::uint32_t));
    const cl::Buffer table = context_.create_buffer("corner_digits", plan_.table_bytes());
    launch("find_corner_keys", corners_, out_.triangles, pairs, mask);
    radix_sort(context_, plan_, pairs, spare, table, options_.key_bits, times_);
    launch("find_first_corners", corners_, pairs, out_.triangles, first_of, ranks);
  }

  const cl::Context& context_;
  const DeviceWideBvh& wide_;
  const CompactOptions& options_;
  std::uint32_t corners_;
  SortPlan plan_;
  DeviceCompactBvh out_;
  cl::StageTimes times_;
};

}  // namespace

void CompactOptions::check() const {
  if (key_bits >= 1 && key_bits <= 32) return;
  throw Error(ErrorCode::kInvalidArgument,
              "compact option key_bits is " + std::to_string(key_bits) + "; it must lie in 1..32");
}

std::uint64_t DeviceCompactBvh::bytes() const {
  const std::uint64_t triangle = shares_corners ? sizeof(GnIndexedTriangle) : sizeof(GnPlainTriangle);
  return node_count * sizeof(CompactNode) + triangle_count * triangle + vertex_count * sizeof(GnVertex);
}

DeviceCompactBvh compact_device(const cl::Context& context, const DeviceWideBvh& tree,
                                const CompactOptions& options, BuildReport* out) {
  const auto start = std::chrono::steady_clock::now();
  options.check();
  refuse_frame(tree.frame, "the compact layout");
  Compactor compactor(context, tree, options);
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
  out.depth = tree.depth;
  if (tree.shares_corners) {
    out.triangles = context.download_values<GnIndexedTriangle>(tree.triangles, tree.triangle_count);
    out.vertices = context.download_values<GnVertex>(tree.vertices, tree.vertex_count);
  } else {
    out.plain = context.download_values<GnPlainTriangle>(tree.triangles, tree.triangle_count);
  }
  return out;
}

}  // namespace gnomon
