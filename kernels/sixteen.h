// Sixteen lanes side by side, for packets of rays: a comparison's bits. Feeds packet_rays.h.
#ifndef GNOMON_SIXTEEN_H
#define GNOMON_SIXTEEN_H

#include "eight.h"
#include "shared/scalar.h"

// Through memory, which compilers see through: oclgrind takes lane 11 of .hi for uninitialized.
static inline float8 lower_half(float16 a) {
  float lanes[16];
  vstore16(a, 0, lanes);
  return vload8(0, lanes);
}
static inline float8 upper_half(float16 a) {
  float lanes[16];
  vstore16(a, 0, lanes);
  return vload8(1, lanes);
}

// Bit i: lane i of a is above that of b, or not above it. False where either is NaN.
#if GN_EIGHT_AVX512
static inline uint lanes_above16(float16 a, float16 b) {
  return (uint)__builtin_ia32_cmpps512_mask(a, b, 30, (ushort)65535, 4);
}
static inline uint lanes_not_above16(float16 a, float16 b) {
  return (uint)__builtin_ia32_cmpps512_mask(a, b, 18, (ushort)65535, 4);
}
#else
static inline uint lanes_above16(float16 a, float16 b) {
  return bits_of_lanes(lower_half(a) > lower_half(b)) | bits_of_lanes(upper_half(a) > upper_half(b)) << 8;
}
static inline uint lanes_not_above16(float16 a, float16 b) {
  return bits_of_lanes(lower_half(a) <= lower_half(b)) | bits_of_lanes(upper_half(a) <= upper_half(b)) << 8;
}
#endif

#define GN_BITS16 \
  ((int16)(1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768))

// All ones where the bit is set.
static inline int16 lanes_of_bits16(uint bits) { return ((int16)((int)bits) & GN_BITS16) != 0; }

static inline float largest_of16(float16 a) {
  const float8 low = lower_half(a), high = upper_half(a), b = GN_MAX8(low, high);
  const float8 c = GN_MAX8(b, b.s45670123);
  const float8 d = GN_MAX8(c, c.s23016745);
  return gn_max(d.s0, d.s1);
}
static inline float smallest_of16(float16 a) { return -largest_of16(-a); }

#endif
