// The host's part of building large nodes: turning one level's results into the next level's tasks and
// chunks. Plain arithmetic on downloaded values, no OpenCL. Feeds build_device.cpp and
// build_fast.cpp; tested through them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/shared/build_layout.h"
#include "gnomon/tree/bvh.h"

namespace gnomon {

// One level of large nodes and their chunks, as the kernels read them.
struct Level {
  std::vector<GnTask> tasks;
  std::vector<GnChunk> chunks;
  std::vector<std::uint32_t> first_chunk;  // tasks + 1 entries
};

// What the level loop leaves behind.
struct LargeNodes {
  std::vector<Node> nodes;           // inner nodes, linking into the sparse array
  std::vector<std::uint32_t> slots;  // their places in it
  std::vector<GnTask> roots;         // subtrees still to build
};

// The bounds of nothing, and `box` grown to hold `other` too.
[[nodiscard]] GnBounds empty_bounds();
void grow(GnBounds& box, const GnBounds& other);

// The root task from the bounds prepare_primitives gathered: per chunk, boxes and doubled centroids.
[[nodiscard]] GnTask root_task(std::span<const GnBounds> bounds, std::uint32_t count);

// Cuts the tasks into chunks.
[[nodiscard]] Level make_level(std::vector<GnTask> tasks, std::uint32_t chunk_size);

// Enters the divided tasks' nodes and small children into `large`; returns the large children.
// bounds: four per chunk, as partition_chunks writes them.
[[nodiscard]] std::vector<GnTask> next_tasks(const Level& level, std::span<const GnChildren> children,
                                             std::span<const GnBounds> bounds, std::uint32_t subtree_size,
                                             LargeNodes& large);

}  // namespace gnomon
