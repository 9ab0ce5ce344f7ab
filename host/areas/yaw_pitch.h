// Areas in the (yaw, pitch) plane, where straight edges in space become curves. Feeds projection.
#pragma once

#include "gnomon/areas/clip.h"

namespace gnomon {

// The area, in square radians, that a flat convex polygon covers in (yaw, pitch) once pitch is cut to
// |pitch| <= half_pitch. Cutting a region to a band of pitch is clamping pitch in the integral of pitch over
// yaw round its edge, so the window's cones need no curve clipped. Each edge's integral is by adaptive
// Simpson quadrature to 2^-40 of half_pitch per radian of yaw; parts of a box add up to it within 1e-9 in the
// tests. The polygon is in local coordinates, already cut to the window's yaw, and has z > 0.
[[nodiscard]] double yaw_pitch_area_of(const Polygon3d& polygon, double half_pitch);

}  // namespace gnomon
