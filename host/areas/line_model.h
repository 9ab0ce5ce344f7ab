// What rays that run together have in common: a direction, or a point that their lines pass. Fits one to
// lines and says how far a line is from it. Feeds detect.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "gnomon/areas/ray_lines.h"

namespace gnomon {

struct LineModel {
  enum class Kind {
    kBundle,      // parallel to `axis`
    kConverging,  // towards `apex`
    kDiverging,   // away from it
  };
  Kind kind = Kind::kBundle;
  Vec3d axis{0.0, 0.0, 1.0};
  Vec3d apex{0.0, 0.0, 0.0};
  double slack = 0.0;  // a line that passes the apex within this passes through it

  // The way a ray from this origin should go; nothing within the slack of the apex, where every way will do.
  [[nodiscard]] std::optional<Vec3d> expected(const Vec3d& origin) const;
  // How far the line is from it, as concentration.h measures angles.
  [[nodiscard]] double share_of(const RayLine& line) const;
};

// The mean direction, or the apex whose lines miss it by the smallest angles as seen from their origins
// (least squares, weights from the model's apex). Nothing where the lines fix no such thing.
[[nodiscard]] std::optional<LineModel> refined(const LineModel& model, std::span<const RayLine> lines);

// The point nearest to all lines, by squared distance; which way they pass it is put to the vote.
[[nodiscard]] std::optional<LineModel> pencil_through(std::span<const RayLine> lines, double slack);

// Of two lines, if they meet well: at an angle of more than a degree, ahead of both or behind both.
struct Meeting {
  LineModel model;
  double gap;  // between the lines over the distance to the nearer origin
};
[[nodiscard]] std::optional<Meeting> meeting_of(const RayLine& a, const RayLine& b, double slack);

// Root mean square of the angles by which lines miss the model, in radians, and of the lengths by which they
// miss its apex (0 for bundles).
struct Spread {
  double angle = 0.0;
  double distance = 0.0;
};
[[nodiscard]] Spread spread_about(const LineModel& model, std::span<const RayLine> lines);

}  // namespace gnomon
