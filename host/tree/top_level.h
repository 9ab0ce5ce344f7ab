// Which influence areas may hold the start of a ray: three structures over the areas' regions, flat as the
// kernels read them, with lookups in plain C++. Not for local trees (host/device/forest.h). Feeds the forest,
// the bench and the tests.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/areas/influence_area.h"
#include "gnomon/shared/area_layout.h"

namespace gnomon {

enum class AreaLookup : std::uint32_t {
  kList = 0,    // every area's box in turn
  kBvh = 1,     // a binary tree over these boxes
  kOctree = 2,  // thesis ch. "top level": cells know the regions that overlap them
};
[[nodiscard]] const char* to_string(AreaLookup lookup);

struct OctreeOptions {
  std::uint32_t max_level = 5;  // of a cell, the root's being 0; 0..9
  // Cells name only areas that hold all of them: no false candidates, but starts near a region's border lose
  // their area and go to the global tree.
  bool conservative = false;
};

// A lookup structure. Its places are areas' indices; it knows nothing else of them.
struct TopLevel {
  AreaLookup lookup = AreaLookup::kList;
  std::uint32_t area_count = 0;
  std::vector<GnAreaBox> boxes;           // list and tree; octree: its root's box alone; none without areas
  std::vector<GnAreaCell> cells;          // octree: root first
  std::vector<std::uint32_t> cell_areas;  // octree: the cells' areas, equal sets stored once
  [[nodiscard]] std::uint64_t bytes() const;
};

// Throws Error: kInvalidArgument (max_level; an area beyond float's range, see to_shared), kOutOfMemory (an
// octree of more than 2^26 cells).
[[nodiscard]] TopLevel build_top_level(std::span<const InfluenceArea> areas, AreaLookup lookup,
                                       const OctreeOptions& octree = {});

// The areas to test for a point, ascending: every area whose region has the point, and others near it. A
// conservative octree leaves some out.
[[nodiscard]] std::vector<std::uint32_t> candidates(const TopLevel& top_level, const float point[3]);

// The area whose local tree a valid ray asks: the lowest one from `from` on that has the ray's start at tmin
// for certain and is meant for its direction, or GN_NONE. The same for every structure but a conservative
// octree. The kernels' arithmetic (area_math.h) in plain C++.
struct AreaChoice {
  std::uint32_t area = GN_NONE;
  std::uint32_t tested = 0;  // regions tested exactly
};
[[nodiscard]] AreaChoice choose_area(const TopLevel& top_level, std::span<const GnArea> areas,
                                     const GnRay& ray, std::uint32_t from = 0);

}  // namespace gnomon
