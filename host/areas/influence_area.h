// Influence areas: a convex region of space and the rays that are expected in it, from a window (parallel),
// an eye (a frustum of rays) or a point that shines all ways. See host/notes/influence-areas.md. Not for
// measuring boxes (projection) or collecting triangles (membership). Feeds both, and the sampling of rays.
#pragma once

#include <optional>
#include <span>
#include <variant>

#include "gnomon/areas/solids.h"

namespace gnomon {

inline constexpr Vec3d kWorldUp{0.0, 1.0, 0.0};

// Parallel rays along `direction` from a rectangle about `point`; the region is the oriented box they cross
// within `depth`. `up` fixes the rectangle's turn; it may be parallel to the direction (look_along then picks
// one).
struct PlaneWindow {
  Vec3d point{0.0, 0.0, 0.0};
  Vec3d direction{0.0, 0.0, 1.0};
  double half_width = 1.0;
  double half_height = 1.0;
  double depth = 1.0;
  Vec3d up = kWorldUp;
};

// Rays from an eye through a window; the region is the frustum between near and far. Angles are full ones, in
// radians, less than pi.
struct PointView {
  Vec3d eye{0.0, 0.0, 0.0};
  Vec3d direction{0.0, 0.0, 1.0};
  double fov_x = 1.0;
  double fov_y = 1.0;
  double near_distance = 1.0;
  double far_distance = 2.0;
  Vec3d up = kWorldUp;
};

enum class AreaKind { kPlane, kPoint, kOmni };

class InfluenceArea {
 public:
  // Each throws Error{kInvalidArgument} naming what is not finite, zero, not positive or out of range.
  [[nodiscard]] static InfluenceArea plane(const PlaneWindow& window);
  [[nodiscard]] static InfluenceArea point(const PointView& view);
  // All directions from a centre; the region is a ball.
  [[nodiscard]] static InfluenceArea omni(const Vec3d& centre, double radius);

  [[nodiscard]] AreaKind kind() const { return kind_; }
  // Origin: the window's middle, the eye, the centre. Omni: the world's axes.
  [[nodiscard]] const AreaFrame& frame() const { return frame_; }
  [[nodiscard]] const std::variant<OrientedBox, Frustum, Ball>& region() const { return region_; }
  // Half the window's size (plane: lengths; point: angles in radians); omni: {0, 0}.
  [[nodiscard]] const Vec2d& half_window() const { return half_window_; }

  // The region is closed. Tolerances are those of solids.h: contains rounds, overlaps is never false for
  // touching.
  [[nodiscard]] bool contains(const Vec3d& p) const;
  [[nodiscard]] bool overlaps(const Box3d& box) const;
  // Whether all of the box is in the region: the box's corners are, and the region is convex. An empty box is
  // not.
  [[nodiscard]] bool fully_contains(const Box3d& box) const;
  // Holds every point of the region, and at most 2^-48 of its largest coordinate more.
  [[nodiscard]] Box3d enclosing_box() const;
  // The bounding half-spaces, unit normals inwards; none for omni.
  [[nodiscard]] std::span<const Plane> planes() const;

  // Unit direction of the area's ray through a point; at the eye or centre itself, forward.
  [[nodiscard]] Vec3d direction_at(const Vec3d& p) const;
  // Whether the area's tree is meant for this ray: its origin is inside and |cos| of the angle to
  // direction_at is at least 1 - tolerance, either sense (thesis: 0.01, that is 8.1 degrees). At omni's
  // centre every ray is. This decides speed only, never what is hit.
  [[nodiscard]] bool is_affine(const Ray3d& ray, double tolerance = 0.01) const;
  // The largest t with origin + t direction in the region; nothing for an origin outside. A zero direction
  // never leaves (+inf). Wrong by a few roundings of the coordinates over the cosine to the side it leaves
  // by; the note says how to use it.
  [[nodiscard]] std::optional<double> exit_distance(const Ray3d& ray) const;

 private:
  InfluenceArea(AreaKind kind, const AreaFrame& frame, const Vec2d& half_window,
                const std::variant<OrientedBox, Frustum, Ball>& region);

  AreaKind kind_;
  AreaFrame frame_;
  Vec2d half_window_;
  std::variant<OrientedBox, Frustum, Ball> region_;
  std::array<Plane, 6> planes_{};
};

}  // namespace gnomon
