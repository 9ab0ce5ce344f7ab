// Merges the triangles of one segment of the Morton curve into a few clusters, bottom up: in every round each cluster
// finds the nearest of its neighbours on the curve, and those that chose each other become one (PLOC: Meister, Bittner
// 2018). A work-group has a segment to itself, in local memory. The serial flavour looks at all neighbours at once and
// has no branch that depends on the data. Not for what becomes of the clusters (assemble.cl).
#include "shared/fast_math.h"
#include "triangle_box.h"

// Places before the first cluster and behind the last that neighbours may be looked for in.
#define GN_BEFORE 8u
#define GN_PLACES (GN_SEGMENT + 2u * GN_BEFORE)

// Clusters in their order on the curve. planes: lower x, y, z, upper x, y, z, from GN_BEFORE on.
typedef struct GnClusters {
  __local float* planes;
  __local uint* numbers;
  __local uint* counts;
  __local float* costs;
  __local uint* partners;
} GnClusters;

// One cluster on its way from place to place.
typedef struct GnMoving {
  float lo[3];
  float hi[3];
  uint number;
  uint counts;
  float cost;
} GnMoving;

static inline __local float* plane_of(const GnClusters* clusters, uint plane) {
  return clusters->planes + plane * GN_PLACES + GN_BEFORE;
}

static inline void put_cluster(const GnClusters* clusters, uint place, const GnMoving* cluster) {
  uint k;
  for (k = 0u; k < 3u; ++k) {
    plane_of(clusters, k)[place] = cluster->lo[k];
    plane_of(clusters, 3u + k)[place] = cluster->hi[k];
  }
  clusters->numbers[place] = cluster->number;
  clusters->counts[place] = cluster->counts;
  clusters->costs[place] = cluster->cost;
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

#if GN_WGS == 1

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
      clusters->partners[i] = gn_pair_partner(nearest_of(clusters, i), i);
  } else {
    for (i = GN_LOCAL_ID; i < count; i += GN_WGS) clusters->partners[i] = (i ^ 1u) < count ? i ^ 1u : i;
  }
}

// What stands at a place after this round: the cluster itself, or it and its partner as one (merges), which gets the
// number given. The later one of two that merge is no more (stays == 0).
static inline GnMoving after_round(const GnClusters* clusters, uint place, uint next_merge, GnLeafRule rule,
                                   GnMerge* record, uint* stays, uint* merges) {
  const uint chosen = clusters->partners[place];
  const uint mutual = clusters->partners[chosen] == place;
  const uint joins = mutual & (uint)(chosen > place);
  const uint partner = joins ? chosen : place;
  const uint number = clusters->numbers[place], counts = clusters->counts[place];
  const float cost = clusters->costs[place];
  GnMoving out;
  float joined_cost;
  uint k, joined_counts;
  for (k = 0u; k < 3u; ++k) {
    out.lo[k] = gn_min(plane_of(clusters, k)[place], plane_of(clusters, k)[partner]);
    out.hi[k] = gn_max(plane_of(clusters, 3u + k)[place], plane_of(clusters, 3u + k)[partner]);
    record->lo[k] = out.lo[k];
    record->hi[k] = out.hi[k];
  }
  joined_counts = gn_merge_counts(rule, gn_surface_measure(out.lo, out.hi), cost + clusters->costs[partner], counts,
                                  clusters->counts[partner], &joined_cost);
  record->children = number | clusters->numbers[partner] << 16;
  record->counts = joined_counts;
  out.number = joins ? next_merge : number;
  out.counts = joins ? joined_counts : counts;
  out.cost = joins ? joined_cost : cost;
  *stays = 1u ^ (mutual & (uint)(chosen < place));
  *merges = joins;
  return out;
}

// The clusters of a segment, one a triangle.
static inline void load_clusters(const GnClusters* clusters, __global const float* triangles, __global const uint2* keys,
                                 uint count, GnLeafRule rule) {
  uint i;
  for (i = GN_LOCAL_ID; i < count; i += GN_WGS) {
    const GnBoxPair box = box_of_triangle(triangles, keys[i].y);
    GnMoving cluster = {{box.lo.x, box.lo.y, box.lo.z}, {box.hi.x, box.hi.y, box.hi.z}, i, 1u, 0.0f};
    cluster.cost = gn_triangle_cost(rule, gn_surface_measure(cluster.lo, cluster.hi));
    put_cluster(clusters, i, &cluster);
  }
}

// One work-group per segment. keys: sorted. merges: GN_SEGMENT for each segment. remaining: GN_SEGMENT_CLUSTERS for each,
// remaining_counts says how many of them there are.
__kernel void merge_segments(__global const float* triangles, __global const uint2* keys, __global GnMerge* merges,
                             __global GnCluster* remaining, __global uint* remaining_counts, uint count,
                             float cost_traversal, float cost_triangle, uint max_leaf_size) {
  __local float planes[6 * GN_PLACES];
  __local uint numbers[GN_SEGMENT], counts[GN_SEGMENT], partners[GN_SEGMENT];
  __local float costs[GN_SEGMENT];
#if GN_WGS > 1
  __local uint sums[GN_WGS];
#endif
  const GnClusters clusters = {planes, numbers, counts, costs, partners};
  const GnLeafRule rule = {cost_traversal, cost_triangle, max_leaf_size};
  const uint segment = (uint)get_group_id(0);
  const uint size = min(count - segment * GN_SEGMENT, GN_SEGMENT);
  const uint few = (size + GN_PER_CLUSTER - 1u) / GN_PER_CLUSTER;
  uint height = size, merged = 0u, round, i, k;
  merges += (size_t)segment * GN_SEGMENT;
  load_clusters(&clusters, triangles, keys + (size_t)segment * GN_SEGMENT, size, rule);
  // Each round merges two at least, so all are over by then.
  for (round = 0u; round < GN_SEGMENT && height > few; ++round) {
    uint kept = 0u;
    fence(&clusters, height);
    GN_GROUP_BARRIER();
    choose_partners(&clusters, height, round);
    GN_GROUP_BARRIER();
#if GN_WGS == 1
    for (i = 0u; i < height; ++i) {
      GnMerge record;
      uint stays, joins;
      const GnMoving cluster = after_round(&clusters, i, GN_SEGMENT + merged, rule, &record, &stays, &joins);
      merges[merged] = record;
      put_cluster(&clusters, kept, &cluster);
      kept += stays;
      merged += joins;
    }
#else
    for (i = 0u; i < height; i += GN_WGS) {
      const uint place = i + GN_LOCAL_ID;
      const uint here = place < height ? place : 0u;
      GnMerge record;
      GnMoving cluster;
      uint stays, joins, before;
      cluster = after_round(&clusters, here, 0u, rule, &record, &stays, &joins);
      if (place >= height) stays = joins = 0u;
      before = group_sum_before(stays | joins << 16, sums);
      if (joins) {
        cluster.number = GN_SEGMENT + merged + (before >> 16);
        merges[merged + (before >> 16)] = record;
      }
      if (stays) put_cluster(&clusters, kept + (before & 0xffffu), &cluster);
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
  for (i = GN_LOCAL_ID; i < height; i += GN_WGS) {
    __global GnCluster* out = remaining + (size_t)segment * GN_SEGMENT_CLUSTERS + i;
    for (k = 0u; k < 3u; ++k) {
      out->lo[k] = plane_of(&clusters, k)[i];
      out->hi[k] = plane_of(&clusters, 3u + k)[i];
    }
    out->place = segment * 2u * GN_SEGMENT + numbers[i];
    out->counts = counts[i];
  }
  if (GN_LOCAL_ID == 0u) remaining_counts[segment] = height;
}
