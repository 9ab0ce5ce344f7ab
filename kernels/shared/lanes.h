// Several boxes weighed side by side by formulae that are written once. A gn_lanes is what the compiler at hand handles
// best: four floats where a device works one item at a time (kernels/group.h), one float on the host and where work-items
// stand side by side anyway. A lane's bits do not depend on which it is. Such code has no branches, only choices
// (condition ? a : b, both computed); masks are joined by & and |. Feeds elementary_math.h and the measures.
#ifndef GNOMON_SHARED_LANES_H
#define GNOMON_SHARED_LANES_H

#include "scalar.h"

#if defined(__OPENCL_VERSION__) && defined(GN_WGS) && GN_WGS == 1
#define GN_HAS_LANES 1
// Calls would pass lanes through memory. Only where the compiler is known to take it: oclgrind 21.10 does not know what it
// leaves behind.
#if defined(POCL_DEVICE_ADDRESS_BITS)
#define GN_LANES_INLINE __attribute__((always_inline)) static inline
#else
#define GN_LANES_INLINE GN_INLINE
#endif
typedef float4 gn_lanes;
typedef uint4 gn_lane_bits;
typedef int4 gn_lane_mask;
#define GN_LANES 4u
#define GN_ALL(x) ((float4)(x))
#define GN_ALL_BITS(x) ((uint4)(x))
GN_INLINE gn_lane_bits gn_bits_of_lanes(gn_lanes x) { return as_uint4(x); }
GN_INLINE gn_lanes gn_lanes_of_bits(gn_lane_bits x) { return as_float4(x); }
GN_INLINE gn_lane_bits gn_whole_lanes(gn_lanes x) { return convert_uint4(x); }  // of 0 and more
GN_INLINE gn_f32 gn_first_lane(gn_lanes x) { return x.x; }
GN_INLINE gn_lanes gn_lanes_at(GN_GLOBAL const gn_f32* from) { return vload4(0, from); }
GN_INLINE void gn_lanes_to(gn_lanes x, gn_f32* to) { vstore4(x, 0, to); }
GN_INLINE int gn_any_lane(gn_lane_mask mask) {
  return any(mask);
}
#else
#define GN_HAS_LANES 0
#define GN_LANES_INLINE GN_INLINE
typedef gn_f32 gn_lanes;
typedef gn_u32 gn_lane_bits;
typedef int gn_lane_mask;
#define GN_LANES 1u
#define GN_ALL(x) (x)
#define GN_ALL_BITS(x) (x)
GN_INLINE gn_lane_bits gn_bits_of_lanes(gn_lanes x) { return gn_bits_of(x); }
GN_INLINE gn_lanes gn_lanes_of_bits(gn_lane_bits x) { return gn_float_of(x); }
GN_INLINE gn_lane_bits gn_whole_lanes(gn_lanes x) { return (gn_u32)x; }
GN_INLINE gn_f32 gn_first_lane(gn_lanes x) { return x; }
GN_INLINE gn_lanes gn_lanes_at(GN_GLOBAL const gn_f32* from) { return *from; }
GN_INLINE void gn_lanes_to(gn_lanes x, gn_f32* to) { *to = x; }
GN_INLINE int gn_any_lane(gn_lane_mask mask) {
  return mask;
}
#endif

// gn_min, gn_max and gn_abs of each lane.
GN_INLINE gn_lanes gn_lanes_min(gn_lanes a, gn_lanes b) { return a < b ? a : b; }
GN_INLINE gn_lanes gn_lanes_max(gn_lanes a, gn_lanes b) { return a > b ? a : b; }
GN_INLINE gn_lanes gn_lanes_abs(gn_lanes a) { return gn_lanes_of_bits(gn_bits_of_lanes(a) & 0x7fffffffu); }

// A box in each lane.
typedef struct GnBoxes {
  gn_lanes lo[3];
  gn_lanes hi[3];
} GnBoxes;

// The same box in every lane.
GN_INLINE GnBoxes gn_boxes_of(const gn_f32* lo, const gn_f32* hi) {
  GnBoxes boxes;
  int k;
  for (k = 0; k < 3; ++k) {
    boxes.lo[k] = GN_ALL(lo[k]);
    boxes.hi[k] = GN_ALL(hi[k]);
  }
  return boxes;
}

#endif
