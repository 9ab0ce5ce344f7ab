#include "gnomon/tree/box_frame.h"

#include <algorithm>
#include <cmath>

#include "gnomon/base/error.h"

namespace gnomon {

namespace {

using Axis = std::array<double, 3>;

Axis cross(const Axis& a, const Axis& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double length(const Axis& a) {
  return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

Axis unit(const Axis& a) {
  const double by = 1.0 / length(a);
  return {a[0] * by, a[1] * by, a[2] * by};
}

BoxFrame frame_of(const std::array<Axis, 3>& axes, float size) {
  BoxFrame frame{};
  for (std::size_t i = 0; i < 9; ++i) frame.rows[i] = static_cast<float>(0.5 * axes[i / 3][i % 3]);
  frame.size = size;
  return frame;
}

float size_of(std::span<const GnTriangle> triangles) {
  float size = 0.0F;
  for (const GnTriangle& t : triangles) {
    for (const float* corner : {t.v0, t.v1, t.v2}) {
      for (int k = 0; k < 3; ++k) size = std::max(size, std::fabs(corner[k]));
    }
  }
  return size;
}

// What triangles' boxes cover, seen along the frame's z.
double covered(std::span<const GnTriangle> triangles, const BoxFrame& frame) {
  double sum = 0.0;
  for (const GnTriangle& t : turned(triangles, frame)) {
    double area = 1.0;
    for (int k = 0; k < 2; ++k)
      area *= double{std::max({t.v0[k], t.v1[k], t.v2[k]})} - double{std::min({t.v0[k], t.v1[k], t.v2[k]})};
    sum += area;
  }
  return sum;
}

}  // namespace

BoxFrame frame_along(const std::array<double, 3>& direction, std::span<const GnTriangle> triangles) {
  const double largest =
      std::max({std::fabs(direction[0]), std::fabs(direction[1]), std::fabs(direction[2])});
  if (!(largest > 0.0) || !std::isfinite(direction[0] + direction[1] + direction[2])) {
    throw Error(ErrorCode::kInvalidArgument, "a frame is to stand along (" + std::to_string(direction[0]) +
                                                 ", " + std::to_string(direction[1]) + ", " +
                                                 std::to_string(direction[2]) +
                                                 "); a direction is finite and not zero");
  }
  const Axis z = unit({direction[0] / largest, direction[1] / largest, direction[2] / largest});
  const float size = size_of(triangles);
  BoxFrame best{};
  double least = INFINITY;
  for (std::size_t k = 0; k < 3; ++k) {
    Axis upright{};
    upright[k] = 1.0;
    const Axis across = cross(upright, z);
    if (length(across) < 0.1) continue;  // seen end on: it gives no direction
    const Axis x = unit(across);
    const BoxFrame frame = frame_of({x, cross(z, x), z}, size);
    const double area = covered(triangles, frame);
    if (!(area < least)) continue;
    least = area;
    best = frame;
  }
  return best;
}

std::vector<GnTriangle> turned(std::span<const GnTriangle> triangles, const BoxFrame& frame) {
  std::vector<GnTriangle> out(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    gn_turn(&frame, triangles[i].v0, out[i].v0);
    gn_turn(&frame, triangles[i].v1, out[i].v1);
    gn_turn(&frame, triangles[i].v2, out[i].v2);
  }
  return out;
}

std::vector<GnRay> turned(std::span<const GnRay> rays, const BoxFrame& frame) {
  std::vector<GnRay> out(rays.begin(), rays.end());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    gn_turn(&frame, rays[i].origin, out[i].origin);
    gn_turn(&frame, rays[i].direction, out[i].direction);
  }
  return out;
}

std::optional<std::string> fault_of(const BoxFrame& frame, std::span<const GnTriangle> triangles) {
  for (int row = 0; row < 3; ++row) {
    double sum = 0.0;
    double square = 0.0;
    for (int k = 0; k < 3; ++k) {
      const double value = frame.rows[3 * row + k];
      if (!(std::fabs(value) <= 0.5)) return "row " + std::to_string(row) + " has a value beyond 1/2";
      sum += std::fabs(value);
      square += value * value;
    }
    if (sum > 0.875) return "the magnitudes of row " + std::to_string(row) + " sum up to more than 7/8";
    if (square < 0.2) return "row " + std::to_string(row) + " is not that of half a rotation";
  }
  const float size = size_of(triangles);
  if (!(frame.size >= size)) {
    return "its size is " + std::to_string(frame.size) + ", and a coordinate's magnitude " +
           std::to_string(size);
  }
  return std::nullopt;
}

void refuse_frame(const std::optional<BoxFrame>& frame, const std::string& what) {
  if (!frame) return;
  throw Error(ErrorCode::kInvalidArgument,
              what +
                  " takes trees whose boxes stand where triangles do; this one's stand in a frame of their "
                  "own (a plan's light-space tree)");
}

}  // namespace gnomon
