// Dividing large triangles into parts before a tree is built over them (host/notes/best-builder.md): which triangles, how
// often, along which planes, and boxes that hold each part. For both compilers, without division. Sources: Ernst,
// Greiner 2007 (early split clipping); Karras, Aila 2013 (a budget of splits given to those whose boxes waste most, at
// planes that halve the scene again and again). Parts are boxes: the triangle itself stays whole. Feeds parts.cl and
// parts.cpp.
#ifndef GNOMON_SHARED_PARTS_MATH_H
#define GNOMON_SHARED_PARTS_MATH_H

#include "cost_math.h"
#include "shown_area.h"

// Parts of one triangle at most.
#define GN_MOST_PARTS 32u
// Planes halve the scene's longest side so many times.
#define GN_PLANE_BITS 20u
// Wasted areas are counted in bins of an eighth of a power of two.
#define GN_WASTE_BINS 2048u
#define GN_WASTE_SHIFT 20
// Of the coordinates that a clipped edge lies between: what rounding may have moved its end by.
#define GN_CLIP_ERROR 1.9073486e-6f  // 2^-19

// The planes: lo + i * cell on each axis.
typedef struct GnPlaneGrid {
  gn_f32 lo[3];
  gn_f32 scale;  // cells per unit; 0: no planes
  gn_f32 cell;   // side of a cell
  gn_f32 units;  // factor from an area to a share of the scene's; 0: too small or large a scene to tell
  gn_u32 floor;  // bin of the least wasted area that is divided; GN_NONE: none is
  gn_u32 pad;
} GnPlaneGrid;
GN_SIZE_IS(GnPlaneGrid, 32);

typedef struct GnPart {
  gn_f32 lo[3];
  gn_u32 splits;  // still to be made of it
  gn_f32 hi[3];
  gn_u32 pad;
} GnPart;
GN_SIZE_IS(GnPart, 32);

// A triangle without negative zeros: corner[i][axis].
typedef struct GnCut {
  gn_f32 corner[3][3];
} GnCut;

GN_INLINE GnPlaneGrid gn_plane_grid(const gn_f32* lo, const gn_f32* hi) {
  GnPlaneGrid grid;
  const gn_f32 extent = gn_max(hi[0] - lo[0], gn_max(hi[1] - lo[1], hi[2] - lo[2]));
  const gn_f32 area = gn_surface_measure(lo, hi);
  int k;
  for (k = 0; k < 3; ++k) grid.lo[k] = lo[k];
  grid.scale = area > 1e-24f && area < 1e38f ? gn_bin_scale(0.0f, extent, 1u << GN_PLANE_BITS) : 0.0f;
  grid.cell = extent * (1.0f / (gn_f32)(1u << GN_PLANE_BITS));
  grid.units = area > 1e-24f && area < 1e38f ? gn_reciprocal(area) : 0.0f;
  grid.floor = GN_NONE;
  grid.pad = 0u;
  return grid;
}

// How much larger a triangle's box is than the boxes of infinitely many parts would be together: half the surface of one,
// and the areas that the triangle shows each axis.
GN_INLINE gn_f32 gn_wasted_area(const GnCut* t, const gn_f32* lo, const gn_f32* hi) {
  return gn_max(gn_surface_measure(lo, hi) - gn_shown_area(t->corner[0], t->corner[1], t->corner[2]), 0.0f);
}

GN_INLINE gn_u32 gn_waste_bin(gn_f32 waste) { return gn_bits_of(waste) >> GN_WASTE_SHIFT; }

// Times a triangle is divided whose wasted area is in `bin`, when those from `floor` on are: as the square root of how
// much it is more. s parts of a long triangle waste an s-th of what it wasted, so each next part then saves as much
// whichever triangle it is of.
GN_INLINE gn_u32 gn_splits_of(gn_u32 bin, gn_u32 floor) {
  const gn_f32 waste = gn_float_of(bin << GN_WASTE_SHIFT), least = gn_float_of(floor << GN_WASTE_SHIFT);
  gn_u32 splits = 0u;
  if (bin < floor) return 0u;
  while (splits < GN_MOST_PARTS - 1u) {
    const gn_f32 next = (gn_f32)(splits + 1u);
    if (!(next * next * least <= waste)) return splits;
    splits += 1u;
  }
  return splits;
}

GN_INLINE gn_u32 gn_cell_of(gn_f32 x, gn_f32 lo, gn_f32 scale) { return gn_bin_of(x, lo, scale, 1u << GN_PLANE_BITS); }

// The plane across `axis` that halves the most of the scene of all that pass through the box; 0: none does.
GN_INLINE int gn_plane_through(const GnPlaneGrid* grid, const GnPart* part, int axis, gn_f32* plane) {
  const gn_u32 from = gn_cell_of(part->lo[axis], grid->lo[axis], grid->scale);
  const gn_u32 to = gn_cell_of(part->hi[axis], grid->lo[axis], grid->scale);
  gn_u32 mask = from ^ to;
  // All ones from the highest bit that differs.
  mask |= mask >> 1;
  mask |= mask >> 2;
  mask |= mask >> 4;
  mask |= mask >> 8;
  mask |= mask >> 16;
  *plane = gn_without_negative_zero(grid->lo[axis] + (gn_f32)(to & ~(mask >> 1)) * grid->cell);
  return mask != 0u && part->lo[axis] < *plane && *plane < part->hi[axis];
}

// The plane that divides a part: across its longest side that has one. axis 3: none.
GN_INLINE int gn_part_plane(const GnPlaneGrid* grid, const GnPart* part, gn_f32* plane) {
  int axis, best = 3;
  gn_f32 longest = GN_SMALLEST_EXTENT;
  for (axis = 0; axis < 3; ++axis) {
    const gn_f32 side = part->hi[axis] - part->lo[axis];
    gn_f32 at;
    if (side > longest && gn_plane_through(grid, part, axis, &at)) {
      longest = side;
      *plane = at;
      best = axis;
    }
  }
  return best;
}

GN_INLINE void gn_grow_part(GnPart* part, const gn_f32* lo, const gn_f32* hi) {
  int k;
  for (k = 0; k < 3; ++k) {
    part->lo[k] = gn_min(part->lo[k], lo[k]);
    part->hi[k] = gn_max(part->hi[k], hi[k]);
  }
}

// Where the edge from a to b, on either side of the plane, passes it: a box that holds the point for certain.
GN_INLINE void gn_edge_at(const gn_f32* a, const gn_f32* b, int axis, gn_f32 plane, gn_f32* lo, gn_f32* hi) {
  const gn_f32 share = (plane - a[axis]) * gn_reciprocal(b[axis] - a[axis]);
  int k;
  for (k = 0; k < 3; ++k) {
    const gn_f32 at = a[k] + share * (b[k] - a[k]);
    const gn_f32 error = GN_CLIP_ERROR * (gn_abs(a[k]) + gn_abs(b[k]));
    lo[k] = gn_max(at - error, gn_min(a[k], b[k]));
    hi[k] = gn_min(at + error, gn_max(a[k], b[k]));
  }
  lo[axis] = hi[axis] = plane;
}

// What of the triangle lies on either side of the plane, as boxes; empty ones are inverted.
GN_INLINE void gn_cut_triangle(const GnCut* t, int axis, gn_f32 plane, GnPart* left, GnPart* right) {
  int i;
  gn_empty_box(left->lo, left->hi);
  gn_empty_box(right->lo, right->hi);
  for (i = 0; i < 3; ++i) {
    const gn_f32* a = t->corner[i];
    const gn_f32* b = t->corner[i == 2 ? 0 : i + 1];
    if (a[axis] <= plane) gn_grow_part(left, a, a);
    if (a[axis] >= plane) gn_grow_part(right, a, a);
    if ((a[axis] < plane && b[axis] > plane) || (a[axis] > plane && b[axis] < plane)) {
      const int rising = a[axis] < b[axis];
      gn_f32 lo[3], hi[3];
      gn_edge_at(rising ? a : b, rising ? b : a, axis, plane, lo, hi);
      gn_grow_part(left, lo, hi);
      gn_grow_part(right, lo, hi);
    }
  }
}

// What a box shares with another one; 0 where that is nothing.
GN_INLINE int gn_clip_part(GnPart* part, const GnPart* whole) {
  int k, some = 1;
  for (k = 0; k < 3; ++k) {
    part->lo[k] = gn_without_negative_zero(gn_max(part->lo[k], whole->lo[k]));
    part->hi[k] = gn_without_negative_zero(gn_min(part->hi[k], whole->hi[k]));
    some &= part->lo[k] <= part->hi[k];
  }
  return some;
}

GN_INLINE gn_f32 gn_longest_side(const GnPart* part) {
  return gn_max(part->hi[0] - part->lo[0], gn_max(part->hi[1] - part->lo[1], part->hi[2] - part->lo[2]));
}

// Divides a part in two and its remaining splits among them by their longest sides. Returns how many parts there are then:
// one where no plane passes, or where the triangle keeps to one side of it.
GN_INLINE int gn_divide_part(const GnPlaneGrid* grid, const GnCut* t, GnPart* part, GnPart* right) {
  GnPart left;
  gn_f32 plane = 0.0f, a, b;
  gn_u32 rest = part->splits - 1u, share;
  const int axis = gn_part_plane(grid, part, &plane);
  int some_left, some_right;
  part->splits = 0u;
  if (axis == 3) return 1;
  gn_cut_triangle(t, axis, plane, &left, right);
  some_left = gn_clip_part(&left, part);
  some_right = gn_clip_part(right, part);
  left.pad = right->pad = 0u;
  if (!some_left && !some_right) return 1;
  if (!some_left || !some_right) {
    *part = some_left ? left : *right;
    part->splits = rest;
    return 1;
  }
  a = gn_longest_side(&left);
  b = gn_longest_side(right);
  share = a + b > GN_SMALLEST_EXTENT ? (gn_u32)((gn_f32)rest * a * gn_reciprocal(a + b) + 0.5f) : 0u;
  left.splits = share < rest ? share : rest;
  right->splits = rest - left.splits;
  *part = left;
  return 2;
}

// The parts of a triangle, one after the other. Before the first: parts[0] is the whole triangle's box with its splits, and
// *height is 1. Returns 0 when there are no more.
GN_INLINE int gn_next_part(const GnPlaneGrid* grid, const GnCut* t, GnPart* parts, gn_u32* height, GnPart* out) {
  if (*height == 0u) return 0;
  while (parts[*height - 1u].splits > 0u) {
    GnPart left = parts[*height - 1u], right;
    if (gn_divide_part(grid, t, &left, &right) == 2) {
      parts[*height - 1u] = right;
      parts[*height] = left;
      *height += 1u;
    } else {
      parts[*height - 1u] = left;
    }
  }
  *height -= 1u;
  *out = parts[*height];
  return 1;
}

#endif
