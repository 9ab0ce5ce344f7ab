#include "gnomon/device/build_fast.h"

#include <algorithm>
#include <map>
#include <string>

#include "gnomon/cl/launch.h"
#include "gnomon/cl/program.h"
#include "gnomon/device/build_plan.h"
#include "gnomon/device/level_loop.h"
#include "gnomon/device/radix_sort.h"
#include "gnomon/shared/fast_math.h"
#include "gnomon/tree/build_fast_reference.h"
#include "gnomon/tree/build_reference.h"

namespace gnomon {

namespace {

const std::vector<std::string> kSources = {"morton.cl", "ploc.cl", "assemble.cl"};
constexpr std::uint32_t kCodeBits = 30;

// How a build is cut into work for one device. Changes speed, never the tree.
struct FastPlan {
  std::uint32_t count = 0;
  std::uint32_t work_group_size = 0;
  std::uint32_t item_group_size = 0;
  SortPlan sort;
  [[nodiscard]] std::uint32_t segments() const { return (count + GN_SEGMENT - 1) / GN_SEGMENT; }
  [[nodiscard]] std::uint64_t most_clusters() const {
    return std::min<std::uint64_t>(count, std::uint64_t{segments()} * GN_SEGMENT_CLUSTERS);
  }
  // In memory that all work-groups share; the serial flavour's are in its own.
  [[nodiscard]] std::uint64_t merges() const {
    return work_group_size == 1 ? 1 : std::uint64_t{segments()} * GN_SEGMENT;
  }
  [[nodiscard]] std::string program_options() const {
    return "-DGN_WGS=" + std::to_string(work_group_size) + " -DGN_KIND=0u";
  }
};

// Turns that one work-item of merge_segments takes at most: those that count are the serial flavour's, four
// loops over the clusters a round, where rounds merge two each until they need not choose.
constexpr std::uint32_t kTurnsPerCluster = 4 * GN_FREE_ROUNDS + 16;

void heed_loop_limit(const FastPlan& plan, const cl::DeviceInfo& device) {
  const std::uint32_t limit = device.loop_limit;
  const std::uint64_t longest =
      std::max({std::uint64_t{GN_SEGMENT} * kTurnsPerCluster, std::uint64_t{plan.sort.chunk_size},
                2 * plan.most_clusters(), std::uint64_t{plan.sort.chunks()} << plan.sort.digit_bits});
  if (limit == 0 || longest <= limit) return;
  throw Error(ErrorCode::kInvalidArgument, device.name + " ends loops after " + std::to_string(limit) +
                                               " turns, too few for builder fast and " +
                                               std::to_string(plan.count) +
                                               " triangles; use builder balanced or another device");
}

FastPlan plan_fast(const cl::DeviceInfo& device, std::uint64_t count, const BuildOptions& options) {
  options.check();
  const BuildPlan general = plan_build(device, count, options_over_clusters(options));
  FastPlan plan;
  plan.count = general.count;
  plan.work_group_size = general.work_group_size;
  plan.item_group_size = general.item_group_size;
  plan.sort = plan_sort(device, general.count, general.work_group_size, options.chunk_size);
  heed_loop_limit(plan, device);
  return plan;
}

std::vector<BufferNeed> own_buffers(const FastPlan& plan) {
  const std::uint64_t n = std::max(1U, plan.count);
  const std::uint64_t clusters = plan.most_clusters();
  return {
      {"bounds", plan.sort.chunks() * sizeof(GnBounds), true},
      {"first_bad", sizeof(std::uint32_t), true},
      {"keys", n * sizeof(GnMortonKey), true},
      {"spare_keys", n * sizeof(GnMortonKey), true},
      {"digits", plan.sort.table_bytes(), true},
      {"sorted_triangles", n * sizeof(GnLeafTriangle), true},
      {"merges", plan.merges() * sizeof(GnMerge), true},
      {"parts", std::uint64_t{plan.segments()} * GN_SEGMENT_NODES * sizeof(GnNode), true},
      {"remaining", std::uint64_t{plan.segments()} * GN_SEGMENT_CLUSTERS * sizeof(GnCluster), true},
      {"first_clusters", (plan.segments() + 1ULL) * sizeof(std::uint32_t), true},
      {"clusters", clusters * sizeof(GnCluster), true},
      {"stand_ins", clusters * sizeof(Triangle), true},
      {"first_triangles", (clusters + 1) * sizeof(std::uint32_t), true},
      {"first_splits", (clusters + 1) * sizeof(std::uint32_t), true},
      {"cluster_leaves", clusters * sizeof(std::uint32_t), true},
      {"triangles", n * sizeof(Triangle), true},
      {"nodes", 2 * n * sizeof(GnNode), false},
      {"order", n * sizeof(std::uint32_t), false},
      {"leaf_triangles", n * sizeof(GnLeafTriangle), false},
  };
}

class FastBuilder {
 public:
  FastBuilder(const cl::Context& context, const BuildOptions& options, const FastPlan& plan, cl_mem triangles)
      : context_(context), options_(options), plan_(plan), triangles_(triangles) {
    for (const BufferNeed& need : own_buffers(plan)) sizes_.emplace(need.name, need.bytes);
  }

  DeviceBvh run(const Progress& progress, BuildReport* out) {
    report(progress, "build: sort", 0.0);
    sort_along_curve();
    report(progress, "build: merge", 0.3);
    merge();
    report(progress, "build: tree over clusters", 0.7);
    BuildReport top_report;
    const DeviceBvh top = build_device(context_, stand_ins_.mem.get(), cluster_count_,
                                       options_over_clusters(options_), &top_report);
    report(progress, "build: assemble", 0.8);
    DeviceBvh tree = assemble(top);
    if (out != nullptr) add_stages(top_report, *out);
    return tree;
  }

 private:
  cl::Buffer allocate(const std::string& name) {
    return context_.create_buffer(name, static_cast<std::size_t>(sizes_.at(name)));
  }

  template <typename... Arguments>
  void launch(const char* stage, const char* name, std::size_t global, std::size_t local,
              const Arguments&... arguments) {
    const cl::Handle<cl_kernel> kernel = context_.programs().kernel(kSources, plan_.program_options(), name);
    cl::set_arguments(kernel.get(), arguments...);
    times_.add(stage, cl::enqueue(context_.queue(), kernel.get(), global, local));
  }

  // One work-group per item.
  template <typename... Arguments>
  void launch_groups(const char* stage, const char* name, std::size_t groups, const Arguments&... arguments) {
    launch(stage, name, groups * plan_.work_group_size, plan_.work_group_size, arguments...);
  }

  // One work-item per element; the kernel ignores those past the end.
  template <typename... Arguments>
  void launch_items(const char* stage, const char* name, std::size_t items, const Arguments&... arguments) {
    const std::size_t local = plan_.item_group_size;
    launch(stage, name, (items + local - 1) / local * local, local, arguments...);
  }

  void scan(const cl::Buffer& values, std::uint32_t count) {
    scan_values(context_, plan_.sort, values, count, "assemble", times_);
  }

  GnMortonFrame bound() {
    const std::uint32_t chunks = plan_.sort.chunks();
    const cl::Buffer bounds = allocate("bounds");
    const cl::Buffer first_bad = allocate("first_bad");
    context_.fill(first_bad, GN_NONE);
    launch_groups("bound", "bound_centroids", chunks, triangles_, bounds, first_bad, plan_.count,
                  plan_.sort.chunk_size);
    GnBounds all = empty_bounds();
    for (const GnBounds& part : context_.download_values<GnBounds>(bounds, chunks)) grow(all, part);
    const std::uint32_t bad = context_.download_values<std::uint32_t>(first_bad, 1).front();
    if (bad != GN_NONE) throw_bad_coordinate(bad);
    return gn_morton_frame(all.lo, all.hi);
  }

  void sort_along_curve() {
    const GnMortonFrame frame = bound();
    keys_ = allocate("keys");
    spare_keys_ = allocate("spare_keys");
    const cl::Buffer table = allocate("digits");
    const auto sort_by = [&](std::uint32_t fine, std::uint32_t again) {
      launch_groups("codes", "assign_codes", plan_.sort.chunks(), triangles_, keys_, frame.lo[0], frame.lo[1],
                    frame.lo[2], frame.scale, fine, again, plan_.count, plan_.sort.chunk_size);
      radix_sort(context_, plan_.sort, keys_, spare_keys_, table, kCodeBits, times_);
    };
    sort_by(0, 0);
    const std::uint32_t whole = plan_.count / GN_SEGMENT;
    if (whole == 0) return;
    const cl::Buffer crowded = context_.create_buffer("crowded", sizeof(std::uint32_t));
    context_.fill(crowded, 0);
    launch_items("codes", "find_crowded", whole, keys_, crowded, whole);
    if (context_.download_values<std::uint32_t>(crowded, 1).front() == 0) return;
    // A whole segment in one cell: the lower bits of cells' numbers first, then, stably, the upper ones.
    sort_by(1, 0);
    sort_by(0, 1);
  }

  void merge() {
    const std::uint32_t segments = plan_.segments();
    sorted_ = allocate("sorted_triangles");
    parts_ = allocate("parts");
    first_cluster_ = allocate("first_clusters");
    const cl::Buffer merges = allocate("merges");
    const cl::Buffer remaining = allocate("remaining");
    launch_groups("merge", "merge_segments", segments, triangles_, keys_, merges, sorted_, parts_, remaining,
                  first_cluster_, plan_.count, options_.cost_traversal, options_.cost_triangle,
                  options_.max_leaf_size);
    scan(first_cluster_, segments);
    cluster_count_ = context_.download_values<std::uint32_t>(first_cluster_, 1, segments).front();
    clusters_ = context_.create_buffer("clusters", cluster_count_ * sizeof(GnCluster));
    stand_ins_ = context_.create_buffer("stand_ins", cluster_count_ * sizeof(Triangle));
    launch_items("assemble", "list_clusters", segments, remaining, first_cluster_, clusters_, stand_ins_,
                 segments);
  }

  DeviceBvh assemble(const DeviceBvh& top) {
    const std::uint32_t m = cluster_count_;
    const cl::Buffer first_triangle =
        context_.create_buffer("first_triangles", (m + std::size_t{1}) * sizeof(std::uint32_t));
    const cl::Buffer first_split =
        context_.create_buffer("first_splits", (m + std::size_t{1}) * sizeof(std::uint32_t));
    const cl::Buffer leaves = context_.create_buffer("cluster_leaves", m * sizeof(std::uint32_t));
    launch_items("assemble", "measure_clusters", m, clusters_, top.order, first_triangle, first_split, leaves,
                 m);
    scan(first_triangle, m);
    scan(first_split, m);
    DeviceBvh tree;
    tree.triangle_count = plan_.count;
    tree.node_count = 2 * context_.download_values<std::uint32_t>(first_split, 1, m).front() - 1;
    tree.nodes = context_.create_buffer("nodes", tree.node_count * sizeof(Node));
    tree.order = allocate("order");
    tree.leaf_triangles = allocate("leaf_triangles");
    const cl::Buffer deepest = context_.create_buffer("deepest", sizeof(std::uint32_t));
    context_.fill(deepest, 0);
    launch_items("assemble", "emit_top", m, top.nodes, top.order, clusters_, first_triangle, first_split,
                 tree.nodes, deepest, m);
    launch_groups("assemble", "emit_clusters", plan_.segments(), sorted_, parts_, clusters_, first_cluster_,
                  leaves, first_triangle, first_split, tree.nodes, tree.order, tree.leaf_triangles);
    tree.max_depth = context_.download_values<std::uint32_t>(deepest, 1).front();
    return tree;
  }

  // The tree over the clusters counts as one stage.
  void add_stages(const BuildReport& top, BuildReport& out) const {
    double top_ms = 0.0;
    for (const auto& [stage, ms] : top.stages) top_ms += ms;
    out.stages = times_.milliseconds();
    if (!top.stages.empty()) out.stages.emplace_back("tree over clusters", top_ms);
  }

  const cl::Context& context_;
  const BuildOptions& options_;
  const FastPlan& plan_;
  cl_mem triangles_;
  std::map<std::string, std::uint64_t> sizes_;
  cl::StageTimes times_;
  std::uint32_t cluster_count_ = 0;
  cl::Buffer keys_, spare_keys_, sorted_, parts_, first_cluster_, clusters_, stand_ins_;
};

}  // namespace

std::vector<BufferNeed> fast_memory(const cl::DeviceInfo& device, std::uint64_t count,
                                    const BuildOptions& options) {
  const FastPlan plan = plan_fast(device, count, options);
  std::vector<BufferNeed> needs = own_buffers(plan);
  for (BufferNeed& need : build_memory(device, plan.most_clusters(), options_over_clusters(options))) {
    if (need.name == "triangles") continue;  // the stand-ins
    needs.push_back({"clusters: " + need.name, need.bytes, true});
  }
  return needs;
}

DeviceBvh build_fast(const cl::Context& context, cl_mem triangles, std::uint32_t count,
                     const BuildOptions& options, BuildReport* out, const Progress& progress) {
  const FastPlan plan = plan_fast(context.device(), count, options);
  return FastBuilder(context, options, plan, triangles).run(progress, out);
}

}  // namespace gnomon
