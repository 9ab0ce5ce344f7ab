// A node's box as the double-precision rooms take it. Feeds this room.
#pragma once

#include "gnomon/areas/box.h"
#include "gnomon/tree/bvh.h"

namespace gnomon {

[[nodiscard]] inline Box3d box_of(const Node& node) {
  return {{node.lo[0], node.lo[1], node.lo[2]}, {node.hi[0], node.hi[1], node.hi[2]}};
}

}  // namespace gnomon
