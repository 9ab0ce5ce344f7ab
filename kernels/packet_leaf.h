// A packet of rays against leaves: eight triangles are prepared for all rays at once, then each is tested against
// sixteen rays a step. Hits are intervals, as in wide_leaf.h. Feeds packet_walk.h.
#ifndef GNOMON_PACKET_LEAF_H
#define GNOMON_PACKET_LEAF_H

#include "packet_rays.h"

// A triangle that floats cannot rank for this ray, or not even call met.
static GN_OUT_OF_LINE void decide(GnPacket* p, __global const float8* rays, __global const uint* leaves,
                                  uint index, uint seat, int verdict) {
  const uint g = index >> 4, bit = 1u << (index & 15u);
  if (p->found[g] & bit) {  // trees of parts have a triangle in several leaves, and it is not nearer there
    const uint other = ((const uint*)p->seat)[index];
    const uint nearest =
        p->pending[g] & bit ? gn_number_at(leaves, other) : p->best[index].primitive;
    if (nearest == gn_number_at(leaves, seat)) return;
  }
  const GnRay ray = load_ray(rays, p->first + index);
  const GnRayFrame frame = gn_ray_frame(&ray);
  if (verdict > 0 && (p->pending[g] & bit)) {
    uint* pending = (uint*)p->seat + index;
    if (meet_at_once(&frame, leaves, *pending, seat)) {
      if (gn_number_at(leaves, seat) < gn_number_at(leaves, *pending)) *pending = seat;
      return;
    }
  }
  float* nearest = (float*)p->nearest + index;
  float* farthest = (float*)p->farthest + index;
  GnHit hit;
  if (!resolve(&frame, leaves, seat, verdict, &hit)) return;
  if (!(hit.t >= ray.tmin && hit.t <= ray.tmax)) return;
  if (p->pending[g] & bit) {
    const uint other = ((const uint*)p->seat)[index];
    resolve(&frame, leaves, other, 1, p->best + index);
    p->pending[g] &= ~bit;
    *nearest = p->best[index].t;
    *farthest = *nearest;
  }
  if (!(p->found[g] & bit) || gn_hit_is_nearer(&hit, p->best + index)) {
    p->best[index] = hit;
    *nearest = hit.t;
    *farthest = hit.t;
  }
  p->found[g] |= bit;
}

// Eight triangles as a packet sees them, an array for each number of theirs. An edge function is
// u[0] + slide_x u[1] + slide_y u[2]; the distance from the apex along the main axis is from / through, of which one
// changes by nx slide_x + ny slide_y: rays through a point pass through a plane at different slopes, parallel ones from
// different places.
typedef struct GnPacketEdges {
  float u[3][8], v[3][8], w[3][8];
  float from[8], through[8], nx[8], ny[8];
  float bound[8];  // of the edge functions' errors
  float from_error[8];
  float through_error[8];
} GnPacketEdges;

// The edge function x cross y, taken as (x - y) cross y so that its error goes with the edge's length: value, slopes in
// the slides, and how much these make of the packet's reach.
#define GN_STORE_EDGE(to, dx, dy, dz, yx, yy, yz, e0, reach)                  \
  const float8 e0 = (dx) * (yy) - (dy) * (yx);                                \
  const float8 e0##_x = (dy) * (yz) - (dz) * (yy);                            \
  const float8 e0##_y = (dz) * (yx) - (dx) * (yz);                            \
  const float8 reach = p->reach_x * fabs(e0##_x) + p->reach_y * fabs(e0##_y); \
  vstore8(e0, 0, to[0]);                                                      \
  vstore8(e0##_x, 0, to[1]);                                                  \
  vstore8(e0##_y, 0, to[2]);

#define GN_LARGEST_OF_3(a, b, c) GN_MAX8(GN_MAX8(fabs(a), fabs(b)), fabs(c))

// Bounds of errors, with e = 2^-24, edges of length l, sheared coordinates up to p, distances along the main axis up to z,
// shears up to s and reach h. For rays through the apex: a sheared coordinate is off by e(2p + 3sz), a sheared edge by
// 6el, a slope by el(16z + 5p), a slide by e(5s + 6h). With roundings an edge function is then off by at most
// el(55p + 36sz + 67hz), below 64el(p + (s + 2h)z) = 64el far. For parallel rays with origins up to f from the apex a slide
// is off by e(2h + 10f), and an edge function by el(51p + 51h + 36sz + 45f). Rays that miss the apex by r move an edge
// function by 4.8lr, below 64e l 2^21 r. 1e-30 and 1e-36 cover underflow.
// The normal's component nx is off by 8e ly lz, lx being the edges' extent along x; so that with roundings through is
// off by 28e, and from by 24e, of sums of such products with shears and distances: 32e here.
#define GN_PACKET_ERROR 3.8146973e-06f  // 64 * 2^-24
#define GN_PLANE_ERROR 1.9073486e-06f   // 32 * 2^-24

// Prepares a block of `count` triangles whose words begin at c; returns those that a ray of the packet may meet.
static inline uint packet_edges(const GnPacket* p, __global const float* c, uint count, GnPacketEdges* out) {
  const uint kx = p->kx, ky = p->ky, kz = p->kz;
  const float8 one = (float8)1.0f, zero = (float8)0.0f;
  // Corners as they stand, then seen from the apex.
  const float8 cax = GN_OF_BLOCK(c, kx, count), cbx = GN_OF_BLOCK(c, 3u + kx, count), ccx = GN_OF_BLOCK(c, 6u + kx, count);
  const float8 cay = GN_OF_BLOCK(c, ky, count), cby = GN_OF_BLOCK(c, 3u + ky, count), ccy = GN_OF_BLOCK(c, 6u + ky, count);
  const float8 caz = GN_OF_BLOCK(c, kz, count), cbz = GN_OF_BLOCK(c, 3u + kz, count), ccz = GN_OF_BLOCK(c, 6u + kz, count);
  const float8 rx = cax - p->apex[kx], ry = cay - p->apex[ky];
  const float8 az = caz - p->apex[kz], bz = cbz - p->apex[kz], cz = ccz - p->apex[kz];
  const float8 ax = rx - p->shear_x * az;
  const float8 ay = ry - p->shear_y * az;
  const float8 bx = (cbx - p->apex[kx]) - p->shear_x * bz;
  const float8 by = (cby - p->apex[ky]) - p->shear_y * bz;
  const float8 cx = (ccx - p->apex[kx]) - p->shear_x * cz;
  const float8 cy = (ccy - p->apex[ky]) - p->shear_y * cz;
  // Edges: to c from b, to a from c, to b from a.
  const float8 ux = ccx - cbx, uy = ccy - cby, uz = ccz - cbz;
  const float8 vx = cax - ccx, vy = cay - ccy, vz = caz - ccz;
  const float8 wx = cbx - cax, wy = cby - cay, wz = cbz - caz;
  const float8 lx = GN_LARGEST_OF_3(ux, vx, wx), ly = GN_LARGEST_OF_3(uy, vy, wy), lz = GN_LARGEST_OF_3(uz, vz, wz);
  const float8 length = GN_MAX8(GN_MAX8(lx, ly), lz) + GN_PACKET_UNDERFLOW;
  const float8 far = GN_MAX8(GN_LARGEST_OF_3(ax, bx, cx), GN_LARGEST_OF_3(ay, by, cy)) +
                     p->most_shear * GN_LARGEST_OF_3(az, bz, cz) + p->extra;
  const float8 bound = GN_FAST ? (float8)0.0f : GN_PACKET_ERROR * length * far + GN_EDGE_UNDERFLOW;
  const float8 za = p->parallel ? one : az, zb = p->parallel ? one : bz, zc = p->parallel ? one : cz;
  const float8 uw = p->parallel ? zero : uz, vw = p->parallel ? zero : vz, ww = p->parallel ? zero : wz;
  GN_STORE_EDGE(out->u, ux - p->shear_x * uz, uy - p->shear_y * uz, uw, bx, by, zb, u, ru)
  GN_STORE_EDGE(out->v, vx - p->shear_x * vz, vy - p->shear_y * vz, vw, cx, cy, zc, v, rv)
  GN_STORE_EDGE(out->w, wx - p->shear_x * wz, wy - p->shear_y * wz, ww, ax, ay, za, w, rw)
  {
    const float8 nx = wz * vy - wy * vz, ny = wx * vz - wz * vx, nz = wy * vx - wx * vy;
    const float8 mx = ly * lz, my = lx * lz, mz = lx * ly;
    vstore8(nx, 0, out->nx);
    vstore8(ny, 0, out->ny);
    vstore8(nx * rx + ny * ry + nz * az, 0, out->from);
    vstore8(nx * p->shear_x + ny * p->shear_y + nz, 0, out->through);
    vstore8(bound, 0, out->bound);
#if !GN_FAST
    vstore8(GN_PLANE_ERROR * (mx * (fabs(rx) + p->extra) + my * (fabs(ry) + p->extra) + mz * fabs(az)) +
                GN_EDGE_UNDERFLOW * (fabs(rx) + fabs(ry) + fabs(az) + 1.0f),
            0, out->from_error);
    vstore8(GN_PLANE_ERROR * (mx * p->most_shear_x + my * p->most_shear_y + mz) + GN_EDGE_UNDERFLOW, 0,
            out->through_error);
#endif
  }
  // Missed by all: two edges have certain and different signs, or the facing is certain and one edge's sign is not its.
  {
    const float8 slack = 2.0f * bound;
    const float8 low_u = u - ru, low_v = v - rv, low_w = w - rw;
    const float8 high_u = u + ru, high_v = v + rv, high_w = w + rw;
    const float8 highest_low = GN_MAX8(GN_MAX8(low_u, low_v), low_w);
    const float8 lowest_high = GN_MIN8(GN_MIN8(high_u, high_v), high_w);
    const float8 sum_x = u_x + v_x + w_x, sum_y = u_y + v_y + w_y, sum = u + v + w;
    const float8 sum_reach = p->reach_x * fabs(sum_x) + p->reach_y * fabs(sum_y) + 4.0f * slack;
    const uint some_over = lanes_above(highest_low, slack), some_under = lanes_above(-slack, lowest_high);
    const uint front = lanes_above(sum, sum_reach), back = lanes_above(-sum_reach, sum);
    const uint missed = (some_over & some_under) | (front & some_under) | (back & some_over);
    return ~missed & (255u >> (8u - count));
  }
}

// The rays of `mask` in group g against triangle i of the block.
static inline void test_triangle(GnPacket* p, __global const float8* rays, __global const uint* leaves,
                                 const GnPacketEdges* e, uint i, uint seat, uint g, uint mask, int any_hit) {
  const float16 x = p->slide_x[g], y = p->slide_y[g];
  const float16 u = fma(y, (float16)e->u[2][i], fma(x, (float16)e->u[1][i], (float16)e->u[0][i]));
  const float16 v = fma(y, (float16)e->v[2][i], fma(x, (float16)e->v[1][i], (float16)e->v[0][i]));
  const float16 w = fma(y, (float16)e->w[2][i], fma(x, (float16)e->w[1][i], (float16)e->w[0][i]));
  const float16 largest = GN_MAX8(GN_MAX8(u, v), w), smallest = GN_MIN8(GN_MIN8(u, v), w);
  const float16 bound = (float16)e->bound[i];
  const uint met = ~(lanes_above16(largest, bound) & lanes_above16(-bound, smallest)) & mask;
  if (met == 0u) return;
  {
    const uint inside = lanes_above16(smallest, bound) | lanes_above16(-bound, largest);
    const float16 start = p->start[g], inverse = GN_MAIN_INVERSE(p, g);
    const float16 lean = x * e->nx[i] + y * e->ny[i];
    const float16 from = p->parallel ? e->from[i] - lean : (float16)e->from[i];
    const float16 through = p->parallel ? (float16)e->through[i] : e->through[i] + lean;
    const float16 share = 1.0f / through;
    const float16 distance = from * share;
#if GN_FAST
    const float16 error = (float16)0.0f;
#else
    // Beyond twice its error, through is wrong by less than half.
    const float16 scale =
        fabs(through) > 2.0f * e->through_error[i] ? fabs(2.0f * inverse * share) : (float16)INFINITY;
    const float16 error = (e->from_error[i] + e->through_error[i] * fabs(distance)) * scale +
                          GN_SLAB_SLACK * (fabs(distance) + fabs(start)) * fabs(inverse) + GN_MET_UNDERFLOW;
#endif
    const float16 t = (distance - start) * inverse;
    const float16 nearest = t - error, farthest = t + error;
    const uint beyond = lanes_above16(p->tmin[g], farthest) | lanes_above16(nearest, p->tmax[g]) |
                        lanes_above16(nearest, p->farthest[g]);
    // Not where something overflowed: infinities less themselves and NaN compare with nothing.
    const uint known = lanes_above16((float16)INFINITY, farthest - nearest);
    const uint within = lanes_not_above16(p->tmin[g], nearest) & lanes_not_above16(farthest, p->tmax[g]);
    const uint take = met & inside & known & within & lanes_above16(p->nearest[g], farthest);
    uint rest = met & ~(inside & known & beyond) & ~take;
    if (take != 0u) {
      const int16 lanes = lanes_of_bits16(take);
      p->nearest[g] = lanes ? nearest : p->nearest[g];
      p->farthest[g] = lanes ? farthest : p->farthest[g];
      p->seat[g] = lanes ? (uint16)seat : p->seat[g];
#if GN_FAST
      {
        const float16 whole = 1.0f / (u + v + w);
        p->hit_u[g] = lanes ? v * whole : p->hit_u[g];
        p->hit_v[g] = lanes ? w * whole : p->hit_v[g];
      }
#endif
      p->found[g] |= take;
      p->pending[g] |= take;
    }
    while (rest != 0u) {
      const uint lane = lowest_bit(rest);
      const uint sure = (inside >> lane) & (known >> lane) & 1u;
      decide(p, rays, leaves, 16u * g + lane, seat, sure ? 1 : -1);
      rest &= rest - 1u;
    }
    if (any_hit) p->active[g] &= ~p->found[g];
  }
}

// masks: the rays of each group that meet the leaf's box.
static inline void test_packet_leaf(GnPacket* p, __global const float8* rays, __global const uint* leaves,
                                    uint link, const uint* masks, int any_hit) {
  GnLeaf leaf = gn_leaf_at(leaves, link);
  uint g;
  for (;;) {
    const uint count = min(leaf.count, GN_WIDTH);
    GnPacketEdges edges;
    uint met = packet_edges(p, (__global const float*)leaves + GN_TRIANGLE_WORDS * leaf.first, count, &edges);
#if GN_COUNTERS
    for (g = 0u; g < p->groups; ++g) p->triangles[g] += masks[g] != 0u ? count : 0u;
#endif
    while (met != 0u) {
      const uint i = lowest_bit(met), seat = gn_seat(leaf.first, count, i);
      for (g = 0u; g < p->groups; ++g) {
        const uint mask = masks[g] & p->active[g];
        GN_WORK(p, triangles, mask != 0u);
        if (mask != 0u) test_triangle(p, rays, leaves, &edges, i, seat, g, mask, any_hit);
      }
      met &= met - 1u;
    }
    if (leaf.count <= GN_WIDTH) break;
    leaf.count -= GN_WIDTH;
    leaf.first += GN_WIDTH;
  }
  for (g = 0u; g < p->groups; ++g) {
    const float16 limit = p->farthest[g] * (1.0f + GN_SLAB_SLACK);
    p->limit[g] = GN_MIN8(limit, p->limit[g]);
  }
  find_limit_of_all(p);
}

#endif
