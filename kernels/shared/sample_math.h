// Random numbers for the path tracer, for both compilers: each is a function of seed, pixel, sample and what it is for,
// never of what was drawn before. Integer steps only, so the same on every device. Not cryptographic. Sources: Burley
// 2020 (shuffled Sobol points with hashed Owen scrambling), Wellons' triple32 (hash).
#ifndef GNOMON_SHARED_SAMPLE_MATH_H
#define GNOMON_SHARED_SAMPLE_MATH_H

#include "elementary_math.h"

GN_INLINE gn_u32 gn_hash(gn_u32 x) {
  x ^= x >> 17;
  x *= 0xed5ad4bbu;
  x ^= x >> 11;
  x *= 0xac4c1b51u;
  x ^= x >> 15;
  x *= 0x31848babu;
  return x ^ (x >> 14);
}

GN_INLINE gn_u32 gn_hash_with(gn_u32 hash, gn_u32 value) { return gn_hash(hash ^ (value + 0x9e3779b9u)); }

GN_INLINE gn_u32 gn_reversed_bits(gn_u32 x) {
  x = (x >> 16) | (x << 16);
  x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

// A nested permutation of the numbers whose bits are read from the lowest: what a bit becomes depends on lower ones
// only.
GN_INLINE gn_u32 gn_nested_hash(gn_u32 x, gn_u32 seed) {
  x += seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  return x ^ (x * 0x8d22f6e6u);
}

// The second coordinate of a Sobol point, whose first is `reversed`, its number's bits reversed: Pascal's triangle
// modulo two times those bits, as (1 + x)^n = 1 + x^n modulo two for powers of two n.
GN_INLINE gn_u32 gn_second_sobol(gn_u32 reversed) {
  reversed ^= (reversed & 0x0000ffffu) << 16;
  reversed ^= (reversed & 0x00ff00ffu) << 8;
  reversed ^= (reversed & 0x0f0f0f0fu) << 4;
  reversed ^= (reversed & 0x33333333u) << 2;
  return reversed ^ ((reversed & 0x55555555u) << 1);
}

// The upper 24 bits, in [0, 1).
GN_INLINE gn_f32 gn_unit_of(gn_u32 bits) { return (gn_f32)(bits >> 8) * 5.9604645e-8f; }

// The sample-th point of the unit square of those meant for `purpose` in a pixel. Any 2^k consecutive samples from a
// multiple of 2^k on lie evenly; points of different purposes or pixels know nothing of each other.
GN_INLINE void gn_sample_point(const gn_u32* seed, gn_u32 pixel, gn_u32 purpose, gn_u32 sample, gn_f32* point) {
  const gn_u32 key = gn_hash_with(gn_hash_with(gn_hash_with(gn_hash_with(0u, seed[0]), seed[1]), pixel), purpose);
  const gn_u32 shuffled = gn_nested_hash(gn_reversed_bits(sample), key);  // bits reversed, as the rest takes them
  const gn_u32 first = gn_reversed_bits(gn_nested_hash(gn_reversed_bits(shuffled), gn_hash_with(key, 1u)));
  const gn_u32 second = gn_nested_hash(gn_reversed_bits(gn_second_sobol(shuffled)), gn_hash_with(key, 2u));
  point[0] = gn_unit_of(first);
  point[1] = gn_unit_of(gn_reversed_bits(second));
}

// Cosine and sine of an angle in full turns from 0 to 1: Taylor's series on an eighth of a turn, error below 3e-7.
GN_INLINE void gn_cos_sin(gn_f32 turns, gn_f32* cos_sin) {
  const gn_u32 quarter = (gn_u32)(4.0f * turns + 0.5f);
  const gn_f32 x = 6.2831853f * (turns - 0.25f * (gn_f32)quarter);
  const gn_f32 z = x * x;
  const gn_f32 s = x * (1.0f + z * (-0.16666667f + z * (8.3333333e-3f + z * (-1.9841270e-4f + z * 2.7557319e-6f))));
  const gn_f32 c = 1.0f + z * (-0.5f + z * (4.1666667e-2f + z * (-1.3888889e-3f + z * 2.4801587e-5f)));
  const gn_f32 cosine = (quarter & 1u) != 0u ? s : c;
  const gn_f32 sine = (quarter & 1u) != 0u ? c : s;
  cos_sin[0] = quarter == 1u || quarter == 2u ? -cosine : cosine;
  cos_sin[1] = quarter == 2u || quarter == 3u ? -sine : sine;
}

#endif
