#include "gnomon/areas/detect.h"

#include <algorithm>
#include <string>

#include "gnomon/areas/concentration.h"
#include "gnomon/areas/line_model.h"
#include "gnomon/areas/ray_regions.h"
#include "gnomon/base/error.h"
#include "gnomon/scene/steady_random.h"

namespace gnomon {
namespace {

using Kind = LineModel::Kind;

constexpr double kAsSure = 0.98;  // of the surest, by logarithms
constexpr std::size_t kFewest = 16;
constexpr double kLeastContrast = 5.0;
constexpr double kLog10Chance = -6.0;
constexpr double kLn10 = 2.302585092994046;

constexpr std::size_t kScored = 1024;    // rays that rank candidates
constexpr std::size_t kAxes = 1024;      // candidates for bundles
constexpr std::size_t kPairs = 100'000;  // of rays that may meet
constexpr std::size_t kTightest = 512;   // candidates for pencils: those that meet best
constexpr std::size_t kLoose = 1024;     // and others that meet at all
constexpr double kWidestGap = 0.2;       // over the distance
constexpr std::size_t kFollowed = 24;    // candidates that are refined on all rays
constexpr int kRounds = 8;               // of refining
constexpr double kSlackShare = 1e-4;     // of the rays' extent: what passes for a point
constexpr double kFarthest = 1e3;        // extents to an apex; farther ones are directions
// A bundle narrower than this is one, however well its lines meet; else an apex must explain it so much
// better.
constexpr double kSharp = 1e-3;
constexpr double kBetter = 0.5;

struct Found {
  LineModel model;
  Concentration concentration;
};

class Search {
 public:
  Search(std::vector<RayLine> lines, const DetectOptions& options)
      : rest_(std::move(lines)), options_(options), total_(rest_.size()), bounds_(extent_of(rest_)) {
    if (!rest_.empty()) {
      extent_ = length(bounds_.hi - bounds_.lo);
      slack_ = kSlackShare * extent_ + 0x1p-20 * larger(magnitude(bounds_.lo), magnitude(bounds_.hi));
    }
    least_ = std::max<std::size_t>(
        kFewest, static_cast<std::size_t>(options.least_share * static_cast<double>(total_)));
  }

  // The surest group of what is left, which is then no longer there.
  [[nodiscard]] std::optional<RayGroup> next() {
    while (rest_.size() >= least_) {
      tried_ = 0.0;
      ++searches_;
      std::optional<Found> best;
      for (const LineModel& candidate : promising(axes(), 1)) follow(candidate, best);
      for (const LineModel& candidate : promising(meetings(), 2)) follow(candidate, best);
      if (!best) break;
      if (auto group = take(*best)) return group;  // else its rays have no region: look at the others
    }
    return std::nullopt;
  }

 private:
  static std::size_t used_by(const LineModel& model) { return model.kind == Kind::kBundle ? 1 : 2; }

  [[nodiscard]] Concentration concentration_of(const LineModel& model, std::span<const RayLine> lines,
                                               std::vector<double>& shares) const {
    shares.resize(lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i) shares[i] = model.share_of(lines[i]);
    return most_concentrated(shares, used_by(model));
  }

  [[nodiscard]] std::vector<LineModel> axes() const {
    std::vector<LineModel> out;
    const std::size_t count = std::min(kAxes, rest_.size());
    for (std::size_t i = 0; i < count; ++i) {
      out.emplace_back();
      out.back().axis = rest_[i].direction;
    }
    return out;
  }

  // Points where two rays meet: the pairs that meet best, and as many others drawn evenly.
  [[nodiscard]] std::vector<LineModel> meetings() const {
    SteadyRandom random(options_.seed, searches_);
    std::vector<Meeting> met;
    const auto n = static_cast<unsigned>(rest_.size());
    for (std::size_t pair = 0; pair < kPairs; ++pair) {
      const unsigned a = random.below(n);
      const unsigned b = random.below(n);
      const auto meeting = a == b ? std::nullopt : meeting_of(rest_[a], rest_[b], slack_);
      if (meeting && meeting->gap < kWidestGap) met.push_back(*meeting);
    }
    const std::size_t tight = std::min(kTightest, met.size());
    const std::size_t all = std::min(kTightest + kLoose, met.size());
    // Stable, so that ties are broken by the draw: they come in an order of the rays' values.
    std::vector<std::size_t> order(met.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(tight), order.end(),
                      [&](std::size_t a, std::size_t b) {
                        return met[a].gap != met[b].gap ? met[a].gap < met[b].gap : a < b;
                      });
    std::sort(order.begin() + static_cast<std::ptrdiff_t>(tight), order.end());
    std::vector<LineModel> out;
    for (std::size_t i = 0; i < all; ++i) out.push_back(met[order[i]].model);
    return out;
  }

  // The candidates about which a part of the rays are densest.
  [[nodiscard]] std::vector<LineModel> promising(const std::vector<LineModel>& candidates, std::size_t used) {
    tried_ += static_cast<double>(used == 2 ? kPairs : candidates.size());
    const std::span<const RayLine> scored =
        std::span<const RayLine>(rest_).first(std::min(kScored, rest_.size()));
    std::vector<std::pair<double, std::size_t>> ranks;
    std::vector<double> shares;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const double nats = concentration_of(candidates[i], scored, shares).nats;
      if (nats > 0.0) ranks.emplace_back(-nats, i);
    }
    std::sort(ranks.begin(), ranks.end());
    std::vector<LineModel> out;
    for (std::size_t i = 0; i < std::min(kFollowed, ranks.size()); ++i)
      out.push_back(candidates[ranks[i].second]);
    return out;
  }

  [[nodiscard]] std::vector<RayLine> within(const LineModel& model, double share) const {
    std::vector<RayLine> out;
    for (const RayLine& line : rest_) {
      if (model.share_of(line) <= share) out.push_back(line);
    }
    return out;
  }

  // Moves the model to the middle of its rays as long as that makes it surer.
  [[nodiscard]] Found settled(const LineModel& start) const {
    std::vector<double> shares;
    Found best{start, concentration_of(start, rest_, shares)};
    for (int round = 0; round < kRounds && best.concentration.count > used_by(start); ++round) {
      const auto moved = refined(best.model, within(best.model, best.concentration.share));
      if (!moved) break;
      const Concentration now = concentration_of(*moved, rest_, shares);
      if (!(now.nats > best.concentration.nats)) {
        // As sure, or all but so, and in the middle of its rays.
        if (now.nats > kAsSure * best.concentration.nats) best = {*moved, now};
        break;
      }
      best = {*moved, now};
    }
    return best;
  }

  [[nodiscard]] bool is_sure(const Found& found) const {
    return found.concentration.count >= least_ && found.concentration.contrast >= kLeastContrast &&
           log10_chance(found.concentration) <= kLog10Chance;
  }

  [[nodiscard]] double log10_chance(const Concentration& concentration) const {
    return smaller(0.0, std::log10(larger(1.0, 36.0 * tried_)) - concentration.nats / kLn10);
  }

  void keep(const Found& found, std::optional<Found>& best) const {
    if (found.model.kind != Kind::kBundle && !(length(found.model.apex - rest_[0].origin) <= reach())) return;
    if (is_sure(found) && (!best || found.concentration.nats > best->concentration.nats)) best = found;
  }
  [[nodiscard]] double reach() const { return kFarthest * (extent_ + slack_); }

  void follow(const LineModel& candidate, std::optional<Found>& best) const {
    const Found found = settled(candidate);
    if (found.model.kind == Kind::kBundle && is_sure(found)) {
      if (const auto pencil = apex_of(found)) {
        keep(*pencil, best);
        return;
      }
    }
    keep(found, best);
  }

  // Rays to a lamp far away are nearly parallel. They are a pencil where lines meet much better than
  // directions agree.
  [[nodiscard]] std::optional<Found> apex_of(const Found& bundle) const {
    const std::vector<RayLine> lines = within(bundle.model, bundle.concentration.share);
    const double spread = spread_about(bundle.model, lines).angle;
    if (spread < kSharp) return std::nullopt;
    const auto start = pencil_through(lines, slack_);
    if (!start) return std::nullopt;
    const Found pencil = settled(*start);
    if (static_cast<double>(pencil.concentration.count) < 0.9 * static_cast<double>(lines.size()))
      return std::nullopt;
    const auto members = within(pencil.model, pencil.concentration.share);
    if (spread_about(pencil.model, members).angle > kBetter * spread) return std::nullopt;
    if (!(length(pencil.model.apex - rest_[0].origin) <= reach()) || !is_sure(pencil)) return std::nullopt;
    return pencil;
  }

  [[nodiscard]] std::optional<RayGroup> take(const Found& found) {
    const double share = found.concentration.share;
    std::vector<RayLine> lines = within(found.model, share);
    const auto is_member = [&](const RayLine& line) { return found.model.share_of(line) <= share; };
    rest_.erase(std::remove_if(rest_.begin(), rest_.end(), is_member), rest_.end());
    const Concentration& concentration = found.concentration;
    const auto count = static_cast<double>(lines.size());
    const Spread spread = spread_about(found.model, lines);
    // Of rays that are there by chance half may be on one side.
    const double outside = std::clamp(0.5 * concentration.expected / count, 0.0025, 0.05);
    const bool bundle = found.model.kind == Kind::kBundle;
    if (found.model.kind == Kind::kConverging) {
      for (RayLine& line : lines) {
        const double to_apex = dot(found.model.apex - line.origin, line.direction);
        line.end = larger(line.begin, smaller(line.end, to_apex));
      }
    }
    end_within(lines, options_.bounds ? *options_.bounds : bounds_);
    const auto area = bundle ? box_about(lines, found.model.axis, outside)
                             : frustum_about(lines, found.model.apex, outside);
    if (!area) return std::nullopt;
    const GroupKind kind = bundle                                  ? GroupKind::kBundle
                           : found.model.kind == Kind::kConverging ? GroupKind::kConverging
                                                                   : GroupKind::kDiverging;
    return RayGroup{kind,
                    *area,
                    bundle ? found.model.axis : area->frame().forward,
                    found.model.apex,
                    lines.size(),
                    count / static_cast<double>(total_),
                    share_inside(*area, lines),
                    spread.angle,
                    spread.distance,
                    concentration.contrast,
                    log10_chance(concentration)};
  }

  std::vector<RayLine> rest_;
  const DetectOptions& options_;
  std::size_t total_;
  Box3d bounds_;
  double extent_ = 0.0;
  double slack_ = 0.0;
  std::size_t least_ = kFewest;
  std::uint64_t searches_ = 0;
  double tried_ = 0.0;
};

}  // namespace

const char* to_string(GroupKind kind) {
  switch (kind) {
    case GroupKind::kBundle:
      return "bundle";
    case GroupKind::kConverging:
      return "converging";
    case GroupKind::kDiverging:
      return "diverging";
  }
  return "";
}

void DetectOptions::check() const {
  const auto refuse = [](const std::string& why) {
    throw Error(ErrorCode::kInvalidArgument, "detect: " + why);
  };
  if (most_rays < kFewest) refuse("most_rays must be 16 or more, but is " + std::to_string(most_rays));
  if (!(least_share >= 0.0 && least_share <= 1.0))
    refuse("least_share must be from 0 to 1, but is " + std::to_string(least_share));
  if (bounds && (is_empty(*bounds) || !is_finite(bounds->lo) || !is_finite(bounds->hi)))
    refuse("bounds must be finite and not empty");
}

Detection detect(std::span<const GnRay> rays, const DetectOptions& options) {
  options.check();
  static_cast<void>(lines_of(rays));  // all of them must be fit for it, not only those looked at
  const std::vector<GnRay> sample = unordered_sample(rays, options.most_rays, options.seed);
  Detection out;
  out.rays = rays.size();
  out.looked_at = sample.size();
  Search search(lines_of(sample), options);
  while (out.groups.size() < options.most_groups) {
    auto group = search.next();
    if (!group) break;
    out.groups.push_back(*group);
  }
  std::stable_sort(out.groups.begin(), out.groups.end(),
                   [](const RayGroup& a, const RayGroup& b) { return a.count > b.count; });
  return out;
}

}  // namespace gnomon
