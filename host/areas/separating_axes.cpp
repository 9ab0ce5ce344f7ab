// overlap() of solids.h: two convex bodies are apart if and only if they are apart along a normal of one of
// their faces or along a cross product of two of their edges.
#include "gnomon/areas/solids.h"

namespace gnomon {
namespace {

constexpr double kParallelEdges = 0x1p-30;
constexpr double kGap = 0x1p-46;

// A body's extremes along an axis, and the size of the numbers they were computed from.
struct Extent {
  double lo;
  double hi;
  double size;
};

double absolute_dot(const Vec3d& a, const Vec3d& b) {
  return std::abs(a[0] * b[0]) + std::abs(a[1] * b[1]) + std::abs(a[2] * b[2]);
}

// The signs of the axis say which corner lies farthest along it: none is projected in vain (thesis A.5.1).
Extent extent_of(const Box3d& box, const Vec3d& axis) {
  Extent e{0.0, 0.0, absolute_dot(axis, box.lo) + absolute_dot(axis, box.hi)};
  for (std::size_t k = 0; k < 3; ++k) {
    e.lo += axis[k] * (axis[k] > 0.0 ? box.lo[k] : box.hi[k]);
    e.hi += axis[k] * (axis[k] > 0.0 ? box.hi[k] : box.lo[k]);
  }
  return e;
}

Extent extent_of(const OrientedBox& body, const Vec3d& axis) {
  double reach = 0.0;
  for (std::size_t k = 0; k < 3; ++k) reach += body.half[k] * std::abs(dot(body.axes[k], axis));
  const double centre = dot(body.centre, axis);
  return {centre - reach, centre + reach, absolute_dot(axis, body.centre) + reach};
}

Extent extent_of(const Frustum& body, const Vec3d& axis) {
  const AreaFrame& f = body.frame;
  const double along = dot(f.forward, axis);
  const double aside = body.tan_x * std::abs(dot(f.right, axis)) + body.tan_y * std::abs(dot(f.up, axis));
  const double eye = dot(f.origin, axis);
  const double lo = along - aside;
  const double hi = along + aside;
  const double near = body.near_distance;
  const double far = body.far_distance;
  return {eye + lo * (lo > 0.0 ? near : far), eye + hi * (hi > 0.0 ? far : near),
          absolute_dot(axis, f.origin) + far * (length(axis) + aside)};
}

std::array<Vec3d, 3> normals_of(const OrientedBox& body) {
  return body.axes;
}
std::array<Vec3d, 3> edges_of(const OrientedBox& body) {
  return body.axes;
}

// Near and far face share one; lengths do not matter.
std::array<Vec3d, 5> normals_of(const Frustum& body) {
  const AreaFrame& f = body.frame;
  return {f.forward, body.tan_x * f.forward + f.right, body.tan_x * f.forward - f.right,
          body.tan_y * f.forward + f.up, body.tan_y * f.forward - f.up};
}

std::array<Vec3d, 6> edges_of(const Frustum& body) {
  const AreaFrame& f = body.frame;
  const Vec3d x = body.tan_x * f.right;
  const Vec3d y = body.tan_y * f.up;
  return {f.right, f.up, f.forward + x + y, f.forward + x - y, f.forward - x + y, f.forward - x - y};
}

template <typename Body>
bool apart_along(const Vec3d& axis, const Body& body, const Box3d& box) {
  const Extent a = extent_of(body, axis);
  const Extent b = extent_of(box, axis);
  const double gap = larger(a.lo - b.hi, b.lo - a.hi);
  return gap > kGap * (a.size + b.size);
}

template <typename Body>
bool bodies_overlap(const Body& body, const Box3d& box) {
  if (is_empty(box)) return false;
  const std::array<Vec3d, 3> world{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
  for (const Vec3d& axis : world) {
    if (apart_along(axis, body, box)) return false;
  }
  for (const Vec3d& normal : normals_of(body)) {
    if (apart_along(normal, body, box)) return false;
  }
  for (const Vec3d& edge : edges_of(body)) {
    for (const Vec3d& side : world) {
      const Vec3d axis = cross(edge, side);
      if (magnitude(axis) <= kParallelEdges * magnitude(edge)) continue;
      if (apart_along(axis, body, box)) return false;
    }
  }
  return true;
}

}  // namespace

bool overlap(const OrientedBox& body, const Box3d& box) {
  return bodies_overlap(body, box);
}

bool overlap(const Frustum& body, const Box3d& box) {
  return bodies_overlap(body, box);
}

bool overlap(const Ball& body, const Box3d& box) {
  if (is_empty(box)) return false;
  Vec3d nearest{};
  for (std::size_t k = 0; k < 3; ++k) nearest[k] = smaller(larger(body.centre[k], box.lo[k]), box.hi[k]);
  return length(nearest - body.centre) <= body.radius + kGap * (body.radius + magnitude(body.centre));
}

}  // namespace gnomon
