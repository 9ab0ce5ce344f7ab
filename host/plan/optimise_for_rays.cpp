#include "gnomon/plan/optimise_for_rays.h"

#include <cmath>
#include <string>

#include "gnomon/base/error.h"
#include "gnomon/plan/met_part.h"
#include "gnomon/plan/sample_mover.h"
#include "gnomon/tree/box_frame.h"
#include "gnomon/tree/parents_first.h"

namespace gnomon {

namespace {

// Of a node that is copied and measured, beside a box test.
constexpr double kCopyWork = 4.0;

void require(bool ok, const char* option, const std::string& value, const char* range) {
  if (ok) return;
  throw Error(ErrorCode::kInvalidArgument,
              std::string("sample option ") + option + " = " + value + " is outside its range " + range);
}

std::uint32_t depth_of(const Bvh& bvh) {
  std::vector<std::uint32_t> depths(bvh.nodes.size());
  std::uint32_t most = 0;
  for (const std::uint32_t index : parents_first(bvh)) {
    const Node& node = bvh.nodes[index];
    most = depths[index] > most ? depths[index] : most;
    if (node.count == 0) depths[node.first] = depths[node.first + 1] = depths[index] + 1;
  }
  return most;
}

// What each node weighs: those of `top` as the mover left them, others by area. Where few segments meet a
// subtree that was not looked into, they are spread by area.
std::vector<float> measures_of(const Bvh& bvh, const Grafted& whole, const MetPart& part,
                               const SampleMover& mover) {
  const auto areas = [&](const Node& node) { return mover.areas_of(box_of(node)); };
  std::vector<float> out;
  out.reserve(whole.bvh.nodes.size());
  for (const Node& node : whole.bvh.nodes) out.push_back(mover.cost(0, areas(node)));
  for (std::size_t i = 0; i < part.subtrees.size(); ++i) {
    const float root = areas(bvh.nodes[part.subtrees[i]]);
    if (part.counts[i] == 0 || !(root > 0.0F)) continue;
    const float each = mover.cost(part.counts[i], 0.0F) / root;
    for (std::uint32_t n = whole.below[i].first; n < whole.below[i].last; ++n)
      out[n] += each * areas(whole.bvh.nodes[n]);
  }
  const std::vector<float> top = mover.measures();
  for (std::size_t i = 0; i < top.size(); ++i) out[whole.numbers[i]] = top[i];
  return out;
}

}  // namespace

void SampleMeasure::check() const {
  for (const float w : face_weights)
    require(w >= 0.0F && std::isfinite(w), "face_weights", std::to_string(w), "of finite numbers >= 0");
  require(prior_share > 0.0F && prior_share <= 1000.0F, "prior_share", std::to_string(prior_share),
          "(0, 1000]");
}

void SampledOptions::check() const {
  require(least_met >= 1, "least_met", std::to_string(least_met), "from 1");
  require(least_saved >= 0.0F && std::isfinite(least_saved), "least_saved", std::to_string(least_saved),
          "of finite numbers >= 0");
  require(most_work >= 0.0 && std::isfinite(most_work), "most_work", std::to_string(most_work),
          "of finite numbers >= 0");
  require(max_depth >= 1 && max_depth <= GN_MOST_DEPTH, "max_depth", std::to_string(max_depth), "1..128");
}

SampledTree optimise_for_rays(const Bvh& bvh, std::span<const Ray> segments, const SampleMeasure& measure,
                              const SampledOptions& options) {
  options.check();
  measure.check();
  refuse_frame(bvh.frame, "optimise_for_rays");
  if (bvh.nodes.empty()) return {bvh, {}, 0.0, 0.0};
  SegmentSet set(segments, box_of(bvh.nodes[0]));
  const MetPart part = met_part(bvh, set, options.least_met);
  SampleMover mover(set, part, measure);
  mover.run(options);
  Grafted whole = graft(bvh, part, mover.tree());
  if (mover.saved() > 0.0) {
    const std::uint32_t depth = depth_of(whole.bvh);
    if (depth > options.max_depth && depth > depth_of(bvh)) {
      mover.take_back();
      whole = graft(bvh, part, mover.tree());
    }
  }
  SampledTree out;
  out.measures = measures_of(bvh, whole, part, mover);
  out.bvh = std::move(whole.bvh);
  out.saved = mover.saved();
  out.work = mover.work() + kCopyWork * static_cast<double>(bvh.nodes.size());
  return out;
}

}  // namespace gnomon
