// Flat convex polygons in space, as seen from the origin: cutting, solid angle, areas in projections. For weighing a few
// large boxes precisely; far boxes need none of it. No divisions by devices' own rules (elementary_math.h).
// A polygon is up to GN_MAX_CORNERS corners, x y z after one another. Feeds seen_measure.h.
#ifndef GNOMON_SHARED_POLYGON_MATH_H
#define GNOMON_SHARED_POLYGON_MATH_H

#include "elementary_math.h"

// A face has four corners, and each of at most five cuts adds one.
#define GN_MAX_CORNERS 10

// Keeps what lies where x * px + y * py + z * pz + offset >= 0 (Sutherland & Hodgman 1974); returns the corners left. Most
// polygons are all on one side. scratch: another array.
GN_INLINE gn_u32 gn_cut_polygon(gn_f32* polygon, gn_u32 count, const gn_f32* plane, gn_f32 offset, gn_f32* scratch) {
  gn_f32 at[GN_MAX_CORNERS];
  gn_u32 i, inside = 0u, kept = 0u;
  for (i = 0u; i < count; ++i) {
    at[i] = gn_dot(polygon + 3u * i, plane) + offset;
    inside += at[i] >= 0.0f ? 1u : 0u;
  }
  if (inside == count || inside == 0u) return inside;
  for (i = 0u; i < count; ++i) {
    const gn_u32 next = i + 1u == count ? 0u : i + 1u;
    const gn_f32* a = polygon + 3u * i;
    const gn_f32* b = polygon + 3u * next;
    if (at[i] >= 0.0f && kept < GN_MAX_CORNERS) {
      scratch[3u * kept] = a[0];
      scratch[3u * kept + 1u] = a[1];
      scratch[3u * kept + 2u] = a[2];
      kept += 1u;
    }
    if ((at[i] >= 0.0f) != (at[next] >= 0.0f) && kept < GN_MAX_CORNERS) {
      const gn_f32 span = gn_abs(at[i]) + gn_abs(at[next]);
      const gn_f32 t = span < 1.17549435e-38f ? 0.5f : gn_abs(at[i]) * gn_reciprocal(span);
      scratch[3u * kept] = a[0] + t * (b[0] - a[0]);
      scratch[3u * kept + 1u] = a[1] + t * (b[1] - a[1]);
      scratch[3u * kept + 2u] = a[2] + t * (b[2] - a[2]);
      kept += 1u;
    }
  }
  for (i = 0u; i < 3u * kept; ++i) polygon[i] = scratch[i];
  return kept;
}

// Solid angle of a triangle as half its angle's direction (x, y): y = |a . (b x c)|, x = the rest of Van Oosterom &
// Strackee's quotient (IEEE Trans. Biomed. Eng. 1983). la, lb, lc: lengths of a, b, c. The product is taken from the edges,
// which loses nothing where the triangle is small.
GN_INLINE void gn_triangle_half_angle(const gn_f32* a, gn_f32 la, const gn_f32* b, gn_f32 lb, const gn_f32* c, gn_f32 lc,
                                      gn_f32* x, gn_f32* y) {
  const gn_f32 ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
  const gn_f32 vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
  *y = gn_abs(a[0] * (uy * vz - uz * vy) + a[1] * (uz * vx - ux * vz) + a[2] * (ux * vy - uy * vx));
  *x = la * lb * lc + gn_dot(a, b) * lc + gn_dot(a, c) * lb + gn_dot(b, c) * la;
}

// Solid angle of the polygon from the origin, at most 2 pi: half angles of a fan of triangles add up, as arguments of a
// product of complex numbers, to at most pi.
GN_INLINE gn_f32 gn_polygon_solid_angle(const gn_f32* polygon, gn_u32 count) {
  gn_f32 x = 1.0f, y = 0.0f, first_length, last_length;
  gn_u32 i;
  if (count < 3u) return 0.0f;
  first_length = gn_root(gn_dot(polygon, polygon));
  last_length = gn_root(gn_dot(polygon + 3, polygon + 3));
  for (i = 2u; i < count; ++i) {
    const gn_f32* corner = polygon + 3u * i;
    const gn_f32 length = gn_root(gn_dot(corner, corner));
    gn_f32 half_x, half_y, size, product_x;
    gn_triangle_half_angle(polygon, first_length, corner - 3, last_length, corner, length, &half_x, &half_y);
    last_length = length;
    size = gn_max(gn_abs(half_x), half_y);
    if (size < 1e-30f) continue;  // a triangle without extent
    size = gn_reciprocal(size);
    half_x *= size;
    half_y *= size;
    product_x = x * half_x - y * half_y;
    y = x * half_y + y * half_x;
    x = product_x;
  }
  return 2.0f * gn_angle_of(gn_max(y, 0.0f), x);
}

// Area of the polygon (x, y, ignoring z) by Gauss's formula from its first corner.
GN_INLINE gn_f32 gn_polygon_flat_area(const gn_f32* polygon, gn_u32 count) {
  gn_f32 twice = 0.0f;
  gn_u32 i;
  for (i = 2u; i < count; ++i) {
    const gn_f32 ax = polygon[3u * i - 3u] - polygon[0], ay = polygon[3u * i - 2u] - polygon[1];
    const gn_f32 bx = polygon[3u * i] - polygon[0], by = polygon[3u * i + 1u] - polygon[1];
    twice += ax * by - ay * bx;
  }
  return 0.5f * gn_abs(twice);
}

// Projects the polygon (all z > 0) onto the plane z = 1.
GN_INLINE void gn_project_polygon(gn_f32* polygon, gn_u32 count) {
  gn_u32 i;
  for (i = 0u; i < count; ++i) {
    const gn_f32 scale = gn_reciprocal(polygon[3u * i + 2u]);
    polygon[3u * i] *= scale;
    polygon[3u * i + 1u] *= scale;
    polygon[3u * i + 2u] = 1.0f;
  }
}

#endif
