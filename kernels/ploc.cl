// Merges the triangles of one segment of the Morton curve into a few clusters, bottom up: in every round each cluster
// finds the nearest of its neighbours on the curve, and those that chose each other become one (PLOC: Meister, Bittner
// 2018). A work-group has a segment to itself, in local memory. The serial flavour takes sixteen clusters at once where it
// can, and has no branch that depends on the data. Not for what becomes of the clusters (assemble.cl).
#include "ahead.h"
#include "ploc_lanes.h"
#include "ploc_parts.h"

// Triangles that are sent for before they are needed.
#define GN_AHEAD 32u

// One cluster on its way from place to place: its box, what it counts and costs (gn_merge_counts), its number and in the upper
// half how many levels are below its root.
typedef struct GnMoving {
  float lo_x, lo_y, lo_z, hi_x, hi_y, hi_z;
  float cost;
  uint counts;
  uint number;
} GnMoving;

static inline void put_cluster(const GnClusters* clusters, uint place, GnMoving cluster) {
  __local uint* at = plane_of(clusters, 0u) + place;
  at[0] = as_uint(cluster.lo_x);
  at[GN_PLACES] = as_uint(cluster.lo_y);
  at[2u * GN_PLACES] = as_uint(cluster.lo_z);
  at[3u * GN_PLACES] = as_uint(cluster.hi_x);
  at[4u * GN_PLACES] = as_uint(cluster.hi_y);
  at[5u * GN_PLACES] = as_uint(cluster.hi_z);
  at[GN_COSTS * GN_PLACES] = as_uint(cluster.cost);
  at[GN_COUNTS * GN_PLACES] = cluster.counts;
  at[GN_NUMBERS * GN_PLACES] = cluster.number;
}

#if GN_WGS > 1
static inline GnMoving cluster_at(const GnClusters* clusters, uint place) {
  __local const uint* at = plane_of(clusters, 0u) + place;
  GnMoving out;
  out.lo_x = as_float(at[0]);
  out.lo_y = as_float(at[GN_PLACES]);
  out.lo_z = as_float(at[2u * GN_PLACES]);
  out.hi_x = as_float(at[3u * GN_PLACES]);
  out.hi_y = as_float(at[4u * GN_PLACES]);
  out.hi_z = as_float(at[5u * GN_PLACES]);
  out.cost = as_float(at[GN_COSTS * GN_PLACES]);
  out.counts = at[GN_COUNTS * GN_PLACES];
  out.number = at[GN_NUMBERS * GN_PLACES];
  return out;
}
#endif

static inline void expect_triangle(__global const float* triangles, uint triangle) {
  GN_EXPECT(triangles + 9u * (size_t)triangle);
  GN_EXPECT(triangles + 9u * (size_t)triangle + 8);
}

static inline float half_area_of(float lo_x, float lo_y, float lo_z, float hi_x, float hi_y, float hi_z) {
  const float l[3] = {lo_x, lo_y, lo_z}, h[3] = {hi_x, hi_y, hi_z};
  return gn_surface_measure(l, h);
}

// Two clusters made one, which gets the number given: a leaf has no levels.
static inline GnMoving join(const GnClusters* clusters, uint left, uint right, uint number, GnLeafRule rule) {
  __local const uint* a = plane_of(clusters, 0u) + left;
  __local const uint* b = plane_of(clusters, 0u) + right;
  GnMoving out;
  out.lo_x = gn_min(as_float(a[0]), as_float(b[0]));
  out.lo_y = gn_min(as_float(a[GN_PLACES]), as_float(b[GN_PLACES]));
  out.lo_z = gn_min(as_float(a[2u * GN_PLACES]), as_float(b[2u * GN_PLACES]));
  out.hi_x = gn_max(as_float(a[3u * GN_PLACES]), as_float(b[3u * GN_PLACES]));
  out.hi_y = gn_max(as_float(a[4u * GN_PLACES]), as_float(b[4u * GN_PLACES]));
  out.hi_z = gn_max(as_float(a[5u * GN_PLACES]), as_float(b[5u * GN_PLACES]));
  out.counts = gn_merge_counts(rule, half_area_of(out.lo_x, out.lo_y, out.lo_z, out.hi_x, out.hi_y, out.hi_z),
                               as_float(a[GN_COSTS * GN_PLACES]) + as_float(b[GN_COSTS * GN_PLACES]),
                               a[GN_COUNTS * GN_PLACES], b[GN_COUNTS * GN_PLACES], &out.cost);
  // A product: compilers would make a branch of a choice, and which it is cannot be foreseen.
  out.number = number + min(out.counts >> 16, 1u) *
                            ((max(a[GN_NUMBERS * GN_PLACES] >> 16, b[GN_NUMBERS * GN_PLACES] >> 16) + 1u) << 16);
  return out;
}

// Writes down that `left` and `right` became `joined`. Before that takes one's place: their numbers are read.
static inline void store_merge(const GnMerged* merges, uint merge, const GnClusters* clusters, uint left, uint right,
                               GnMoving joined) {
  __local const uint* numbers = plane_of(clusters, GN_NUMBERS);
  GN_MERGES uint* out = (GN_MERGES uint*)(merges->records + merge);
  const uint children = (numbers[left] & 0xffffu) | numbers[right] << 16;
  vstore4((uint4)(as_uint(joined.lo_x), as_uint(joined.lo_y), as_uint(joined.lo_z), children), 0, out);
  vstore4((uint4)(as_uint(joined.hi_x), as_uint(joined.hi_y), as_uint(joined.hi_z), joined.counts), 1, out);
  merges->left_counts[merge] = plane_of(clusters, GN_COUNTS)[left];
}

// Boxes so large that nothing is farther than they are, on both sides of the clusters.
static inline void fence(const GnClusters* clusters, uint count) {
  uint i, k;
  for (i = GN_LOCAL_ID; i < 2u * GN_BEFORE; i += GN_WGS) {
    const uint place = i < GN_BEFORE ? i : count + i;
    for (k = 0u; k < 3u; ++k) {
      clusters->planes[k * GN_PLACES + place] = as_uint(-1e30f);
      clusters->planes[(3u + k) * GN_PLACES + place] = as_uint(1e30f);
    }
  }
}

// Partners of a round in which clusters no longer choose: every other one's is the next.
static inline void pair_neighbours(const GnClusters* clusters, uint count) {
  uint i;
  GN_FOR_UP_TO(i, count, GN_SEGMENT) plane_of(clusters, GN_CHOSEN)[i] = (i ^ 1u) < count ? i ^ 1u : i;
}

#if GN_WGS == 1

// Everything that a round does once partners are known. *height, *merged: how many clusters there are, how many merges
// there have been.
static inline void end_round(const GnClusters* clusters, GnRound* round, const GnMerged* merges, GnLeafRule rule,
                             uint* height, uint* merged) {
  uint i;
  find_joins(clusters, *height, round);
  GN_FOR_UP_TO(i, round->joins, GN_SEGMENT / 2u) {
    const uint left = round->lefts[i], right = round->rights[i], merge = *merged + i;
    const GnMoving joined = join(clusters, left, right, GN_SEGMENT + merge, rule);
    store_merge(merges, merge, clusters, left, right, joined);
    put_cluster(clusters, left, joined);
  }
  *merged += round->joins;
  *height = close_ranks(clusters, round, *height);
}

#else

// The same for a group. sums: GN_WGS numbers.
static inline void end_round(const GnClusters* clusters, __local uint* sums, const GnMerged* merges, GnLeafRule rule,
                             uint* height, uint* merged) {
  __local const uint* partners = plane_of(clusters, GN_CHOSEN);
  uint kept = 0u, i;
  for (i = 0u; i < *height; i += GN_WGS) {
    const uint place = min(i + GN_LOCAL_ID, *height - 1u), counted = i + GN_LOCAL_ID < *height;
    const uint chosen = partners[place], mutual = partners[chosen] == place;
    const uint joins = counted & mutual & (uint)(chosen > place);
    const uint stays = counted & (1u ^ (mutual & (uint)(chosen < place)));
    const uint before = group_sum_before(stays | joins << 16, sums);
    const uint merge = *merged + (before >> 16);
    GnMoving cluster = cluster_at(clusters, place);
    if (joins) {
      cluster = join(clusters, place, chosen, GN_SEGMENT + merge, rule);
      store_merge(merges, merge, clusters, place, chosen, cluster);
    }
    GN_GROUP_BARRIER();
    if (stays) put_cluster(clusters, kept + (before & 0xffffu), cluster);
    // What the last work-item counted tells what all did.
    if (GN_LOCAL_ID == GN_WGS - 1u) sums[0] = before + (stays | joins << 16);
    GN_GROUP_BARRIER();
    kept += sums[0] & 0xffffu;
    *merged += sums[0] >> 16;
    GN_GROUP_BARRIER();
  }
  *height = kept;
}

#endif

// The clusters of a segment, one a triangle.
static inline void load_clusters(const GnClusters* clusters, __global const float* triangles, __global const uint2* keys,
                                 uint count, GnLeafRule rule) {
  uint i;
#if GN_WGS == 1
  for (i = 0u; i < min(count, GN_AHEAD); ++i) expect_triangle(triangles, keys[i].y);
#endif
  for (i = GN_LOCAL_ID; i < count; i += GN_WGS) {
    const GnCorners corners = corners_of(triangles, keys[i].y);
    const GnBoxPair box = box_of_corners(corners.a, corners.b, corners.c);
    GnMoving cluster;
#if GN_WGS == 1
    expect_triangle(triangles, keys[min(i + GN_AHEAD, count - 1u)].y);
#endif
    cluster.lo_x = box.lo.x;
    cluster.lo_y = box.lo.y;
    cluster.lo_z = box.lo.z;
    cluster.hi_x = box.hi.x;
    cluster.hi_y = box.hi.y;
    cluster.hi_z = box.hi.z;
    cluster.cost = gn_triangle_cost(rule, half_area_of(box.lo.x, box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z));
    cluster.counts = 1u;
    cluster.number = i;
    put_cluster(clusters, i, cluster);
  }
}

// One work-group per segment. keys: sorted. all_merges: scratch, GN_SEGMENT for each segment; the serial flavour has its own.
// sorted, parts, remaining: GN_SEGMENT, GN_SEGMENT_NODES and GN_SEGMENT_CLUSTERS for each, filled as GnCluster says;
// remaining_counts says how many clusters there are.
__kernel void merge_segments(__global const float* triangles, __global const uint2* keys, __global GnMerge* all_merges,
                             __global GnLeafTriangle* sorted, __global GnNode* parts, __global GnCluster* remaining,
                             __global uint* remaining_counts, uint count, float cost_traversal, float cost_triangle,
                             uint max_leaf_size) {
  __local uint planes[GN_PLANES * GN_PLACES] __attribute__((aligned(64)));
  __local uint left_counts[GN_SEGMENT];
#if GN_WGS > 1
  __local uint sums[GN_WGS], rounds[GN_MOST_ROUNDS + 1u];
  const GnMerged merges = {all_merges + (size_t)get_group_id(0) * GN_SEGMENT, left_counts};
#else
  GnMerge records[GN_SEGMENT];
  const GnMerged merges = {records, left_counts};
  GnRound joins;
#endif
  const GnClusters clusters = {planes};
  const GnLeafRule rule = {cost_traversal, cost_triangle, max_leaf_size};
  const uint segment = (uint)get_group_id(0);
  const uint size = min(count - segment * GN_SEGMENT, GN_SEGMENT);
  const uint few = (size + GN_PER_CLUSTER - 1u) / GN_PER_CLUSTER;
  uint height = size, merged = 0u, round = 0u;
  keys += (size_t)segment * GN_SEGMENT;
  sorted += (size_t)segment * GN_SEGMENT;
  parts += (size_t)segment * GN_SEGMENT_NODES;
  load_clusters(&clusters, triangles, keys, size, rule);
#if GN_WGS == 1
  // What is written at the end, in no order.
  expect_range(sorted, size * sizeof(GnLeafTriangle));
  expect_range(parts, size * sizeof(GnNode));
#endif
  while (height > few && round < GN_MOST_ROUNDS) {
    fence(&clusters, height);
    GN_GROUP_BARRIER();
    if (round < GN_FREE_ROUNDS) {
      choose_partners(&clusters, height);
    } else {
      pair_neighbours(&clusters, height);
    }
    GN_GROUP_BARRIER();
#if GN_WGS == 1
    end_round(&clusters, &joins, &merges, rule, &height, &merged);
#else
    if (GN_LOCAL_ID == 0u) rounds[round] = merged;
    GN_GROUP_BARRIER();  // which nobody waits for, but PoCL 3.1 loses what was written without it
    end_round(&clusters, sums, &merges, rule, &height, &merged);
#endif
    round += 1u;
  }
  store_clusters(&clusters, &merges, remaining + (size_t)segment * GN_SEGMENT_CLUSTERS, height);
  GN_GROUP_BARRIER();
  place_roots(&clusters, height);
  if (GN_LOCAL_ID == 0u) remaining_counts[segment] = height;
  // From the roots down: rounds backwards, since merges of one round are not below each other.
#if GN_WGS == 1
  {
    uint i;
    GN_FOR_UP_TO(i, merged, GN_SEGMENT) place_children(planes, &merges, merged - 1u - i, parts);
  }
#else
  if (GN_LOCAL_ID == 0u) rounds[round] = merged;
  GN_GROUP_BARRIER();
  for (height = GN_MOST_ROUNDS; height > 0u; --height) {
    if (height <= round) {
      uint i;
      for (i = rounds[height - 1u] + GN_LOCAL_ID; i < rounds[height]; i += GN_WGS) place_children(planes, &merges, i, parts);
    }
    GN_GROUP_BARRIER();
  }
#endif
  place_triangles(planes, triangles, keys, sorted, parts, size);
}
