#include "gnomon/compare/judging.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "gnomon/tree/oracle.h"

namespace gnomon::compare {
namespace {

bool same_bits(const Answers& a, const Answers& b) {
  return a.occluded == b.occluded && a.hits.size() == b.hits.size() &&
         (a.hits.empty() || std::memcmp(a.hits.data(), b.hits.data(), a.hits.size() * sizeof(Hit)) == 0);
}

AccuracyRow row_from(const OracleReport& report) {
  AccuracyRow row;
  row.judged = report.rays_judged;
  row.hits = report.hits;
  row.lost = report.lost;
  row.false_hits = report.false_hits;
  row.wrong_primitive = report.wrong_primitive;
  row.any_closest_disagree = report.any_closest_disagree;
  row.max_t_error_ulp = report.max_t_error_ulp;
  const auto& steps = report.t_errors.steps;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i] == 0) continue;
    const bool last = i + 1 == steps.size();
    row.t_error_steps.emplace_back(
        last ? 0.0 : static_cast<double>(i + 1) / static_cast<double>(ErrorCounts::kPerUlp), steps[i]);
  }
  return row;
}

}  // namespace

Judge::Judge(const Scene& scene, bool pairs_of_floats)
    : scene_(scene), pairs_of_floats_(pairs_of_floats), candidates_(scene.triangles) {}

AccuracyRow Judge::row(const std::string& method, const Batch& batch, Answers answers, std::uint64_t rays,
                       double seconds, const Progress& progress) {
  for (const auto& [earlier, theirs] : earlier_) {
    if (!same_bits(answers, theirs)) continue;
    AccuracyRow row = earlier;
    row.method = method;
    row.same_as = earlier.method;
    return row;
  }
  OracleOptions options;
  options.max_rays = rays;
  options.pairs_of_floats = pairs_of_floats_;
  options.tree = &candidates_;
  options.time_budget = std::chrono::milliseconds(std::llround(1e3 * seconds));
  AccuracyRow row =
      row_from(judge(scene_.triangles, batch.rays, answers.hits, answers.occluded, options, progress));
  row.method = method;
  row.kind = batch.kind;
  earlier_.emplace_back(row, std::move(answers));
  return row;
}

}  // namespace gnomon::compare
