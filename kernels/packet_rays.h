// Up to 64 rays that run close together, taken as one packet: all through a common point (camera rays; shadow rays of a
// point light), or all parallel (a sun's). Not for tracing them. Feeds packet_leaf.h and packet_walk.h.
#ifndef GNOMON_PACKET_RAYS_H
#define GNOMON_PACKET_RAYS_H

#include "packet_choice.h"
#include "sixteen.h"
#include "wide_leaf.h"

#define GN_PACKET 64u
#define GN_GROUPS 4u  // of sixteen rays

// The packet's main axis kz is that of its first ray's largest direction component; shears are the two other components
// over that one. Rays through a point, the apex, differ by their shears; parallel ones by where they pass the apex.
// slide_x and slide_y are that difference; packet_edges in packet_leaf.h builds on it.
typedef struct GnPacket {
  // Per ray, a vector for each group of sixteen.
  float16 origin[3][GN_GROUPS];  // as boxes stand; directions' inverses too
  float16 inverse[3][GN_GROUPS];
#if GN_FRAME
  float16 main_inverse[GN_GROUPS];  // along the main axis, as triangles stand
  GnBoxFrame frame;
  float margin;  // that widens boxes
#endif
#if GN_REGIONS
  float16 direction[3][GN_GROUPS];
#endif
  float16 tmin[GN_GROUPS];
  float16 tmax[GN_GROUPS];
  float16 limit[GN_GROUPS];  // of box entries still of interest
  float16 nearest[GN_GROUPS];  // the nearest hit so far lies between nearest and farthest; +inf before the first
  float16 farthest[GN_GROUPS];
  float16 slide_x[GN_GROUPS];
  float16 slide_y[GN_GROUPS];
  float16 start[GN_GROUPS];  // from the apex to the origin along the main axis
  uint16 seat[GN_GROUPS];    // of the triangle that floats found
#if GN_FAST
  float16 hit_u[GN_GROUPS];  // where in it
  float16 hit_v[GN_GROUPS];
#endif
  uint active[GN_GROUPS];    // a bit for each ray still traced
  uint found[GN_GROUPS];
  uint pending[GN_GROUPS];  // found by floats, exact values not known
  GnHit best[GN_PACKET];    // of those found and not pending
  // Bounds over all rays.
  float near_origin[3], far_origin[3];      // of the origins, those that meet near planes first and far planes last
  float least_inverse[3], most_inverse[3];  // in magnitude
  uint near_side[3];                        // byte offset of the planes met first, per axis
  float tmin_of_all;
  float limit_of_all;
  float apex[3];
  float shear_x, shear_y;            // of the middle
  float reach_x, reach_y;            // the largest |slide|
  float most_shear_x, most_shear_y;  // the largest |shear|
  float most_shear;                  // at least the larger plus the reach of shears
  float extra;  // what origins and a vague apex add to distances in error bounds
  uint kx, ky, kz;
  uint parallel;
  uint groups;
  uint first;  // ray of the batch
  GnPacketWork work;
#if GN_COUNTERS
  uint boxes[GN_GROUPS + 1u];  // the last: tested for all rays at once
  uint triangles[GN_GROUPS];
#endif
} GnPacket;

#if GN_FRAME
#define GN_MAIN_INVERSE(p, g) (p)->main_inverse[g]
#define GN_SCENE_SIZE(nodes) (2.0f * size_of_root(nodes))  // frames halve the scene
#else
#define GN_MAIN_INVERSE(p, g) (p)->inverse[(p)->kz][g]
#define GN_SCENE_SIZE(nodes) size_of_root(nodes)
#endif

// Error bounds of packet_leaf.h count on these.
#define GN_SHEAR_LIMIT 1.25f
#define GN_PENCIL_WIDTH 0.125f
#define GN_PACKET_FAR 1e18f  // of origins and the apex: products of edges and distances do not overflow
#define GN_PACKET_UNDERFLOW 1e-30f

// Parallel rays further apart than this share of the scene would meet different parts of it (host/notes/packets.md).
#define GN_BUNDLE_WIDTH 0.25f

// The scene's largest extent; not above 0 where it is empty.
static inline float size_of_root(__global const GnWideNode* root) {
  float size = 0.0f;
  uint k, i;
  for (k = 0u; k < 3u; ++k) {
    float low = root->planes[2u * k][0], high = root->planes[2u * k + 1u][0];
    for (i = 1u; i < GN_WIDTH; ++i) {
      low = gn_min(root->planes[2u * k][i], low);
      high = gn_max(root->planes[2u * k + 1u][i], high);
    }
    size = gn_max(high - low, size);
  }
  return size;
}

// Turns the batch's rays side by side. False if one is not traceable, or its range is empty or starts before 0.
static inline int take_rays(GnPacket* p, __global const float8* rays, float16 directions[3][GN_GROUPS]) {
  float lanes[8][GN_PACKET];
  const uint count = 16u * p->groups;
  uint i, g, k;
  int fit = 1;
  for (i = 0u; i < count; ++i) {
    const float8 r = rays[p->first + i];
    lanes[0][i] = r.s0;
    lanes[1][i] = r.s1;
    lanes[2][i] = r.s2;
    lanes[3][i] = r.s3;
    lanes[4][i] = r.s4;
    lanes[5][i] = r.s5;
    lanes[6][i] = r.s6;
    lanes[7][i] = r.s7;
  }
  for (g = 0u; g < p->groups; ++g) {
    p->tmin[g] = vload16(g, lanes[3]);
    p->tmax[g] = vload16(g, lanes[7]);
    fit &= all(p->tmin[g] >= 0.0f) && all(p->tmax[g] >= p->tmin[g]);
    p->tmax[g] = GN_MIN8(p->tmax[g], (float16)FLT_MAX);  // gn_finite_tmax
    for (k = 0u; k < 3u; ++k) {
      p->origin[k][g] = vload16(g, lanes[k]);
      directions[k][g] = vload16(g, lanes[4u + k]);
      p->inverse[k][g] = 1.0f / directions[k][g];
      // Of denormal components the reciprocal is not known (gn_slab_inverse).
      fit &= all(fabs(p->origin[k][g]) <= GN_PACKET_FAR) && all(fabs(directions[k][g]) <= GN_LONGEST_DIRECTION) &&
             all((directions[k][g] == 0.0f) | (fabs(directions[k][g]) >= FLT_MIN));
    }
  }
  return fit;
}

// Least and largest lane of a packet's vectors; false where one is NaN.
static inline int range_of(const float16* values, uint groups, float* low, float* high) {
  float16 least = values[0], most = least;
  int numbers = all(values[0] == values[0]);
  uint g;
  for (g = 1u; g < groups; ++g) {
    numbers &= all(values[g] == values[g]);
    least = GN_MIN8(values[g], least);
    most = GN_MAX8(values[g], most);
  }
  *low = smallest_of16(least);
  *high = largest_of16(most);
  return numbers;
}

// Bounds of the rays per axis. False if their directions differ in sign.
static inline int bound_rays(GnPacket* p) {
  uint k;
  for (k = 0u; k < 3u; ++k) {
    float low, high, least, most;
    uint backwards;
    range_of(p->origin[k], p->groups, &low, &high);
    range_of(p->inverse[k], p->groups, &least, &most);
    backwards = most < 0.0f;
    if (!backwards && !(least > 0.0f)) return 0;
    p->near_origin[k] = backwards ? low : high;
    p->far_origin[k] = backwards ? high : low;
    p->least_inverse[k] = backwards ? most : least;
    p->most_inverse[k] = backwards ? least : most;
    p->near_side[k] = 64u * k + 32u * backwards;
  }
  return 1;
}

// Where two rays of the packet come closest, in shears: exact if they meet. False where they are parallel.
static inline int find_apex(GnPacket* p, const float16* shear_x, const float16* shear_y) {
  const uint last = 16u * p->groups - 1u;
  const float* sx = (const float*)shear_x;
  const float* sy = (const float*)shear_y;
  const float* ox = (const float*)p->origin[p->kx];
  const float* oy = (const float*)p->origin[p->ky];
  const float* oz = (const float*)p->origin[p->kz];
  const float x = sx[0] - sx[last], y = sy[0] - sy[last];
  const float gap_x = (ox[last] - ox[0]) - sx[last] * (oz[last] - oz[0]);
  const float gap_y = (oy[last] - oy[0]) - sy[last] * (oz[last] - oz[0]);
  const float t = (x * gap_x + y * gap_y) / (x * x + y * y);
  p->apex[p->kx] = ox[0] + sx[0] * t;
  p->apex[p->ky] = oy[0] + sy[0] * t;
  p->apex[p->kz] = oz[0] + t;
  return fabs(t) <= GN_PACKET_FAR;
}

// The main axis and shears; false if they are too many.
static inline int find_shears(GnPacket* p, const float16 directions[3][GN_GROUPS], float16* shear_x,
                              float16* shear_y) {
  const float dx = fabs(directions[0][0].s0), dy = fabs(directions[1][0].s0), dz = fabs(directions[2][0].s0);
  float low, high;
  uint g;
  p->kz = dz > gn_max(dx, dy) ? 2u : dy > dx ? 1u : 0u;
  p->kx = p->kz == 2u ? 0u : p->kz + 1u;
  p->ky = p->kx == 2u ? 0u : p->kx + 1u;
  for (g = 0u; g < p->groups; ++g) {
    const float16 along = directions[p->kz][g];
    if (!all(fabs(along) >= GN_SHORTEST_DIRECTION)) return 0;
    shear_x[g] = directions[p->kx][g] / along;
    shear_y[g] = directions[p->ky][g] / along;
  }
  if (!range_of(shear_x, p->groups, &low, &high) || high - low > 2.0f * GN_PENCIL_WIDTH) return 0;
  if (!(low >= -GN_SHEAR_LIMIT && high <= GN_SHEAR_LIMIT)) return 0;
  p->shear_x = 0.5f * (low + high);
  p->parallel = low == high;
  if (!range_of(shear_y, p->groups, &low, &high) || high - low > 2.0f * GN_PENCIL_WIDTH) return 0;
  if (!(low >= -GN_SHEAR_LIMIT && high <= GN_SHEAR_LIMIT)) return 0;
  p->shear_y = 0.5f * (low + high);
  p->parallel &= low == high;
  return 1;
}

// How the rays run: through a point, or side by side. False if neither, or too far apart for a scene of this size.
static inline int find_pencil(GnPacket* p, const float16 directions[3][GN_GROUPS], float scene_size) {
  float16 shear_x[GN_GROUPS], shear_y[GN_GROUPS];
  float16 off = (float16)0.0f, far = off, wide_x = off, wide_y = off;
  float far_all, reach;
  uint g, one_origin = 1u;
  if (!find_shears(p, directions, shear_x, shear_y)) return 0;
  for (g = 0u; g < 3u; ++g) {
    one_origin &= p->near_origin[g] == p->far_origin[g];
    p->apex[g] = p->near_origin[g];
  }
  if (!p->parallel && !one_origin && !find_apex(p, shear_x, shear_y)) return 0;
  for (g = 0u; g < p->groups; ++g) {
    const float16 z = p->origin[p->kz][g] - p->apex[p->kz];
    const float16 x = (p->origin[p->kx][g] - p->apex[p->kx]) - shear_x[g] * z;
    const float16 y = (p->origin[p->ky][g] - p->apex[p->ky]) - shear_y[g] * z;
    p->start[g] = z;
    p->slide_x[g] = p->parallel ? x : shear_x[g] - p->shear_x;
    p->slide_y[g] = p->parallel ? y : shear_y[g] - p->shear_y;
    far = GN_MAX8(fabs(z), far);
    off = GN_MAX8(GN_MAX8(fabs(x), fabs(y)), off);
    wide_x = GN_MAX8(fabs(p->slide_x[g]), wide_x);
    wide_y = GN_MAX8(fabs(p->slide_y[g]), wide_y);
  }
  far_all = largest_of16(far);
  p->reach_x = largest_of16(wide_x);
  p->reach_y = largest_of16(wide_y);
  reach = gn_max(p->reach_x, p->reach_y);
  p->most_shear_x = fabs(p->shear_x) + (p->parallel ? 0.0f : p->reach_x) + GN_PACKET_UNDERFLOW;
  p->most_shear_y = fabs(p->shear_y) + (p->parallel ? 0.0f : p->reach_y) + GN_PACKET_UNDERFLOW;
  p->most_shear = gn_max(p->most_shear_x, p->most_shear_y) + (p->parallel ? 0.0f : reach);
  if (p->parallel) {
    p->extra = far_all + reach;
    return reach <= GN_BUNDLE_WIDTH * scene_size;
  }
  // Rays pass the apex at a distance of off, itself wrong by less than 12 * 2^-24 of far.
  p->extra = one_origin ? 0.0f : 2097152.0f * largest_of16(off) + 1.5f * far_all;
  return p->extra <= 16.0f * far_all;
}

#if GN_FRAME
// Turns the rays for box tests, as gn_box_ray does one: the margin is the largest of theirs, and doubled, since it is added
// to planes as well, which rounds. False where a component is denormal or differs in sign; parallel rays stay parallel.
static inline int turn_packet(GnPacket* p, const float16 directions[3][GN_GROUPS]) {
  const float* r = p->frame.rows;
  float16 far = (float16)0.0f;
  uint g, k;
  int fit = 1;
  for (g = 0u; g < p->groups; ++g) {
    const float16 x = p->origin[0][g], y = p->origin[1][g], z = p->origin[2][g];
    far = GN_MAX8(fabs(x) + fabs(y) + fabs(z), far);
    p->main_inverse[g] = p->inverse[p->kz][g];
    for (k = 0u; k < 3u; ++k) {
      const float16 way =
          r[3u * k] * directions[0][g] + r[3u * k + 1u] * directions[1][g] + r[3u * k + 2u] * directions[2][g];
      p->origin[k][g] = r[3u * k] * x + r[3u * k + 1u] * y + r[3u * k + 2u] * z;
      p->inverse[k][g] = 1.0f / way;
      fit &= all((way == 0.0f) | (fabs(way) >= FLT_MIN));
    }
  }
  p->margin = 2.0f * (GN_FRAME_MARGIN * (p->frame.size + largest_of16(far)) + GN_FRAME_UNDERFLOW);
  if (!fit || !bound_rays(p)) return 0;
  for (k = 0u; k < 3u; ++k) {
    const float ahead = p->near_side[k] & 32u ? -p->margin : p->margin;
    p->near_origin[k] += ahead;
    p->far_origin[k] -= ahead;
  }
  return 1;
}
#endif

// The largest distance at which a box still matters to any ray.
static inline void find_limit_of_all(GnPacket* p) {
  float16 most = (float16)(0.0f);
  uint g;
  for (g = 0u; g < p->groups; ++g) {
    const float16 limit = lanes_of_bits16(p->active[g]) ? p->limit[g] : (float16)(0.0f);
    most = GN_MAX8(limit, most);
  }
  p->limit_of_all = largest_of16(most);
}

// Whether no direction component has both signs, and a glance at four rays says that taking all is worth the while.
static inline int may_be_packet(__global const float8* rays, uint first, uint groups) {
  const uint count = 16u * groups, step = (count - 1u) / 3u;
  float3 low = rays[first].s456, high = low;
  uint i;
  for (i = 1u; i < 4u; ++i) {
    const float3 d = rays[first + i * step].s456;
    low = d < low ? d : low;
    high = d > high ? d : high;
  }
  {
    const float3 wide = high - low, size = fabs(high) > fabs(low) ? fabs(high) : fabs(low);
    const float most = gn_max(gn_max(size.x, size.y), size.z), widest = gn_max(gn_max(wide.x, wide.y), wide.z);
    if (!(widest <= 0.5f * most && all((low >= 0.0f) | (high <= 0.0f)))) return 0;
  }
  {
    const uint4 bits = as_uint4(rays[first].hi);
    uint4 differ = (uint4)(0u);
    for (i = 1u; i < count; ++i) differ |= as_uint4(rays[first + i].hi) ^ bits;
    return ((differ.x | differ.y | differ.z) & 0x80000000u) == 0u;
  }
}

// Rays [first, first + 16 groups). False if they do not make a packet.
static inline int start_packet(GnPacket* p, __global const float8* rays, uint first, uint groups, float scene_size) {
  float16 directions[3][GN_GROUPS];
  float16 least;
  uint g;
  p->first = first;
  p->groups = groups;
  if (!may_be_packet(rays, first, groups)) return 0;
  if (!take_rays(p, rays, directions) || !bound_rays(p) || !find_pencil(p, directions, scene_size)) return 0;
#if GN_FRAME
  if (!turn_packet(p, directions)) return 0;
#endif
  for (g = 0u; g < groups; ++g) {
    const float16 limit = p->tmax[g] * (1.0f + GN_SLAB_SLACK);
#if GN_REGIONS
    p->direction[0][g] = directions[0][g];
    p->direction[1][g] = directions[1][g];
    p->direction[2][g] = directions[2][g];
#endif
    p->limit[g] = GN_MIN8(limit, (float16)FLT_MAX);
    p->nearest[g] = (float16)INFINITY;
    p->farthest[g] = (float16)INFINITY;
    p->seat[g] = (uint16)(0u);  // lanes are chosen from it, which a simulator takes for reading what nobody wrote
    p->active[g] = 65535u;
    p->found[g] = 0u;
    p->pending[g] = 0u;
    least = g == 0u ? p->tmin[0] : GN_MIN8(p->tmin[g], least);
  }
  p->tmin_of_all = smallest_of16(least);
  find_limit_of_all(p);
  return 1;
}

#endif
