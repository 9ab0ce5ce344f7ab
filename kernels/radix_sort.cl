// Sorts pairs (key, value) by key, stably, digit by digit from the lowest: each pass counts every chunk's digits, turns
// the counts into places by one prefix sum over (digit, chunk), and moves the pairs there. No group waits for another, no
// width of sub-groups is assumed. Options: GN_WGS, GN_DIGIT_BITS; the sorted pairs depend on neither.
#include "group.h"

#ifndef GN_DIGIT_BITS
#define GN_DIGIT_BITS 8
#endif
#define GN_DIGITS (1u << GN_DIGIT_BITS)

// Pairs of a tile that one work-item of a cooperative group ranks: neighbours, so that the order stays.
#define GN_SORT_RUN 8u
#define GN_SORT_TILE (GN_WGS * GN_SORT_RUN)

static inline uint digit_of(uint2 pair, uint shift) { return (pair.x >> shift) & (GN_DIGITS - 1u); }

// One work-group per chunk: table[digit * chunks + chunk] says how many of its keys have that digit.
__kernel void count_digits(__global const uint2* pairs, __global uint* table, uint count, uint chunk_size, uint chunks,
                           uint shift) {
  __local uint counts[GN_DIGITS];
  const uint chunk = (uint)get_group_id(0);
  const uint begin = min(count, chunk * chunk_size);
  const uint end = begin + min(count - begin, chunk_size);
  uint i;
  for (i = GN_LOCAL_ID; i < GN_DIGITS; i += GN_WGS) counts[i] = 0u;
  GN_GROUP_BARRIER();
  for (i = begin + GN_LOCAL_ID; i < end; i += GN_WGS) {
#if GN_WGS == 1
    counts[digit_of(pairs[i], shift)] += 1u;
#else
    atomic_inc(counts + digit_of(pairs[i], shift));
#endif
  }
  GN_GROUP_BARRIER();
  for (i = GN_LOCAL_ID; i < GN_DIGITS; i += GN_WGS) table[i * chunks + chunk] = counts[i];
}

// One work-group: replaces each of `count` values by the sum of those before it; the sum of all goes behind the last.
__kernel void scan_values(__global uint* values, uint count) {
#if GN_WGS > 1
  __local uint sums[GN_WGS];
#endif
  const uint share = (count + GN_WGS - 1u) / GN_WGS;
  const uint begin = min(count, GN_LOCAL_ID * share);
  const uint end = min(count, begin + share);
  uint i, sum = 0u;
#if GN_WGS > 1
  for (i = begin; i < end; ++i) sum += values[i];
  sum = group_sum_before(sum, sums);
#endif
  for (i = begin; i < end; ++i) {
    const uint value = values[i];
    values[i] = sum;
    sum += value;
  }
  if (GN_LOCAL_ID == GN_WGS - 1u) values[count] = sum;
}

// One work-group per chunk: moves its pairs to their places of this digit. table: as scan_values left it.
__kernel void scatter_by_digit(__global const uint2* from, __global uint2* to, __global const uint* table, uint count,
                               uint chunk_size, uint chunks, uint shift) {
  __local uint places[GN_DIGITS];
  const uint chunk = (uint)get_group_id(0);
  const uint begin = min(count, chunk * chunk_size);
  const uint end = begin + min(count - begin, chunk_size);
  uint i;
  for (i = GN_LOCAL_ID; i < GN_DIGITS; i += GN_WGS) places[i] = table[i * chunks + chunk];
#if GN_WGS == 1
  for (i = begin; i < end; ++i) {
    const uint2 pair = from[i];
    const uint digit = digit_of(pair, shift);
    const uint place = places[digit];
    places[digit] = place + 1u;
    to[place] = pair;
  }
#else
  // counts[digit][item]: an item's pairs of a digit, then how many of the tile's come before them.
  __local uint counts[GN_DIGITS * GN_WGS];
  __local uint sums[GN_WGS];
  uint tile;
  for (tile = begin; tile < end; tile += GN_SORT_TILE) {
    const uint first = min(end, tile + GN_LOCAL_ID * GN_SORT_RUN);
    const uint last = min(end, first + GN_SORT_RUN);
    uint digit, sum = 0u;
    for (digit = 0u; digit < GN_DIGITS; ++digit) counts[digit * GN_WGS + GN_LOCAL_ID] = 0u;
    for (i = first; i < last; ++i) counts[digit_of(from[i], shift) * GN_WGS + GN_LOCAL_ID] += 1u;
    GN_GROUP_BARRIER();
    // Each item sums up GN_DIGITS neighbours of the whole array, all of them in its order.
    for (i = 0u; i < GN_DIGITS; ++i) sum += counts[GN_LOCAL_ID * GN_DIGITS + i];
    sum = group_sum_before(sum, sums);
    for (i = 0u; i < GN_DIGITS; ++i) {
      const uint value = counts[GN_LOCAL_ID * GN_DIGITS + i];
      counts[GN_LOCAL_ID * GN_DIGITS + i] = sum;
      sum += value;
    }
    GN_GROUP_BARRIER();
    // Of a digit's first item the count before it is that of smaller digits.
    for (digit = GN_LOCAL_ID; digit < GN_DIGITS; digit += GN_WGS) places[digit] -= counts[digit * GN_WGS];
    GN_GROUP_BARRIER();
    for (i = first; i < last; ++i) {
      const uint2 pair = from[i];
      const uint at = digit_of(pair, shift) * GN_WGS + GN_LOCAL_ID;
      to[places[digit_of(pair, shift)] + counts[at]] = pair;
      counts[at] += 1u;
    }
    GN_GROUP_BARRIER();
    // The last item's count has become that of all pairs up to its digit: where the next tile goes on.
    for (digit = GN_LOCAL_ID; digit < GN_DIGITS; digit += GN_WGS) places[digit] += counts[digit * GN_WGS + GN_WGS - 1u];
    GN_GROUP_BARRIER();
  }
#endif
}
