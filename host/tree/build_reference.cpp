#include "gnomon/tree/build_reference.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "gnomon/shared/cost_math.h"

namespace gnomon {

namespace {

constexpr float kCoordinateLimit = 281474976710656.0F;  // 2^48, as prepare.cl

// Everything the recursion shares.
struct Builder {
  const BuildOptions& options;
  std::vector<GnPrimitive> primitives;
  std::vector<Node> sparse;
  std::vector<bool> is_split;
  std::vector<GnTask> open;
};

GnPrimitive primitive_of(const Triangle& triangle, std::uint32_t index) {
  GnPrimitive primitive{};
  primitive.index = index;
  for (int k = 0; k < 3; ++k) {
    for (const float x : {triangle.v0[k], triangle.v1[k], triangle.v2[k]}) {
      if (!(std::fabs(x) <= kCoordinateLimit)) {
        throw Error(ErrorCode::kBadScene,
                    "triangle " + std::to_string(index) +
                        " has a coordinate that is not finite or beyond 2^48; drop or repair it");
      }
    }
    primitive.lo[k] =
        gn_without_negative_zero(gn_min(gn_min(triangle.v0[k], triangle.v1[k]), triangle.v2[k]));
    primitive.hi[k] =
        gn_without_negative_zero(gn_max(gn_max(triangle.v0[k], triangle.v1[k]), triangle.v2[k]));
  }
  return primitive;
}

// Bounds of the boxes and of the doubled centroids of a range.
void measure_range(const std::vector<GnPrimitive>& primitives, GnTask& task) {
  gn_empty_box(task.lo, task.hi);
  gn_empty_box(task.centroid_lo, task.centroid_hi);
  for (std::uint32_t i = task.begin; i < task.end; ++i) {
    const GnPrimitive& p = primitives[i];
    for (int k = 0; k < 3; ++k) {
      task.lo[k] = gn_min(p.lo[k], task.lo[k]);
      task.hi[k] = gn_max(p.hi[k], task.hi[k]);
      task.centroid_lo[k] = gn_min(p.lo[k] + p.hi[k], task.centroid_lo[k]);
      task.centroid_hi[k] = gn_max(p.lo[k] + p.hi[k], task.centroid_hi[k]);
    }
  }
}

std::uint32_t bin_on_axis(const GnPrimitive& primitive, const GnTask& task, std::uint32_t axis,
                          std::uint32_t bins) {
  const float scale = gn_bin_scale(task.centroid_lo[axis], task.centroid_hi[axis], bins);
  return gn_bin_of(primitive.lo[axis] + primitive.hi[axis], task.centroid_lo[axis], scale, bins);
}

GnSplit best_split_on_axis(const Builder& builder, const GnTask& task, std::uint32_t axis) {
  const std::uint32_t bins = builder.options.bins;
  GnBin boxes[GN_MAX_BINS];
  std::uint32_t counts[GN_MAX_BINS] = {};
  for (GnBin& box : boxes) gn_empty_box(box.lo, box.hi);
  for (std::uint32_t i = task.begin; i < task.end; ++i) {
    const GnPrimitive& p = builder.primitives[i];
    const std::uint32_t bin = bin_on_axis(p, task, axis, bins);
    counts[bin] += 1;
    for (int k = 0; k < 3; ++k) {
      boxes[bin].lo[k] = gn_min(p.lo[k], boxes[bin].lo[k]);
      boxes[bin].hi[k] = gn_max(p.hi[k], boxes[bin].hi[k]);
    }
  }
  return gn_sweep_axis(boxes, counts, bins, axis, task.end - task.begin);
}

GnSplit choose_split(const Builder& builder, const GnTask& task) {
  const std::uint32_t count = task.end - task.begin;
  GnSplit best{GN_INFINITY, GN_NONE, 0, 0};
  if (count < 2 || task.depth >= builder.options.median_depth) return best;
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    if (gn_bin_scale(task.centroid_lo[axis], task.centroid_hi[axis], builder.options.bins) <= 0.0F) continue;
    const GnSplit split = best_split_on_axis(builder, task, axis);
    if (split.axis != GN_NONE && (best.axis == GN_NONE || gn_split_is_better(&split, &best, count)))
      best = split;
  }
  return best;
}

bool becomes_leaf(const BuildOptions& options, const GnTask& task, const GnSplit& split) {
  const std::uint32_t count = task.end - task.begin;
  if (count > options.max_leaf_size) return false;
  if (count == 1) return true;
  return gn_leaf_is_better(&split, gn_box_measure(task.lo, task.hi), count, options.cost_traversal,
                           options.cost_triangle) != 0;
}

// Stable, so that leaf order does not depend on how the work is cut.
std::uint32_t partition(Builder& builder, const GnTask& task, const GnSplit& split) {
  const auto first = builder.primitives.begin() + task.begin;
  const auto last = builder.primitives.begin() + task.end;
  if (split.axis == GN_NONE) return task.begin + (task.end - task.begin) / 2;
  const auto middle = std::stable_partition(first, last, [&](const GnPrimitive& p) {
    return bin_on_axis(p, task, split.axis, builder.options.bins) <= split.plane;
  });
  return static_cast<std::uint32_t>(middle - builder.primitives.begin());
}

void push_child(Builder& builder, std::uint32_t begin, std::uint32_t end, std::uint32_t slot,
                std::uint32_t depth) {
  GnTask child{};
  child.begin = begin;
  child.end = end;
  child.slot = slot;
  child.depth = depth;
  measure_range(builder.primitives, child);
  builder.open.push_back(child);
}

void build_node(Builder& builder, const GnTask& task) {
  const GnSplit split = choose_split(builder, task);
  Node node{};
  std::copy_n(task.lo, 3, node.lo);
  std::copy_n(task.hi, 3, node.hi);
  if (becomes_leaf(builder.options, task, split)) {
    node.first = task.begin;
    node.count = task.end - task.begin;
  } else {
    const std::uint32_t middle = partition(builder, task, split);
    node.first = 2 * middle;
    builder.is_split[middle] = true;
    push_child(builder, task.begin, middle, 2 * middle, task.depth + 1);
    push_child(builder, middle, task.end, 2 * middle + 1, task.depth + 1);
  }
  builder.sparse[task.slot] = node;
}

}  // namespace

std::vector<Node> compact_nodes(const std::vector<Node>& sparse, const std::vector<bool>& is_split) {
  std::vector<std::uint32_t> rank(is_split.size());
  std::uint32_t splits = 0;
  for (std::size_t m = 0; m < is_split.size(); ++m) rank[m] = is_split[m] ? splits++ : GN_NONE;
  std::vector<Node> nodes(1 + 2 * static_cast<std::size_t>(splits));
  const auto dense = [&](Node node) {
    if (node.count == 0) node.first = 1 + 2 * rank[node.first / 2];
    return node;
  };
  nodes[0] = dense(sparse[0]);
  for (std::size_t m = 0; m < is_split.size(); ++m) {
    if (!is_split[m]) continue;
    nodes[1 + 2 * static_cast<std::size_t>(rank[m])] = dense(sparse[2 * m]);
    nodes[2 + 2 * static_cast<std::size_t>(rank[m])] = dense(sparse[2 * m + 1]);
  }
  return nodes;
}

Bvh build_reference(std::span<const Triangle> triangles, const BuildOptions& options) {
  options.check();
  Bvh bvh;
  if (triangles.empty()) return bvh;
  const auto count = static_cast<std::uint32_t>(triangles.size());
  Builder builder{options, {}, {}, {}, {}};
  builder.primitives.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) builder.primitives.push_back(primitive_of(triangles[i], i));
  builder.sparse.resize(2 * static_cast<std::size_t>(count));
  builder.is_split.resize(count);
  push_child(builder, 0, count, 0, 0);
  while (!builder.open.empty()) {
    const GnTask task = builder.open.back();
    builder.open.pop_back();
    build_node(builder, task);
  }
  bvh.nodes = compact_nodes(builder.sparse, builder.is_split);
  bvh.primitives.reserve(count);
  for (const GnPrimitive& p : builder.primitives) bvh.primitives.push_back(p.index);
  return bvh;
}

}  // namespace gnomon
