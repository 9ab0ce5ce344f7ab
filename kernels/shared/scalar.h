// Names of scalar types and function qualifiers for code that both compilers read: the host's C++ and the
// device's OpenCL C. Not for anything else: no vector types, no bool, no size_t, no GLM (their size or
// alignment differs between the two). Feeds every other header in this folder.
#ifndef GNOMON_SHARED_SCALAR_H
#define GNOMON_SHARED_SCALAR_H

#ifdef __OPENCL_VERSION__
#pragma OPENCL FP_CONTRACT OFF
#if defined(cl_khr_fp64) && !defined(GN_WITHOUT_FP64)
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#define GN_HAS_FP64 1
#else
#define GN_HAS_FP64 0
#endif
typedef float gn_f32;
typedef int gn_i32;
typedef uint gn_u32;
typedef ushort gn_u16;
#define GN_INLINE static inline
#define GN_GLOBAL __global  // where buffers are
#define GN_SIZE_IS(type, bytes)
#else
#include <cmath>
#include <cstdint>
#include <cstring>
#ifdef GN_WITHOUT_FP64  // tests compile the arithmetic of devices without double on the host
#define GN_HAS_FP64 0
#else
#define GN_HAS_FP64 1
#endif
using gn_f32 = float;
using gn_i32 = std::int32_t;
using gn_u32 = std::uint32_t;
using gn_u16 = std::uint16_t;
#define GN_INLINE static inline
#define GN_GLOBAL
#define GN_SIZE_IS(type, bytes) static_assert(sizeof(type) == (bytes), #type " must have no padding")
#endif

// Reads a float's bits as an integer and back.
#ifdef __OPENCL_VERSION__
GN_INLINE gn_u32 gn_bits_of(gn_f32 value) { return as_uint(value); }
GN_INLINE gn_f32 gn_float_of(gn_u32 bits) { return as_float(bits); }
#else
GN_INLINE gn_u32 gn_bits_of(gn_f32 value) {
  gn_u32 bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}
GN_INLINE gn_f32 gn_float_of(gn_u32 bits) {
  gn_f32 value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}
#endif

// -0 becomes +0, so that minima do not depend on the order of their arguments. By bits: adding +0 does the same in IEEE
// arithmetic, but compilers drop it (Mesa's llvmpipe).
GN_INLINE gn_f32 gn_without_negative_zero(gn_f32 x) { return gn_bits_of(x) == 0x80000000u ? 0.0f : x; }

// Ternaries, not fmin/fmax: one instruction on every target, and b wins when a comparison meets a NaN.
GN_INLINE gn_f32 gn_min(gn_f32 a, gn_f32 b) { return a < b ? a : b; }
GN_INLINE gn_f32 gn_max(gn_f32 a, gn_f32 b) { return a > b ? a : b; }
GN_INLINE gn_f32 gn_abs(gn_f32 a) { return gn_float_of(gn_bits_of(a) & 0x7fffffffu); }

#endif
