// A plain tree file's parts, and rays against boxes and triangles in double precision: what programs that
// take such trees have of their own. Feeds tree_import_test.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstring>
#include <limits>
#include <vector>

#include "tree_file_tools.h"

namespace gnomon::test::plain {

using Vec = std::array<double, 3>;

struct Box {
  std::array<float, 3> lo, hi;
};

struct Found {
  double t = std::numeric_limits<double>::infinity();
  std::uint32_t primitive = GN_NONE;
};

inline Vec vec(const float* v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}
inline Vec minus(const Vec& a, const Vec& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline double dot(const Vec& a, const Vec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline bool meets(const Box& box, const GnRay& ray) {
  double enter = static_cast<double>(ray.tmin);
  double leave = static_cast<double>(ray.tmax);
  for (std::size_t k = 0; k < 3; ++k) {
    const double inverse = 1.0 / static_cast<double>(ray.direction[k]);
    const double a = (static_cast<double>(box.lo[k]) - static_cast<double>(ray.origin[k])) * inverse;
    const double b = (static_cast<double>(box.hi[k]) - static_cast<double>(ray.origin[k])) * inverse;
    enter = std::max(enter, std::min(a, b) - 1e-6);
    leave = std::min(leave, std::max(a, b) + 1e-6);
  }
  return enter <= leave;
}

// Moeller and Trumbore's test in double precision; `stride` floats from corner to corner.
inline void test_triangle(const float* corners, std::size_t stride, std::uint32_t primitive, const GnRay& ray,
                          Found& found) {
  const Vec a = vec(corners);
  const Vec e = minus(vec(corners + stride), a);
  const Vec f = minus(vec(corners + 2 * stride), a);
  const Vec d = vec(ray.direction);
  const Vec p = cross(d, f);
  const double scale = 1.0 / dot(e, p);
  const Vec s = minus(vec(ray.origin), a);
  const Vec q = cross(s, e);
  const double u = dot(s, p) * scale;
  const double v = dot(d, q) * scale;
  const double t = dot(f, q) * scale;
  if (!(u >= 0.0 && v >= 0.0 && u + v <= 1.0)) return;
  if (t < static_cast<double>(ray.tmin) || t > static_cast<double>(ray.tmax) || t >= found.t) return;
  found = {t, primitive};
}

struct Parts {
  const std::byte* nodes;
  std::uint32_t node_count;
  std::vector<std::uint32_t> indices;
  std::vector<float> corners;  // 9 a triangle
};

inline Parts parts_of(const FileBytes& bytes) {
  REQUIRE(std::memcmp(bytes.data(), "gnombvh2", 8) == 0);
  Parts parts{bytes.data() + 32, value_at<std::uint32_t>(bytes, 12), {}, {}};
  parts.indices.resize(value_at<std::uint32_t>(bytes, 16));
  parts.corners.resize(9 * std::size_t{value_at<std::uint32_t>(bytes, 20)});
  const std::byte* at = parts.nodes + 32 * std::size_t{parts.node_count};
  REQUIRE(bytes.data() + bytes.size() == at + 4 * (parts.indices.size() + parts.corners.size()));
  std::memcpy(parts.indices.data(), at, 4 * parts.indices.size());
  std::memcpy(parts.corners.data(), at + 4 * parts.indices.size(), 4 * parts.corners.size());
  return parts;
}

// A node of the file, for importers that make their own.
struct Plain {
  Box box;
  std::uint32_t left_first, count;
  Plain(const Parts& parts, std::uint32_t node) {
    REQUIRE(node < parts.node_count);
    const std::byte* at = parts.nodes + 32 * std::size_t{node};
    std::memcpy(box.lo.data(), at, 12);
    std::memcpy(&left_first, at + 12, 4);
    std::memcpy(box.hi.data(), at + 16, 12);
    std::memcpy(&count, at + 28, 4);
  }
};

}  // namespace gnomon::test::plain
