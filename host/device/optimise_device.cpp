#include "gnomon/device/optimise_device.h"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <string>

#include "gnomon/cl/launch.h"
#include "gnomon/cl/program.h"
#include "gnomon/shared/reinsert_math.h"

namespace gnomon {

namespace {

// Slots one work-item weighs and candidates one searches for: CPUs are spared the start of a group each.
constexpr std::uint32_t kSlotRun = 1024;
constexpr std::uint32_t kCandidateRun = 16;

// Nothing but face weights is compiled.
constexpr const char* kFaceOptions = "-DGN_KIND=0u";

// Turns of the loops that one node may cost in the one work-item that cuts the tree and joins its top.
constexpr std::uint64_t kTurnsPerNode = 2;

std::uint64_t slots_of(std::uint64_t nodes) {
  return nodes + 1;
}
std::uint64_t pairs_of(std::uint64_t nodes) {
  return slots_of(nodes) / 2 + 1;
}

// Inner nodes of a subtree that one work-item works on; few enough subtrees for what one does above them.
std::uint32_t inner_per_task(std::uint32_t nodes) {
  return std::max(64U, nodes / 8192);
}

class Optimiser {
 public:
  Optimiser(const cl::Context& context, const DeviceBvh& tree, const OptimiseOptions& options)
      : context_(context), tree_(tree), options_(options), nodes_(tree.node_count) {
    if (context.device().loop_limit != 0 || !context.device().is_cpu) slot_run_ = candidate_run_ = 1;
    cl::Buffer* const all[] = {&slots_, &above_,      &below_,  &tasks_, &top_,    &numbers_, &bins_,
                               &sums_,  &candidates_, &length_, &gains_, &owners_, &moving_,  &cost_bins_};
    std::size_t next = 0;
    for (const BufferNeed& need : optimise_memory(nodes_))
      *all[next++] = context.create_buffer(need.name, static_cast<std::size_t>(need.bytes));
    launch_light("load", "load_slots", nodes_, tree.nodes, tree.order, slots_, above_, nodes_);
    for (const cl::Buffer* marks : {&below_, &cost_bins_}) context_.fill(*marks, 0);
  }

  DeviceBvh run() {
    launch("join", "cut_loaded", 1, slots_, nodes_ / 2, inner_per_task(nodes_), tasks_, top_, gains_, owners_,
           numbers_);
    join_cut();
    require_depth(whole().height);
    const Node root = context_.download_values<Node>(slots_, 1, GN_ROOT_SLOT).front();
    if (looks_at_rays()) send_ray_costs(root);
    units_ = units_of(box_costs({{root}, {}}, options_).front());
    if (units_ > 0.0F) run_passes(*this, options_);
    return renumber();
  }

  TreeWeight weigh() {
    join();
    const std::uint32_t chunks = runs_of(nodes_, slot_run_);
    context_.fill(bins_, 0);
    launch_costs("weigh", "weigh_slots", chunks, slots_, above_, below_, cost_bins_, bins_, sums_, units_,
                 nodes_, slot_run_);
    TreeWeight weight;
    weight.bins = context_.download_values<std::uint32_t>(bins_, GN_MEASURE_BINS);
    const auto parts = context_.download_values<std::uint64_t>(sums_, chunks);
    weight.units = std::accumulate(parts.begin(), parts.end(), std::uint64_t{0});
    weight.depth = whole().height;
    return weight;
  }

  std::uint32_t move(std::uint32_t floor) {
    context_.fill(length_, 0);
    launch("list", "list_candidates", runs_of(nodes_, slot_run_), cost_bins_, candidates_, length_, floor,
           nodes_, slot_run_);
    count_ = context_.download_values<std::uint32_t>(length_, 1).front();
    if (count_ == 0) return 0;
    moves_ = context_.create_buffer("moves", count_ * sizeof(GnMove));
    launch_costs("search", "find_moves", runs_of(count_, candidate_run_), slots_, above_, candidates_, moves_,
                 cost_bins_, std::uint32_t{options_.leave_settled}, count_, candidate_run_);
    for (const cl::Buffer* claims : {&gains_, &owners_, &moving_, &length_}) context_.fill(*claims, 0);
    launch_light("settle", "bid_gains", count_, moves_, gains_, count_);
    launch_light("settle", "bid_slots", count_, moves_, gains_, owners_, count_);
    launch_light("settle", "enter_winners", count_, moves_, gains_, owners_, moving_, count_);
    launch_light("settle", "give_way", count_, moves_, above_, moving_, length_, count_);
    launch_light("move", "make_moves", count_, slots_, above_, below_, moves_, count_);
    joined_ = false;
    return context_.download_values<std::uint32_t>(length_, 1).front();
  }

  void take_back() {
    launch_light("move", "take_back", count_, slots_, above_, moves_, count_);
    joined_ = false;
    join();
  }

  [[nodiscard]] const cl::StageTimes& times() const { return times_; }

 private:
  static std::uint32_t runs_of(std::uint32_t count, std::uint32_t run) { return (count + run - 1) / run; }

  [[nodiscard]] float w(std::size_t axis) const { return options_.face_weights.at(axis); }

  // One work-item per item; kernels ignore those past the end. On CPUs one to a group: PoCL gives each item
  // of a group its own copy of a kernel's stack.
  template <typename... Arguments>
  void launch(const char* stage, const char* name, std::uint32_t items, const Arguments&... arguments) {
    run("reinsert.cl", kFaceOptions, stage, name, items, context_.device().is_cpu ? 1 : widest(),
        arguments...);
  }

  // The same for kernels that ask what boxes cost, which are compiled without rays' where there are none.
  template <typename... Arguments>
  void launch_costs(const char* stage, const char* name, std::uint32_t items, const Arguments&... arguments) {
    if (!looks_at_rays()) {
      launch(stage, name, items, arguments..., w(0), w(1), w(2));
    } else {
      run("reinsert.cl", "-DGN_RAY_COSTS=1", stage, name, items, context_.device().is_cpu ? 1 : widest(),
          arguments..., w(0), w(1), w(2), areas_, area_count_, maps_, segments_,
          static_cast<std::uint32_t>(options_.segments.size()), per_segment_);
    }
  }

  [[nodiscard]] bool looks_at_rays() const { return !options_.areas.empty() || !options_.segments.empty(); }

  void send_ray_costs(const Node& root) {
    const float faces = gn_linear_measure(options_.face_weights.data(), root.lo, root.hi);
    AreaCosts all = area_costs(options_.areas, faces, root.lo, root.hi);
    std::vector<float> planes = segment_planes(options_.segments);
    area_count_ = static_cast<std::uint32_t>(all.areas.size());
    per_segment_ = cost_per_segment(options_, faces);
    if (all.areas.empty()) all.areas.push_back({});  // no buffer is empty
    if (all.maps.empty()) all.maps.push_back(0);
    if (planes.empty()) planes.push_back(0.0F);
    segments_ = context_.create_buffer("optimise_segments", planes.size() * sizeof(float));
    context_.upload_values<float>(segments_, planes);
    areas_ = context_.create_buffer("optimise_areas", all.areas.size() * sizeof(GnAreaCost));
    maps_ = context_.create_buffer("optimise_maps", all.maps.size() * sizeof(std::uint16_t));
    context_.upload_values<GnAreaCost>(areas_, all.areas);
    context_.upload_values<std::uint16_t>(maps_, all.maps);
  }

  // Items that do little and have no stack go in groups on CPUs too.
  template <typename... Arguments>
  void launch_light(const char* stage, const char* name, std::uint32_t items, const Arguments&... arguments) {
    run("reinsert.cl", kFaceOptions, stage, name, items, widest(), arguments...);
  }

  [[nodiscard]] std::size_t widest() const {
    return std::clamp<std::size_t>(context_.device().max_work_group, 1, 64);
  }

  template <typename... Arguments>
  void run(const char* source, const char* program_options, const char* stage, const char* name,
           std::uint32_t items, std::size_t group, const Arguments&... arguments) {
    if (items == 0) return;
    const cl::Handle<cl_kernel> kernel = context_.programs().kernel({source}, program_options, name);
    cl::set_arguments(kernel.get(), arguments...);
    const std::size_t local = items == 1 ? 1 : group;
    times_.add(stage,
               cl::enqueue(context_.queue(), kernel.get(), (items + local - 1) / local * local, local));
  }

  void read_cut() {
    const auto found = context_.download_values<std::uint32_t>(numbers_, 2);
    task_count_ = found[0];
    top_count_ = found[1];
  }

  void cut() {
    launch("join", "cut_slots", 1, slots_, below_, inner_per_task(nodes_), tasks_, top_, numbers_);
    read_cut();
  }

  // Boxes, sizes and heights from the leaves up.
  void join() {
    if (joined_) return;
    launch("join", "cut_slots", 1, slots_, below_, inner_per_task(nodes_), tasks_, top_, numbers_);
    join_cut();
  }

  void join_cut() {
    read_cut();
    launch("join", "join_subtrees", task_count_, slots_, above_, below_, tasks_, task_count_);
    launch("join", "join_top", 1, slots_, below_, top_, top_count_);
    joined_ = true;
  }

  // What is below the root.
  [[nodiscard]] GnBelow whole() const {
    const Node root = context_.download_values<Node>(slots_, 1, GN_ROOT_SLOT).front();
    if (root.count > 0) return {0, root.count, 0, 0};
    return context_.download_values<GnBelow>(below_, 1, root.first / 2).front();
  }

  DeviceBvh renumber() {
    cut();
    const GnBelow all = whole();
    DeviceBvh out;
    out.triangle_count = all.triangles;
    out.node_count = nodes_;
    out.max_depth = all.height;
    out.frame = tree_.frame;
    out.nodes = context_.create_buffer("nodes", nodes_ * sizeof(Node));
    out.order = context_.create_buffer("order", all.triangles * sizeof(std::uint32_t));
    out.leaf_triangles = context_.create_buffer("leaf_triangles", all.triangles * sizeof(GnLeafTriangle));
    const cl::Buffer places = context_.create_buffer("places", slots_of(nodes_) * 4 * sizeof(std::uint32_t));
    run("renumber.cl", kFaceOptions, "renumber", "write_top", 1, 1, slots_, below_, tree_.order,
        tree_.leaf_triangles, out.nodes, out.order, out.leaf_triangles, top_, places, top_count_);
    run("renumber.cl", kFaceOptions, "renumber", "write_subtrees", task_count_,
        context_.device().is_cpu ? 1 : widest(), slots_, below_, tree_.order, tree_.leaf_triangles, out.nodes,
        out.order, out.leaf_triangles, tasks_, places, task_count_);
    return out;
  }

  const cl::Context& context_;
  const DeviceBvh& tree_;
  const OptimiseOptions& options_;
  std::uint32_t nodes_;
  std::uint32_t slot_run_ = kSlotRun;
  std::uint32_t candidate_run_ = kCandidateRun;
  std::uint32_t task_count_ = 0;
  std::uint32_t top_count_ = 0;
  std::uint32_t count_ = 0;  // candidates of the last pass
  std::uint32_t area_count_ = 0;
  float per_segment_ = 0.0F;
  float units_ = 0.0F;
  bool joined_ = false;  // boxes and sizes are those of the links
  cl::StageTimes times_;
  cl::Buffer slots_, above_, below_, tasks_, top_, numbers_, bins_, sums_, candidates_, length_, gains_,
      owners_, moving_, cost_bins_, moves_, areas_, maps_, segments_;
};

// A search looks at two boxes for each pair below and two for each node above, and at each segment for each.
void heed_segment_limit(const cl::DeviceInfo& device, std::size_t segments) {
  constexpr std::uint64_t kBoxes = 2 * (GN_SEARCH_PAIRS + GN_MOST_DEPTH);
  if (device.loop_limit == 0 || segments * kBoxes <= device.loop_limit) return;
  throw Error(ErrorCode::kInvalidArgument,
              device.name + " ends loops after " + std::to_string(device.loop_limit) +
                  " turns, too few to weigh boxes by " + std::to_string(segments) +
                  " segments; give at most " + std::to_string(device.loop_limit / kBoxes) +
                  " or use another device");
}

}  // namespace

std::vector<BufferNeed> optimise_memory(std::uint64_t nodes) {
  const std::uint64_t slots = slots_of(std::max<std::uint64_t>(1, nodes));
  constexpr std::uint64_t kWord = sizeof(std::uint32_t);
  return {
      {"slots", slots * sizeof(GnNode), true},
      {"above", pairs_of(slots) * kWord, true},
      {"below", pairs_of(slots) * sizeof(GnBelow), true},
      {"optimise_subtrees", slots * kWord, true},
      {"optimise_top", slots * kWord, true},
      {"optimise_numbers", 2 * kWord, true},
      {"cost_bins", GN_MEASURE_BINS * kWord, true},
      {"cost_sums", slots * sizeof(std::uint64_t), true},
      {"candidates", slots * kWord, true},
      {"candidate_count", kWord, true},
      {"gains", slots * kWord, true},
      {"owners", slots * kWord, true},
      {"moving", slots * kWord, true},
      {"slot_bins", slots * sizeof(std::uint16_t), true},
  };
}

void heed_optimise_limit(const cl::DeviceInfo& device, std::uint64_t nodes) {
  if (device.loop_limit == 0 || nodes * kTurnsPerNode <= device.loop_limit) return;
  throw Error(ErrorCode::kInvalidArgument,
              device.name + " ends loops after " + std::to_string(device.loop_limit) +
                  " turns, too few to optimise a tree of " + std::to_string(nodes) +
                  " nodes; use builder balanced or another device");
}

DeviceBvh optimise_device(const cl::Context& context, const DeviceBvh& tree, const OptimiseOptions& options,
                          BuildReport* out) {
  const auto start = std::chrono::steady_clock::now();
  options.check();
  heed_optimise_limit(context.device(), tree.node_count);
  heed_segment_limit(context.device(), options.segments.size());
  if (tree.triangle_count == 0) return upload_bvh(context, {}, {});
  Optimiser optimiser(context, tree, options);
  DeviceBvh better = optimiser.run();
  if (out != nullptr) {
    for (auto& stage : optimiser.times().milliseconds()) out->stages.push_back(std::move(stage));
    out->total_ms +=
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  return better;
}

}  // namespace gnomon
