// Merges the triangles of one segment of the Morton curve into a few clusters, bottom up: in every round each cluster
// finds the nearest of its neighbours on the curve, and those that chose each other become one (PLOC: Meister, Bittner
// 2018). A work-group has a segment to itself, in local memory. The serial flavour looks at all neighbours at once and
// has no branch that depends on the data. Not for what becomes of the clusters (assemble.cl).
#include "ahead.h"
#include "shared/fast_math.h"
#include "triangle_box.h"

// Places before the first cluster and behind the last that neighbours may be looked for in.
#define GN_BEFORE 8u
#define GN_PLACES (GN_SEGMENT + 2u * GN_BEFORE)

// Triangles that are sent for before they are needed.
#define GN_AHEAD 16u

// Clusters in their order on the curve. boxes: lower corner with what it counts (gn_merge_counts), upper corner with its
// cost; bits throughout, since small whole numbers are floats that devices may take for zero. planes: the same corners
// for those who look at many clusters at once: lower x, y, z, upper x, y, z, each from GN_BEFORE on.
typedef struct GnClusters {
  __local uint* boxes;
  __local float* planes;
  __local ushort* numbers;
  __local ushort* partners;
} GnClusters;

// One cluster on its way from place to place. Lanes w as in boxes.
typedef struct GnMoving {
  uint4 lo;
  uint4 hi;
  uint number;
} GnMoving;

static inline __local float* plane_of(const GnClusters* clusters, uint plane) {
  return clusters->planes + plane * GN_PLACES + GN_BEFORE;
}

static inline void put_cluster(const GnClusters* clusters, uint place, GnMoving cluster) {
  vstore4(cluster.lo, 2u * place, clusters->boxes);
  vstore4(cluster.hi, 2u * place + 1u, clusters->boxes);
  plane_of(clusters, 0u)[place] = as_float(cluster.lo.x);
  plane_of(clusters, 1u)[place] = as_float(cluster.lo.y);
  plane_of(clusters, 2u)[place] = as_float(cluster.lo.z);
  plane_of(clusters, 3u)[place] = as_float(cluster.hi.x);
  plane_of(clusters, 4u)[place] = as_float(cluster.hi.y);
  plane_of(clusters, 5u)[place] = as_float(cluster.hi.z);
  clusters->numbers[place] = (ushort)cluster.number;
}

static inline float half_area_of(float3 lo, float3 hi) {
  const float l[3] = {lo.x, lo.y, lo.z}, h[3] = {hi.x, hi.y, hi.z};
  return gn_surface_measure(l, h);
}

// Boxes so large that nothing is farther than they are, on both sides of the clusters.
static inline void fence(const GnClusters* clusters, uint count) {
  uint i, k;
  for (i = GN_LOCAL_ID; i < 2u * GN_BEFORE; i += GN_WGS) {
    const uint place = i < GN_BEFORE ? i : count + i;
    for (k = 0u; k < 3u; ++k) {
      clusters->planes[k * GN_PLACES + place] = -1e30f;
      clusters->planes[(3u + k) * GN_PLACES + place] = 1e30f;
    }
  }
}

// PoCL's compiler makes sixteen lanes one instruction; others take the loop below, whose keys are the same.
#if GN_WGS == 1 && defined(POCL_DEVICE_ADDRESS_BITS)

#define GN_ALL16(x) ((float16)(x))

// The least key of a cluster and any of its neighbours: lane 0 is seven places before it, lane 7 itself.
static inline uint nearest_of(const GnClusters* clusters, uint place) {
  const uint16 apart = (uint16)(6, 5, 4, 3, 2, 1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 0) << 1;
  const uint16 lowest = (uint16)(0, 1, 0, 2, 0, 1, 0, 0, 0, 1, 0, 2, 0, 1, 0, 0);
  const uint16 back = (uint16)(7, 6, 5, 4, 3, 2, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0);
  const uint16 none = (uint16)(0, 0, 0, 0, 0, 0, 0, GN_NONE, 0, 0, 0, 0, 0, 0, 0, GN_NONE);
  __local const float* lo_x = plane_of(clusters, 0u) + place;
  const float16 dx = GN_VMAX(vload16(0, lo_x + 3u * GN_PLACES - 7), GN_ALL16(lo_x[3u * GN_PLACES])) -
                     GN_VMIN(vload16(0, lo_x - 7), GN_ALL16(lo_x[0]));
  const float16 dy = GN_VMAX(vload16(0, lo_x + 4u * GN_PLACES - 7), GN_ALL16(lo_x[4u * GN_PLACES])) -
                     GN_VMIN(vload16(0, lo_x + GN_PLACES - 7), GN_ALL16(lo_x[GN_PLACES]));
  const float16 dz = GN_VMAX(vload16(0, lo_x + 5u * GN_PLACES - 7), GN_ALL16(lo_x[5u * GN_PLACES])) -
                     GN_VMIN(vload16(0, lo_x + 2u * GN_PLACES - 7), GN_ALL16(lo_x[2u * GN_PLACES]));
  const float16 area = dx * (dy + dz) + dy * dz;
  const uint16 sides = (((uint16)(place) - back) >> lowest) & 1u;
  const uint16 keys = ((as_uint16(area) & ~15u) | apart | sides) | none;
  const uint8 eight = min(keys.lo, keys.hi);
  const uint4 four = min(eight.lo, eight.hi);
  const uint2 two = min(four.lo, four.hi);
  return min(two.x, two.y);
}

#else

static inline uint nearest_of(const GnClusters* clusters, uint place) {
  uint best = GN_NONE, distance, side, k;
  float lo[3], hi[3];
  for (k = 0u; k < 3u; ++k) {
    lo[k] = plane_of(clusters, k)[place];
    hi[k] = plane_of(clusters, 3u + k)[place];
  }
  for (distance = 1u; distance <= GN_NEIGHBOURS; ++distance) {
    for (side = 0u; side < 2u; ++side) {
      const int other = side ? (int)(place + distance) : (int)place - (int)distance;
      float both_lo[3], both_hi[3];
      for (k = 0u; k < 3u; ++k) {
        both_lo[k] = gn_min(lo[k], plane_of(clusters, k)[other]);
        both_hi[k] = gn_max(hi[k], plane_of(clusters, 3u + k)[other]);
      }
      best = min(best, gn_pair_key(gn_surface_measure(both_lo, both_hi), distance, side ? place : (uint)other));
    }
  }
  return best;
}

#endif

static inline void choose_partners(const GnClusters* clusters, uint count, uint round) {
  uint i;
  if (round < GN_FREE_ROUNDS) {
    for (i = GN_LOCAL_ID; i < count; i += GN_WGS)
      clusters->partners[i] = (ushort)gn_pair_partner(nearest_of(clusters, i), i);
  } else {
    for (i = GN_LOCAL_ID; i < count; i += GN_WGS) clusters->partners[i] = (ushort)((i ^ 1u) < count ? i ^ 1u : i);
  }
}

// What stands at a place after this round: the cluster itself, or it and its partner as one (joins == 1), which gets the
// number given and whose merge is `record`'s corners. The later one of two that merge is no more (stays == 0).
static inline GnMoving after_round(const GnClusters* clusters, uint place, uint next_merge, GnLeafRule rule,
                                   uint4* record_lo, uint4* record_hi, uint* stays, uint* joins) {
  const uint chosen = clusters->partners[place];
  const uint mutual = clusters->partners[chosen] == place;
  const uint joining = mutual & (uint)(chosen > place);
  const uint partner = joining ? chosen : place;
  const uint number = clusters->numbers[place];
  const uint4 lo = vload4(2u * place, clusters->boxes), hi = vload4(2u * place + 1u, clusters->boxes);
  const uint4 other_lo = vload4(2u * partner, clusters->boxes), other_hi = vload4(2u * partner + 1u, clusters->boxes);
  const float3 least = GN_VMIN(as_float4(lo).xyz, as_float4(other_lo).xyz);
  const float3 most = GN_VMAX(as_float4(hi).xyz, as_float4(other_hi).xyz);
  float cost;
  const uint counts = gn_merge_counts(rule, half_area_of(least, most), as_float(hi.w) + as_float(other_hi.w), lo.w,
                                      other_lo.w, &cost);
  GnMoving out;
  out.lo = (uint4)(as_uint(least.x), as_uint(least.y), as_uint(least.z), joining ? counts : lo.w);
  out.hi = (uint4)(as_uint(most.x), as_uint(most.y), as_uint(most.z), joining ? as_uint(cost) : hi.w);
  out.number = joining ? next_merge : number;
  *record_lo = (uint4)(out.lo.xyz, number | (uint)clusters->numbers[partner] << 16);
  *record_hi = (uint4)(out.hi.xyz, counts);
  *stays = 1u ^ (mutual & (uint)(chosen < place));
  *joins = joining;
  return out;
}

static inline void store_merge(__global GnMerge* merge, uint4 lo, uint4 hi) {
  vstore4(lo, 0, (__global uint*)merge);
  vstore4(hi, 1, (__global uint*)merge);
}

static inline void expect_triangle(__global const float* triangles, uint triangle) {
  GN_EXPECT(triangles + 9u * (size_t)triangle);
  GN_EXPECT(triangles + 9u * (size_t)triangle + 8);
}

// The clusters of a segment, one a triangle, whose corners go to the segment's place in the curve's order.
static inline void load_clusters(const GnClusters* clusters, __global const float* triangles, __global const uint2* keys,
                                 __global GnLeafTriangle* sorted, uint count, GnLeafRule rule) {
  uint i;
#if GN_WGS == 1
  for (i = 0u; i < min(count, GN_AHEAD); ++i) expect_triangle(triangles, keys[i].y);
#endif
  for (i = GN_LOCAL_ID; i < count; i += GN_WGS) {
    const uint triangle = keys[i].y;
    const GnCorners corners = corners_of(triangles, triangle);
    const GnBoxPair box = box_of_corners(corners.a, corners.b, corners.c);
    __global uint* out = (__global uint*)(sorted + i);
    GnMoving cluster;
#if GN_WGS == 1
    expect_triangle(triangles, keys[min(i + GN_AHEAD, count - 1u)].y);
#endif
    vstore4((uint4)(as_uint3(corners.a), triangle), 0, out);
    vstore4((uint4)(as_uint3(corners.b), 0u), 1, out);
    vstore4((uint4)(as_uint3(corners.c), 0u), 2, out);
    cluster.lo = (uint4)(as_uint4(box.lo).xyz, 1u);
    cluster.hi = (uint4)(as_uint4(box.hi).xyz, as_uint(gn_triangle_cost(rule, half_area_of(box.lo.xyz, box.hi.xyz))));
    cluster.number = i;
    put_cluster(clusters, i, cluster);
  }
}

// One work-group per segment. keys: sorted. sorted: receives the triangles in the curve's order. merges: GN_SEGMENT for
// each segment. remaining: GN_SEGMENT_CLUSTERS for each, remaining_counts says how many of them there are.
__kernel void merge_segments(__global const float* triangles, __global const uint2* keys,
                             __global GnLeafTriangle* sorted, __global GnMerge* merges, __global GnCluster* remaining, __global uint* remaining_counts, uint count,
                             float cost_traversal, float cost_triangle, uint max_leaf_size) {
  __local uint boxes[8 * GN_SEGMENT] __attribute__((aligned(32)));
  __local float planes[6 * GN_PLACES];
  __local ushort numbers[GN_SEGMENT], partners[GN_SEGMENT];
#if GN_WGS > 1
  __local uint sums[GN_WGS];
#endif
  const GnClusters clusters = {boxes, planes, numbers, partners};
  const GnLeafRule rule = {cost_traversal, cost_triangle, max_leaf_size};
  const uint segment = (uint)get_group_id(0);
  const uint size = min(count - segment * GN_SEGMENT, GN_SEGMENT);
  const uint few = (size + GN_PER_CLUSTER - 1u) / GN_PER_CLUSTER;
  uint height = size, merged = 0u, round, i;
  merges += (size_t)segment * GN_SEGMENT;
  load_clusters(&clusters, triangles, keys + (size_t)segment * GN_SEGMENT,
                sorted + (size_t)segment * GN_SEGMENT, size, rule);
  // Each round merges two at least, so all are over by then.
  for (round = 0u; round < GN_SEGMENT && height > few; ++round) {
    uint kept = 0u;
    fence(&clusters, height);
    GN_GROUP_BARRIER();
    choose_partners(&clusters, height, round);
    GN_GROUP_BARRIER();
#if GN_WGS == 1
    for (i = 0u; i < height; ++i) {
      uint4 lo, hi;
      uint stays, joins;
      const GnMoving cluster = after_round(&clusters, i, GN_SEGMENT + merged, rule, &lo, &hi, &stays, &joins);
      store_merge(merges + merged, lo, hi);
      put_cluster(&clusters, kept, cluster);
      kept += stays;
      merged += joins;
    }
#else
    for (i = 0u; i < height; i += GN_WGS) {
      const uint place = i + GN_LOCAL_ID;
      uint4 lo, hi;
      uint stays, joins, before;
      GnMoving cluster =
          after_round(&clusters, place < height ? place : 0u, 0u, rule, &lo, &hi, &stays, &joins);
      if (place >= height) stays = joins = 0u;
      before = group_sum_before(stays | joins << 16, sums);
      if (joins) {
        cluster.number = GN_SEGMENT + merged + (before >> 16);
        store_merge(merges + merged + (before >> 16), lo, hi);
      }
      if (stays) put_cluster(&clusters, kept + (before & 0xffffu), cluster);
      // What the last work-item counted tells what all did.
      if (GN_LOCAL_ID == GN_WGS - 1u) sums[0] = before + (stays | joins << 16);
      GN_GROUP_BARRIER();
      kept += sums[0] & 0xffffu;
      merged += sums[0] >> 16;
      GN_GROUP_BARRIER();
    }
#endif
    height = kept;
  }
  // Counted to a constant: with a bound that a loop before has changed Mesa 22.3 leaves after the first turn.
  for (i = GN_LOCAL_ID; i < GN_SEGMENT_CLUSTERS; i += GN_WGS) {
    if (i >= height) continue;
    __global uint* out = (__global uint*)(remaining + (size_t)segment * GN_SEGMENT_CLUSTERS + i);
    const uint4 lo = vload4(2u * i, boxes), hi = vload4(2u * i + 1u, boxes);
    vstore4((uint4)(lo.xyz, segment * 2u * GN_SEGMENT + numbers[i]), 0, out);
    vstore4((uint4)(hi.xyz, lo.w), 1, out);
  }
  if (GN_LOCAL_ID == 0u) remaining_counts[segment] = height;
}
