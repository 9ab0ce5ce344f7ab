// Local trees of a plan: of its pool, what concerns regions.
#include <algorithm>

#include "gnomon/areas/detect.h"
#include "gnomon/plan/plan_pool.h"

namespace gnomon {

namespace {

// Of the rays, that a detected group must have.
constexpr double kLeastShare = 0.1;

}  // namespace

LocalSets PlanPool::find_local(bool detected) {
  std::vector<InfluenceArea> known = rays_->regions;
  if (detected && !fit_.empty() && !baseline_.tree.bvh.nodes.empty()) {
    DetectOptions options;
    options.least_share = kLeastShare;
    options.bounds.emplace();
    const Node& root = baseline_.tree.bvh.nodes.front();
    for (const float* corner : {root.lo, root.hi})
      extend(*options.bounds, {double{corner[0]}, double{corner[1]}, double{corner[2]}});
    for (const RayGroup& group : detect(fit_, options).groups) known.push_back(group.area);
  }
  LocalLimits limits;
  limits.least_share = kLeastShare;
  limits.most_members = options_.most_local;
  LocalSets out = local_sets(baseline_.tree.bvh, triangles_, fit_, known, limits);
  work_ += out.work;
  return out;
}

double PlanPool::likely_local_price(const LocalSets& local) const {
  const PlanPrices& prices = options_.prices;
  const double each =
      prices.build + prices.move + prices.finish + (query_ == Query::kAny ? prices.learn : 0.0);
  double price = 0.0;
  for (const LocalSet& set : local.sets) {
    const double building =
        prices.build_start + prices.move_start + each * static_cast<double>(set.members.size());
    price += (1.0 + options_.sample_share) * building;
  }
  return price;
}

// A plan of its own over the set's triangles, by those of the rays that are within.
PlanTree PlanPool::tree_for(const LocalSet& set, const std::vector<Ray>& rays, Entry& entry) const {
  std::vector<Triangle> own;
  own.reserve(set.members.size());
  for (const std::uint32_t member : set.members) own.push_back(triangles_[member]);
  PlanOptions options = options_;
  options.choice = "auto";
  PlanPool pool(own, options, builder_);
  PlanRays asked;
  asked.query = query_;
  asked.fit = rays;
  pool.aim_at(asked);
  const std::string& base = pool.baseline().name;
  Entry fitted = pool.make(base + "-rays");
  if (fitted.fit_gain < options_.race.least_gain)
    fitted = query_ == Query::kAny ? pool.make(base + "-order") : Entry{pool.baseline(), 0.0};
  entry.fit_gain += set.share * fitted.fit_gain;
  entry.tree.build_units += pool.baseline_units() + pool.work();
  for (std::uint32_t& primitive : fitted.tree.tree.bvh.primitives) primitive = set.members[primitive];
  return std::move(fitted.tree);
}

PlanPool::Entry PlanPool::make_local(const LocalSets& local, const PlanTree& others) {
  Entry entry;
  entry.tree.name = "local-rays";
  entry.tree.tree = others.tree;
  std::vector<Region> regions;
  for (const LocalSet& set : local.sets) regions.push_back(set.region);
  std::vector<std::vector<Ray>> rays(regions.size());
  for (const Ray& ray : rays_->fit) {
    const std::uint32_t region = region_of(regions, ray);
    if (region != GN_NONE) rays[region].push_back(ray);
  }
  for (std::size_t i = 0; i < regions.size(); ++i) {
    PlanTree made = tree_for(local.sets[i], rays[i], entry);
    const OrderedTree& tree = made.tree;
    entry.tree.bytes += tree.bvh.nodes.size() * sizeof(Node) +
                        tree.bvh.primitives.size() * (sizeof(std::uint32_t) + sizeof(Triangle)) +
                        (tree.ranks.size() + tree.weights.size()) * sizeof(float);
    entry.tree.tree.local.push_back({regions[i], tree.bvh, tree.ranks, tree.weights});
  }
  work_ += entry.tree.build_units;
  return entry;
}

}  // namespace gnomon
