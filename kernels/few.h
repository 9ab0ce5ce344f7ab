// Binning a node of few primitives, which most nodes are. Device only. Feeds subtree.cl.
#ifndef GNOMON_FEW_H
#define GNOMON_FEW_H

#include "bin.h"

// A node of few primitives has no use for bins that are empty: a serial group numbers only as many as there are primitives,
// which leaves the order of those that hold any, and so the split, as they were.
#if GN_WGS == 1 && GN_BINS > 8 && !GN_PUBLISHED_BINS && !GN_ORDERED_AXES
#define GN_FEW 8u
// Bins `count` primitives, at most GN_FEW, into the first `count` bins of each axis. bin_at: receives which of the GN_BINS
// bins that is, axis after axis, for those that hold any.
static inline void bin_few(__global const float8* primitives, uint count, GnBinning binning, __local GnBin* bins,
                           __local uint* counts, uint* bin_at) {
  int4 place[GN_FEW], rank[GN_FEW];
  uint i, k;
  for (i = 0u; i < count; ++i) {
    const float8 primitive = primitives[i];
    place[i] = places_of(primitive, binning);
    rank[i] = (int4)(0);
    for (k = 0u; k < i; ++k) {
      rank[i] -= place[k] < place[i];  // true is -1
      rank[k] -= place[i] < place[k];
    }
    for (k = 0u; k < 3u; ++k) {
      *(__local float8*)(bins + k * GN_BINS + i) = (float8)(INFINITY);
      counts[k * GN_BINS + i] = 0u;
    }
  }
  for (i = 0u; i < count; ++i) {
    const uint3 at = as_uint4(rank[i]).xyz;
    add_on_three_axes(bins, counts, at, with_upper_negated(primitives[i]));
    bin_at[at.x] = (uint)place[i].x;
    bin_at[GN_FEW + at.y] = (uint)place[i].y;
    bin_at[2u * GN_FEW + at.z] = (uint)place[i].z;
  }
}
#else
#define GN_FEW 0u
#endif

#endif
