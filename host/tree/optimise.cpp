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

void require(bool ok, const char* option, const std::string& value, const char* range) {
  if (ok) return;
  throw Error(ErrorCode::kInvalidArgument,
              std::string("optimise option ") + option + " = " + value + " is outside its range " + range);
}

// What face weights say.
class FaceCosts {
 public:
  explicit FaceCosts(const std::array<float, 3>& weights) {
    std::copy(weights.begin(), weights.end(), faces_.w);
  }
  void prepare(const std::vector<Node>&) {}
  [[nodiscard]] float of(const std::vector<Node>& slots, std::uint32_t slot) const {
    return gn_slot_cost(&faces_, &slots[slot]);
  }
  [[nodiscard]] GnMove find(const std::vector<Node>& slots, const std::vector<std::uint32_t>& above,
                            std::uint32_t slot) const {
    return gn_find_move(slots.data(), above.data(), &faces_, slot);
  }

 private:
  GnFaces faces_{};
};

}  // namespace

void OptimiseOptions::check() const {
  for (const float w : face_weights)
    require(w >= 0.0F && std::isfinite(w), "face_weights", std::to_string(w), "of finite numbers >= 0");
  require(max_passes <= 64, "max_passes", std::to_string(max_passes), "0..64");
  require(share > 0.0F && share <= 1.0F, "share", std::to_string(share), "(0, 1]");
  require(least_gain >= 0.0F && least_gain < 1.0F, "least_gain", std::to_string(least_gain), "[0, 1)");
  require(max_depth >= 1 && max_depth <= GN_MOST_DEPTH, "max_depth", std::to_string(max_depth), "1..128");
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
  FaceCosts costs(options.face_weights);
  return Optimiser<FaceCosts>(bvh, options, costs).run();
}

}  // namespace gnomon
