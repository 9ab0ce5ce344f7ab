#include "gnomon/tree/refit.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "gnomon/base/error.h"
#include "gnomon/shared/cost_math.h"
#include "gnomon/tree/box_frame.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/regions.h"

namespace gnomon {

namespace {

std::vector<GnPrimitive> checked_boxes(std::span<const GnTriangle> triangles) {
  std::vector<GnPrimitive> boxes;
  boxes.reserve(triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) boxes.push_back(primitive_of(triangles[i], i));
  return boxes;
}

template <typename Box, typename Other>
void grow(Box& box, const Other& other) {
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = gn_min(other.lo[k], box.lo[k]);
    box.hi[k] = gn_max(other.hi[k], box.hi[k]);
  }
}

// Parents before children.
std::vector<std::uint32_t> from_the_root(const Bvh& bvh) {
  std::vector<std::uint32_t> order;
  std::vector<std::uint32_t> open{0};
  while (!open.empty()) {
    const std::uint32_t node = open.back();
    open.pop_back();
    order.push_back(node);
    if (bvh.nodes[node].count > 0) continue;
    open.push_back(bvh.nodes[node].first);
    open.push_back(bvh.nodes[node].first + 1);
  }
  return order;
}

class WideRefit {
 public:
  WideRefit(WideBvh& wide, std::span<const GnTriangle> triangles)
      : wide_(wide), triangles_(triangles), boxes_(checked_boxes(triangles)) {}

  // The box of all that is below the node. Depth is that of the tree: recursion is shallow.
  GnPrimitive node(std::uint32_t index) {
    GnPrimitive whole{};
    gn_empty_box(whole.lo, whole.hi);
    for (std::uint32_t slot = 0; slot < GN_WIDTH; ++slot) {
      const std::uint32_t link = wide_.nodes[index].links[slot];
      if (link == GN_NONE) continue;
      const GnPrimitive box = (link & GN_LEAF_LINK) != 0 ? leaf(link) : node(link);
      grow(whole, box);
      for (int k = 0; k < 3; ++k) {
        wide_.nodes[index].planes[2 * k][slot] = box.lo[k];
        wide_.nodes[index].planes[2 * k + 1][slot] = box.hi[k];
      }
    }
    return whole;
  }

 private:
  GnPrimitive leaf(std::uint32_t link) {
    const GnLeaf leaf = gn_leaf_at(wide_.leaves.data(), link);
    GnPrimitive box{};
    gn_empty_box(box.lo, box.hi);
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
      const std::uint32_t seat = gn_seat_in(leaf, i);
      const std::uint32_t number = number_in(wide_, seat);
      put_triangle(wide_, seat, triangles_[number]);
      grow(box, boxes_[number]);
    }
    return box;
  }

  WideBvh& wide_;
  std::span<const GnTriangle> triangles_;
  std::vector<GnPrimitive> boxes_;
};

std::size_t triangles_of(const WideBvh& wide) {
  std::size_t count = 0;
  for (const WideNode& node : wide.nodes) {
    for (const std::uint32_t link : node.links)
      if (link != GN_NONE && (link & GN_LEAF_LINK) != 0) count += gn_leaf_at(wide.leaves.data(), link).count;
  }
  return count;
}

}  // namespace

void require_count(std::size_t given, std::size_t built) {
  if (given == built) return;
  throw Error(ErrorCode::kInvalidArgument,
              "a tree of " + std::to_string(built) + " triangles cannot be refitted to " +
                  std::to_string(given) +
                  " (builder best counts those it divides more than once); build a new "
                  "one");
}

void refit_reference(Bvh& bvh, std::span<const GnTriangle> triangles) {
  require_count(triangles.size(), bvh.primitives.size());
  refuse_frame(bvh.frame, "refitting");
  if (triangles.empty()) return;
  const std::vector<GnPrimitive> boxes = checked_boxes(triangles);
  const std::vector<std::uint32_t> order = from_the_root(bvh);
  for (auto index = order.rbegin(); index != order.rend(); ++index) {
    Node& node = bvh.nodes[*index];
    gn_empty_box(node.lo, node.hi);
    for (std::uint32_t i = 0; i < node.count; ++i) grow(node, boxes[bvh.primitives[node.first + i]]);
    for (std::uint32_t side = 0; side < 2 && node.count == 0; ++side)
      grow(node, bvh.nodes[node.first + side]);
  }
}

void refit_reference(WideBvh& wide, std::span<const GnTriangle> triangles) {
  refuse_frame(wide.frame, "refitting");
  refuse_regions(wide.regions, "refitting");
  require_count(triangles.size(), triangles_of(wide));
  if (!triangles.empty()) static_cast<void>(WideRefit(wide, triangles).node(0));
}

}  // namespace gnomon
