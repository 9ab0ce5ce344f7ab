// Asks the device for measures of boxes, every measure with every box: they must have the host's bits, or trees differ.
#include "shared/measure_math.h"

// boxes: lo x y z, hi x y z. Item i weighs box i % box_count by measure i / box_count: as it would a node (how, chosen) and
// precisely.
__kernel void probe_measures(__global const GnMeasure* measures, __global const float* boxes, uint box_count,
                             __global uint* how, __global float* chosen, __global float* precise) {
  const size_t i = get_global_id(0);
  const GnMeasure measure = measures[i / box_count];
  const size_t box = 6u * (i % box_count);
  float lo[3], hi[3];
  int k;
  for (k = 0; k < 3; ++k) {
    lo[k] = boxes[box + k];
    hi[k] = boxes[box + 3 + k];
  }
  how[i] = (uint)gn_measure_how(&measure, lo, hi);
  chosen[i] = gn_box_measure(&measure, (int)how[i], lo, hi);
  precise[i] = gn_box_measure(&measure, GN_SEEN_PRECISE, lo, hi);
}
