#include "gnomon/device/forest.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include "gnomon/areas/grown_area.h"
#include "gnomon/areas/shared_area.h"

namespace gnomon {
namespace {

constexpr std::size_t kMostEntries = GN_NONE - 1;

double ms_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

// The box no ray meets.
Node empty_root() {
  Node node{};
  std::fill_n(node.lo, 3, std::numeric_limits<float>::infinity());
  std::fill_n(node.hi, 3, -std::numeric_limits<float>::infinity());
  node.count = 1;
  return node;
}

// The buffers' contents while trees are added.
struct Assembly {
  std::vector<Node> nodes;
  std::vector<std::uint32_t> order;

  // Appends a tree over triangles[names[i]], or over all of them where there are no names.
  ForestTree append(const Bvh& bvh, const std::vector<std::uint32_t>* names, std::uint32_t max_depth) {
    if (nodes.size() + bvh.nodes.size() > kMostEntries || order.size() + bvh.primitives.size() > kMostEntries)
      throw Error(ErrorCode::kOutOfMemory,
                  "the trees of a forest have more than 2^32 - 2 nodes or triangles");
    ForestTree tree;
    tree.node_count = static_cast<std::uint32_t>(bvh.nodes.size());
    tree.triangle_count = static_cast<std::uint32_t>(bvh.primitives.size());
    tree.max_depth = max_depth;
    tree.first_place = static_cast<std::uint32_t>(order.size());
    const auto first_node = static_cast<std::uint32_t>(nodes.size());
    if (tree.node_count > 0) tree.root = first_node;
    for (Node node : bvh.nodes) {
      node.first += node.count > 0 ? tree.first_place : first_node;
      nodes.push_back(node);
    }
    for (const std::uint32_t primitive : bvh.primitives)
      order.push_back(names == nullptr ? primitive : (*names)[primitive]);
    return tree;
  }
};

// A tree over some of the triangles.
ForestTree add_tree(const cl::Context& context, std::span<const Triangle> triangles,
                    const std::vector<std::uint32_t>* names, const BuildOptions& options,
                    Assembly& assembly) {
  std::vector<Triangle> gathered;
  if (names != nullptr) {
    gathered.reserve(names->size());
    for (const std::uint32_t name : *names) gathered.push_back(triangles[name]);
  }
  const DeviceBvh tree = build_device(context, names == nullptr ? triangles : gathered, options);
  return assembly.append(download_bvh(context, tree), names, tree.max_depth);
}

// The region whose triangles the local tree holds and in which rays may ask it.
InfluenceArea grown_of(const LocalTree& wanted) {
  if (!(wanted.growth >= 0.0 && wanted.growth <= 1.0)) {
    throw Error(ErrorCode::kInvalidArgument,
                "growth = " + std::to_string(wanted.growth) + " is outside its range 0..1");
  }
  const Box3d box = wanted.area.enclosing_box();
  return grown_by(wanted.area, wanted.growth * larger(magnitude(box.lo), magnitude(box.hi)));
}

GnArea shared_of(const LocalTree& wanted, const InfluenceArea& grown, const ForestTree& tree) {
  GnArea shared = to_shared(grown, wanted.affinity_tolerance);
  // The rays' own eye, not the one that growing moved back.
  std::copy_n(to_shared(wanted.area).focus, 3, shared.focus);
  shared.root = tree.root;
  return shared;
}

}  // namespace

std::uint32_t DeviceForest::max_depth() const {
  std::uint32_t deepest = global.max_depth;
  for (const ForestTree& tree : local) deepest = std::max(deepest, tree.max_depth);
  return deepest;
}

std::uint64_t DeviceForest::local_bytes() const {
  std::uint64_t sum = 0;
  for (const ForestTree& tree : local)
    sum += tree.node_count * sizeof(Node) + tree.triangle_count * sizeof(std::uint32_t);
  return sum;
}

DeviceForest build_forest(const cl::Context& context, std::span<const Triangle> triangles,
                          std::span<const LocalTree> local_trees, const BuildOptions& global_options,
                          ForestReport* out, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  ForestReport times;
  DeviceForest forest;
  forest.triangle_count = static_cast<std::uint32_t>(triangles.size());
  Assembly assembly;
  report(progress, "forest: global tree", 0.0);
  forest.global = add_tree(context, triangles, nullptr, global_options, assembly);
  times.global_ms = ms_since(start);
  if (assembly.nodes.empty()) assembly.nodes.push_back(empty_root());
  for (const LocalTree& wanted : local_trees) {
    report(progress, "forest: local trees",
           static_cast<double>(forest.local.size() + 1) / static_cast<double>(local_trees.size() + 1));
    const auto before = std::chrono::steady_clock::now();
    forest.areas.push_back(grown_of(wanted));
    const std::vector<std::uint32_t> names = members(forest.areas.back(), triangles, wanted.membership);
    times.members_ms.push_back(ms_since(before));
    const auto between = std::chrono::steady_clock::now();
    forest.local.push_back(add_tree(context, triangles, &names, wanted.options, assembly));
    times.local_ms.push_back(ms_since(between));
    forest.shared_areas.push_back(shared_of(wanted, forest.areas.back(), forest.local.back()));
  }
  forest.triangles = context.create_buffer("triangles", triangles.size_bytes());
  forest.nodes = context.create_buffer("forest_nodes", assembly.nodes.size() * sizeof(Node));
  forest.order = context.create_buffer("forest_order", assembly.order.size() * sizeof(std::uint32_t));
  context.upload_values<Triangle>(forest.triangles, triangles);
  context.upload_values<Node>(forest.nodes, assembly.nodes);
  context.upload_values<std::uint32_t>(forest.order, assembly.order);
  times.total_ms = ms_since(start);
  if (out != nullptr) *out = times;
  return forest;
}

}  // namespace gnomon
