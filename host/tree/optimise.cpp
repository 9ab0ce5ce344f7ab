#include "gnomon/tree/optimise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "gnomon/base/error.h"
#include "gnomon/tree/optimiser.h"

namespace gnomon {

namespace {

void require(bool ok, const char* option, const std::string& value, const std::string& range) {
  if (ok) return;
  throw Error(ErrorCode::kInvalidArgument,
              std::string("optimise option ") + option + " = " + value + " is outside its range " + range);
}

class BoxCosts {
 public:
  // The options must outlive it.
  BoxCosts(const OptimiseOptions& options, const Node& root) {
    std::copy(options.face_weights.begin(), options.face_weights.end(), costs_.w);
    const float faces = gn_linear_measure(costs_.w, root.lo, root.hi);
    segments_ = segment_planes(options.segments);
    costs_.segments = segments_.data();
    costs_.segment_count = static_cast<std::uint32_t>(options.segments.size());
    costs_.per_segment = cost_per_segment(options, faces);
    areas_ = area_costs(options.areas, faces, root.lo, root.hi);
    costs_.count = static_cast<std::uint32_t>(areas_.areas.size());
    costs_.maps = areas_.maps.data();
    std::copy(areas_.areas.begin(), areas_.areas.end(), costs_.areas);
  }
  void prepare(const std::vector<Node>&) {}
  [[nodiscard]] float of(const std::vector<Node>& slots, std::uint32_t slot) const {
    return gn_slot_cost(&costs_, &slots[slot]);
  }
  [[nodiscard]] GnMove find(const std::vector<Node>& slots, const std::vector<std::uint32_t>& above,
                            std::uint32_t slot) const {
    return gn_find_move(slots.data(), above.data(), &costs_, slot);
  }

 private:
  AreaCosts areas_;
  std::vector<float> segments_;
  GnBoxCosts costs_{};
};

}  // namespace

void OptimiseOptions::check() const {
  for (const float w : face_weights)
    require(w >= 0.0F && std::isfinite(w), "face_weights", std::to_string(w), "of finite numbers >= 0");
  require(areas.size() <= GN_MOST_COST_AREAS, "areas", std::to_string(areas.size()) + " of them",
          "0.." + std::to_string(GN_MOST_COST_AREAS));
  for (const AreaCost& area : areas) {
    require(area.share >= 0.0F && std::isfinite(area.share), "areas: share", std::to_string(area.share),
            "of finite numbers >= 0");
    require(area.map.sums.empty() || area.map.sums.size() == GN_MAP_SUMS, "areas: sums of a map",
            std::to_string(area.map.sums.size()), "0 or " + std::to_string(GN_MAP_SUMS));
  }
  for (const GnRay& segment : segments)
    require(gn_ray_is_valid(&segment) != 0, "segments", "one that cannot be traced", "of traceable rays");
  require(segments_share >= 0.0F && std::isfinite(segments_share), "segments_share",
          std::to_string(segments_share), "of finite numbers >= 0");
  require(max_passes <= 64, "max_passes", std::to_string(max_passes), "0..64");
  require(share > 0.0F && share <= 1.0F, "share", std::to_string(share), "(0, 1]");
  require(least_gain >= 0.0F && least_gain < 1.0F, "least_gain", std::to_string(least_gain), "[0, 1)");
  require(max_depth >= 1 && max_depth <= GN_MOST_DEPTH, "max_depth", std::to_string(max_depth), "1..128");
}

std::vector<float> segment_planes(std::span<const GnRay> segments) {
  const std::size_t count = segments.size();
  std::vector<float> planes(GN_SEGMENT_PLANES * count);
  for (std::size_t i = 0; i < count; ++i) {
    const GnRayFrame frame = gn_ray_frame(&segments[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      planes[k * count + i] = frame.origin[k];
      planes[(3 + k) * count + i] = frame.inverse[k];
    }
    planes[6 * count + i] = gn_finite_tmin(segments[i].tmin);
    planes[7 * count + i] = segments[i].tmax;
  }
  return planes;
}

float cost_per_segment(const OptimiseOptions& options, float root_faces) {
  if (options.segments.empty()) return 0.0F;
  return options.segments_share * root_faces / static_cast<float>(options.segments.size());
}

void require_depth(std::uint32_t depth) {
  if (depth <= GN_MOST_DEPTH) return;
  throw Error(ErrorCode::kInvalidArgument,
              "a tree " + std::to_string(depth) + " levels deep cannot be optimised: at most " +
                  std::to_string(GN_MOST_DEPTH) + "; build one that is halved sooner");
}

std::uint32_t candidate_floor(std::span<const std::uint32_t> bins, float share) {
  std::uint64_t nodes = 0;
  for (const std::uint32_t count : bins) nodes += count;
  const double most = static_cast<double>(share) * static_cast<double>(nodes);
  std::uint64_t taken = 0;
  auto floor = static_cast<std::uint32_t>(bins.size());
  while (floor > 0 && (taken == 0 || static_cast<double>(taken + bins[floor - 1]) <= most))
    taken += bins[--floor];
  return floor;
}

float units_of(float root_cost) {
  return root_cost > 1e-28F && root_cost < 1e38F ? GN_ROOT_UNITS * gn_reciprocal(root_cost) : 0.0F;
}

Bvh optimise_reference(const Bvh& bvh, const OptimiseOptions& options) {
  options.check();
  if (bvh.nodes.empty()) return bvh;
  BoxCosts costs(options, bvh.nodes.front());
  return Optimiser<BoxCosts>(bvh, options, costs).run();
}

std::vector<float> box_costs(const Bvh& bvh, const OptimiseOptions& options) {
  options.check();
  std::vector<float> out;
  if (bvh.nodes.empty()) return out;
  const BoxCosts costs(options, bvh.nodes.front());
  for (std::uint32_t i = 0; i < bvh.nodes.size(); ++i) out.push_back(costs.of(bvh.nodes, i));
  return out;
}

}  // namespace gnomon
