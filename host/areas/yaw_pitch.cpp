#include "gnomon/areas/yaw_pitch.h"

namespace gnomon {
namespace {

constexpr double kError = 0x1p-40;
constexpr int kPanels =
    4;  // halved at least once, so that no bump between the samples of a whole edge is missed
constexpr int kMostHalvings = 30;

// The pitch of an edge from p to q where its yaw is `yaw`, clamped.
class EdgePitch {
 public:
  EdgePitch(const Vec3d& p, const Vec3d& q, double half_pitch) : p_(p), q_(q), half_pitch_(half_pitch) {}

  double operator()(double yaw) const {
    // Signed distances from the upright plane at this yaw say where the edge crosses it.
    const double c = std::cos(yaw);
    const double s = std::sin(yaw);
    const double p_side = p_[0] * c - p_[2] * s;
    const double q_side = q_[0] * c - q_[2] * s;
    const double along = p_side == q_side ? 0.5 : p_side / (p_side - q_side);
    const Vec3d at = p_ + smaller(larger(along, 0.0), 1.0) * (q_ - p_);
    const double pitch = std::atan2(at[1], std::sqrt(at[0] * at[0] + at[2] * at[2]));
    return smaller(larger(pitch, -half_pitch_), half_pitch_);
  }

 private:
  Vec3d p_;
  Vec3d q_;
  double half_pitch_;
};

struct Panel {
  double from, to;
  double f_from, f_middle, f_to;
  [[nodiscard]] double middle() const { return 0.5 * (from + to); }
  [[nodiscard]] double simpson() const { return (to - from) / 6.0 * (f_from + 4.0 * f_middle + f_to); }
};

double integral_of(const EdgePitch& pitch, const Panel& whole, double error, int halvings) {
  const double middle = whole.middle();
  const Panel left{whole.from, middle, whole.f_from, pitch(0.5 * (whole.from + middle)), whole.f_middle};
  const Panel right{middle, whole.to, whole.f_middle, pitch(0.5 * (middle + whole.to)), whole.f_to};
  const double both = left.simpson() + right.simpson();
  const double change = both - whole.simpson();
  if (std::abs(change) <= 15.0 * error || halvings >= kMostHalvings) return both + change / 15.0;
  return integral_of(pitch, left, 0.5 * error, halvings + 1) +
         integral_of(pitch, right, 0.5 * error, halvings + 1);
}

double edge_integral(const Vec3d& p, const Vec3d& q, double half_pitch) {
  const double from = std::atan2(p[0], p[2]);
  const double to = std::atan2(q[0], q[2]);
  const double width = (to - from) / kPanels;
  if (width == 0.0) return 0.0;
  const EdgePitch pitch(p, q, half_pitch);
  double sum = 0.0;
  for (int i = 0; i < kPanels; ++i) {
    const double a = from + i * width;
    const double b = from + (i + 1) * width;
    const Panel panel{a, b, pitch(a), pitch(0.5 * (a + b)), pitch(b)};
    sum += integral_of(pitch, panel, kError * half_pitch * std::abs(width), 0);
  }
  return sum;
}

}  // namespace

double yaw_pitch_area_of(const Polygon3d& polygon, double half_pitch) {
  double sum = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    sum += edge_integral(polygon[i], polygon[(i + 1) % polygon.size()], half_pitch);
  return std::abs(sum);
}

}  // namespace gnomon
