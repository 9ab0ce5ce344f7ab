#include "gnomon/device/collapse_device.h"

#include <algorithm>
#include <chrono>

#include "gnomon/cl/launch.h"
#include "gnomon/cl/program.h"

namespace gnomon {
namespace {

// Several subtrees for every compute unit, none so large that it leaves the cache, and few enough for the
// lists.
std::uint32_t triangles_per_task(const cl::DeviceInfo& device, std::uint32_t triangles) {
  const std::uint64_t least = std::max<std::uint64_t>(64, triangles / 4096);
  const std::uint64_t share = triangles / (16ULL * std::max(1U, device.compute_units));
  return static_cast<std::uint32_t>(
      std::clamp<std::uint64_t>(share, least, std::max<std::uint64_t>(least, 8192)));
}

// Loop turns that one triangle costs in the slowest kernel: a node of the binary tree is opened in about 100,
// written with its boxes and triangles in as many, and a device's vector unit may do several subtrees side by
// side.
constexpr std::uint64_t kTurnsPerTriangle = 512;

void heed_loop_limit(const cl::DeviceInfo& device, std::uint32_t triangles) {
  if (device.loop_limit == 0 || triangles * kTurnsPerTriangle <= device.loop_limit) return;
  throw Error(ErrorCode::kInvalidArgument,
              device.name + " ends loops after " + std::to_string(device.loop_limit) +
                  " turns, too few to make a wide tree of " + std::to_string(triangles) +
                  " triangles; trace the binary tree there or use another device");
}

class Collapser {
 public:
  Collapser(const cl::Context& context, const DeviceBvh& tree, const CollapseOptions& options,
            std::span<const float> slot_keys, std::span<const float> weights)
      : context_(context),
        tree_(tree),
        options_(options),
        weights_given_(weights.empty() ? 0 : 1),
        write_keys_(slot_keys.empty() ? 1 : 0) {
    inner_count_ = tree.node_count / 2;
    limit_ = options.triangles_per_task != 0 ? options.triangles_per_task
                                             : triangles_per_task(context.device(), tree.triangle_count);
    numbers_ = context.create_buffer("collapse_numbers", 5 * sizeof(std::uint32_t));
    forests_ = context.create_buffer("collapse_forests", inner_count_ * sizeof(GnForest));
    no_nodes_ = context.create_buffer("no_wide_nodes", 1);
    weights_ = uploaded("node_weights", weights);
    keys_ = slot_keys.empty() ? context.create_buffer("slot_keys", tree.node_count * sizeof(float))
                              : uploaded("slot_keys", slot_keys);
  }

  DeviceWideBvh run() {
    weigh();
    return emit();
  }

  [[nodiscard]] const cl::StageTimes& times() const { return times_; }

 private:
  [[nodiscard]] cl::Buffer uploaded(const char* name, std::span<const float> values) const {
    cl::Buffer buffer = context_.create_buffer(name, std::max<std::size_t>(1, values.size()) * sizeof(float));
    if (!values.empty()) context_.upload_values<float>(buffer, values);
    return buffer;
  }

  template <typename... Arguments>
  void launch(const char* stage, const char* name, std::uint32_t items, const Arguments&... arguments) {
    if (items == 0) return;
    const std::string options = "-DGN_COLLAPSE_DEPTH=" + std::to_string((tree_.max_depth + 2 + 31) / 32 * 32);
    const cl::Handle<cl_kernel> kernel = context_.programs().kernel({"collapse.cl"}, options, name);
    cl::set_arguments(kernel.get(), arguments...);
    times_.add(stage, cl::enqueue(context_.queue(), kernel.get(), items, 1));
  }

  [[nodiscard]] std::vector<std::uint32_t> numbers() const {
    return context_.download_values<std::uint32_t>(numbers_, 5);
  }

  // Subtrees at one depth are disjoint, and all nodes above the cut have more than `limit` below them.
  [[nodiscard]] std::size_t most_above(std::uint32_t count, std::uint32_t limit) const {
    return std::min<std::size_t>(count, (std::size_t{count} / limit + 1) * (tree_.max_depth + 1));
  }

  void weigh() {
    const std::uint32_t limit = std::max(options_.triangles_per_task != 0 ? 1U : 32U, limit_ / 4);
    const std::size_t most_top = most_above(inner_count_, limit);
    const auto tasks = context_.create_buffer("collapse_subtrees", (most_top + 1) * sizeof(std::uint32_t));
    const auto top = context_.create_buffer("collapse_top", most_top * sizeof(std::uint32_t));
    launch("collapse: weigh", "cut_binary", 1, tree_.nodes, inner_count_, limit, tasks, top, numbers_);
    const auto found = numbers();
    launch("collapse: weigh", "weigh_subtrees", found[0], tree_.nodes, forests_, tasks, found[0],
           options_.cost_node, options_.cost_block, weights_, weights_given_, tree_.leaf_triangles, keys_,
           write_keys_);
    launch("collapse: weigh", "weigh_top", 1, tree_.nodes, forests_, top, found[1], options_.cost_node,
           options_.cost_block, weights_, weights_given_, tree_.leaf_triangles, keys_, write_keys_);
  }

  DeviceWideBvh emit() {
    const std::size_t most_tasks = std::min<std::size_t>(
        std::max(1U, inner_count_), GN_WIDTH * most_above(tree_.triangle_count, limit_) + 1);
    const auto tasks = context_.create_buffer("collapse_tasks", most_tasks * sizeof(GnCollapseTask));
    const auto opened =
        context_.create_buffer("collapse_opened", std::max(1U, inner_count_) * sizeof(GnOpened));
    top(no_nodes_, no_nodes_, tasks, 0);
    const std::uint32_t task_count = numbers()[0];
    launch("collapse: count", "count_subtrees", task_count, tree_.nodes, forests_, tree_.leaf_triangles,
           no_nodes_, no_nodes_, options_.cost_node, options_.cost_block, weights_, weights_given_, keys_,
           tasks, task_count, opened);
    DeviceWideBvh wide = allocate(tasks, task_count);
    top(wide.nodes, wide.leaves, tasks, 1);
    const cl::Buffer depth = context_.create_buffer("collapse_depth", sizeof(std::uint32_t));
    context_.fill(depth, 0);
    launch("collapse: emit", "emit_subtrees", task_count, tree_.nodes, forests_, tree_.leaf_triangles,
           wide.nodes, wide.leaves, options_.cost_node, options_.cost_block, weights_, weights_given_, keys_,
           tasks, task_count, depth, opened);
    wide.depth = std::max(numbers()[4], context_.download_values<std::uint32_t>(depth, 1).front());
    return wide;
  }

  void top(const cl::Buffer& nodes, const cl::Buffer& leaves, const cl::Buffer& tasks, std::uint32_t write) {
    launch("collapse: top", "emit_top", 1, tree_.nodes, forests_, tree_.leaf_triangles, nodes, leaves,
           options_.cost_node, options_.cost_block, weights_, weights_given_, keys_, tasks, limit_, numbers_,
           write);
  }

  // The nodes and leaves that the top and all subtrees have together.
  DeviceWideBvh allocate(const cl::Buffer& tasks, std::uint32_t task_count) {
    const auto found = numbers();
    DeviceWideBvh wide;
    wide.triangle_count = tree_.triangle_count;
    wide.frame = tree_.frame;
    wide.node_count = found[1];
    wide.place_count = found[2];
    std::uint32_t largest_leaf = found[3];
    for (const GnCollapseTask& task : context_.download_values<GnCollapseTask>(tasks, task_count)) {
      wide.node_count += task.nodes_below;
      wide.place_count += task.places_below;
      largest_leaf = std::max(largest_leaf, task.largest_leaf);
    }
    if (largest_leaf > GN_MAX_WIDE_LEAF) throw_leaf_too_large(largest_leaf);
    if (wide.place_count > GN_MAX_PLACES) {
      throw Error(ErrorCode::kOutOfMemory, "a wide tree of " + std::to_string(tree_.triangle_count) +
                                               " triangles has more of them than its links can name");
    }
    wide.nodes = context_.create_buffer("wide_nodes", wide.node_count * sizeof(WideNode));
    wide.leaves = leaf_buffer(context_, wide.place_count);
    return wide;
  }

  const cl::Context& context_;
  const DeviceBvh& tree_;
  const CollapseOptions& options_;
  std::uint32_t weights_given_;
  std::uint32_t write_keys_;
  std::uint32_t inner_count_ = 0;
  std::uint32_t limit_ = 0;
  cl::StageTimes times_;
  cl::Buffer numbers_, forests_, no_nodes_, weights_, keys_;
};

}  // namespace

cl::Buffer leaf_buffer(const cl::Context& context, std::uint32_t places) {
  return context.create_buffer(
      "wide_leaves", (std::size_t{places} * GN_TRIANGLE_WORDS + GN_LEAF_SLACK) * sizeof(std::uint32_t));
}

DeviceWideBvh collapse_device(const cl::Context& context, const DeviceBvh& tree,
                              const CollapseOptions& options, BuildReport* out,
                              std::span<const float> slot_keys, std::span<const float> weights) {
  const auto start = std::chrono::steady_clock::now();
  options.check();
  check_slot_keys(slot_keys, tree.node_count);
  check_node_weights(weights, tree.node_count);
  heed_loop_limit(context.device(), tree.triangle_count);
  if (tree.triangle_count == 0) {
    const WideBvh empty = collapse_reference({}, {}, options);
    DeviceWideBvh wide;
    wide.nodes = context.create_buffer("wide_nodes", sizeof(WideNode));
    wide.leaves = leaf_buffer(context, 0);
    wide.node_count = 1;
    wide.depth = 1;
    context.upload_values<WideNode>(wide.nodes, empty.nodes);
    return wide;
  }
  Collapser collapser(context, tree, options, slot_keys, weights);
  DeviceWideBvh wide = collapser.run();
  if (out != nullptr) {
    for (auto& stage : collapser.times().milliseconds()) out->stages.push_back(std::move(stage));
    out->total_ms +=
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  return wide;
}

WideBvh download_wide(const cl::Context& context, const DeviceWideBvh& tree) {
  return {
      context.download_values<WideNode>(tree.nodes, tree.node_count),
      context.download_values<std::uint32_t>(tree.leaves, std::size_t{tree.place_count} * GN_TRIANGLE_WORDS),
      tree.depth, tree.frame, tree.regions};
}

}  // namespace gnomon
