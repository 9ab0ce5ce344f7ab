#include "gnomon/plan/plan_pool.h"

#include "gnomon/plan/child_order.h"
#include "gnomon/shared/hit_math.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/merge_leaves.h"

namespace gnomon {

namespace {

constexpr std::array<float, 3> kSurface{1.0F, 1.0F, 1.0F};

std::uint64_t bytes_of(const Bvh& bvh) {
  return bvh.nodes.size() * sizeof(Node) + bvh.primitives.size() * sizeof(std::uint32_t);
}

}  // namespace

PlanPool::PlanPool(std::span<const Triangle> triangles, const PlanOptions& options,
                   const PlanBuilder& builder)
    : triangles_(triangles), options_(options), builder_(builder) {
  loose_baseline_ = moved(built(kSurface), kSurface);
  baseline_ = {"sah", {merge_leaves(loose_baseline_, face_measures(loose_baseline_, kSurface)), {}}, 0.0, 0};
  baseline_.bytes = bytes_of(baseline_.tree.bvh);
  baseline_units_ = build_price() + pass_price();
}

double PlanPool::build_price() const {
  return options_.prices.build * static_cast<double>(triangles_.size());
}

double PlanPool::pass_price() const {
  return options_.prices.pass * static_cast<double>(triangles_.size()) * options_.optimise.max_passes;
}

Bvh PlanPool::built(const std::array<float, 3>& weights) const {
  BuildOptions build;
  build.max_leaf_size = 1;  // leaves are joined at the end, when it is known what lies above them
  std::copy(weights.begin(), weights.end(), build.measure.weights);
  return builder_.build(triangles_, build);
}

Bvh PlanPool::moved(const Bvh& bvh, const std::array<float, 3>& weights) const {
  OptimiseOptions optimise = options_.optimise;
  optimise.face_weights = weights;
  return builder_.optimise(bvh, optimise);
}

void PlanPool::aim_at(const PlanRays& rays) {
  loose_.clear();
  query_ = rays.query;
  fit_.clear();
  for (Ray ray : rays.fit) {
    if (gn_ray_is_valid(&ray) != 0) fit_.push_back(ray);
  }
  fit_ = thinned(fit_, options_.fit_rays);
  segments_ = segments_of(baseline_.tree.bvh, triangles_, fit_, query_);
  weights_ = mixed_weights(fit_, query_ == Query::kEvery ? options_.every_share : options_.mixture_share);
}

double PlanPool::expected_cost() const {
  const Bvh& bvh = baseline_.tree.bvh;
  if (bvh.nodes.empty()) return 0.0;
  const std::vector<float> measures = face_measures(bvh, weights_);
  double sum = 0.0;
  for (std::size_t i = 0; i < measures.size(); ++i) {
    const double step = bvh.nodes[i].count > 0 ? kTriangleCost * bvh.nodes[i].count : 2.0 * kBoxCost;
    sum += step * double{measures[i]};
  }
  return measures[0] > 0.0F ? sum / double{measures[0]} : sum;
}

double PlanPool::least_price(const std::string& name) const {
  if (name == "sah") return 0.0;
  if (name == "sah-order") return expected_cost() * static_cast<double>(fit_.size());
  return pass_price() + (name.starts_with("mix") ? build_price() : 0.0);
}

const LooseTree& PlanPool::loose(const std::string& name) {
  const auto known = loose_.find(name);
  if (known != loose_.end()) return known->second;
  return loose_.emplace(name, made(name)).first->second;
}

LooseTree PlanPool::made(const std::string& name) {
  LooseTree out;
  if (name.ends_with("-rays")) {
    const LooseTree& from = loose(name.substr(0, name.size() - 5) == "sah" ? "sah-mix" : "mix");
    SampledTree sampled =
        optimise_for_rays(from.bvh, segments_, {weights_, options_.prior_share}, options_.optimise_rays);
    const double own = options_.prices.segment_test * static_cast<double>(sampled.segment_tests);
    work_ += own;
    out = {std::move(sampled.bvh), std::move(sampled.measures), from.units + own};
    return out;
  }
  const bool anew = name == "mix";
  out.bvh = moved(anew ? built(weights_) : loose_baseline_, weights_);
  out.measures = face_measures(out.bvh, weights_);
  out.units = pass_price() + (anew ? build_price() : 0.0);
  work_ += out.units;
  return out;
}

double PlanPool::fit_cost(OrderedTree& tree, bool learn) {
  if (learn) {
    OrderOptions order;
    order.face_weights = weights_;
    ChildOrder learnt = learn_order(tree.bvh, triangles_, fit_, order);
    tree.ranks = std::move(learnt.ranks);
  }
  double sum = 0.0;
  for (const double cost : ray_costs(tree, triangles_, fit_, query_)) sum += cost;
  work_ += sum;
  return fit_.empty() ? 0.0 : sum / static_cast<double>(fit_.size());
}

PlanPool::Entry PlanPool::make(const std::string& name) {
  Entry entry;
  entry.tree.name = name;
  if (name == "sah" || name == "sah-order") {
    entry.tree.tree.bvh = baseline_.tree.bvh;
  } else {
    const LooseTree& from = loose(name);
    entry.tree.tree.bvh = merge_leaves(from.bvh, from.measures);
    entry.tree.build_units = from.units;
    entry.tree.bytes = bytes_of(entry.tree.tree.bvh);
  }
  const bool learn = query_ == Query::kAny && name != "sah";
  entry.fit_cost = fit_cost(entry.tree.tree, learn);
  if (learn) {
    entry.tree.build_units += entry.fit_cost * static_cast<double>(fit_.size());
    entry.tree.bytes += entry.tree.tree.ranks.size() * sizeof(float);
  }
  return entry;
}

double PlanPool::baseline_fit_cost() {
  return fit_cost(baseline_.tree, false);
}

}  // namespace gnomon
