// How large things look from a point, in steradians. Feeds projection.
#pragma once

#include "gnomon/areas/box.h"
#include "gnomon/areas/clip.h"

namespace gnomon {

// Of a triangle, by Van Oosterom and Strackee (1983), with the triple product taken over edges so that far
// and small triangles keep their relative precision (2^-40 unless seen edge-on). From a point in its plane: 2
// pi inside, 0 outside and at its corners.
[[nodiscard]] double solid_angle_of(const Vec3d& eye, const Vec3d& a, const Vec3d& b, const Vec3d& c);

// Of a flat convex polygon that the eye is not in, as a fan of triangles.
[[nodiscard]] double solid_angle_of(const Vec3d& eye, const Polygon3d& polygon);

// Of a box: the sum over its visible faces, at most three, which never look behind each other. 4 pi from
// inside. From its surface, the directions that lead inside: 2 pi on a face, pi on an edge, pi/2 at a corner;
// a flat box counts as a face there. No tolerance: "on" means equal coordinates. An empty box has none.
[[nodiscard]] double solid_angle_of(const Vec3d& eye, const Box3d& box);

// The four corners, in order round the face, of the side of a box at axis = lo (or hi).
[[nodiscard]] Polygon3d face_of(const Box3d& box, unsigned axis, bool at_hi);

}  // namespace gnomon
