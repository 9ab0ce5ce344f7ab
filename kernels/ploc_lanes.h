// Clusters of a segment as merging looks at them, many at once: each one's nearest neighbour on the curve, and closing the
// ranks when some are gone. Sixteen lanes on CPUs that have them, one cluster after the other elsewhere; the same results.
// Feeds ploc.cl.
#ifndef GNOMON_PLOC_LANES_H
#define GNOMON_PLOC_LANES_H

#include "eight.h"
#include "group.h"
#include "shared/fast_math.h"

#define GN_CLUSTERS_AT_ONCE 16u

// What a work-item does of a loop up to a bound that a loop before has changed, after whose first turn Mesa 22.3 leaves it:
// elsewhere than in PoCL it is counted to a constant.
#ifdef POCL_DEVICE_ADDRESS_BITS
#define GN_FOR_UP_TO(i, bound, most) for (i = GN_LOCAL_ID; i < (bound); i += GN_WGS)
#else
#define GN_FOR_UP_TO(i, bound, most)                 \
  for (i = GN_LOCAL_ID; i < (most); i += GN_WGS)     \
    if (i < (bound))
#endif

// Places before the first cluster and behind the last that neighbours may be looked for in; behind, those of sixteen
// clusters of which the first is the last.
#define GN_BEFORE 8u
#define GN_BEHIND 24u
#define GN_PLACES (GN_BEFORE + GN_SEGMENT + GN_BEHIND)

// planes: of each cluster in its order on the curve the lower x, y, z, the upper x, y, z, what it costs and counts
// (gn_merge_counts), its number, and the place of the one it chose, each from GN_BEFORE on. Bits throughout: small whole
// numbers are floats that devices may take for zero.
typedef struct GnClusters {
  __local uint* planes;
} GnClusters;
#define GN_COSTS 6u
#define GN_COUNTS 7u
#define GN_NUMBERS 8u
#define GN_STAYING 9u  // planes that say what a cluster is
#define GN_CHOSEN 9u
#define GN_PLANES 10u

static inline __local uint* plane_of(const GnClusters* clusters, uint plane) {
  return clusters->planes + plane * GN_PLACES + GN_BEFORE;
}

// Vectors that may begin at any number: compilers cut vload16 and vstore16 into pieces, and share pieces of loads that overlap.
typedef uint16 GnLoose16 __attribute__((aligned(4)));
typedef float16 GnLooseFloat16 __attribute__((aligned(4)));
#define GN_FLOATS16(at) (*(__local const GnLooseFloat16*)(at))
#define GN_PUT16(space, at, value) (*(space GnLoose16*)(at) = (value))
#define GN_LANES16 ((uint16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))

// PoCL's compiler makes sixteen lanes one instruction or two; others take the loops below.
#if GN_WGS == 1 && defined(POCL_DEVICE_ADDRESS_BITS)

// Keys of sixteen clusters and those so many places away: gn_pair_key's, whose lower place has the bit that `sides` says.
static inline uint16 keys_at(__local const float* lo_x, int away, uint distance, uint16 sides) {
  __local const float* hi_x = lo_x + 3u * GN_PLACES;
  const float16 dx = GN_VMAX(GN_FLOATS16(hi_x + away), GN_FLOATS16(hi_x)) -
                     GN_VMIN(GN_FLOATS16(lo_x + away), GN_FLOATS16(lo_x));
  const float16 dy = GN_VMAX(GN_FLOATS16(hi_x + GN_PLACES + away), GN_FLOATS16(hi_x + GN_PLACES)) -
                     GN_VMIN(GN_FLOATS16(lo_x + GN_PLACES + away), GN_FLOATS16(lo_x + GN_PLACES));
  const float16 dz = GN_VMAX(GN_FLOATS16(hi_x + 2u * GN_PLACES + away), GN_FLOATS16(hi_x + 2u * GN_PLACES)) -
                     GN_VMIN(GN_FLOATS16(lo_x + 2u * GN_PLACES + away), GN_FLOATS16(lo_x + 2u * GN_PLACES));
  const float16 area = dx * (dy + dz) + dy * dz;
  return (as_uint16(area) & ~15u) | (sides | (distance - 1u) << 1);
}

// The bit of sixteen neighbouring places that stands for a distance, the first of them a multiple of sixteen. Of two places
// so far apart one has it and the other has not.
#define GN_SIDES_1 ((uint16)(0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1))
#define GN_SIDES_2 ((uint16)(0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1))
#define GN_SIDES_4 ((uint16)(0, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0, 1, 1, 1, 1))

#define GN_BOTH_WAYS(distance, sides)                                    \
  {                                                                      \
    const uint16 behind = keys_at(lo_x, distance, distance##u, sides);   \
    const uint16 before = keys_at(lo_x, -distance, distance##u, sides ^ 1u); \
    best = min(best, min(behind, before));                               \
  }

static inline void choose_partners(const GnClusters* clusters, uint count) {
  uint i;
  for (i = 0u; i < count; i += GN_CLUSTERS_AT_ONCE) {
    __local const float* lo_x = (__local const float*)clusters->planes + GN_BEFORE + i;
    uint16 best = (uint16)(GN_NONE), distance, bit;
    GN_BOTH_WAYS(1, GN_SIDES_1)
    GN_BOTH_WAYS(2, GN_SIDES_2)
    GN_BOTH_WAYS(3, GN_SIDES_1)
    GN_BOTH_WAYS(4, GN_SIDES_4)
    GN_BOTH_WAYS(5, GN_SIDES_1)
    GN_BOTH_WAYS(6, GN_SIDES_2)
    GN_BOTH_WAYS(7, GN_SIDES_1)
    // gn_pair_partner of sixteen.
    distance = ((best & 15u) >> 1) + 1u;
    bit = distance & (0u - distance);
    bit = ((GN_LANES16 & bit) != 0u ? (uint16)(1u) : (uint16)(0u));
    GN_PUT16(__local, plane_of(clusters, GN_CHOSEN) + i, i + GN_LANES16 + (bit == (best & 1u) ? distance : 0u - distance));
  }
}

#else

static inline uint key_at(__local const float* at, int away, uint distance, uint lower) {
  const float lo[3] = {gn_min(at[0], at[away]), gn_min(at[GN_PLACES], at[(int)GN_PLACES + away]),
                       gn_min(at[2u * GN_PLACES], at[(int)(2u * GN_PLACES) + away])};
  const float hi[3] = {gn_max(at[3u * GN_PLACES], at[(int)(3u * GN_PLACES) + away]),
                       gn_max(at[4u * GN_PLACES], at[(int)(4u * GN_PLACES) + away]),
                       gn_max(at[5u * GN_PLACES], at[(int)(5u * GN_PLACES) + away])};
  return gn_pair_key(gn_surface_measure(lo, hi), distance, lower);
}

#define GN_BOTH_WAYS(distance)                                                                 \
  best = min(best, min(key_at(at, distance, distance##u, place),                               \
                       key_at(at, -distance, distance##u, place - distance##u)));

// Without a loop: some devices end kernels whose loops take many turns.
static inline uint nearest_of(const GnClusters* clusters, uint place) {
  __local const float* at = (__local const float*)clusters->planes + GN_BEFORE + place;
  uint best = GN_NONE;
  GN_BOTH_WAYS(1)
  GN_BOTH_WAYS(2)
  GN_BOTH_WAYS(3)
  GN_BOTH_WAYS(4)
  GN_BOTH_WAYS(5)
  GN_BOTH_WAYS(6)
  GN_BOTH_WAYS(7)
  return best;
}

static inline void choose_partners(const GnClusters* clusters, uint count) {
  uint i;
  GN_FOR_UP_TO(i, count, GN_SEGMENT)
    plane_of(clusters, GN_CHOSEN)[i] = gn_pair_partner(nearest_of(clusters, i), i);
}

#endif

#if GN_WGS == 1

// What a round does: the places of those that become one, the lower first, and of sixteen places each which of them remain.
typedef struct GnRound {
  uint joins;
  uint lefts[GN_SEGMENT / 2u + GN_CLUSTERS_AT_ONCE];
  uint rights[GN_SEGMENT / 2u + GN_CLUSTERS_AT_ONCE];
  ushort stays[GN_SEGMENT / GN_CLUSTERS_AT_ONCE];
} GnRound;

#if GN_EIGHT_AVX512

static inline uint16 packed16(uint16 value, uint mask) {
  return as_uint16(__builtin_ia32_compresssi512_mask(as_int16(value), (int16)(0), (ushort)mask));
}

static inline void find_joins(const GnClusters* clusters, uint count, GnRound* round) {
  uint i;
  round->joins = 0u;
  for (i = 0u; i < count; i += GN_CLUSTERS_AT_ONCE) {
    __local const uint* at = plane_of(clusters, GN_CHOSEN) + i;
    const uint16 own = i + GN_LANES16, chosen = *(__local const GnLoose16*)at;
    // Whom the chosen one chose: it is not eight places away.
    const int16 before = as_int16(*(__local const GnLoose16*)(at - 8)), behind = as_int16(*(__local const GnLoose16*)(at + 8));
    const int16 theirs = as_int16(__builtin_ia32_vpermi2vard512(before, as_int16(chosen - i + 8u), behind));
    const uint there = count - i < GN_CLUSTERS_AT_ONCE ? (1u << (count - i)) - 1u : 65535u;
    const uint mutual = (uint)__builtin_ia32_cmpd512_mask(theirs, as_int16(own), 0, (ushort)there);
    const uint upwards = (uint)__builtin_ia32_cmpd512_mask(as_int16(chosen), as_int16(own), 6, (ushort)mutual);
    const uint downwards = (uint)__builtin_ia32_cmpd512_mask(as_int16(chosen), as_int16(own), 1, (ushort)mutual);
    GN_PUT16(__private, round->lefts + round->joins, packed16(own, upwards));
    GN_PUT16(__private, round->rights + round->joins, packed16(chosen, upwards));
    round->joins += popcount(upwards);
    round->stays[i / GN_CLUSTERS_AT_ONCE] = (ushort)(there & ~downwards);
  }
}

// Moves the clusters that remain together in their order: how many they are.
static inline uint close_ranks(const GnClusters* clusters, const GnRound* round, uint count) {
  uint kept = 0u, i, k;
  for (i = 0u; i < count; i += GN_CLUSTERS_AT_ONCE) {
    const uint mask = round->stays[i / GN_CLUSTERS_AT_ONCE];
    for (k = 0u; k < GN_STAYING; ++k) {
      __local uint* plane = plane_of(clusters, k);
      GN_PUT16(__local, plane + kept, packed16(*(__local const GnLoose16*)(plane + i), mask));
    }
    kept += popcount(mask);
  }
  return kept;
}

#else

static inline void find_joins(const GnClusters* clusters, uint count, GnRound* round) {
  __local const uint* partners = plane_of(clusters, GN_CHOSEN);
  uint i, stays = 0u;
  round->joins = 0u;
  for (i = 0u; i < count; ++i) {
    const uint chosen = partners[i], mutual = partners[chosen] == i;
    round->lefts[round->joins] = i;
    round->rights[round->joins] = chosen;
    round->joins += mutual & (uint)(chosen > i);
    stays = (i % GN_CLUSTERS_AT_ONCE ? stays : 0u) |
            (1u ^ (mutual & (uint)(chosen < i))) << (i % GN_CLUSTERS_AT_ONCE);
    round->stays[i / GN_CLUSTERS_AT_ONCE] = (ushort)stays;
  }
}

// Planes one by one without a loop: some devices end kernels whose loops take many turns.
static inline uint close_ranks(const GnClusters* clusters, const GnRound* round, uint count) {
  __local uint* boxes = plane_of(clusters, 0u);
  uint kept = 0u, i;
  for (i = 0u; i < count; ++i) {
    boxes[kept] = boxes[i];
    boxes[GN_PLACES + kept] = boxes[GN_PLACES + i];
    boxes[2u * GN_PLACES + kept] = boxes[2u * GN_PLACES + i];
    boxes[3u * GN_PLACES + kept] = boxes[3u * GN_PLACES + i];
    boxes[4u * GN_PLACES + kept] = boxes[4u * GN_PLACES + i];
    boxes[5u * GN_PLACES + kept] = boxes[5u * GN_PLACES + i];
    boxes[GN_COSTS * GN_PLACES + kept] = boxes[GN_COSTS * GN_PLACES + i];
    boxes[GN_COUNTS * GN_PLACES + kept] = boxes[GN_COUNTS * GN_PLACES + i];
    boxes[GN_NUMBERS * GN_PLACES + kept] = boxes[GN_NUMBERS * GN_PLACES + i];
    kept += (uint)(round->stays[i / GN_CLUSTERS_AT_ONCE] >> (i % GN_CLUSTERS_AT_ONCE)) & 1u;
  }
  return kept;
}

#endif

#endif

#endif
