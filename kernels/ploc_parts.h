// What becomes of a segment once it is merged: its clusters, and what lies below them ready to be put into the tree, triangles
// in leaf order and nodes in pairs, both numbered within the segment (GnCluster). Positions go from the roots down: a merge
// tells its children where they begin. Feeds ploc.cl.
#ifndef GNOMON_PLOC_PARTS_H
#define GNOMON_PLOC_PARTS_H

#include "ploc_lanes.h"
#include "triangle_box.h"

// Where merges of a segment are kept: local memory has no room for them beside the clusters.
#if GN_WGS == 1
#define GN_MERGES __private
#else
#define GN_MERGES __global
#endif

// Instead of a node's place: it stands inside a leaf, or the tree over the clusters has it. No segment has so many nodes; the
// serial flavour writes there what nobody reads rather than ask.
#define GN_IN_LEAF (GN_SEGMENT_NODES - 1u)
#define GN_ABOVE (GN_SEGMENT_NODES - 2u)

// What has been merged, and of each merge what its left child counted.
typedef struct GnMerged {
  GN_MERGES GnMerge* records;
  __local uint* left_counts;
} GnMerged;

// Where a number, triangle or merge, has its place: its first triangle, its first split, its node. Kept by number in the
// clusters' planes, of whose boxes nothing is needed any more.
#define GN_SPOT(begin, split, node) ((begin) | (split) << 10 | (node) << 20)
#define GN_SPOT_BEGIN(spot) ((spot) & 1023u)
#define GN_SPOT_SPLIT(spot) (((spot) >> 10) & 1023u)
#define GN_SPOT_NODE(spot) ((spot) >> 20)

// The clusters that remain.
static inline void store_clusters(const GnClusters* clusters, const GnMerged* merges, __global GnCluster* out, uint height) {
  uint i;
  // Counted to a constant: with a bound that a loop before has changed Mesa 22.3 leaves after the first turn.
  for (i = GN_LOCAL_ID; i < GN_SEGMENT_CLUSTERS; i += GN_WGS) {
    if (i < height) {
      __local const uint* at = plane_of(clusters, 0u) + i;
      __global uint* words = (__global uint*)(out + i);
      const uint number = at[GN_NUMBERS * GN_PLACES] & 0xffffu, depth = at[GN_NUMBERS * GN_PLACES] >> 16;
      const uint left = depth ? merges->left_counts[number - GN_SEGMENT] >> 16 : 0u;
      vstore4((uint4)(at[0], at[GN_PLACES], at[2u * GN_PLACES], left | depth << 16), 0, words);
      vstore4((uint4)(at[3u * GN_PLACES], at[4u * GN_PLACES], at[5u * GN_PLACES], at[GN_COUNTS * GN_PLACES]), 1, words);
    }
  }
}

// Tells their roots where they begin. Their boxes are gone then.
static inline void place_roots(const GnClusters* clusters, uint height) {
  uint begin = 0u, split = 0u, i;
  for (i = 0u; i < GN_SEGMENT_CLUSTERS; ++i) {
    if (i < height) {
      const uint number = plane_of(clusters, GN_NUMBERS)[i] & 0xffffu, counts = plane_of(clusters, GN_COUNTS)[i];
      if (i % GN_WGS == GN_LOCAL_ID) clusters->planes[number] = GN_SPOT(begin, split, GN_ABOVE);
      begin += counts & 0xffffu;
      split += counts >> 16;
    }
  }
}

static inline void place_part(__global GnNode* parts, uint at, uint4 lo, uint4 hi, uint first, uint count) {
#if GN_WGS > 1
  if (at >= GN_ABOVE) return;
#endif
  vstore4((uint4)(lo.xyz, first), 0, (__global uint*)(parts + at));
  vstore4((uint4)(hi.xyz, count), 1, (__global uint*)(parts + at));
}

// Writes the node of a merge that knows its place, and tells its children theirs.
static inline void place_children(__local uint* spots, const GnMerged* merges, uint merge, __global GnNode* parts) {
  GN_MERGES const uint* words = (GN_MERGES const uint*)(merges->records + merge);
  const uint4 lo = vload4(0, words), hi = vload4(1, words);
  const uint spot = spots[GN_SEGMENT + merge], left_counts = merges->left_counts[merge];
  const uint begin = GN_SPOT_BEGIN(spot), split = GN_SPOT_SPLIT(spot), node = GN_SPOT_NODE(spot);
  const uint is_leaf = (uint)(node == GN_IN_LEAF) | (uint)(hi.w >> 16 == 0u);
  const uint own = split + (left_counts >> 16);
  place_part(parts, node, lo, hi, is_leaf ? begin : 2u * own, is_leaf ? hi.w & 0xffffu : 0u);
  spots[lo.w & 0xffffu] = GN_SPOT(begin, split, is_leaf ? GN_IN_LEAF : 2u * own);
  spots[lo.w >> 16] = GN_SPOT(begin + (left_counts & 0xffffu), own + 1u, is_leaf ? GN_IN_LEAF : 2u * own + 1u);
}

// Copies the triangles to where they begin, and writes nodes of those that are leaves by themselves.
static inline void place_triangles(__local const uint* spots, __global const float* triangles, __global const uint2* keys,
                                   __global GnLeafTriangle* sorted, __global GnNode* parts, uint count) {
  uint i;
  for (i = GN_LOCAL_ID; i < GN_SEGMENT; i += GN_WGS) {
    if (i < count) {
      const uint triangle = keys[i].y, begin = GN_SPOT_BEGIN(spots[i]);
      const GnCorners corners = corners_of(triangles, triangle);
      const GnBoxPair box = box_of_corners(corners.a, corners.b, corners.c);
      __global uint* out = (__global uint*)(sorted + begin);
      vstore4((uint4)(as_uint3(corners.a), triangle), 0, out);
      vstore4((uint4)(as_uint3(corners.b), 0u), 1, out);
      vstore4((uint4)(as_uint3(corners.c), 0u), 2, out);
      place_part(parts, GN_SPOT_NODE(spots[i]), as_uint4(box.lo), as_uint4(box.hi), begin, 1u);
    }
  }
}

#endif
