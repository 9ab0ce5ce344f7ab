#include "gnomon/areas/ray_regions.h"

#include <algorithm>
#include <vector>

#include "gnomon/scene/steady_random.h"

namespace gnomon {
namespace {

constexpr double kNearShare = 0x1p-10;
constexpr double kMargin = 1e-6;  // of the region's size and place: flat ones must have some depth
constexpr double kSineWidest = 0.9659258262890683;  // of 75 degrees
constexpr unsigned kTurns = 16;                     // of a quarter turn
constexpr double kWorthTurning = 0.95;

struct Range {
  double lo;
  double hi;
};

// Leaves out a share at each end. `low` and `high` are reordered.
Range range_of(std::vector<double>& low, std::vector<double>& high, double outside) {
  const auto skipped = static_cast<std::ptrdiff_t>(outside * static_cast<double>(low.size()));
  std::nth_element(low.begin(), low.begin() + skipped, low.end());
  std::nth_element(high.begin(), high.end() - 1 - skipped, high.end());
  return {*(low.begin() + skipped), *(high.end() - 1 - skipped)};
}

// What the segments span along an axis.
Range span_along(std::span<const RayLine> lines, const Vec3d& origin, const Vec3d& axis, double outside) {
  std::vector<double> low;
  std::vector<double> high;
  low.reserve(lines.size());
  high.reserve(lines.size());
  for (const RayLine& line : lines) {
    const double begin = dot(line.at(line.begin) - origin, axis);
    const double end = dot(line.at(line.end) - origin, axis);
    low.push_back(smaller(begin, end));
    high.push_back(larger(begin, end));
  }
  return range_of(low, high, outside);
}

struct Box {
  AreaFrame frame;
  Range x, y, z;
  [[nodiscard]] double face() const { return (x.hi - x.lo) * (y.hi - y.lo); }
};

Box box_in(std::span<const RayLine> lines, const AreaFrame& frame, const Range& z, double outside) {
  return {frame, span_along(lines, frame.origin, frame.right, outside),
          span_along(lines, frame.origin, frame.up, outside), z};
}

std::optional<InfluenceArea> ball_about(std::span<const RayLine> lines, const Vec3d& apex, double outside) {
  std::vector<double> low;
  for (const RayLine& line : lines)
    low.push_back(larger(length(line.at(line.begin) - apex), length(line.at(line.end) - apex)));
  std::vector<double> high = low;
  const double radius = range_of(low, high, outside).hi;
  if (!(radius > 0.0) || !std::isfinite(radius)) return std::nullopt;
  return InfluenceArea::omni(apex, radius);
}

double angle_of(double tangent) {
  return std::atan(tangent);
}

}  // namespace

std::optional<InfluenceArea> box_about(std::span<const RayLine> lines, const Vec3d& direction,
                                       double outside) {
  if (lines.empty()) return std::nullopt;
  const AreaFrame straight = look_along(lines[lines.size() / 2].origin, direction, kWorldUp);
  const Range z = span_along(lines, straight.origin, straight.forward, outside);
  const Box kept = box_in(lines, straight, z, outside);
  Box best = kept;
  for (unsigned turn = 1; turn < kTurns; ++turn) {
    const double turns = 0.25 * static_cast<double>(turn) / kTurns;
    const Vec3d up = cos_turns(turns) * straight.up + sin_turns(turns) * straight.right;
    const Box turned = box_in(lines, look_along(straight.origin, direction, up), z, outside);
    if (turned.face() < best.face()) best = turned;
  }
  if (!(best.face() < kWorthTurning * kept.face())) best = kept;
  const Vec3d size{best.x.hi - best.x.lo, best.y.hi - best.y.lo, z.hi - z.lo};
  const double margin =
      larger(kMargin * larger(magnitude(size), magnitude(best.frame.origin)), kMargin * kMargin);
  PlaneWindow window;
  window.point =
      to_world(best.frame, {0.5 * (best.x.lo + best.x.hi), 0.5 * (best.y.lo + best.y.hi), z.lo - margin});
  window.direction = direction;
  window.up = best.frame.up;
  window.half_width = 0.5 * size[0] + margin;
  window.half_height = 0.5 * size[1] + margin;
  window.depth = size[2] + 2.0 * margin;
  if (!is_finite(window.point) || !std::isfinite(window.depth * window.half_width * window.half_height))
    return std::nullopt;
  return InfluenceArea::plane(window);
}

std::optional<InfluenceArea> frustum_about(std::span<const RayLine> lines, const Vec3d& apex,
                                           double outside) {
  // Where the rays are, seen from the apex: each by the middle of its segment.
  Vec3d forward{};
  for (const RayLine& line : lines) {
    const Vec3d middle = line.at(0.5 * (line.begin + line.end)) - apex;
    if (magnitude(middle) > 0.0) forward = forward + unit_of(middle);
  }
  if (lines.empty() || !is_finite(forward)) return std::nullopt;
  if (!(length(forward) > 0.1 * static_cast<double>(lines.size()))) return ball_about(lines, apex, outside);
  AreaFrame frame = look_along(apex, forward, kWorldUp);
  Range x{0.0, 0.0};
  Range y{0.0, 0.0};
  // The axis is moved to the middle of what is seen, which shifts what is seen a little.
  for (int round = 0; round < 4; ++round) {
    std::vector<double> across, high, beside;
    std::size_t wide = 0;
    for (const RayLine& line : lines) {
      const Vec3d seen = to_local(frame, line.at(0.5 * (line.begin + line.end)));
      if (!(seen[2] > 0.0) || seen[2] * seen[2] < (1.0 - kSineWidest * kSineWidest) * dot(seen, seen)) {
        ++wide;
        continue;
      }
      across.push_back(seen[0] / seen[2]);
      high.push_back(seen[1] / seen[2]);
    }
    if (static_cast<double>(wide) > 2.0 * outside * static_cast<double>(lines.size()) || across.empty())
      return ball_about(lines, apex, outside);
    beside = across;
    x = range_of(across, beside, outside);
    beside = high;
    y = range_of(high, beside, outside);
    if (round == 3) break;
    const auto middle_of = [](const Range& r) { return std::tan(0.5 * (angle_of(r.lo) + angle_of(r.hi))); };
    frame = look_along(apex, frame.forward + middle_of(x) * frame.right + middle_of(y) * frame.up, kWorldUp);
  }
  const Range z = span_along(lines, apex, frame.forward, outside);
  PointView view;
  view.eye = apex;
  view.direction = frame.forward;
  view.far_distance = (1.0 + kMargin) * z.hi;
  view.near_distance = larger((1.0 - kMargin) * z.lo, kNearShare * view.far_distance);
  const auto fov = [](const Range& r) {
    return 2.0 * (1.0 + kMargin) * larger(angle_of(larger(-r.lo, r.hi)), kMargin);
  };
  view.fov_x = fov(x);
  view.fov_y = fov(y);
  if (!(view.far_distance > view.near_distance) || !std::isfinite(view.far_distance) || !is_finite(apex))
    return std::nullopt;
  if (larger(view.fov_x, view.fov_y) >=
      2.0 * angle_of(kSineWidest / std::sqrt(1.0 - kSineWidest * kSineWidest)))
    return ball_about(lines, apex, outside);
  return InfluenceArea::point(view);
}

double share_inside(const InfluenceArea& area, std::span<const RayLine> lines) {
  if (lines.empty()) return 0.0;
  const auto* const frustum = std::get_if<Frustum>(&area.region());
  std::size_t inside = 0;
  for (const RayLine& line : lines) {
    bool in = true;
    for (const Vec3d& point : {line.at(line.begin), line.at(line.end)}) {
      if (frustum != nullptr && to_local(frustum->frame, point)[2] < frustum->near_distance &&
          length(point - frustum->frame.origin) < 2.0 * frustum->near_distance)
        continue;
      in &= area.contains(point);
    }
    inside += in ? 1U : 0U;
  }
  return static_cast<double>(inside) / static_cast<double>(lines.size());
}

}  // namespace gnomon
