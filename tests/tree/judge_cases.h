// Three walls, rays towards them and a report as one comparable row. Feeds the tests of the judge.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "gnomon/tree/oracle.h"

namespace judge_cases {

inline constexpr float kInf = std::numeric_limits<float>::infinity();
inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
inline const GnHit kMiss{kInf, 0, 0, GN_NONE};

inline GnTriangle wall_at(float z) {
  return {{-1, -1, z}, {3, -1, z}, {-1, 3, z}};
}

// Rays along +z from the origin meet the triangles 0, 1, 2 at t = 3, 5, 9; triangle 3 lies elsewhere.
inline const std::vector<GnTriangle> kWalls{
    wall_at(3), wall_at(5), wall_at(9), {{50, 0, 3}, {51, 0, 3}, {50, 1, 3}}};

inline GnRay ahead(float tmin = 0, float tmax = kInf) {
  return {{0, 0, 0}, tmin, {0, 0, 1}, tmax};
}

inline GnHit hit_at(float t, std::uint32_t primitive) {
  return {t, 0.25F, 0.25F, primitive};
}

// The counts of a report in one comparable row: lost, false, wrong, ties, disagree, ambiguous.
inline std::vector<std::uint64_t> counts(const gnomon::OracleReport& report) {
  return {report.lost, report.false_hits,           report.wrong_primitive,
          report.ties, report.any_closest_disagree, report.range_ambiguous};
}
using Counts = std::vector<std::uint64_t>;
inline const Counts kClean{0, 0, 0, 0, 0, 0};

}  // namespace judge_cases
