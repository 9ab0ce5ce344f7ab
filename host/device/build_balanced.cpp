#include "gnomon/device/build_balanced.h"

#include <utility>

#include "gnomon/cl/launch.h"
#include "gnomon/cl/program.h"
#include "gnomon/device/build_plan.h"
#include "gnomon/device/level_loop.h"
#include "gnomon/tree/build_reference.h"

namespace gnomon {

namespace {

const std::vector<std::string> kSources = {"prepare.cl", "large.cl", "subtree.cl", "compact.cl"};

// One build in progress: buffers, kernels, and the passes in order.
class DeviceBuilder {
 public:
  DeviceBuilder(const cl::Context& context, const BuildOptions& options, const BuildPlan& plan,
                cl_mem triangles, cl::Buffer parts)
      : context_(context),
        options_(options),
        plan_(plan),
        triangles_(triangles),
        primitives_a_(std::move(parts)) {
    has_parts_ = static_cast<bool>(primitives_a_.mem);
    if (!has_parts_) primitives_a_ = allocate("primitives_a");
    for (cl::Buffer* buffer :
         {&primitives_b_, &sparse_nodes_, &inner_rank_, &rank_sums_, &status_, &chunk_bounds_, &chunk_bins_,
          &chunk_counts_, &chunks_, &tasks_, &first_chunk_, &children_, &order_, &heuristic_}) {
      *buffer = allocate(buffer->name);
    }
  }

  DeviceBvh run(const Progress& progress) {
    report(progress, "build: prepare", 0.0);
    LargeNodes large;
    std::vector<GnTask> tasks = prepare(large);
    const double whole = plan_.count;
    while (!tasks.empty()) {
      double left = 0.0;
      for (const GnTask& task : tasks) left += task.end - task.begin;
      report(progress, "build: large nodes", 0.5 * (1.0 - left / whole));
      tasks = divide_level(std::move(tasks), large);
    }
    report(progress, "build: subtrees", 0.5);
    build_subtrees(large);
    report(progress, "build: compact", 0.9);
    return compact();
  }

  [[nodiscard]] const cl::StageTimes& times() const { return times_; }

 private:
  cl::Buffer allocate(const std::string& name) {
    return context_.create_buffer(name, static_cast<std::size_t>(plan_.bytes_of(name)));
  }

  template <typename... Arguments>
  void launch(const char* stage, const char* kernel_name, std::size_t global, std::size_t local,
              const Arguments&... arguments) {
    const cl::Handle<cl_kernel> kernel =
        context_.programs().kernel(kSources, plan_.program_options(), kernel_name);
    cl::set_arguments(kernel.get(), arguments...);
    times_.add(stage, cl::enqueue(context_.queue(), kernel.get(), global, local));
  }

  // One work-group per item.
  template <typename... Arguments>
  void launch_groups(const char* stage, const char* kernel_name, std::size_t groups,
                     const Arguments&... arguments) {
    launch(stage, kernel_name, groups * plan_.work_group_size, plan_.work_group_size, arguments...);
  }

  // One work-item per element; the kernel ignores those past the end.
  template <typename... Arguments>
  void launch_items(const char* stage, const char* kernel_name, std::size_t items,
                    const Arguments&... arguments) {
    const std::size_t local = plan_.item_group_size;
    launch(stage, kernel_name, (items + local - 1) / local * local, local, arguments...);
  }

  // Boxes and root bounds; the root is the first large node, or the only subtree.
  std::vector<GnTask> prepare(LargeNodes& large) {
    const std::uint32_t chunks = (plan_.count + plan_.chunk_size - 1) / plan_.chunk_size;
    const std::uint32_t initial[2] = {GN_NONE, 0};
    context_.upload_values<std::uint32_t>(status_, initial);
    context_.fill(inner_rank_, 0);
    if (has_parts_) {
      launch_groups("prepare", "bound_primitives", chunks, primitives_a_, chunk_bounds_, plan_.count,
                    plan_.chunk_size);
    } else {
      launch_groups("prepare", "prepare_primitives", chunks, triangles_, primitives_a_, chunk_bounds_,
                    status_, plan_.count, plan_.chunk_size);
    }
    const auto bounds =
        context_.download_values<GnBounds>(chunk_bounds_, 2 * static_cast<std::size_t>(chunks));
    const std::uint32_t first_bad = context_.download_values<std::uint32_t>(status_, 1).front();
    if (first_bad != GN_NONE) throw_bad_coordinate(first_bad);
    const GnTask root = root_task(bounds, plan_.count);
    const GnHeuristic heuristic = heuristic_of(options_, root.lo, root.hi);
    context_.upload_values<GnHeuristic>(heuristic_, std::span(&heuristic, 1));
    if (plan_.count > plan_.subtree_size) return {root};
    large.roots.push_back(root);
    return {};
  }

  std::vector<GnTask> divide_level(std::vector<GnTask> tasks, LargeNodes& large) {
    Level level = make_level(std::move(tasks), plan_.chunk_size);
    context_.upload_values<GnTask>(tasks_, level.tasks);
    context_.upload_values<GnChunk>(chunks_, level.chunks);
    context_.upload_values<std::uint32_t>(first_chunk_, level.first_chunk);
    launch_groups("bin", "bin_chunks", level.chunks.size(), primitives_a_, primitives_b_, triangles_, tasks_,
                  chunks_, chunk_bins_, chunk_counts_);
    launch_groups("split", "split_tasks", level.tasks.size(), tasks_, chunks_, first_chunk_, chunk_bins_,
                  chunk_counts_, children_, heuristic_, triangles_);
    launch_groups("partition", "partition_chunks", level.chunks.size(), primitives_a_, primitives_b_,
                  triangles_, tasks_, chunks_, chunk_bounds_);
    const auto children = context_.download_values<GnChildren>(children_, level.tasks.size());
    const auto bounds = context_.download_values<GnBounds>(chunk_bounds_, 4 * level.chunks.size());
    level.tasks = context_.download_values<GnTask>(tasks_, level.tasks.size());
    return next_tasks(level, children, bounds, plan_.subtree_size, large);
  }

  void build_subtrees(const LargeNodes& large) {
    const auto root_count = large.roots.size();
    const cl::Buffer roots = context_.create_buffer("subtree_roots", root_count * sizeof(GnTask));
    context_.upload_values<GnTask>(roots, large.roots);
    const cl::Buffer outcome = context_.create_buffer("subtree_outcome", 2 * sizeof(std::uint32_t));
    context_.fill(outcome, 0);
    launch_groups("subtrees", "build_subtrees", root_count, primitives_a_, primitives_b_, roots,
                  sparse_nodes_, inner_rank_, order_, outcome, heuristic_, triangles_);
    if (!large.nodes.empty()) {
      const auto count = static_cast<std::uint32_t>(large.nodes.size());
      const cl::Buffer nodes = context_.create_buffer("large_nodes", count * sizeof(Node));
      const cl::Buffer slots = context_.create_buffer("large_slots", count * sizeof(std::uint32_t));
      context_.upload_values<Node>(nodes, large.nodes);
      context_.upload_values<std::uint32_t>(slots, large.slots);
      launch_items("compact", "enter_large_nodes", count, nodes, slots, sparse_nodes_, inner_rank_, count);
    }
    const auto depth_and_unfinished = context_.download_values<std::uint32_t>(outcome, 2);
    if (depth_and_unfinished[1] != 0) {
      throw Error(ErrorCode::kDevice, context_.device().name + " ended the loops of " +
                                          std::to_string(depth_and_unfinished[1]) +
                                          " subtrees before they were built; use another device");
    }
    depth_ = depth_and_unfinished[0];
  }

  DeviceBvh compact() {
    const std::uint32_t chunks = (plan_.count + plan_.compact_chunk - 1) / plan_.compact_chunk;
    launch("compact", "count_inner", chunks, 1, inner_rank_, rank_sums_, plan_.count, plan_.compact_chunk);
    launch("compact", "scan_chunk_sums", 1, 1, rank_sums_, chunks);
    launch("compact", "rank_inner", chunks, 1, inner_rank_, rank_sums_, plan_.count, plan_.compact_chunk);
    const std::uint32_t inner = context_.download_values<std::uint32_t>(rank_sums_, 1, chunks).front();
    DeviceBvh tree;
    tree.triangle_count = plan_.count;
    tree.node_count = 1 + 2 * inner;
    tree.max_depth = depth_;
    tree.nodes = context_.create_buffer("nodes", tree.node_count * sizeof(Node));
    tree.leaf_triangles = allocate("leaf_triangles");
    launch_items("compact", "emit_nodes", plan_.count, sparse_nodes_, inner_rank_, tree.nodes, plan_.count);
    launch_items("gather", "gather_triangles", plan_.count, triangles_, order_, tree.leaf_triangles,
                 plan_.count);
    tree.order = std::move(order_);
    return tree;
  }

  const cl::Context& context_;
  const BuildOptions& options_;
  const BuildPlan& plan_;
  cl_mem triangles_;
  cl::StageTimes times_;
  std::uint32_t depth_ = 0;
  bool has_parts_ = false;
  cl::Buffer primitives_a_, primitives_b_{{}, "primitives_b"}, sparse_nodes_{{}, "sparse_nodes"};
  cl::Buffer inner_rank_{{}, "inner_rank"}, rank_sums_{{}, "rank_sums"}, status_{{}, "status"};
  cl::Buffer chunk_bounds_{{}, "chunk_bounds"}, chunk_bins_{{}, "chunk_bins"},
      chunk_counts_{{}, "chunk_counts"};
  cl::Buffer chunks_{{}, "chunks"}, tasks_{{}, "tasks"}, first_chunk_{{}, "first_chunk"},
      children_{{}, "children"};
  cl::Buffer order_{{}, "order"}, heuristic_{{}, "heuristic"};
};

}  // namespace

DeviceBvh build_balanced(const cl::Context& context, cl_mem triangles, std::uint32_t count, cl::Buffer parts,
                         const BuildOptions& options, BuildReport* out, const Progress& progress) {
  const BuildPlan plan = plan_build(context.device(), count, options);
  DeviceBuilder builder(context, options, plan, triangles, std::move(parts));
  DeviceBvh tree = builder.run(progress);
  if (out != nullptr) out->stages = builder.times().milliseconds();
  return tree;
}

}  // namespace gnomon
