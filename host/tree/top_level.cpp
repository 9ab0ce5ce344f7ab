#include "gnomon/tree/top_level.h"

#include <algorithm>

#include "gnomon/areas/shared_area.h"
#include "gnomon/base/error.h"
#include "gnomon/shared/area_math.h"
#include "gnomon/tree/area_octree.h"

namespace gnomon {
namespace {

// One area's box, as in a list of which it is entry `area`.
GnAreaBox box_of(const InfluenceArea& area, std::uint32_t index) {
  const FloatBox around = float_box_around(area.enclosing_box());
  GnAreaBox box{};
  std::copy_n(around.lo.data(), 3, box.lo);
  std::copy_n(around.hi.data(), 3, box.hi);
  box.area = index;
  box.skip = index + 1;
  return box;
}

GnAreaBox union_of(std::span<const GnAreaBox> boxes) {
  GnAreaBox all = boxes.front();
  for (const GnAreaBox& box : boxes) {
    for (int k = 0; k < 3; ++k) {
      all.lo[k] = gn_min(box.lo[k], all.lo[k]);
      all.hi[k] = gn_max(box.hi[k], all.hi[k]);
    }
    all.area = std::min(all.area, box.area);
  }
  return all;
}

// Halves by count along the axis in which the boxes' middles spread most; depth first into `out`.
void append_tree(std::span<GnAreaBox> boxes, std::vector<GnAreaBox>& out) {
  const std::size_t place = out.size();
  out.push_back(union_of(boxes));
  if (boxes.size() > 1) {
    int axis = 0;
    float widest = -1.0F;
    for (int k = 0; k < 3; ++k) {
      const auto [least, most] = std::minmax_element(boxes.begin(), boxes.end(), [&](auto& a, auto& b) {
        return a.lo[k] + a.hi[k] < b.lo[k] + b.hi[k];
      });
      const float spread = (most->lo[k] + most->hi[k]) - (least->lo[k] + least->hi[k]);
      if (spread > widest) {
        widest = spread;
        axis = k;
      }
    }
    std::sort(boxes.begin(), boxes.end(), [&](const GnAreaBox& a, const GnAreaBox& b) {
      const float at_a = a.lo[axis] + a.hi[axis];
      const float at_b = b.lo[axis] + b.hi[axis];
      return at_a < at_b || (at_a == at_b && a.area < b.area);
    });
    append_tree(boxes.first(boxes.size() / 2), out);
    append_tree(boxes.subspan(boxes.size() / 2), out);
  }
  out[place].skip = static_cast<std::uint32_t>(out.size());
}

// Calls visit(area) for every candidate until it returns true. Those of an octree come ascending.
template <typename Visit>
void visit_candidates(const TopLevel& top, const float* point, Visit&& visit) {
  if (top.boxes.empty()) return;
  if (top.lookup != AreaLookup::kOctree) {
    for (std::uint32_t i = 0; i < top.boxes.size();) {
      const GnAreaBox& box = top.boxes[i];
      if (gn_box_has(box.lo, box.hi, point) == 0) {
        i = box.skip;
        continue;
      }
      if (box.skip == i + 1 && visit(box.area)) return;
      i += 1;
    }
    return;
  }
  GnAreaBox cell_box = top.boxes.front();
  if (gn_box_has(cell_box.lo, cell_box.hi, point) == 0) return;
  const GnAreaCell* cell = top.cells.data();
  while (cell->first_child != GN_NONE)
    cell = &top.cells[cell->first_child + gn_octree_step(cell_box.lo, cell_box.hi, point)];
  for (std::uint32_t i = cell->first; i < cell->first + cell->count; ++i) {
    if (visit(top.cell_areas[i])) return;
  }
}

}  // namespace

const char* to_string(AreaLookup lookup) {
  switch (lookup) {
    case AreaLookup::kList:
      return "list";
    case AreaLookup::kBvh:
      return "bvh";
    case AreaLookup::kOctree:
      return "octree";
  }
  return "unknown";
}

std::uint64_t TopLevel::bytes() const {
  return boxes.size() * sizeof(GnAreaBox) + cells.size() * sizeof(GnAreaCell) +
         cell_areas.size() * sizeof(std::uint32_t);
}

TopLevel build_top_level(std::span<const InfluenceArea> areas, AreaLookup lookup,
                         const OctreeOptions& octree) {
  TopLevel top;
  top.lookup = lookup;
  top.area_count = static_cast<std::uint32_t>(areas.size());
  if (areas.empty()) return top;
  std::vector<GnAreaBox> boxes;
  for (const InfluenceArea& area : areas) {
    static_cast<void>(to_shared(area));  // refuses what float cannot hold
    boxes.push_back(box_of(area, static_cast<std::uint32_t>(boxes.size())));
  }
  if (lookup == AreaLookup::kList) top.boxes = boxes;
  if (lookup == AreaLookup::kBvh) append_tree(boxes, top.boxes);
  if (lookup == AreaLookup::kOctree) {
    top.boxes = {union_of(boxes)};
    top.boxes.front().skip = 1;
    append_octree(areas, octree, top);
  }
  return top;
}

std::vector<std::uint32_t> candidates(const TopLevel& top_level, const float point[3]) {
  std::vector<std::uint32_t> found;
  visit_candidates(top_level, point, [&](std::uint32_t area) {
    found.push_back(area);
    return false;
  });
  std::sort(found.begin(), found.end());
  return found;
}

AreaChoice choose_area(const TopLevel& top_level, std::span<const GnArea> areas, const GnRay& ray,
                       std::uint32_t from) {
  const GnRayStart start = gn_ray_start(&ray);
  AreaChoice choice;
  visit_candidates(top_level, start.point, [&](std::uint32_t index) {
    if (index < from || index >= choice.area) return false;
    const GnArea& area = areas[index];
    choice.tested += 1;
    if (gn_area_is_affine(&area, &start) == 0 || gn_area_contains(&area, &start) == 0) return false;
    choice.area = index;
    return top_level.lookup != AreaLookup::kBvh;
  });
  return choice;
}

}  // namespace gnomon
