#include "gnomon/tree/build_reference.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "gnomon/shared/axis_policy.h"
#include "gnomon/tree/build_best_reference.h"
#include "gnomon/tree/build_fast_reference.h"

namespace gnomon {

namespace {

constexpr float kCoordinateLimit = 281474976710656.0F;  // 2^48, as prepare.cl

// Everything the recursion shares.
struct BuildState {
  const BuildOptions& options;
  std::span<const Triangle> triangles;
  GnHeuristic heuristic;
  std::vector<GnPrimitive> primitives;
  std::vector<Node> sparse;
  std::vector<bool> is_split;
  std::vector<GnTask> open;
  SplitTally tally;
};

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

// Where a primitive's bins are taken: twice the middle of its box, or for the published builder three times
// the barycentre of its triangle.
float key_of(const BuildState& builder, const GnPrimitive& primitive, std::uint32_t axis) {
  if (!builder.options.published_leaves.on) return primitive.lo[axis] + primitive.hi[axis];
  const Triangle& t = builder.triangles[primitive.index];
  return t.v0[axis] + t.v1[axis] + t.v2[axis];
}

// Bounds of the keys, on one axis.
std::pair<float, float> key_bounds(const BuildState& builder, const GnTask& task, std::uint32_t axis) {
  if (!builder.options.published_leaves.on) return {task.centroid_lo[axis], task.centroid_hi[axis]};
  return {3.0F * task.lo[axis], 3.0F * task.hi[axis]};
}

float bin_scale_on_axis(const BuildState& builder, const GnTask& task, std::uint32_t axis) {
  const auto [lo, hi] = key_bounds(builder, task, axis);
  return gn_bin_scale(lo, hi, builder.options.bins);
}

std::uint32_t bin_on_axis(const BuildState& builder, const GnPrimitive& primitive, const GnTask& task,
                          std::uint32_t axis) {
  const float base = key_bounds(builder, task, axis).first;
  // Rounding may leave a barycentre below its box; middles never are.
  const float key = gn_max(key_of(builder, primitive, axis), base);
  return gn_bin_of(key, base, bin_scale_on_axis(builder, task, axis), builder.options.bins);
}

struct Bins {
  std::vector<GnBin> boxes;
  std::vector<std::uint32_t> counts;
};

// Bins of all three axes, axis after axis.
Bins bins_of(const BuildState& builder, const GnTask& task, std::uint32_t usable) {
  const std::uint32_t bins = builder.options.bins;
  Bins out{std::vector<GnBin>(3 * std::size_t{bins}), std::vector<std::uint32_t>(3 * std::size_t{bins})};
  for (GnBin& box : out.boxes) gn_empty_box(box.lo, box.hi);
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    if ((usable >> axis & 1U) == 0) continue;
    for (std::uint32_t i = task.begin; i < task.end; ++i) {
      const GnPrimitive& p = builder.primitives[i];
      const std::uint32_t bin = axis * bins + bin_on_axis(builder, p, task, axis);
      out.counts[bin] += 1;
      for (int k = 0; k < 3; ++k) {
        out.boxes[bin].lo[k] = gn_min(p.lo[k], out.boxes[bin].lo[k]);
        out.boxes[bin].hi[k] = gn_max(p.hi[k], out.boxes[bin].hi[k]);
      }
    }
  }
  return out;
}

GnNodeView view_of(const BuildState& builder, const GnTask& task) {
  GnNodeView node{};
  std::copy_n(task.lo, 3, node.lo);
  std::copy_n(task.hi, 3, node.hi);
  node.probability = task.probability;
  node.count = task.end - task.begin;
  node.depth = task.depth;
  node.how = task.how;
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    if (bin_scale_on_axis(builder, task, axis) > 0.0F) node.usable |= 1U << axis;
  }
  return node;
}

GnSplit choose_split(const BuildState& builder, const GnNodeView& node, int how, const GnTask& task,
                     GnPolicyEffort& effort) {
  GnSplit best = gn_no_split();
  if (node.count < 2 || task.depth >= builder.heuristic.rules.median_depth) return best;
  const std::uint32_t bins = builder.options.bins;
  const std::uint32_t planes = bins - 1 - (builder.options.published_leaves.on ? 1 : 0);
  const Bins binned = bins_of(builder, task, node.usable);
  if (builder.options.axes != AxisPolicy::kAll) {
    return gn_policy_split(&builder.heuristic, how, &node, binned.boxes.data(), binned.counts.data(), planes,
                           bins, &effort);
  }
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    if ((node.usable >> axis & 1U) == 0) continue;
    effort.axes += 1;
    const GnSplit split = gn_sweep_axis(&builder.heuristic.measure, how, &binned.boxes[axis * bins],
                                        &binned.counts[axis * bins], planes, bins, axis, node.count);
    if (split.axis != GN_NONE && (best.axis == GN_NONE || gn_split_is_better(&split, &best, node.count)))
      best = split;
  }
  return best;
}

// Stable, so that leaf order does not depend on how the work is cut.
std::uint32_t partition(BuildState& builder, const GnTask& task, const GnSplit& split) {
  const auto first = builder.primitives.begin() + task.begin;
  const auto last = builder.primitives.begin() + task.end;
  if (split.axis == GN_NONE) return task.begin + (task.end - task.begin) / 2;
  const auto middle = std::stable_partition(first, last, [&](const GnPrimitive& p) {
    return bin_on_axis(builder, p, task, split.axis) <= split.plane;
  });
  return static_cast<std::uint32_t>(middle - builder.primitives.begin());
}

void count_split(SplitTally& tally, const GnSplit& split, const GnPolicyEffort& effort) {
  tally.inner_nodes += 1;
  if (split.axis != GN_NONE) tally.split_on[split.axis] += 1;
  if (effort.fallback_axis != GN_NONE) tally.fallback_on[effort.fallback_axis] += 1;
}

// how: its parent's parts were measured.
void push_child(BuildState& builder, const GnTask& task, int how, float probability) {
  GnTask child = task;
  child.how = static_cast<std::uint32_t>(how);
  child.probability = probability;
  measure_range(builder.primitives, child);
  builder.open.push_back(child);
}

GnTask task_of(std::uint32_t begin, std::uint32_t end, std::uint32_t slot, std::uint32_t depth) {
  GnTask task{};
  task.begin = begin;
  task.end = end;
  task.slot = slot;
  task.depth = depth;
  return task;
}

void build_node(BuildState& builder, const GnTask& task) {
  const GnNodeView view = view_of(builder, task);
  const int how =
      gn_measure_how_below(&builder.heuristic.measure, static_cast<int>(task.how), task.lo, task.hi);
  GnPolicyEffort effort{0, GN_NONE};
  const GnSplit split = choose_split(builder, view, how, task, effort);
  builder.tally.axes_tried += effort.axes;
  Node node{};
  std::copy_n(task.lo, 3, node.lo);
  std::copy_n(task.hi, 3, node.hi);
  if (gn_becomes_leaf(&builder.heuristic, how, &view, &split) != 0) {
    node.first = task.begin;
    node.count = task.end - task.begin;
  } else {
    count_split(builder.tally, split, effort);
    const std::uint32_t middle = partition(builder, task, split);
    node.first = 2 * middle;
    builder.is_split[middle] = true;
    push_child(builder, task_of(task.begin, middle, 2 * middle, task.depth + 1), how, split.left_measure);
    push_child(builder, task_of(middle, task.end, 2 * middle + 1, task.depth + 1), how, split.right_measure);
  }
  builder.sparse[task.slot] = node;
}

}  // namespace

void throw_bad_coordinate(std::uint32_t triangle) {
  throw Error(ErrorCode::kBadScene,
              "triangle " + std::to_string(triangle) +
                  " has a coordinate that is not finite or beyond 2^48; drop or repair it");
}

GnPrimitive primitive_of(const Triangle& triangle, std::uint32_t index) {
  GnPrimitive primitive{};
  primitive.index = index;
  for (int k = 0; k < 3; ++k) {
    for (const float x : {triangle.v0[k], triangle.v1[k], triangle.v2[k]}) {
      if (!(std::fabs(x) <= kCoordinateLimit)) throw_bad_coordinate(index);
    }
    primitive.lo[k] =
        gn_without_negative_zero(gn_min(gn_min(triangle.v0[k], triangle.v1[k]), triangle.v2[k]));
    primitive.hi[k] =
        gn_without_negative_zero(gn_max(gn_max(triangle.v0[k], triangle.v1[k]), triangle.v2[k]));
  }
  return primitive;
}

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

Bvh build_over_primitives(std::vector<GnPrimitive> primitives, std::span<const Triangle> triangles,
                          const BuildOptions& options, SplitTally* tally) {
  Bvh bvh;
  if (primitives.empty()) return bvh;
  const auto count = static_cast<std::uint32_t>(primitives.size());
  BuildState builder{options, triangles, {}, std::move(primitives), {}, {}, {}, {}};
  if (tally != nullptr) builder.tally = *tally;
  builder.sparse.resize(2 * static_cast<std::size_t>(count));
  builder.is_split.resize(count);
  push_child(builder, task_of(0, count, 0, 0), GN_SEEN_PRECISE, GN_FLOAT_MAX);
  builder.heuristic = heuristic_of(options, builder.open.back().lo, builder.open.back().hi);
  while (!builder.open.empty()) {
    const GnTask task = builder.open.back();
    builder.open.pop_back();
    build_node(builder, task);
  }
  if (tally != nullptr) *tally = builder.tally;
  bvh.nodes = compact_nodes(builder.sparse, builder.is_split);
  bvh.primitives.reserve(count);
  for (const GnPrimitive& p : builder.primitives) bvh.primitives.push_back(p.index);
  return bvh;
}

Bvh build_reference(std::span<const Triangle> triangles, const BuildOptions& options, SplitTally* tally) {
  options.check();
  if (options.builder == Builder::kFast) return build_fast_reference(triangles, options);
  if (options.builder == Builder::kBest) return build_best_reference(triangles, options);
  std::vector<GnPrimitive> primitives;
  primitives.reserve(triangles.size());
  for (const Triangle& triangle : triangles)
    primitives.push_back(primitive_of(triangle, static_cast<std::uint32_t>(primitives.size())));
  return build_over_primitives(std::move(primitives), triangles, options, tally);
}

}  // namespace gnomon
