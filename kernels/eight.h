// Eight lanes side by side: what OpenCL C lacks for them (a comparison's bits, compaction, sorting), in portable form
// and, where the device's own compiler says it can, with the instruction made for it. Both give the same lanes.
// Options: GN_PORTABLE (1: the portable form everywhere). Feeds trace_wide.cl.
#ifndef GNOMON_EIGHT_H
#define GNOMON_EIGHT_H

#ifndef GN_PORTABLE
#define GN_PORTABLE 0
#endif
#if !GN_PORTABLE && defined(__clang__) && defined(__AVX512VL__) && defined(__AVX512F__)
#define GN_EIGHT_AVX512 1
#else
#define GN_EIGHT_AVX512 0
#endif
#if !GN_PORTABLE && defined(__clang__) && defined(__AVX__)
#define GN_EIGHT_AVX 1
#else
#define GN_EIGHT_AVX 0
#endif

// One instruction each; the second argument wins when a comparison meets a NaN, as in gn_min and gn_max.
#define GN_MIN8(a, b) ((a) < (b) ? (a) : (b))
#define GN_MAX8(a, b) ((a) > (b) ? (a) : (b))

#define GN_LANES8 ((int8)(0, 1, 2, 3, 4, 5, 6, 7))

static inline uint lowest_bit(uint x) {
#if GN_EIGHT_AVX
  return (uint)__builtin_ctz(x);
#else
  return 31u - clz(x & (0u - x));
#endif
}
static inline uint highest_bit(uint x) { return 31u - clz(x); }

// Bit i: lane i of a comparison's result is true.
static inline uint bits_of_lanes(int8 lanes) {
#if GN_EIGHT_AVX
  return (uint)__builtin_ia32_movmskps256(as_float8(lanes));
#else
  // A bit of every lane's byte, and their sum in the highest byte.
  const ulong bytes = as_ulong(convert_char8(lanes)) & 0x8040201008040201UL;
  return (uint)((bytes * 0x0101010101010101UL) >> 56);
#endif
}

static inline uint lanes_not_above(float8 a, float8 b) {
#if GN_EIGHT_AVX512
  return (uint)__builtin_ia32_cmpps256_mask(a, b, 18, (uchar)255);  // less or equal, quiet
#else
  return bits_of_lanes(a <= b);
#endif
}

static inline uint lanes_above(float8 a, float8 b) {
#if GN_EIGHT_AVX512
  return (uint)__builtin_ia32_cmpps256_mask(a, b, 30, (uchar)255);  // greater, quiet
#else
  return bits_of_lanes(a > b);
#endif
}

// Lanes where a is above b and c above d, and where either is: one comparison's bits less than two of the above.
static inline uint lanes_both_above(float8 a, float8 b, float8 c, float8 d) {
#if GN_EIGHT_AVX512
  return lanes_above(a, b) & lanes_above(c, d);
#else
  return bits_of_lanes((a > b) & (c > d));
#endif
}
static inline uint lanes_either_above(float8 a, float8 b, float8 c, float8 d) {
#if GN_EIGHT_AVX512
  return lanes_above(a, b) | lanes_above(c, d);
#else
  return bits_of_lanes((a > b) | (c > d));
#endif
}

// One stage of a sorting network: lanes where `upper` is set keep the larger of themselves and their partner.
#define GN_EXCHANGE8(keys, partner, upper)                              \
  {                                                                     \
    const int8 other = partner;                                         \
    keys = (upper) ? max(keys, other) : min(keys, other);               \
  }
#define GN_SIGNS8(a, b, c, d, e, f, g, h) ((int8)(-(a), -(b), -(c), -(d), -(e), -(f), -(g), -(h)))

// The same for keys of which no two are equal, with what belongs to them.
#define GN_EXCHANGE_BOTH8(keys, links, partner, upper)                  \
  {                                                                     \
    const int8 other = keys.partner, takes = ~((other > keys) ^ (upper)); \
    keys = takes ? other : keys;                                        \
    links = takes ? links.partner : links;                              \
  }

// Ascending order of lanes 0 to 3; lanes 4 to 7 are undefined.
static inline int8 sort_first_four(int8 keys) {
  GN_EXCHANGE8(keys, keys.s10325476, GN_SIGNS8(0, 1, 1, 0, 0, 1, 1, 0));
  GN_EXCHANGE8(keys, keys.s23016745, GN_SIGNS8(0, 0, 1, 1, 0, 0, 1, 1));
  GN_EXCHANGE8(keys, keys.s10325476, GN_SIGNS8(0, 1, 0, 1, 0, 1, 0, 1));
  return keys;
}

// Ascending order of all lanes (bitonic: Batcher 1968).
static inline int8 sort_eight(int8 keys) {
  GN_EXCHANGE8(keys, keys.s10325476, GN_SIGNS8(0, 1, 1, 0, 0, 1, 1, 0));
  GN_EXCHANGE8(keys, keys.s23016745, GN_SIGNS8(0, 0, 1, 1, 1, 1, 0, 0));
  GN_EXCHANGE8(keys, keys.s10325476, GN_SIGNS8(0, 1, 0, 1, 1, 0, 1, 0));
  GN_EXCHANGE8(keys, keys.s45670123, GN_SIGNS8(0, 0, 0, 0, 1, 1, 1, 1));
  GN_EXCHANGE8(keys, keys.s23016745, GN_SIGNS8(0, 0, 1, 1, 0, 0, 1, 1));
  GN_EXCHANGE8(keys, keys.s10325476, GN_SIGNS8(0, 1, 0, 1, 0, 1, 0, 1));
  return keys;
}

// Where a ray enters a box, with the box's lane in the three lowest bits: orders boxes by distance. entries must not
// be negative.
static inline int8 entry_keys(float8 entries) { return (as_int8(entries) & ~7) | GN_LANES8; }

// Writes the keys and the links of the lanes in mask, `count` of them, to keys_out and links_out, farthest first. Both must
// have room for eight. Without a branch on how many they are up to four: which it is cannot be foreseen.
static inline void put_by_distance(float8 entries, uint mask, uint count, __global const uint* links, uint* keys_out,
                                   uint* links_out) {
#if GN_EIGHT_AVX512
  int8 keys = as_int8(__builtin_ia32_compresssi256_mask(entry_keys(entries), (int8)INT_MAX, (uchar)mask));
  keys = count <= 4u ? sort_first_four(keys) : sort_eight(keys);
  keys = as_int8(__builtin_ia32_permvarsi256(keys, (int8)((int)count - 1) - GN_LANES8));
  vstore8(as_uint8(keys), 0, keys_out);
  vstore8(as_uint8(__builtin_ia32_permvarsi256(as_int8(vload8(0, links)), keys)), 0, links_out);
#else
  // Farthest first by their complements, which are as many, ascending; those that are not in the mask come last.
  const int8 chosen = ((int8)((int)mask) & (int8)(1, 2, 4, 8, 16, 32, 64, 128)) != 0;
  int8 keys = chosen ? ~entry_keys(entries) : (int8)INT_MAX;
  uint8 sorted = vload8(0, links);
  GN_EXCHANGE_BOTH8(keys, sorted, s10325476, GN_SIGNS8(0, 1, 1, 0, 0, 1, 1, 0));
  GN_EXCHANGE_BOTH8(keys, sorted, s23016745, GN_SIGNS8(0, 0, 1, 1, 1, 1, 0, 0));
  GN_EXCHANGE_BOTH8(keys, sorted, s10325476, GN_SIGNS8(0, 1, 0, 1, 1, 0, 1, 0));
  GN_EXCHANGE_BOTH8(keys, sorted, s45670123, GN_SIGNS8(0, 0, 0, 0, 1, 1, 1, 1));
  GN_EXCHANGE_BOTH8(keys, sorted, s23016745, GN_SIGNS8(0, 0, 1, 1, 0, 0, 1, 1));
  GN_EXCHANGE_BOTH8(keys, sorted, s10325476, GN_SIGNS8(0, 1, 0, 1, 0, 1, 0, 1));
  vstore8(as_uint8(~keys), 0, keys_out);
  vstore8(sorted, 0, links_out);
#endif
}

// The same for packets, with base plus the lane instead of links.
static inline void put_places(float8 entries, uint mask, uint count, uint base, uint* keys_out, uint* places_out) {
#if GN_EIGHT_AVX512
  int8 keys = as_int8(__builtin_ia32_compresssi256_mask(entry_keys(entries), (int8)INT_MAX, (uchar)mask));
  if (count > 1u) keys = count <= 4u ? sort_first_four(keys) : sort_eight(keys);
  keys = as_int8(__builtin_ia32_permvarsi256(keys, (int8)((int)count - 1) - GN_LANES8));
  vstore8(as_uint8(keys), 0, keys_out);
  vstore8(as_uint8(keys & 7) + base, 0, places_out);
#else
  const int8 chosen = ((int8)((int)mask) & (int8)(1, 2, 4, 8, 16, 32, 64, 128)) != 0;
  const int8 keys = ~sort_eight(chosen ? ~entry_keys(entries) : (int8)INT_MAX);
  vstore8(as_uint8(keys), 0, keys_out);
  vstore8(as_uint8(keys & 7) + base, 0, places_out);
#endif
}

// Writes base plus the lane for the lanes in mask, lowest lane first. Room for eight.
static inline void put_lanes(uint mask, uint base, uint* places_out) {
  while (mask != 0u) {
    *places_out++ = base + lowest_bit(mask);
    mask &= mask - 1u;
  }
}

#if GN_EIGHT_AVX512
// Writes the links of the lanes in mask, lowest lane first, to links_out, which must have room for eight. Only where it is an
// instruction: wide_walk.h does without elsewhere.
static inline void put_in_order(uint mask, __global const uint* links, uint* links_out) {
  vstore8(as_uint8(__builtin_ia32_compresssi256_mask(as_int8(vload8(0, links)), (int8)0, (uchar)mask)), 0,
          links_out);
}
#endif

// Keeps of what waits, `count` of it, what is entered no further than limit, in its order; returns how much that is. Both
// arrays may be read eight beyond count.
static inline uint keep_near(uint* keys, uint* links, uint count, float limit) {
  const int most = (limit > 0.0f ? as_int(limit) : 0) | 7;  // not fmax, which may leave -0
  uint i, kept = 0u;
#if GN_EIGHT_AVX512
  for (i = 0u; i < count; i += 8u) {
    const int8 these = as_int8(vload8(0, keys + i)), theirs = as_int8(vload8(0, links + i));
    const uint mask = bits_of_lanes(these <= most) & (count - i < 8u ? (1u << (count - i)) - 1u : 255u);
    vstore8(as_uint8(__builtin_ia32_compresssi256_mask(these, (int8)0, (uchar)mask)), 0, keys + kept);
    vstore8(as_uint8(__builtin_ia32_compresssi256_mask(theirs, (int8)0, (uchar)mask)), 0, links + kept);
    kept += popcount(mask);
  }
#else
  for (i = 0u; i < count; ++i) {
    keys[kept] = keys[i];
    links[kept] = links[i];
    kept += (int)keys[i] <= most;
  }
#endif
  return kept;
}

#endif
