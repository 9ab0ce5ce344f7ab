#include "oracle_rows.h"

#include <cmath>

#include "gnomon/compare/answer_counts.h"

namespace gnomon::app {

namespace {

// JSON has no infinity: a quantile beyond the last step is given as null.
Json finite(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json distribution(const ErrorCounts& errors) {
  Json steps = Json::array();
  for (std::size_t i = 0; i < errors.steps.size(); ++i) {
    if (errors.steps[i] == 0) continue;
    const double end = static_cast<double>(i + 1) / static_cast<double>(ErrorCounts::kPerUlp);
    steps.push_back(Json::array({i + 1 == errors.steps.size() ? Json(nullptr) : Json(end), errors.steps[i]}));
  }
  return steps;
}

}  // namespace

void add_oracle(Json& row, const OracleReport& o) {
  row["rays"] = o.rays_judged;
  put_answer_counts(row, o);
  row["ties"] = o.ties;
  row["range_ambiguous"] = o.range_ambiguous;
  row["range_rounded"] = o.range_rounded;
  row["t_error_ulp"] = {{"p50", finite(o.t_errors.quantile(0.5))},
                        {"p99", finite(o.t_errors.quantile(0.99))},
                        {"max", finite(o.max_t_error_ulp)}};
  row["t_error_steps"] = distribution(o.t_errors);
  row["max_uv_error"] = finite(o.max_uv_error);
}

}  // namespace gnomon::app
