#include "gnomon/scene/triangle_check.h"

#include <cmath>
#include <limits>

#include "gnomon/scene/import_message.h"

namespace gnomon {
namespace {

bool in_range(const float v[3]) {
  // Written so that a NaN fails.
  return std::abs(v[0]) <= kMaxCoordinate && std::abs(v[1]) <= kMaxCoordinate &&
         std::abs(v[2]) <= kMaxCoordinate;
}

// True when a * b == c * d. Equal rounded products do not prove it: the rounding errors must agree as well.
bool same_product(double a, double b, double c, double d) {
  const double ab = a * b;
  const double cd = c * d;
  return ab == cd && std::fma(a, b, -ab) == std::fma(c, d, -cd);
}

bool has_zero_area(const Triangle& t) {
  double e[3];
  double f[3];
  for (unsigned axis = 0; axis < 3; ++axis) {
    e[axis] = static_cast<double>(t.v1[axis]) - static_cast<double>(t.v0[axis]);
    f[axis] = static_cast<double>(t.v2[axis]) - static_cast<double>(t.v0[axis]);
  }
  return same_product(e[1], f[2], e[2], f[1]) && same_product(e[2], f[0], e[0], f[2]) &&
         same_product(e[0], f[1], e[1], f[0]);
}

}  // namespace

TriangleFault fault_of(const Triangle& triangle) {
  if (!in_range(triangle.v0) || !in_range(triangle.v1) || !in_range(triangle.v2))
    return TriangleFault::kNotFinite;
  return has_zero_area(triangle) ? TriangleFault::kZeroArea : TriangleFault::kNone;
}

void TriangleSink::reject(TriangleFault fault, const std::string& place) {
  const char* const what = fault == TriangleFault::kZeroArea
                               ? " has no area: its corners are equal or on one line"
                               : " has a coordinate that is not a number, infinite or beyond 2^48";
  bad_scene(place + what + "; repair the model or let such triangles be dropped");
}

void TriangleSink::count(TriangleFault fault) {
  ++(fault == TriangleFault::kZeroArea ? scene_.report.zero_area_dropped : scene_.report.non_finite_dropped);
}

float to_coordinate(double value) {
  return std::abs(value) <= static_cast<double>(kMaxCoordinate) ? static_cast<float>(value)
                                                                : std::numeric_limits<float>::quiet_NaN();
}

void require_room(std::uint64_t so_far, std::uint64_t triangles, const ImportOptions& options) {
  if (so_far <= options.max_triangles && triangles <= options.max_triangles - so_far) return;
  bad_scene("more triangles than the limit of " + std::to_string(options.max_triangles) +
            "; raise the limit (ImportOptions::max_triangles) or simplify the scene");
}

void require_triangles(const Scene& scene) {
  if (!scene.triangles.empty()) return;
  const ImportReport& report = scene.report;
  std::string left_out;
  const auto add = [&left_out](std::uint64_t count, const char* what) {
    if (count > 0) left_out += (left_out.empty() ? "" : ", ") + std::to_string(count) + what;
  };
  add(report.non_finite_dropped, " triangles with coordinates that are no usable numbers");
  add(report.zero_area_dropped, " triangles of zero area");
  add(report.primitives_skipped, " primitives that are not triangles");
  bad_scene("contains no triangles" + (left_out.empty() ? std::string() : " (left out: " + left_out + ")"));
}

}  // namespace gnomon
