// Building the octree of top_level.h. Feeds top_level.cpp alone.
#pragma once

#include "gnomon/tree/top_level.h"

namespace gnomon {

// Fills in cells and cell_areas; top.boxes.front() is the root's box, around all areas. Throws as
// build_top_level.
void append_octree(std::span<const InfluenceArea> areas, const OctreeOptions& options, TopLevel& top);

}  // namespace gnomon
