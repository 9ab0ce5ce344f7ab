#include "gnomon/areas/membership.h"

#include "gnomon/areas/clip.h"

namespace gnomon {
namespace {

constexpr double kSlack = 0x1p-40;

Vec3d to_double(const float* v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

double distance_to_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
  const Vec3d edge = b - a;
  const double squared = dot(edge, edge);
  const double along = squared > 0.0 ? dot(p - a, edge) / squared : 0.0;
  return length(p - (a + smaller(larger(along, 0.0), 1.0) * edge));
}

double distance_to_edges(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return smaller(distance_to_segment(p, a, b),
                 smaller(distance_to_segment(p, b, c), distance_to_segment(p, c, a)));
}

// Whether any of the polygon is left by the half-spaces, each moved outwards by `slack`.
bool meets_all(Polygon3d polygon, std::span<const Plane> planes, double slack) {
  for (Plane plane : planes) {
    plane.offset += slack;
    polygon = clip(polygon, plane);
    if (polygon.empty()) return false;
  }
  return true;
}

bool touches_ball(const Ball& ball, const Polygon3d& t, double slack, Membership membership) {
  const double distance = membership == Membership::kExact
                              ? distance_to_triangle(ball.centre, t[0], t[1], t[2])
                              : distance_to_edges(ball.centre, t[0], t[1], t[2]);
  return distance <= ball.radius + slack;
}

}  // namespace

double distance_to_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const double to_edges = distance_to_edges(p, a, b, c);
  const Vec3d normal = cross(b - a, c - a);
  const double size = length(normal);
  if (!(size > 0.0)) return to_edges;
  // Over the triangle when on the inner side of the three upright planes through its edges.
  const bool over = dot(cross(b - a, p - a), normal) >= 0.0 && dot(cross(c - b, p - b), normal) >= 0.0 &&
                    dot(cross(a - c, p - c), normal) >= 0.0;
  return over ? smaller(to_edges, std::abs(dot(p - a, normal)) / size) : to_edges;
}

bool touches(const InfluenceArea& area, const GnTriangle& triangle, Membership membership) {
  const Polygon3d t{to_double(triangle.v0), to_double(triangle.v1), to_double(triangle.v2)};
  bool a_corner_inside = false;
  for (const Vec3d& corner : t) {
    if (!is_finite(corner)) return false;
    a_corner_inside |= area.contains(corner);
  }
  if (a_corner_inside) return true;
  if (membership == Membership::kVertices) return false;
  const Box3d around = area.enclosing_box();
  double size = larger(magnitude(around.lo), magnitude(around.hi));
  for (const Vec3d& corner : t) size = larger(size, magnitude(corner));
  if (const auto* ball = std::get_if<Ball>(&area.region()))
    return touches_ball(*ball, t, kSlack * size, membership);
  if (membership == Membership::kExact) return meets_all(t, area.planes(), kSlack * size);
  for (std::size_t i = 0; i < 3; ++i) {
    if (meets_all({t[i], t[(i + 1) % 3]}, area.planes(), kSlack * size)) return true;
  }
  return false;
}

std::vector<std::uint32_t> members(const InfluenceArea& area, std::span<const GnTriangle> triangles,
                                   Membership membership) {
  std::vector<std::uint32_t> inside;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (touches(area, triangles[i], membership)) inside.push_back(static_cast<std::uint32_t>(i));
  }
  return inside;
}

}  // namespace gnomon
