#include "gnomon/plan/local_sets.h"

#include <algorithm>
#include <cstring>
#include <optional>

#include "gnomon/areas/grown_area.h"
#include "gnomon/areas/membership.h"
#include "gnomon/areas/ray_regions.h"
#include "gnomon/areas/shared_area.h"

namespace gnomon {

namespace {

// By the clock, in units of PlanPrices: a ray tested against a region, a node's box against its planes, a
// triangle cut by them.
constexpr double kRayPrice = 3.0;
constexpr double kNodePrice = 3.0;
constexpr double kTrianglePrice = 60.0;

// How far a region is grown, as a share of its largest coordinate: as forests grow theirs (top-level.md).
constexpr double kGrowth = 0x1p-16;
// Where a frustum begins, as a share of where it ends: once grown it has its eye.
constexpr double kNear = 0x1p-19;
// Of the rays, that may stick out of a region made about them on each side.
constexpr double kStrays = 0.005;
// How far rays may pass a point, as a share of the scene, or turn from a direction, to be all of one.
constexpr double kApart = 0x1p-17;

double size_of(const Box3d& box) {
  return larger(magnitude(box.lo), magnitude(box.hi));
}

// The box around a ball: rays are tested against planes.
InfluenceArea box_around(const Ball& ball) {
  PlaneWindow window;
  window.point = ball.centre - Vec3d{0.0, 0.0, ball.radius};
  window.half_width = window.half_height = ball.radius;
  window.depth = 2.0 * ball.radius;
  return InfluenceArea::plane(window);
}

// From the eye on.
InfluenceArea from_the_eye(const InfluenceArea& area) {
  const AreaFrame& f = area.frame();
  PointView view;
  view.eye = f.origin;
  view.direction = f.forward;
  view.up = f.up;
  view.fov_x = 2.0 * area.half_window()[0];
  view.fov_y = 2.0 * area.half_window()[1];
  view.far_distance = std::get<Frustum>(area.region()).far_distance;
  view.near_distance = kNear * view.far_distance;
  return InfluenceArea::point(view);
}

// None where float cannot hold it.
std::optional<InfluenceArea> made_ready(const InfluenceArea& area) {
  const auto* ball = std::get_if<Ball>(&area.region());
  const InfluenceArea whole = ball != nullptr                   ? box_around(*ball)
                              : area.kind() == AreaKind::kPoint ? from_the_eye(area)
                                                                : area;
  const double size = size_of(whole.enclosing_box());
  if (!(size < 0x1p47 && size > 0x1p-39)) return std::nullopt;
  return grown_by(whole, kGrowth * size);
}

bool begin_in_one_point(std::span<const Ray> rays) {
  return std::all_of(rays.begin(), rays.end(), [&](const Ray& ray) {
    return std::equal(ray.origin, ray.origin + 3, rays.front().origin);
  });
}

bool run_one_way(std::span<const RayLine> lines) {
  return std::all_of(lines.begin(), lines.end(), [&](const RayLine& line) {
    return length(line.direction - lines.front().direction) <= kApart;
  });
}

// The point where all end, if there is one.
std::optional<Vec3d> common_end(std::span<const RayLine> lines, double size) {
  const Vec3d first = lines.front().at(lines.front().end);
  const bool one = std::all_of(lines.begin(), lines.end(), [&](const RayLine& line) {
    return length(line.at(line.end) - first) <= kApart * size;
  });
  return one ? std::optional(first) : std::nullopt;
}

// The region of all rays, where they are one pencil or bundle.
std::optional<InfluenceArea> common_region(std::span<const Ray> rays, const Box3d& scene) {
  std::vector<RayLine> lines = lines_of(rays);
  end_within(lines, scene);
  if (begin_in_one_point(rays)) return frustum_about(lines, lines.front().origin, kStrays);
  if (run_one_way(lines)) return box_about(lines, lines.front().direction, kStrays);
  if (const auto end = common_end(lines, size_of(scene))) return frustum_about(lines, *end, kStrays);
  return std::nullopt;
}

// The triangles of a tree that touch a region.
class Members {
 public:
  Members(const Bvh& tree, std::span<const Triangle> triangles, const InfluenceArea& area, std::size_t most)
      : tree_(tree), triangles_(triangles), area_(area), most_(most) {
    slack_ = 0x1p-40 * larger(size_of(area.enclosing_box()), size_of(box_of(tree.nodes.front())));
  }

  // False where there are more than `most` of them.
  bool collect() {
    std::vector<std::pair<std::uint32_t, bool>> waiting{{0, false}};  // a node, and whether all of it is in
    while (!waiting.empty() && found_.size() <= most_) {
      const auto [index, all] = waiting.back();
      waiting.pop_back();
      const Node& node = tree_.nodes[index];
      const Side side = all ? Side::kInside : side_of(box_of(node));
      if (side == Side::kOutside) continue;
      if (node.count > 0) {
        take(node, side == Side::kInside);
        continue;
      }
      waiting.emplace_back(node.first + 1, side == Side::kInside);
      waiting.emplace_back(node.first, side == Side::kInside);
    }
    if (found_.size() > most_) return false;
    // A tree of parts has triangles in several leaves.
    std::sort(found_.begin(), found_.end());
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
    return true;
  }

  [[nodiscard]] std::vector<std::uint32_t> take_found() { return std::move(found_); }
  [[nodiscard]] double work() const { return work_; }

 private:
  enum class Side { kOutside, kAcross, kInside };

  static Box3d box_of(const Node& node) {
    Box3d box;
    for (const float* corner : {node.lo, node.hi})
      extend(box, {double{corner[0]}, double{corner[1]}, double{corner[2]}});
    return box;
  }

  // By planes alone: a box beyond none of them may still be outside, which its triangles will tell.
  Side side_of(const Box3d& box) {
    work_ += kNodePrice;
    Side side = Side::kInside;
    for (const Plane& plane : area_.planes()) {
      double least = plane.offset;
      double most = plane.offset;
      for (std::size_t k = 0; k < 3; ++k) {
        const double low = plane.normal[k] * box.lo[k];
        const double high = plane.normal[k] * box.hi[k];
        least += smaller(low, high);
        most += larger(low, high);
      }
      if (most < -slack_) return Side::kOutside;
      if (!(least >= 0.0)) side = Side::kAcross;
    }
    return side;
  }

  void take(const Node& leaf, bool inside) {
    for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
      const std::uint32_t primitive = tree_.primitives[i];
      if (!inside) work_ += kTrianglePrice;
      if (inside || touches(area_, triangles_[primitive])) found_.push_back(primitive);
    }
  }

  const Bvh& tree_;
  std::span<const Triangle> triangles_;
  const InfluenceArea& area_;
  std::size_t most_;
  double slack_ = 0.0;
  double work_ = 0.0;
  std::vector<std::uint32_t> found_;
};

class Search {
 public:
  Search(const Bvh& tree, std::span<const Triangle> triangles, std::span<const Ray> rays,
         const LocalLimits& limits)
      : tree_(tree), triangles_(triangles), rays_(rays), limits_(limits), open_(rays.size(), true) {
    for (const float* corner : {tree.nodes.front().lo, tree.nodes.front().hi})
      extend(scene_, {double{corner[0]}, double{corner[1]}, double{corner[2]}});
  }

  void look_at(const InfluenceArea& given) {
    if (out_.sets.size() == limits_.most_sets) return;
    const std::optional<InfluenceArea> area = made_ready(given);
    if (!area) return;
    const Region region = to_region(*area, scene_);
    const std::vector<std::size_t> own = rays_within(region);
    const double share = static_cast<double>(own.size()) / static_cast<double>(rays_.size());
    if (share < limits_.least_share) return;
    out_.looked_at += 1;
    const auto count = static_cast<double>(triangles_.size());
    Members members(tree_, triangles_, *area, static_cast<std::size_t>(limits_.most_members * count));
    const bool few = members.collect();
    out_.work += members.work();
    if (!few) return;
    LocalSet set{*area, region, members.take_found(), share};
    out_.least_members = std::min(out_.least_members, static_cast<double>(set.members.size()) / count);
    if (set.members.empty()) return;  // its rays meet nothing, which they find out at the root as well
    for (const std::size_t ray : own) open_[ray] = false;
    out_.sets.push_back(std::move(set));
  }

  LocalSets run(std::span<const InfluenceArea> known) {
    for (const InfluenceArea& area : known) look_at(area);
    if (const auto region = common_region(rays_, scene_)) look_at(*region);
    return std::move(out_);
  }

 private:
  // Of those in no set yet.
  std::vector<std::size_t> rays_within(const Region& region) {
    std::vector<std::size_t> own;
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      if (!open_[i]) continue;
      out_.work += kRayPrice;
      if (region_of(std::span(&region, 1), rays_[i]) == 0) own.push_back(i);
    }
    return own;
  }

  const Bvh& tree_;
  std::span<const Triangle> triangles_;
  std::span<const Ray> rays_;
  LocalLimits limits_;
  Box3d scene_;
  std::vector<bool> open_;  // rays in no set yet
  LocalSets out_;
};

}  // namespace

LocalSets local_sets(const Bvh& tree, std::span<const Triangle> triangles, std::span<const Ray> rays,
                     std::span<const InfluenceArea> known, const LocalLimits& limits) {
  if (tree.nodes.empty() || rays.empty()) return {};
  return Search(tree, triangles, rays, limits).run(known);
}

}  // namespace gnomon
