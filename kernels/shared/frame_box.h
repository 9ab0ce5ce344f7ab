// Where a box lies beside the window of an influence area: beyond it, inside it, or neither. Such tests are
// safe: what is said to be beyond or inside is so, and the rest is measured. Feeds seen_measure.h.
#ifndef GNOMON_SHARED_FRAME_BOX_H
#define GNOMON_SHARED_FRAME_BOX_H

#include "build_layout.h"
#include "elementary_math.h"

// Bounds of a box in the area's frame.
typedef struct GnFrameBox {
  gn_f32 at[3];
  gn_f32 reach[3];
} GnFrameBox;

GN_INLINE gn_f32 gn_reach(const gn_f32* direction, const gn_f32* half_size) {
  return gn_abs(direction[0]) * half_size[0] + gn_abs(direction[1]) * half_size[1] +
         gn_abs(direction[2]) * half_size[2];
}

GN_INLINE GnFrameBox gn_frame_box(const GnMeasure* m, const gn_f32* centre, const gn_f32* half_size) {
  GnFrameBox box;
  box.at[0] = gn_dot(centre, m->right);
  box.at[1] = gn_dot(centre, m->up);
  box.at[2] = gn_dot(centre, m->forward);
  box.reach[0] = gn_reach(m->right, half_size);
  box.reach[1] = gn_reach(m->up, half_size);
  box.reach[2] = gn_reach(m->forward, half_size);
  return box;
}

// Whether all of the box lies above or below the cones that are a yaw and pitch window's upper and lower
// sides.
GN_INLINE int gn_is_beyond_pitch(const GnMeasure* m, const GnFrameBox* box) {
  const gn_f32 height = gn_abs(box->at[1]) - box->reach[1];
  const gn_f32 x = gn_abs(box->at[0]) + box->reach[0], z = gn_abs(box->at[2]) + box->reach[2];
  return height > 0.0f && height * height > m->half_height * m->half_height * (x * x + z * z);
}

// Whether all of it lies between these cones.
GN_INLINE int gn_is_within_pitch(const GnMeasure* m, const GnFrameBox* box) {
  const gn_f32 height = gn_abs(box->at[1]) + box->reach[1];
  const gn_f32 x = gn_max(gn_abs(box->at[0]) - box->reach[0], 0.0f),
               z = gn_max(box->at[2] - box->reach[2], 0.0f);
  return height * height <= m->half_height * m->half_height * (x * x + z * z);
}

// Whether no ray can meet the box: all of it lies beyond one side of the window, or behind where rays begin.
// centre is seen from the origin; box: the same box's bounds in the frame.
GN_INLINE int gn_is_out_of_sight(const GnMeasure* m, const gn_f32* centre, const gn_f32* half_size,
                                 const GnFrameBox* box) {
  const int parallel = gn_kind_of(m) == GN_MEASURE_WINDOW;
  gn_u32 side, k;
  if (!m->culled) return 0;
  if (box->at[2] + box->reach[2] < m->near_distance) return 1;
  if (parallel) {
    return gn_abs(box->at[0]) - box->reach[0] > m->half_width ||
           gn_abs(box->at[1]) - box->reach[1] > m->half_height;
  }
  if (gn_kind_of(m) == GN_MEASURE_YAW_PITCH && gn_is_beyond_pitch(m, box)) return 1;
  for (side = 0u; side < (gn_kind_of(m) == GN_MEASURE_YAW_PITCH ? 2u : 4u); ++side) {
    const gn_f32 sign = side % 2u == 0u ? 1.0f : -1.0f;
    const gn_f32 window = side < 2u ? m->half_width : m->half_height;
    gn_f32 distance = 0.0f, reach = 0.0f;
    for (k = 0u; k < 3u; ++k) {
      const gn_f32 outwards = sign * (side < 2u ? m->right[k] : m->up[k]) - window * m->forward[k];
      distance += outwards * centre[k];
      reach += gn_abs(outwards) * half_size[k];
    }
    if (distance > reach) return 1;
  }
  return 0;
}

// Whether the window holds all of the box, and rays begin before it.
GN_INLINE int gn_is_seen_whole(const GnMeasure* m, const GnFrameBox* box) {
  const gn_f32 nearest = box->at[2] - box->reach[2];
  const gn_f32 depth = gn_kind_of(m) == GN_MEASURE_WINDOW ? 1.0f : nearest;
  if (!(nearest >= m->near_distance)) return 0;
  if (!m->culled) return 1;
  if (!(gn_abs(box->at[0]) + box->reach[0] <= m->half_width * depth)) return 0;
  if (gn_kind_of(m) == GN_MEASURE_YAW_PITCH) return gn_is_within_pitch(m, box);
  return gn_abs(box->at[1]) + box->reach[1] <= m->half_height * depth;
}

#endif
