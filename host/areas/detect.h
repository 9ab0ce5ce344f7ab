// Where recorded rays run together: bundles of parallel rays and pencils through a point, found in the rays
// alone, so a mirror's reflection of a lamp is found as well. Not for lights that are known (detect_lights).
// Feeds the choice of local trees and of the rays that trees are built for. See host/notes/detect.md.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gnomon/areas/influence_area.h"

namespace gnomon {

struct DetectOptions {
  std::uint64_t seed = 1;
  std::size_t most_rays = 8192;  // looked at; of more a sample is drawn that does not depend on their order
  std::size_t most_groups = 16;
  double least_share = 0.01;  // of the rays looked at, that a group has; never fewer than 16 rays
  // Where rays without an end stop to count; by default the box of all origins and ends.
  std::optional<Box3d> bounds;

  // Throws Error{kInvalidArgument}: shares outside 0 to 1, fewer than 16 rays looked at, bounds that are
  // empty or not finite.
  void check() const;
};

enum class GroupKind {
  kBundle,      // parallel rays: plane area
  kConverging,  // rays towards a point, as shadow rays to a lamp: point area, or omni where they come all
                // ways
  kDiverging,   // rays from a point, as a camera's
};
[[nodiscard]] const char* to_string(GroupKind kind);

struct RayGroup {
  GroupKind kind;
  InfluenceArea area;     // what the rays occupy, to within their outermost hundredth or so
  Vec3d direction;        // unit; bundle: of its rays. Pencil: from the apex to where they are on the whole
  Vec3d apex;             // pencils
  std::size_t count = 0;  // of the rays looked at
  double coverage = 0.0;  // the same as a share
  // Share of the group's rays that are in the area whole, from begin to end. Low for pencils whose lines miss
  // the apex: next to it the frustum is narrower than that.
  double inside = 0.0;
  double spread = 0.0;        // radians, root mean square: about the direction, or from the line to the apex
  double miss = 0.0;          // pencils: root mean square distance from the apex to the rays' lines
  double contrast = 0.0;      // how many times as dense as in the ring around it, or as isotropic rays are
  double log10_chance = 0.0;  // that rays without direction had shown such a group anywhere: at most 10^this
};

struct Detection {
  std::size_t rays = 0;
  std::size_t looked_at = 0;
  std::vector<RayGroup> groups;  // the larger first
};

// The groups, each with rays that no other has: the surest first takes its rays away, until none is left that
// is denser by a factor of five than what is around it and surer than a chance of 1e-6 over all that was
// tried. The same for rays in any other order. Throws Error{kInvalidArgument}: options as check, or a ray
// that is not finite or has no direction (a range without end is fine).
[[nodiscard]] Detection detect(std::span<const GnRay> rays, const DetectOptions& options = {});

}  // namespace gnomon
