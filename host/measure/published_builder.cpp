#include "gnomon/measure/published_builder.h"

#include <array>
#include <optional>

#include "gnomon/base/error.h"
#include "gnomon/measure/area_measure.h"

namespace gnomon {
namespace {

constexpr float kFacingThreshold = 0.4F;
constexpr float kLongestThreshold = 0.99F;
constexpr std::size_t kCells = 32;  // of the octree, per axis: depth 5
// How far outside the octree's root box the program still finds a point in it, into the nearest cell: its
// TOLERANCE, in units of the scene whatever their size. Whole walls lie that close to some of its areas.
constexpr double kRootTolerance = 0.01;

bool uses_projected_area(PublishedVariant variant, AreaKind kind) {
  return variant == PublishedVariant::kFull || variant == PublishedVariant::kTrueLongest ||
         (variant == PublishedVariant::kLongest && kind == AreaKind::kPlane);
}

bool uses_spfh(PublishedVariant variant, AreaKind kind) {
  return variant == PublishedVariant::kFull || variant == PublishedVariant::kFacing ||
         (variant == PublishedVariant::kLongest && kind == AreaKind::kPoint);
}

BuildOptions published_base() {
  BuildOptions options;
  options.policy.repaired = false;
  options.published_leaves.on = true;
  options.bins = 40;
  options.cost_traversal = 2.0F;
  options.cost_triangle = 1.2F;
  return options;
}

Box3d grown(Box3d box, double by) {
  for (std::size_t k = 0; k < 3; ++k) {
    box.lo[k] -= by;
    box.hi[k] += by;
  }
  return box;
}

// Which cells of the octree's lowest level meet the region, found when first asked.
class Cells {
 public:
  explicit Cells(const InfluenceArea& area)
      : area_(area), box_(area.enclosing_box()), tolerant_box_(grown(box_, kRootTolerance)) {}

  [[nodiscard]] bool has(const float point[3]) {
    const Vec3d p{point[0], point[1], point[2]};
    if (!contains(tolerant_box_, p)) return false;
    std::array<std::size_t, 3> at{};
    Box3d cell;
    for (std::size_t k = 0; k < 3; ++k) {
      const double size = (box_.hi[k] - box_.lo[k]) / static_cast<double>(kCells);
      while (at[k] + 1 < kCells && p[k] > box_.lo[k] + size * static_cast<double>(at[k] + 1)) ++at[k];
      cell.lo[k] = box_.lo[k] + size * static_cast<double>(at[k]);
      cell.hi[k] = box_.lo[k] + size * static_cast<double>(at[k] + 1);
    }
    std::optional<bool>& known = known_[(at[0] * kCells + at[1]) * kCells + at[2]];
    if (!known) known = area_.overlaps(cell);
    return *known;
  }

 private:
  const InfluenceArea& area_;
  Box3d box_;
  Box3d tolerant_box_;
  std::vector<std::optional<bool>> known_ = std::vector<std::optional<bool>>(kCells * kCells * kCells);
};

}  // namespace

std::string_view to_string(PublishedVariant variant) {
  switch (variant) {
    case PublishedVariant::kFull:
      return "Full";
    case PublishedVariant::kFacing:
      return "Facing";
    case PublishedVariant::kStandard:
      return "Standard";
    case PublishedVariant::kLongest:
      return "Longest";
    case PublishedVariant::kTrueLongest:
      return "TrueLongest";
  }
  return "unknown";
}

std::string_view heuristics_of(PublishedVariant variant, AreaKind kind) {
  const bool tight = variant == PublishedVariant::kLongest || variant == PublishedVariant::kTrueLongest ||
                     variant == PublishedVariant::kStandard;
  if (uses_projected_area(variant, kind)) return uses_spfh(variant, kind) ? "PAH+SPFH@0.4" : "PAH+LSPH@0.99";
  if (!uses_spfh(variant, kind)) return "SAH+LSPH@0.99";
  return tight ? "SAH+SPFH@0.99" : "SAH+SPFH@0.4";
}

BuildOptions published_options(PublishedVariant variant, const InfluenceArea& area) {
  if (area.kind() == AreaKind::kOmni)
    throw Error(ErrorCode::kInvalidArgument,
                "the thesis has no omni areas: give a plane or a point area to published_options");
  const bool point = area.kind() == AreaKind::kPoint;
  BuildOptions options = published_base();
  if (uses_projected_area(variant, area.kind())) {
    options.measure = area_measure(area, point ? RayMeasure::kNearPlane : RayMeasure::kParallel);
    options.measure.breaks_ties = 0;
  } else {
    options.measure = framed_surface_measure(area);
    options.policy.rays_from_point = point;
  }
  options.axes = uses_spfh(variant, area.kind()) ? AxisPolicy::kSpfh : AxisPolicy::kLsph;
  const bool loose = variant == PublishedVariant::kFull || variant == PublishedVariant::kFacing;
  options.policy.quality_threshold = loose ? kFacingThreshold : kLongestThreshold;
  return options;
}

BuildOptions published_global_options() {
  BuildOptions options = published_base();
  options.measure.area_share = 0.0F;  // relative to the root
  options.axes = AxisPolicy::kLsph;
  options.policy.quality_threshold = kFacingThreshold;
  return options;
}

std::vector<std::uint32_t> published_members(const InfluenceArea& area,
                                             std::span<const GnTriangle> triangles) {
  Cells cells(area);
  std::vector<std::uint32_t> members;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const GnTriangle& t = triangles[i];
    if (cells.has(t.v0) || cells.has(t.v1) || cells.has(t.v2))
      members.push_back(static_cast<std::uint32_t>(i));
  }
  return members;
}

}  // namespace gnomon
