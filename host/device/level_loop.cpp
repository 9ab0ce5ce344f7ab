#include "gnomon/device/level_loop.h"

#include <algorithm>
#include <utility>

#include "gnomon/shared/cost_math.h"

namespace gnomon {

namespace {

void set_bounds(GnTask& task, const GnBounds& box, const GnBounds& centroids) {
  std::copy_n(box.lo, 3, task.lo);
  std::copy_n(box.hi, 3, task.hi);
  std::copy_n(centroids.lo, 3, task.centroid_lo);
  std::copy_n(centroids.hi, 3, task.centroid_hi);
}

}  // namespace

GnBounds empty_bounds() {
  GnBounds box{};
  gn_empty_box(box.lo, box.hi);
  return box;
}

void grow(GnBounds& box, const GnBounds& other) {
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = gn_min(other.lo[k], box.lo[k]);
    box.hi[k] = gn_max(other.hi[k], box.hi[k]);
  }
}

GnTask root_task(std::span<const GnBounds> bounds, std::uint32_t count) {
  GnBounds box = empty_bounds();
  GnBounds centroids = empty_bounds();
  for (std::size_t i = 0; i < bounds.size(); i += 2) {
    grow(box, bounds[i]);
    grow(centroids, bounds[i + 1]);
  }
  GnTask task{};
  task.end = count;
  task.probability = GN_FLOAT_MAX;
  task.how = GN_SEEN_PRECISE;
  set_bounds(task, box, centroids);
  return task;
}

Level make_level(std::vector<GnTask> tasks, std::uint32_t chunk_size) {
  Level level;
  level.tasks = std::move(tasks);
  for (std::uint32_t t = 0; t < level.tasks.size(); ++t) {
    level.first_chunk.push_back(static_cast<std::uint32_t>(level.chunks.size()));
    const GnTask& task = level.tasks[t];
    for (std::uint32_t begin = task.begin; begin < task.end;
         begin += std::min(chunk_size, task.end - begin)) {
      GnChunk chunk{};
      chunk.task = t;
      chunk.begin = begin;
      chunk.end = begin + std::min(chunk_size, task.end - begin);
      level.chunks.push_back(chunk);
    }
  }
  level.first_chunk.push_back(static_cast<std::uint32_t>(level.chunks.size()));
  return level;
}

std::vector<GnTask> next_tasks(const Level& level, std::span<const GnChildren> children,
                               std::span<const GnBounds> bounds, std::uint32_t subtree_size,
                               LargeNodes& large) {
  std::vector<GnTask> next;
  for (std::size_t t = 0; t < level.tasks.size(); ++t) {
    const GnTask& task = level.tasks[t];
    const bool halved = task.axis == GN_NONE;
    GnBounds centroids[2] = {empty_bounds(), empty_bounds()};
    GnBounds boxes[2] = {empty_bounds(), empty_bounds()};
    for (std::size_t chunk = level.first_chunk[t]; chunk < level.first_chunk[t + 1]; ++chunk) {
      for (std::size_t side = 0; side < 2; ++side) {
        grow(centroids[side], bounds[4 * chunk + side]);
        grow(boxes[side], bounds[4 * chunk + 2 + side]);
      }
    }
    const std::uint32_t middle = task.begin + task.left_count;
    Node node{};
    std::copy_n(task.lo, 3, node.lo);
    std::copy_n(task.hi, 3, node.hi);
    node.first = 2 * middle;
    large.nodes.push_back(node);
    large.slots.push_back(task.slot);
    for (std::uint32_t side = 0; side < 2; ++side) {
      const GnBounds& from_bins = side == 0 ? children[t].left_box : children[t].right_box;
      GnTask child{};
      child.begin = side == 0 ? task.begin : middle;
      child.end = side == 0 ? middle : task.end;
      child.slot = 2 * middle + side;
      child.depth = task.depth + 1;
      child.buffer = task.buffer ^ 1U;
      child.how = task.how;
      child.probability = side == 0 ? task.left_measure : task.right_measure;
      set_bounds(child, halved ? boxes[side] : from_bins, centroids[side]);
      (child.end - child.begin > subtree_size ? next : large.roots).push_back(child);
    }
  }
  return next;
}

}  // namespace gnomon
