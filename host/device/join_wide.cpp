#include "gnomon/device/join_wide.h"

#include <algorithm>
#include <bit>

#include "gnomon/cl/launch.h"
#include "gnomon/cl/program.h"
#include "gnomon/tree/box_frame.h"

namespace gnomon {

namespace {

class Joiner {
 public:
  explicit Joiner(const cl::Context& context) : context_(context) {}

  // Puts a tree behind what is there.
  void add(const DeviceWideBvh& tree, DeviceWideBvh& out) {
    launch("join_nodes", tree.node_count, tree.nodes, out.nodes, out.node_count, out.place_count,
           tree.node_count);
    launch("join_leaves", tree.place_count, tree.leaves, out.leaves, out.place_count, tree.place_count);
    out.node_count += tree.node_count;
    out.place_count += tree.place_count;
    out.depth = std::max(out.depth, tree.depth);
  }

 private:
  template <typename... Arguments>
  void launch(const char* name, std::uint32_t items, const Arguments&... arguments) {
    if (items == 0) return;
    const cl::Handle<cl_kernel> kernel = context_.programs().kernel({"join_wide.cl"}, "", name);
    cl::set_arguments(kernel.get(), arguments...);
    const auto local = static_cast<std::size_t>(
        std::bit_floor(std::min<std::uint64_t>(context_.device().max_work_group, 64)));
    static_cast<void>(
        cl::enqueue(context_.queue(), kernel.get(), (items + local - 1) / local * local, local));
  }

  const cl::Context& context_;
};

}  // namespace

DeviceWideBvh join_wide(const cl::Context& context, const DeviceWideBvh& all,
                        std::span<const DeviceWideBvh> local, std::span<const Region> regions) {
  std::vector<TreeSize> sizes{{all.node_count, all.place_count}};
  for (const DeviceWideBvh& tree : local) sizes.push_back({tree.node_count, tree.place_count});
  refuse_frame(all.frame, "joining local trees to a tree");
  refuse_regions(all.regions, "joining local trees to a tree");
  for (const DeviceWideBvh& tree : local) {
    refuse_frame(tree.frame, "joining local trees to a tree");
    refuse_regions(tree.regions, "joining local trees to a tree");
  }
  check_join(sizes, regions.size());
  TreeSize sum;
  for (const TreeSize& size : sizes) {
    sum.nodes += size.nodes;
    sum.places += size.places;
  }
  DeviceWideBvh out;
  out.triangle_count = all.triangle_count;
  out.nodes = context.create_buffer("wide_nodes", sum.nodes * sizeof(WideNode));
  out.leaves = leaf_buffer(context, static_cast<std::uint32_t>(sum.places));
  Joiner joiner(context);
  joiner.add(all, out);
  for (std::size_t i = 0; i < local.size(); ++i) {
    out.regions.push_back(regions[i]);
    out.regions.back().root = out.node_count;
    joiner.add(local[i], out);
  }
  return out;
}

DeviceWideBvh collapse_with_regions(const cl::Context& context, const DeviceBvh& all,
                                    std::span<const Triangle> triangles, std::span<const RegionTree> local,
                                    std::span<const float> slot_keys, std::span<const float> weights) {
  DeviceWideBvh wide = collapse_device(context, all, {}, nullptr, slot_keys, weights);
  if (local.empty()) return wide;
  std::vector<DeviceWideBvh> trees;
  std::vector<Region> regions;
  for (const RegionTree& one : local) {
    const DeviceBvh tree = upload_bvh(context, one.bvh, triangles);
    trees.push_back(collapse_device(context, tree, {}, nullptr, one.ranks, one.weights));
    regions.push_back(one.region);
  }
  return join_wide(context, wide, trees, regions);
}

}  // namespace gnomon
