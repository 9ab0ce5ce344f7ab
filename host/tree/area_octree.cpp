// A cell keeps the areas that hold all of it, drops those that it does not meet, and is divided while others
// are left. Whether an area holds the cell is asked of the cell's corners; the thesis' program asked it of
// the frustum's own, which is never so, and divided every cell inside one down to the last level.
#include "gnomon/tree/area_octree.h"

#include <algorithm>
#include <map>
#include <string>

#include "gnomon/base/error.h"

namespace gnomon {
namespace {

constexpr std::uint32_t kMostLevels = 9;
constexpr std::size_t kMostCells = std::size_t{1} << 26U;

struct CellBox {
  float lo[3];
  float hi[3];
};

Box3d to_box3d(const CellBox& cell) {
  Box3d box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.lo[k] = static_cast<double>(cell.lo[k]);
    box.hi[k] = static_cast<double>(cell.hi[k]);
  }
  return box;
}

// As gn_octree_step halves it: closed boxes that share their faces.
CellBox child_of(const CellBox& parent, unsigned number) {
  CellBox child = parent;
  for (unsigned k = 0; k < 3; ++k) {
    const float middle = 0.5F * (parent.lo[k] + parent.hi[k]);
    ((number >> k & 1U) != 0 ? child.lo[k] : child.hi[k]) = middle;
  }
  return child;
}

class OctreeBuilder {
 public:
  OctreeBuilder(std::span<const InfluenceArea> areas, const OctreeOptions& options, TopLevel& top)
      : areas_(areas), options_(options), top_(top) {}

  // `kept` hold all of the cell's parent; `open` only meet it.
  void fill(std::size_t cell, const CellBox& box, std::vector<std::uint32_t> kept,
            const std::vector<std::uint32_t>& open, std::uint32_t level) {
    const Box3d extent = to_box3d(box);
    std::vector<std::uint32_t> colliding;
    for (const std::uint32_t area : open) {
      if (!areas_[area].overlaps(extent)) continue;
      (areas_[area].fully_contains(extent) ? kept : colliding).push_back(area);
    }
    if (colliding.empty() || level == options_.max_level) {
      if (!options_.conservative) kept.insert(kept.end(), colliding.begin(), colliding.end());
      std::sort(kept.begin(), kept.end());
      top_.cells[cell] = {GN_NONE, place_of(kept), static_cast<std::uint32_t>(kept.size()), 0};
      return;
    }
    const std::size_t first = top_.cells.size();
    if (first + 8 > kMostCells) {
      throw Error(ErrorCode::kOutOfMemory,
                  "the octree has more than 2^26 cells at max_level " + std::to_string(options_.max_level));
    }
    top_.cells.resize(first + 8);
    top_.cells[cell] = {static_cast<std::uint32_t>(first), 0, 0, 0};
    for (unsigned number = 0; number < 8; ++number)
      fill(first + number, child_of(box, number), kept, colliding, level + 1);
  }

 private:
  std::uint32_t place_of(const std::vector<std::uint32_t>& set) {
    const auto [entry, added] = places_.try_emplace(set, static_cast<std::uint32_t>(top_.cell_areas.size()));
    if (added) top_.cell_areas.insert(top_.cell_areas.end(), set.begin(), set.end());
    return entry->second;
  }

  std::span<const InfluenceArea> areas_;
  const OctreeOptions& options_;
  TopLevel& top_;
  std::map<std::vector<std::uint32_t>, std::uint32_t> places_;
};

}  // namespace

void append_octree(std::span<const InfluenceArea> areas, const OctreeOptions& options, TopLevel& top) {
  if (options.max_level > kMostLevels) {
    throw Error(ErrorCode::kInvalidArgument,
                "octree max_level = " + std::to_string(options.max_level) + " is outside its range 0..9");
  }
  CellBox root{};
  std::copy_n(top.boxes.front().lo, 3, root.lo);
  std::copy_n(top.boxes.front().hi, 3, root.hi);
  std::vector<std::uint32_t> all(areas.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint32_t>(i);
  top.cells.resize(1);
  OctreeBuilder(areas, options, top).fill(0, root, {}, all, 0);
}

}  // namespace gnomon
