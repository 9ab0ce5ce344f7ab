#include "gnomon/plan/plan_pool.h"

#include <algorithm>

#include "gnomon/plan/child_order.h"
#include "gnomon/plan/seen_areas.h"
#include "gnomon/shared/hit_math.h"
#include "gnomon/shared/measure_math.h"
#include "gnomon/tree/box_frame.h"
#include "gnomon/tree/build_best_reference.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/merge_leaves.h"
#include "gnomon/tree/parts.h"
#include "gnomon/tree/refit.h"

namespace gnomon {

namespace {

constexpr std::array<float, 3> kSurface{1.0F, 1.0F, 1.0F};

// Of adding up what a tree's boxes measure, a triangle: a node or two are read.
constexpr double kTotalPrice = 1.0;

std::uint64_t bytes_of(const Bvh& bvh) {
  return bvh.nodes.size() * sizeof(Node) + bvh.primitives.size() * sizeof(std::uint32_t);
}

}  // namespace

PlanPool::PlanPool(std::span<const Triangle> triangles, const PlanOptions& options,
                   const PlanBuilder& builder)
    : triangles_(triangles), options_(options), builder_(builder) {
  const bool best = options.choice.starts_with("best");
  parts_ = (best || options.choice == "auto") && divides_any(triangles, kPartBudget);
  loose_baseline_ = moved(built(triangles, kSurface, parts_), kSurface);
  baseline_ = {parts_ || best ? "best" : "sah",
               {merge_leaves(loose_baseline_, face_measures(loose_baseline_, kSurface)), {}},
               0.0,
               0};
  baseline_.bytes = bytes_of(baseline_.tree.bvh);
  baseline_units_ = build_price() + move_price() + for_all(options.prices.finish);
  if (parts_) baseline_units_ += for_all(options.prices.divide);
}

double PlanPool::for_all(double price) const {
  return price * static_cast<double>(parts_ ? loose_baseline_.primitives.size() : triangles_.size());
}

double PlanPool::build_price() const {
  return options_.prices.build_start + for_all(options_.prices.build);
}

double PlanPool::move_price() const {
  return options_.prices.move_start + for_all(options_.prices.move);
}

Bvh PlanPool::built(std::span<const Triangle> triangles, const std::array<float, 3>& weights,
                    bool parts) const {
  BuildOptions build;
  if (parts) build.builder = Builder::kBest;
  build.max_leaf_size = 1;  // leaves are joined at the end, when it is known what lies above them
  std::copy(weights.begin(), weights.end(), build.measure.weights);
  return builder_.build(triangles, build);
}

Bvh PlanPool::moved(const Bvh& bvh, const std::array<float, 3>& weights) const {
  OptimiseOptions optimise = options_.optimise;
  optimise.face_weights = weights;
  return builder_.optimise(bvh, optimise);
}

// The baseline's moves go on by what the areas that rays run through see; with `sampled`, then by rays.
void PlanPool::move_by_areas(const Space& space, bool sampled, Entry& entry) {
  PlanTree& out = entry.tree;
  SeenAreas seen = seen_areas(baseline_.tree.bvh, triangles_, fit_);
  out.build_units = options_.prices.trace * seen.traced;
  if (seen.areas.empty() && sampled) return fit(loose_baseline_, space, entry);
  if (seen.areas.empty()) {
    out.tree.bvh = baseline_.tree.bvh;
    return;
  }
  OptimiseOptions optimise = options_.optimise;
  optimise.areas = std::move(seen.areas);
  const Bvh loose = builder_.optimise(loose_baseline_, optimise);
  out.build_units += for_all(options_.prices.move_seen);
  if (sampled) return fit(loose, space, entry);
  out.tree.bvh = merge_leaves(loose, box_costs(loose, optimise), {}, &out.tree.weights);
  out.build_units += for_all(options_.prices.finish);
}

// What fit does one move after the other, a pass of many at a time, by whoever builds trees.
void PlanPool::move_by_segments(const Space& space, Entry& entry) {
  PlanTree& out = entry.tree;
  double traced = 0.0;
  OptimiseOptions optimise = options_.optimise;
  optimise.face_weights = space.weights;
  optimise.segments = segments_of(baseline_.tree.bvh, triangles_, fit_, query_, &traced);
  optimise.segments_share = 1.0F / options_.prior_share;
  const Bvh loose = builder_.optimise(loose_baseline_, optimise);
  out.tree.bvh = merge_leaves(loose, box_costs(loose, optimise), {}, &out.tree.weights);
  out.build_units =
      options_.prices.trace * traced + for_all(options_.prices.move_segments + options_.prices.finish);
}

void PlanPool::aim_at(const PlanRays& rays) {
  rays_ = &rays;
  query_ = rays.query;
  fit_.clear();
  for (Ray ray : rays.fit) {
    if (gn_ray_is_valid(&ray) != 0) fit_.push_back(ray);
  }
  fit_ = thinned(fit_, options_.fit_rays);
  weights_ = mixed_weights(fit_, own_share());
  expected_cost_ = -1.0;
  light_ = light_space_of(fit_);
  frame_.reset();
}

float PlanPool::own_share() const {
  return query_ == Query::kEvery ? options_.every_share : options_.mixture_share;
}

PlanPool::Space PlanPool::along_rays() {
  if (!frame_) {
    frame_ = frame_along(light_.direction, triangles_);
    turned_triangles_ = turned(triangles_, *frame_);
    turned_fit_ = turned(fit_, *frame_);
    work_ += for_all(options_.prices.turn);
  }
  return {turned_triangles_, turned_fit_, mixed_weights(turned_fit_, own_share()), frame_};
}

double PlanPool::framed_share() {
  const Space space = along_rays();
  framed_baseline_ = {baseline_.tree.bvh, {}};
  Bvh& framed = framed_baseline_.bvh;
  if (framed.nodes.empty()) return 1.0;
  refit_reference(framed, space.triangles);
  work_ += for_all(2.0 * kTotalPrice);
  const double seen = seen_total(baseline_.tree.bvh, mean_components(fit_));
  const double along = seen_total(framed, mean_components(space.fit));
  framed.frame = space.frame;  // last: until then rays are turned
  // Frames halve the scene.
  return seen > 0.0 ? 4.0 * along / seen : 1.0;
}

double PlanPool::expected_cost() {
  if (expected_cost_ >= 0.0) return expected_cost_;
  const Bvh& bvh = baseline_.tree.bvh;
  if (bvh.nodes.empty()) return expected_cost_ = 0.0;
  work_ += for_all(kTotalPrice);
  double sum = 0.0;
  for (const Node& node : bvh.nodes) {
    const double step = node.count > 0 ? kTriangleCost * node.count : 2.0 * kBoxCost;
    sum += step * double{gn_linear_measure(weights_.data(), node.lo, node.hi)};
  }
  const Node& root = bvh.nodes[0];
  const float measure = gn_linear_measure(weights_.data(), root.lo, root.hi);
  return expected_cost_ = measure > 0.0F ? sum / double{measure} : sum;
}

double PlanPool::likely_price(const std::string& name) {
  if (name == baseline_.name) return 0.0;
  const double rays = options_.prices.trace * expected_cost() * static_cast<double>(fit_.size());
  double price = query_ == Query::kAny ? for_all(options_.prices.learn) + rays : 0.0;
  if (name.ends_with("-order")) return price;
  price += for_all(options_.prices.finish);
  const bool light = name.starts_with("light");
  if (light && !frame_) price += for_all(options_.prices.turn);
  if (light || name.starts_with("mix")) price += build_price();
  if (name.find("seen") != std::string::npos) price += for_all(options_.prices.move_seen);
  if (name == "sah-segments") price += rays + for_all(options_.prices.move_segments);
  if (light || name.find("mix") != std::string::npos) price += move_price();
  if (name.ends_with("-rays")) price += rays + options_.sample_share * baseline_units_;
  return price;
}

// Moves by sampled rays.
void PlanPool::fit(const Bvh& from, const Space& space, Entry& entry) {
  double traced = 0.0;
  std::vector<Ray> segments = segments_of(baseline_.tree.bvh, triangles_, fit_, query_, &traced);
  if (space.frame) segments = turned(segments, *space.frame);
  SampledOptions options = options_.sampled;
  options.most_work = std::min(options.most_work, options_.sample_share * baseline_units_);
  SampledTree sampled = optimise_for_rays(from, segments, {space.weights, options_.prior_share}, options);
  entry.tree.tree.bvh = merge_leaves(sampled.bvh, sampled.measures, {}, &entry.tree.tree.weights);
  entry.tree.build_units += options_.prices.trace * traced + sampled.work + for_all(options_.prices.finish);
  entry.fit_gain = sampled.saved;
}

void PlanPool::learn(PlanTree& tree, const Space& space) {
  OrderOptions order;
  order.face_weights = space.weights;
  ChildOrder learnt = learn_order(tree.tree.bvh, space.triangles, space.fit, order);
  tree.tree.ranks = std::move(learnt.ranks);
  tree.build_units += for_all(options_.prices.learn) + options_.prices.trace * learnt.work;
  tree.bytes += tree.tree.ranks.size() * sizeof(float);
}

PlanPool::Entry PlanPool::make(const std::string& name) {
  Entry entry;
  entry.tree.name = name;
  Bvh& bvh = entry.tree.tree.bvh;
  const bool light = name.starts_with("light");
  const Space space = light ? along_rays() : world();
  const bool as_it_is = name == baseline_.name || name.ends_with("-order");
  if (as_it_is) {
    bvh = baseline_.tree.bvh;
  } else if (name == "sah-seen" || name == "seen-rays") {
    move_by_areas(space, name == "seen-rays", entry);
  } else if (name == "sah-segments") {
    move_by_segments(space, entry);
  } else if (name == baseline_.name + "-rays") {
    fit(loose_baseline_, space, entry);
  } else {
    const bool again = name != "sah-mix";
    const Bvh loose = moved(again ? built(space.triangles, space.weights) : loose_baseline_, space.weights);
    entry.tree.build_units = move_price() + (again ? build_price() : 0.0);
    if (name.ends_with("-rays")) {
      fit(loose, space, entry);
    } else {
      bvh = merge_leaves(loose, face_measures(loose, space.weights), {}, &entry.tree.tree.weights);
      entry.tree.build_units += for_all(options_.prices.finish);
    }
  }
  if (!as_it_is) entry.tree.bytes = bytes_of(bvh);
  entry.tree.bytes += entry.tree.tree.weights.size() * sizeof(float);
  // A tree that is not looked at any further needs no order.
  const bool given_up = options_.choice == "auto" && name == baseline_.name + "-rays" &&
                        entry.fit_gain < options_.race.least_gain;
  if (query_ == Query::kAny && name != baseline_.name && !given_up) learn(entry.tree, space);
  bvh.frame = space.frame;  // last: until then triangles and rays are turned
  work_ += entry.tree.build_units;
  return entry;
}

}  // namespace gnomon
