#include "gnomon/device/build_best.h"

#include <algorithm>
#include <utility>

#include "gnomon/cl/launch.h"
#include "gnomon/cl/program.h"
#include "gnomon/device/build_balanced.h"
#include "gnomon/device/build_plan.h"
#include "gnomon/device/level_loop.h"
#include "gnomon/device/optimise_device.h"
#include "gnomon/device/radix_sort.h"
#include "gnomon/shared/reinsert_layout.h"
#include "gnomon/tree/build_best_reference.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/parts.h"

namespace gnomon {

namespace {

// Triangles one work-item weighs.
constexpr std::uint32_t kTriangleRun = 1024;
constexpr std::uint32_t kShortRun = 4;  // on devices of many work-items, and those that end loops

struct Parts {
  cl::Buffer primitives;
  std::uint32_t count = 0;
  GnBounds scene{};
};

// Triangles into parts.
class PartMaker {
 public:
  PartMaker(const cl::Context& context, cl_mem triangles, const BuildPlan& plan)
      : context_(context), triangles_(triangles), plan_(plan), count_(plan.count) {
    if (!context.device().is_cpu || context.device().loop_limit != 0) run_ = kShortRun;
  }

  Parts run() {
    Parts out{box_triangles(), count_, scene_};
    GnPlaneGrid grid = gn_plane_grid(scene_.lo, scene_.hi);
    const cl::Buffer wastes = context_.create_buffer("wastes", count_ * sizeof(std::uint16_t));
    grid.floor = weigh(grid, out.primitives, wastes);
    if (grid.floor == GN_NONE) return out;
    const cl::Buffer grid_buffer = context_.create_buffer("plane_grid", sizeof(GnPlaneGrid));
    context_.upload_values<GnPlaneGrid>(grid_buffer, std::span(&grid, 1));
    const cl::Buffer first =
        context_.create_buffer("first_parts", (count_ + std::size_t{1}) * sizeof(std::uint32_t));
    launch("count_parts", runs(), run_group(), triangles_, out.primitives, grid_buffer, wastes, first, count_,
           run_);
    const SortPlan sums = plan_sort(context_.device(), count_, plan_.work_group_size, 0);
    scan_values(context_, sums, first, count_, "parts", times_);
    out.count = context_.download_values<std::uint32_t>(first, 1, count_).front();
    cl::Buffer parts = context_.create_buffer("parts", out.count * sizeof(GnPrimitive));
    launch("write_parts", runs(), run_group(), triangles_, out.primitives, grid_buffer, wastes, first, parts,
           count_, run_);
    out.primitives = std::move(parts);
    return out;
  }

  [[nodiscard]] const cl::StageTimes& times() const { return times_; }

 private:
  [[nodiscard]] std::uint32_t runs() const { return (count_ + run_ - 1) / run_; }

  // One to a group on CPUs: PoCL gives each item of a group its own copy of a kernel's stack.
  [[nodiscard]] std::size_t run_group() const { return context_.device().is_cpu ? 1 : plan_.item_group_size; }

  template <typename... Arguments>
  void launch(const char* name, std::uint32_t items, std::size_t local, const Arguments&... arguments) {
    const cl::Handle<cl_kernel> kernel =
        context_.programs().kernel({"prepare.cl", "parts.cl"}, plan_.program_options(), name);
    cl::set_arguments(kernel.get(), arguments...);
    times_.add("parts",
               cl::enqueue(context_.queue(), kernel.get(), (items + local - 1) / local * local, local));
  }

  // Every triangle's box, and the scene's.
  cl::Buffer box_triangles() {
    const std::uint32_t chunks = (count_ + plan_.chunk_size - 1) / plan_.chunk_size;
    cl::Buffer boxes = context_.create_buffer("boxes", count_ * sizeof(GnPrimitive));
    const cl::Buffer bounds = context_.create_buffer("bounds", 2 * std::size_t{chunks} * sizeof(GnBounds));
    const cl::Buffer first_bad = context_.create_buffer("first_bad", sizeof(std::uint32_t));
    context_.fill(first_bad, GN_NONE);
    launch("prepare_primitives", chunks * plan_.work_group_size, plan_.work_group_size, triangles_, boxes,
           bounds, first_bad, count_, plan_.chunk_size);
    const auto all = context_.download_values<GnBounds>(bounds, 2 * std::size_t{chunks});
    const std::uint32_t bad = context_.download_values<std::uint32_t>(first_bad, 1).front();
    if (bad != GN_NONE) throw_bad_coordinate(bad);
    scene_ = empty_bounds();
    for (std::size_t i = 0; i < all.size(); i += 2) grow(scene_, all[i]);
    return boxes;
  }

  // The floor of what is divided.
  std::uint32_t weigh(const GnPlaneGrid& grid, const cl::Buffer& boxes, const cl::Buffer& wastes) {
    const cl::Buffer bins = context_.create_buffer("waste_bins", GN_WASTE_BINS * sizeof(std::uint32_t));
    context_.fill(bins, 0);
    launch("weigh_waste", runs(), run_group(), triangles_, boxes, wastes, bins, count_, run_);
    return waste_floor(context_.download_values<std::uint32_t>(bins, GN_WASTE_BINS), grid.units, kPartBudget);
  }

  const cl::Context& context_;
  cl_mem triangles_;
  const BuildPlan& plan_;
  std::uint32_t count_;
  std::uint32_t run_ = kTriangleRun;
  GnBounds scene_{};
  cl::StageTimes times_;
};

}  // namespace

std::vector<BufferNeed> best_memory(const cl::DeviceInfo& device, std::uint64_t count,
                                    const BuildOptions& options) {
  options.check();
  const std::uint64_t n = std::max<std::uint64_t>(1, count);
  const std::uint64_t parts = most_parts(n, kPartBudget);
  heed_optimise_limit(device, 2 * parts);
  std::vector<BufferNeed> needs = {
      {"boxes", n * sizeof(GnPrimitive), true},
      {"wastes", n * sizeof(std::uint16_t), true},
      {"first_parts", (n + 1) * sizeof(std::uint32_t), true},
  };
  for (BufferNeed need : plan_build(device, parts, options_over_parts(options)).buffers()) {
    if (need.name == "triangles") need.bytes = n * sizeof(Triangle);
    // The tree that is optimised goes when the better one is there.
    if (!need.scratch) needs.push_back({"parts: " + need.name, need.bytes, true});
    needs.push_back(std::move(need));
  }
  for (BufferNeed& need : optimise_memory(2 * parts)) needs.push_back(std::move(need));
  needs.push_back({"moves", 2 * parts * sizeof(GnMove), true});
  needs.push_back({"places", 2 * parts * 4 * sizeof(std::uint32_t), true});
  return needs;
}

DeviceBvh build_best(const cl::Context& context, cl_mem triangles, std::uint32_t count,
                     const BuildOptions& options, BuildReport* out, const Progress& progress) {
  const BuildOptions over_parts = options_over_parts(options);
  const BuildPlan plan = plan_build(context.device(), count, over_parts);
  report(progress, "build: parts", 0.0);
  PartMaker maker(context, triangles, plan);
  Parts parts = maker.run();
  BuildReport balanced;
  BuildReport optimised;
  const DeviceBvh tree = build_balanced(context, triangles, parts.count, std::move(parts.primitives),
                                        over_parts, &balanced, progress);
  report(progress, "build: optimise", 0.95);
  DeviceBvh better = optimise_device(
      context, tree, optimise_options(options, count, parts.scene.lo, parts.scene.hi), &optimised);
  if (out != nullptr) {
    out->stages = maker.times().milliseconds();
    for (const BuildReport* more : {&balanced, &optimised})
      out->stages.insert(out->stages.end(), more->stages.begin(), more->stages.end());
  }
  return better;
}

}  // namespace gnomon
