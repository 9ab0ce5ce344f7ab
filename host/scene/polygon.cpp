#include "gnomon/scene/polygon.h"

#include <cmath>

namespace gnomon {
namespace {

struct Flat {
  double x;
  double y;
};

// Twice the signed area of a, b, c.
double turn(const Flat& a, const Flat& b, const Flat& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Drops the axis along which the polygon's normal (Newell's method) is longest; counter-clockwise afterwards.
std::vector<Flat> flatten(std::span<const Vec3> corners) {
  double normal[3] = {};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3& a = corners[i];
    const Vec3& b = corners[(i + 1) % corners.size()];
    for (unsigned axis = 0; axis < 3; ++axis) {
      const unsigned u = (axis + 1) % 3;
      const unsigned v = (axis + 2) % 3;
      // Relative to the first corner: far from the origin the plain products would lose the area.
      const Vec3& o = corners[0];
      normal[axis] += (static_cast<double>(a[u]) - o[u]) * (static_cast<double>(b[v]) - o[v]) -
                      (static_cast<double>(a[v]) - o[v]) * (static_cast<double>(b[u]) - o[u]);
    }
  }
  unsigned longest = 0;
  for (unsigned axis = 1; axis < 3; ++axis) {
    if (std::abs(normal[axis]) > std::abs(normal[longest])) longest = axis;
  }
  const unsigned u = normal[longest] >= 0.0 ? (longest + 1) % 3 : (longest + 2) % 3;
  const unsigned v = normal[longest] >= 0.0 ? (longest + 2) % 3 : (longest + 1) % 3;
  std::vector<Flat> flat;
  flat.reserve(corners.size());
  for (const Vec3& corner : corners) flat.push_back({corner[u], corner[v]});
  return flat;
}

// Points looked at per corner while clipping ears; bounds the time a hostile file can take.
constexpr std::size_t kTestsPerCorner = 4096;

// Turning left everywhere is not enough, a pentagram does too: a convex outline also changes its horizontal
// direction only twice. Straight corners would make triangles without area in a fan.
bool is_strictly_convex(const std::vector<Flat>& outline) {
  const std::size_t count = outline.size();
  unsigned reversals = 0;
  double last_dx = 0.0;
  for (std::size_t i = 0; i <= count; ++i) {
    const Flat& a = outline[i % count];
    const Flat& b = outline[(i + 1) % count];
    if (!(turn(a, b, outline[(i + 2) % count]) > 0.0)) return false;
    const double dx = b.x - a.x;
    if (dx == 0.0) continue;
    if (last_dx * dx < 0.0) ++reversals;
    last_dx = dx;
  }
  return reversals <= 2;
}

bool is_inside(const Flat& p, const Flat& a, const Flat& b, const Flat& c) {
  return turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
}

bool same(const Flat& a, const Flat& b) {
  return a.x == b.x && a.y == b.y;
}

// What is left of a polygon while ears are cut off, as a ring of corner numbers.
class Ring {
 public:
  explicit Ring(const std::vector<Flat>& outline)
      : outline_(outline), next_(outline.size()), last_(outline.size()) {
    const auto count = static_cast<std::uint32_t>(outline.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      next_[i] = (i + 1) % count;
      last_[i] = (i + count - 1) % count;
    }
  }
  [[nodiscard]] std::uint32_t next(std::uint32_t corner) const { return next_[corner]; }
  [[nodiscard]] std::uint32_t last(std::uint32_t corner) const { return last_[corner]; }

  // An ear turns left and has no other corner inside. Counts the corners it looks at.
  [[nodiscard]] bool is_ear(std::uint32_t tip, std::size_t& tests) const {
    const Flat& a = outline_[last_[tip]];
    const Flat& b = outline_[tip];
    const Flat& c = outline_[next_[tip]];
    ++tests;
    if (!(turn(a, b, c) > 0.0)) return false;
    for (std::uint32_t i = next_[next_[tip]]; i != last_[tip]; i = next_[i]) {
      const Flat& p = outline_[i];
      ++tests;
      // A seam towards a hole visits a corner twice; that one does not block.
      if (!same(p, a) && !same(p, b) && !same(p, c) && is_inside(p, a, b, c)) return false;
    }
    return true;
  }

  void cut(std::uint32_t tip) {
    next_[last_[tip]] = next_[tip];
    last_[next_[tip]] = last_[tip];
  }

 private:
  const std::vector<Flat>& outline_;
  std::vector<std::uint32_t> next_;
  std::vector<std::uint32_t> last_;
};

PolygonTriangles clip_ears(const std::vector<Flat>& outline) {
  PolygonTriangles triangles;
  Ring ring(outline);
  std::size_t left = outline.size();
  std::uint32_t tip = 0;
  std::size_t tries = 0;
  std::size_t tests = 0;
  while (left > 3 && tries < left && tests < kTestsPerCorner * outline.size()) {
    if (ring.is_ear(tip, tests)) {
      triangles.push_back({ring.last(tip), tip, ring.next(tip)});
      ring.cut(tip);
      --left;
      tries = 0;
    } else {
      ++tries;
    }
    tip = ring.next(tip);
  }
  // The last triangle, or whatever had no ear.
  for (std::uint32_t i = ring.next(tip); ring.next(i) != tip; i = ring.next(i)) {
    triangles.push_back({tip, i, ring.next(i)});
  }
  return triangles;
}

PolygonTriangles fan(std::size_t corner_count) {
  PolygonTriangles triangles;
  for (std::uint32_t i = 1; i + 1 < corner_count; ++i) triangles.push_back({0, i, i + 1});
  return triangles;
}

}  // namespace

PolygonTriangles split_polygon(std::span<const Vec3> corners) {
  const auto outline = flatten(corners);
  return is_strictly_convex(outline) ? fan(corners.size()) : clip_ears(outline);
}

}  // namespace gnomon
