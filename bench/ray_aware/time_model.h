// How long a ray takes, fitted to rows of ray_aware_time: by the nodes and blocks that it looks into. Feeds
// ray_aware_time_page.cpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "../page_file.h"

namespace gnomon::bench {

using nlohmann::json;

inline double median(const json& row, const char* field) {
  return row.at(field).at("median").get<double>();
}

// "light" for "light 0".
inline std::string kind_of(const json& row) {
  const std::string rays = row.at("rays");
  return rays.substr(0, rays.find(' '));
}

// Whether rays of a row were traced each by itself: what the tracer tested is then what they would alone.
inline bool were_alone(const json& row) {
  const double alone = row.at("wide_boxes_per_ray");
  return std::fabs(row.at("traced_boxes_per_ray").get<double>() - alone) <= 0.01 * alone;
}

// Time of a ray in nanoseconds: what any ray of its kind takes, however little it meets, and so much for each
// node and each block of eight triangles that it looks into, or where rays run together for each box and each
// triangle that they are tested against. By least squares of relative errors.
class TimeModel {
 public:
  explicit TimeModel(const std::vector<const json*>& rows) {
    for (const json* const row : rows) {
      const std::string kind = kind_of(*row);
      if (std::find(kinds_.begin(), kinds_.end(), kind) == kinds_.end()) kinds_.push_back(kind);
    }
    std::sort(kinds_.begin(), kinds_.end());
    weights_ = solved(normal_equations(rows));
  }

  [[nodiscard]] double operator()(const json& row) const {
    const std::vector<double> terms = terms_of(row);
    double sum = 0.0;
    for (std::size_t i = 0; i < terms.size(); ++i) sum += weights_[i] * terms[i];
    return sum;
  }

  // "primary 70, a node 14.3, a block 21.3; together: a box 1.8, a triangle 0.5".
  [[nodiscard]] std::string words() const {
    std::string out;
    for (std::size_t i = 0; i < kinds_.size(); ++i)
      out += kinds_[i] + " " + page::number(weights_[i], "%.0f") + ", ";
    const auto weight = [&](std::size_t i) { return page::number(weights_[kinds_.size() + i], "%.1f"); };
    return out + "a node " + weight(0) + ", a block " + weight(1) + "; together: a box " + weight(2) +
           ", a triangle " + weight(3);
  }

 private:
  using Rows = std::vector<std::vector<double>>;

  [[nodiscard]] std::vector<double> terms_of(const json& row) const {
    std::vector<double> terms;
    for (const std::string& kind : kinds_) terms.push_back(kind == kind_of(row) ? 1.0 : 0.0);
    const double alone = were_alone(row) ? 1.0 : 0.0;
    terms.push_back(alone * row.at("wide_nodes_per_ray").get<double>());
    terms.push_back(alone * row.at("wide_blocks_per_ray").get<double>());
    terms.push_back((1.0 - alone) * row.at("traced_boxes_per_ray").get<double>());
    terms.push_back((1.0 - alone) * row.at("traced_triangles_per_ray").get<double>());
    return terms;
  }

  [[nodiscard]] Rows normal_equations(const std::vector<const json*>& rows) const {
    const std::size_t n = kinds_.size() + 4;
    Rows m(n, std::vector<double>(n + 1, 0.0));
    for (const json* const row : rows) {
      std::vector<double> terms = terms_of(*row);
      for (double& term : terms) term /= median(*row, "ns_per_ray");
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) m[i][j] += terms[i] * terms[j];
        m[i][n] += terms[i];
      }
    }
    return m;
  }

  // Gauss and Jordan, rows exchanged for the largest pivot; a term that no row tells apart weighs nothing.
  static std::vector<double> solved(Rows m) {
    const std::size_t n = m.size();
    for (std::size_t i = 0; i < n; ++i) {
      std::size_t pivot = i;
      for (std::size_t r = i + 1; r < n; ++r) {
        if (std::fabs(m[r][i]) > std::fabs(m[pivot][i])) pivot = r;
      }
      std::swap(m[i], m[pivot]);
      if (std::fabs(m[i][i]) < 1e-12) continue;
      for (std::size_t r = 0; r < n; ++r) {
        if (r == i) continue;
        const double factor = m[r][i] / m[i][i];
        for (std::size_t c = i; c <= n; ++c) m[r][c] -= factor * m[i][c];
      }
    }
    std::vector<double> out(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) out[i] = std::fabs(m[i][i]) < 1e-12 ? 0.0 : m[i][n] / m[i][i];
    return out;
  }

  std::vector<std::string> kinds_;
  std::vector<double> weights_;
};

}  // namespace gnomon::bench
