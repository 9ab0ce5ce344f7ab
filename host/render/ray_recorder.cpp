#include "gnomon/render/ray_recorder.h"

#include <algorithm>
#include <tuple>

#include "gnomon/scene/steady_random.h"

namespace gnomon {
namespace {

// Deeper rays of a kind are one stratum: there are few, and they are much alike.
constexpr std::uint32_t kDeepest = 4;

RecordedKind kind_of(RayUse use) {
  switch (use) {
    case RayUse::kCamera:
      return RecordedKind::kCamera;
    case RayUse::kBounce:
      return RecordedKind::kBounce;
    case RayUse::kShadow:
      return RecordedKind::kShadow;
  }
  return RecordedKind::kOther;
}

}  // namespace

void RayRecorder::add(const TracedRays& traced) {
  const RecordedKind kind = kind_of(traced.use);
  const std::uint64_t stream = mix_bits(
      seed_ + mix_bits(2 * std::uint64_t{traced.bounce} + (traced.use == RayUse::kShadow ? 1 : 0) + 1));
  for (std::size_t i = 0; i < traced.rays.size(); ++i) {
    const std::uint32_t light = traced.use == RayUse::kShadow ? traced.lights[i] : kNoLight;
    Stratum& stratum = strata_[{kind, light, std::min(traced.bounce, kDeepest)}];
    stratum.traced += 1;
    const PathId path = traced.paths[i];
    const std::uint64_t number = mix_bits(stream ^ mix_bits(std::uint64_t{path.cell} << 32U | path.sample));
    if (number <= stratum.limit) stratum.kept.push_back({number, path, traced.bounce, traced.rays[i]});
  }
  trim();
}

// So many a stratum may keep that all of them together keep `most`, those with fewer leaving room for others.
// More strata or rays never raise it, so what it cuts off now is never missed.
std::uint64_t RayRecorder::even_share() const {
  std::vector<std::uint64_t> counts;
  for (const auto& [key, stratum] : strata_) counts.push_back(stratum.traced);
  std::sort(counts.begin(), counts.end());
  std::uint64_t left = most_;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const std::uint64_t share = left / (counts.size() - i);
    if (counts[i] > share) return share;
    left -= counts[i];
  }
  return most_;
}

void RayRecorder::trim() {
  const std::uint64_t share = even_share();
  const auto before = [](const Kept& a, const Kept& b) {
    return std::tie(a.number, a.path.cell, a.path.sample, a.bounce) <
           std::tie(b.number, b.path.cell, b.path.sample, b.bounce);
  };
  for (auto& [key, stratum] : strata_) {
    if (stratum.kept.size() <= share) continue;
    std::nth_element(stratum.kept.begin(), stratum.kept.begin() + static_cast<std::ptrdiff_t>(share),
                     stratum.kept.end(), before);
    stratum.limit = stratum.kept[share].number;
    stratum.kept.resize(share);
  }
}

RayRecord RayRecorder::record() const {
  RayRecord out;
  out.seed = seed_;
  for (const auto& [key, stratum] : strata_) {
    const auto& [kind, light, depth] = key;
    std::vector<Kept> kept = stratum.kept;
    std::sort(kept.begin(), kept.end(), [](const Kept& a, const Kept& b) {
      return std::tie(a.path.cell, a.path.sample, a.bounce) < std::tie(b.path.cell, b.path.sample, b.bounce);
    });
    out.strata.push_back({kind, light, depth, stratum.traced, kept.size()});
    for (const Kept& one : kept) out.rays.push_back(one.ray);
  }
  return out;
}

}  // namespace gnomon
