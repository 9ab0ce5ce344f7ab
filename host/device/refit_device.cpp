#include "gnomon/device/refit_device.h"

#include <algorithm>
#include <string>
#include <vector>

#include "gnomon/cl/launch.h"
#include "gnomon/cl/program.h"
#include "gnomon/tree/box_frame.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/refit.h"
#include "gnomon/tree/regions.h"

namespace gnomon {

namespace {

// Subtrees for every compute unit, few enough for what one work-item does above them.
std::uint32_t inner_nodes_per_task(std::uint32_t inner_count) {
  return std::max(64U, inner_count / 4096);
}

// Turns of the loops that one triangle costs in the one work-item which cuts the tree.
constexpr std::uint64_t kTurnsPerTriangle = 8;

class Refit {
 public:
  Refit(const cl::Context& context, std::span<const Triangle> triangles)
      : context_(context), count_(static_cast<std::uint32_t>(triangles.size())) {
    const cl::DeviceInfo& device = context.device();
    if (device.loop_limit != 0 && count_ * kTurnsPerTriangle > device.loop_limit) {
      throw Error(ErrorCode::kInvalidArgument, device.name + " ends loops after " +
                                                   std::to_string(device.loop_limit) +
                                                   " turns, too few to refit a tree of " +
                                                   std::to_string(count_) + " triangles; build a new one");
    }
    triangles_ = context.create_buffer("triangles", triangles.size_bytes());
    context.upload_values<Triangle>(triangles_, triangles);
  }

  // Before anything of the tree is touched.
  void check_triangles() {
    const cl::Buffer first_bad = context_.create_buffer("first_bad", sizeof(std::uint32_t));
    context_.fill(first_bad, GN_NONE);
    launch("check_triangles", count_, triangles_, first_bad, count_);
    const std::uint32_t bad = context_.download_values<std::uint32_t>(first_bad, 1).front();
    if (bad != GN_NONE) throw_bad_coordinate(bad);
  }

  void binary(DeviceBvh& tree) {
    depth_ = tree.max_depth;
    run({"compact.cl"}, "gather_triangles", count_, triangles_, tree.order, tree.leaf_triangles, count_);
    const std::uint32_t inner = tree.node_count / 2;
    const std::uint32_t limit = inner_nodes_per_task(inner);
    // Subtrees at one depth are disjoint, and all nodes above the cut have more than `limit` below them.
    const std::size_t most = std::min<std::size_t>(inner, (std::size_t{inner} / limit + 1) * (depth_ + 1));
    const auto tasks = context_.create_buffer("refit_subtrees", (most + 1) * sizeof(std::uint32_t));
    const auto top = context_.create_buffer("refit_top", most * sizeof(std::uint32_t));
    const auto numbers = context_.create_buffer("refit_numbers", 2 * sizeof(std::uint32_t));
    launch("cut_binary", 1, tree.nodes, inner, limit, tasks, top, numbers);
    const auto found = context_.download_values<std::uint32_t>(numbers, 2);
    launch("refit_subtrees", found[0], tree.nodes, tree.leaf_triangles, tasks, found[0]);
    launch("refit_top", 1, tree.nodes, tree.leaf_triangles, top, found[1]);
    finish();
  }

  void wide(DeviceWideBvh& tree) {
    launch("refit_leaves", tree.node_count, triangles_, tree.nodes, tree.leaves, tree.node_count);
    const auto parents = context_.create_buffer("refit_parents", tree.node_count * sizeof(std::uint32_t));
    const auto levels = context_.create_buffer("refit_levels", tree.node_count * sizeof(std::uint32_t));
    launch("find_parents", tree.node_count, tree.nodes, parents, tree.node_count);
    launch("find_levels", tree.node_count, parents, levels, tree.node_count);
    for (std::uint32_t level = tree.depth; level > 0; --level)
      launch("refit_level", tree.node_count, tree.nodes, tree.leaves, levels, level - 1, tree.node_count);
    finish();
  }

 private:
  template <typename... Arguments>
  void run(const std::vector<std::string>& sources, const char* name, std::uint32_t items,
           const Arguments&... arguments) {
    if (items == 0) return;
    const std::string options =
        "-DGN_COLLAPSE_DEPTH=" + std::to_string((depth_ + 2 + 31) / 32 * 32) + " -DGN_KIND=0u";
    const cl::Handle<cl_kernel> kernel = context_.programs().kernel(sources, options, name);
    cl::set_arguments(kernel.get(), arguments...);
    // On CPUs one to a group: PoCL gives each item of a group its own copy of a kernel's stack.
    const std::size_t widest =
        std::max<std::uint64_t>(1, std::min<std::uint64_t>(64, context_.device().max_work_group));
    const std::size_t local = items == 1 || context_.device().is_cpu ? 1 : widest;
    last_ = cl::enqueue(context_.queue(), kernel.get(), (items + local - 1) / local * local, local);
  }

  template <typename... Arguments>
  void launch(const char* name, std::uint32_t items, const Arguments&... arguments) {
    run({"collapse.cl", "refit.cl"}, name, items, arguments...);
  }

  // Faults of the device are reported here rather than by whoever comes next.
  void finish() const { cl::wait(last_); }

  const cl::Context& context_;
  std::uint32_t count_;
  std::uint32_t depth_ = 0;
  cl::Buffer triangles_;
  cl::Handle<cl_event> last_;
};

}  // namespace

void refit_device(const cl::Context& context, DeviceBvh& tree, std::span<const Triangle> triangles) {
  require_count(triangles.size(), tree.triangle_count);
  refuse_frame(tree.frame, "refitting");
  if (triangles.empty()) return;
  Refit refit(context, triangles);
  refit.check_triangles();
  refit.binary(tree);
}

void refit_device(const cl::Context& context, DeviceWideBvh& tree, std::span<const Triangle> triangles) {
  require_count(triangles.size(), tree.triangle_count);
  refuse_frame(tree.frame, "refitting");
  refuse_regions(tree.regions, "refitting");
  if (triangles.empty()) return;
  Refit refit(context, triangles);
  refit.check_triangles();
  refit.wide(tree);
}

}  // namespace gnomon
