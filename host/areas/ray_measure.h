// How the rays of an area are distributed, and so what "the share of rays that hit a box" means. Feeds
// projection and area_rays, which must agree.
#pragma once

#include <string_view>

#include "gnomon/areas/influence_area.h"

namespace gnomon {

// Yaw and pitch of a direction: it is cos pitch (sin yaw right + cos yaw forward) + sin pitch up, which is
// Rot_up(yaw) Rot_right(pitch) forward (thesis 1.14). The window |yaw| <= fov_x/2, |pitch| <= fov_y/2 is not
// the frustum: two of its sides are planes through the eye and two are cones, and its corners are outside the
// frustum (8.6 % of the rays at 90 by 60 degrees).
enum class RayMeasure {
  kParallel,    // plane: uniform over the window
  kSolidAngle,  // point: uniform in steradians within the window; omni: in all directions
  kNearPlane,   // point: uniform over the window in the near plane, as pixels are
  kYawPitch,    // point: yaw and pitch uniform within half the field of view, the thesis' caster
};
[[nodiscard]] std::string_view to_string(RayMeasure measure);

// Where rays of a point area begin. Those of a plane area always begin in its window, omni's in its centre.
enum class RayStart {
  kWindow,  // in the near plane (thesis)
  kEye,
};

// Throws Error{kInvalidArgument} when an area of this kind has no such rays.
void require_measure(const InfluenceArea& area, RayMeasure measure);

}  // namespace gnomon
