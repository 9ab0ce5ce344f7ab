#include "gnomon/areas/line_model.h"

#include <cmath>

namespace gnomon {
namespace {

constexpr double kLeastSine = 0.0174524;  // a degree
// Lines of which one direction is this much better fixed than another fix no point.
constexpr double kLeastDeterminant = 1e-10;

// The point nearest to weighted lines, relative to `about`.
class NearestPoint {
 public:
  explicit NearestPoint(const Vec3d& about) : about_(about) {}

  void add(const RayLine& line, double weight) {
    const Vec3d& d = line.direction;
    const Vec3d o = line.origin - about_;
    const double along = dot(o, d);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) rows_[i][k] += weight * ((i == k ? 1.0 : 0.0) - d[i] * d[k]);
      right_[i] += weight * (o[i] - along * d[i]);
    }
  }

  [[nodiscard]] std::optional<Vec3d> solve() const {
    const double trace = rows_[0][0] + rows_[1][1] + rows_[2][2];
    const double determinant = dot(rows_[0], cross(rows_[1], rows_[2]));
    if (!(determinant > kLeastDeterminant * trace * trace * trace)) return std::nullopt;
    // The matrix is symmetric: its rows are its columns, and Cramer's rule takes cross products of them.
    const Vec3d x = 1.0 / determinant *
                    (right_[0] * cross(rows_[1], rows_[2]) + right_[1] * cross(rows_[2], rows_[0]) +
                     right_[2] * cross(rows_[0], rows_[1]));
    return about_ + x;
  }

 private:
  Vec3d about_;
  std::array<Vec3d, 3> rows_{};
  Vec3d right_{};
};

double sum_of_squares(const Vec3d& v) {
  return dot(v, v);
}

}  // namespace

std::optional<Vec3d> LineModel::expected(const Vec3d& origin) const {
  if (kind == Kind::kBundle) return axis;
  const Vec3d way = kind == Kind::kConverging ? apex - origin : origin - apex;
  if (!(sum_of_squares(way) > slack * slack)) return std::nullopt;
  return 1.0 / length(way) * way;
}

double LineModel::share_of(const RayLine& line) const {
  const auto way = expected(line.origin);
  if (!way) return 0.0;
  double chord = length(*way - line.direction);
  if (kind != Kind::kBundle) chord = larger(0.0, chord - slack / length(apex - line.origin));
  return 0.25 * chord * chord;
}

std::optional<LineModel> refined(const LineModel& model, std::span<const RayLine> lines) {
  LineModel out = model;
  if (model.kind == LineModel::Kind::kBundle) {
    Vec3d sum{};
    for (const RayLine& line : lines) sum = sum + line.direction;
    if (!(magnitude(sum) > 0.0)) return std::nullopt;
    out.axis = unit_of(sum);
    return out;
  }
  NearestPoint nearest(model.apex);
  const double least = larger(model.slack * model.slack, 1e-300);
  for (const RayLine& line : lines)
    nearest.add(line, 1.0 / (sum_of_squares(line.origin - model.apex) + least));
  const auto apex = nearest.solve();
  if (!apex || !is_finite(*apex)) return std::nullopt;
  out.apex = *apex;
  return out;
}

std::optional<LineModel> pencil_through(std::span<const RayLine> lines, double slack) {
  if (lines.empty()) return std::nullopt;
  Vec3d middle{};
  for (const RayLine& line : lines) middle = middle + 1.0 / static_cast<double>(lines.size()) * line.origin;
  NearestPoint nearest(middle);
  for (const RayLine& line : lines) nearest.add(line, 1.0);
  const auto apex = nearest.solve();
  if (!apex || !is_finite(*apex)) return std::nullopt;
  std::size_t ahead = 0;
  for (const RayLine& line : lines) ahead += dot(*apex - line.origin, line.direction) > 0.0 ? 1U : 0U;
  LineModel out;
  out.kind = 2 * ahead > lines.size() ? LineModel::Kind::kConverging : LineModel::Kind::kDiverging;
  out.apex = *apex;
  out.slack = slack;
  return out;
}

std::optional<Meeting> meeting_of(const RayLine& a, const RayLine& b, double slack) {
  const Vec3d normal = cross(a.direction, b.direction);
  const double squared = sum_of_squares(normal);
  if (!(squared > kLeastSine * kLeastSine)) return std::nullopt;
  const Vec3d between = b.origin - a.origin;
  const double along_a = dot(cross(between, b.direction), normal) / squared;
  const double along_b = dot(cross(between, a.direction), normal) / squared;
  const double behind = smaller(along_a, along_b);
  const double ahead = larger(along_a, along_b);
  if (behind < -slack && ahead > slack) return std::nullopt;
  Meeting out;
  out.model.kind = ahead > slack ? LineModel::Kind::kConverging : LineModel::Kind::kDiverging;
  const Vec3d p = a.at(along_a);
  const Vec3d q = b.at(along_b);
  out.model.apex = 0.5 * (p + q);
  out.model.slack = slack;
  const double near = smaller(std::abs(along_a), std::abs(along_b));
  out.gap = larger(0.0, length(q - p) - slack) / larger(near, larger(slack, 1e-300));
  return out;
}

Spread spread_about(const LineModel& model, std::span<const RayLine> lines) {
  Spread out;
  if (lines.empty()) return out;
  for (const RayLine& line : lines) {
    // The angle itself, not a chord: exact to double rounding, also for small ones.
    if (const auto way = model.expected(line.origin)) {
      const double angle = 2.0 * std::asin(smaller(1.0, 0.5 * length(*way - line.direction)));
      out.angle += angle * angle;
    }
    if (model.kind == LineModel::Kind::kBundle) continue;
    const Vec3d to_apex = model.apex - line.origin;
    out.distance += sum_of_squares(to_apex - dot(to_apex, line.direction) * line.direction);
  }
  const auto n = static_cast<double>(lines.size());
  return {std::sqrt(out.angle / n), std::sqrt(out.distance / n)};
}

}  // namespace gnomon
