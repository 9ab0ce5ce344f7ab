// Where a ray meets a box, a plane or a triangle, in double precision: the reference that the float code of
// the kernels and the projected areas are held against. Not for deciding hits (the oracle does). Feeds this
// room.
#pragma once

#include <optional>

#include "gnomon/areas/box.h"
#include "gnomon/shared/layout.h"

namespace gnomon {

// The points origin + t direction with t >= 0; the direction need not have unit length.
struct Ray3d {
  Vec3d origin;
  Vec3d direction;
};
[[nodiscard]] Ray3d to_ray3d(const GnRay& ray);  // its tmin and tmax are left out

// Where the line is inside: entry <= t <= exit. entry is negative for a ray that starts inside.
struct Interval {
  double entry;
  double exit;
};

// The slab test (thesis A.1), for t >= 0. The boundary counts: a flat box can be hit, and so can a face by a
// ray that runs in it. No tolerance: a ray within rounding of an edge may go either way. Empty boxes are
// missed.
[[nodiscard]] std::optional<Interval> intersect(const Ray3d& ray, const Box3d& box);

// The points with dot(normal, x) + offset = 0; the half-space where it is >= 0 is the inner side. The normal
// need not have unit length.
struct Plane {
  Vec3d normal;
  double offset;
};
[[nodiscard]] Plane plane_through(const Vec3d& point, const Vec3d& normal);
// In units of the normal's length, positive on the inner side.
[[nodiscard]] double signed_distance(const Plane& plane, const Vec3d& point);

// t = -(n.o + offset) / (n.d) of the whole line, so it may be negative (thesis A.2, sign of the offset
// corrected). Nothing when they are parallel: |n.d| within 2^-50 of the sum of its terms' magnitudes.
[[nodiscard]] std::optional<double> intersect(const Ray3d& ray, const Plane& plane);

// t >= 0 of the plane point, if that is on the inner side of all edges (thesis A.3 and A.4, edges included):
// one within 2^-46 of the largest coordinate of an edge counts as on it, so shared edges leak no ray. A
// triangle without area is never met.
[[nodiscard]] std::optional<double> intersect(const Ray3d& ray, const Vec3d& a, const Vec3d& b,
                                              const Vec3d& c);

}  // namespace gnomon
