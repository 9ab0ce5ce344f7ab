// The judge: brute force over all triangles in double precision with exact edge signs, independent of the
// float code and of any tree. Slow by design. Feeds `validate`, tests and error figures.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/base/progress.h"
#include "gnomon/shared/layout.h"

namespace gnomon {

using Triangle = GnTriangle;
using Ray = GnRay;
using Hit = GnHit;

// Whether the ray's line meets the closed triangle, decided exactly for float input (Shewchuk 1997
// expansions): the three signs of det(d, a - o, b - o) over its edges; boundary counts as inside; a line in
// the triangle's plane and a zero-area triangle never hit. If it does, t (not range-checked) in double.
struct ExactHit {
  bool inside = false;
  double t = 0.0;
  double t_error = 0.0;  // bound on |t - exact t|
  double u = 0.0;
  double v = 0.0;
};
[[nodiscard]] ExactHit exact_intersect(const Ray& ray, const Triangle& triangle);

// Sign (-1, 0, +1) of det(d, a - o, b - o), exact for finite float input.
[[nodiscard]] int exact_edge_sign(const float d[3], const float o[3], const float a[3], const float b[3]);

struct OracleHit {
  double t = 0.0;                     // +inf: a miss
  std::uint32_t primitive = GN_NONE;  // lowest index among exactly equal t
};
// Closest hit with tmin <= t <= tmax and |t| <= FLT_MAX over all triangles. Rays with NaN, an infinite
// origin, or a direction whose longest component is not between 2^-100 and 2^100 miss.
[[nodiscard]] OracleHit oracle_closest(const Ray& ray, std::span<const Triangle> triangles);

class CandidateTree;

struct OracleOptions {
  std::uint64_t max_rays = 4096;                 // evenly strided sample of the batch
  std::chrono::milliseconds time_budget{20000};  // stop early, keep what is judged
  unsigned threads = 0;                          // 0: all
  double t_tolerance_ulp = 4.0;  // of the device's t, before a nearer or farther hit is a fault
  // The device has no double: t may also be off by pair_error_bound (pair_bound.h).
  bool pairs_of_floats = false;
  // Of the same triangles: rays look at what it offers them, not at every triangle. For many rays.
  const CandidateTree* tree = nullptr;
};

// How many hits' t were wrong by how much, in steps of 1/16 ulp of the exact t as float; the last: by 8 ulp
// or more.
struct ErrorCounts {
  static constexpr std::size_t kPerUlp = 16;
  std::array<std::uint64_t, 8 * kPerUlp + 1> steps{};
  void add(double ulp);
  // Within this error, in ulp, lies so large a share of all; the upper end of a step, +inf for the last, 0
  // for none.
  [[nodiscard]] double quantile(double share) const;
};

// Judgement of a batch: closest hits and any-hit answers against the oracle.
struct OracleReport {
  std::uint64_t rays_given = 0;
  std::uint64_t rays_judged = 0;
  bool budget_exhausted = false;
  std::uint64_t hits = 0;             // by the oracle
  std::uint64_t lost = 0;             // oracle hits, device misses or reports one farther than tolerance
  std::uint64_t false_hits = 0;       // device hits where nothing is, or nearer than tolerance
  std::uint64_t wrong_primitive = 0;  // right t, but a triangle that is not there
  std::uint64_t ties = 0;             // right t, another triangle that is also there
  std::uint64_t any_closest_disagree = 0;
  std::uint64_t range_ambiguous = 0;  // t within tolerance of tmin or tmax: either answer stands
  std::uint64_t range_rounded = 0;  // of these, rays that hit where the exact t misses, or miss where it hits
  double max_t_error_ulp = 0.0;     // over agreeing hits, in ulp of the exact t as float
  ErrorCounts t_errors;             // of the same hits
  double max_uv_error = 0.0;        // over agreeing hits of the same triangle, absolute
  std::vector<std::uint64_t> bad_rays;  // indices of the first 16 at fault
  [[nodiscard]] std::uint64_t mismatches() const {
    return lost + false_hits + wrong_primitive + any_closest_disagree;
  }
  // Adds another batch's counts; its bad rays are appended, whatever batch they count from.
  void add(const OracleReport& other);
};

// Judges device results. `any` may be empty (then only closest hits are judged); `hits` may be empty
// likewise. hits[i] and any[i] (0 or 1) belong to rays[i]. With both given, any is held against hits, so that
// one fault is counted once; alone, against the oracle. Throws Error{kInvalidArgument} on unequal lengths,
// kCancelled.
[[nodiscard]] OracleReport judge(std::span<const Triangle> triangles, std::span<const Ray> rays,
                                 std::span<const Hit> hits, std::span<const std::uint32_t> any,
                                 const OracleOptions& options = {}, const Progress& progress = {});

}  // namespace gnomon
