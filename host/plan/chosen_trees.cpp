#include "gnomon/plan/chosen_trees.h"

namespace gnomon {

namespace {

// As many as a race sees at most.
constexpr std::uint64_t kCounted = 1024;

double mean_cost(const OrderedTree& tree, std::span<const Triangle> triangles, std::span<const Ray> rays,
                 Query query) {
  const std::vector<double> costs = ray_costs(tree, triangles, rays, query);
  double sum = 0.0;
  for (const double cost : costs) sum += cost;
  return costs.empty() ? 0.0 : sum / static_cast<double>(costs.size());
}

double saving(double cost, double plain) {
  return plain > 0.0 ? 1.0 - cost / plain : 0.0;
}

// Rays that one tree is chosen for.
struct Part {
  std::vector<Ray> fit, probe;
  Query query;
  double expected;
};

struct Cost {
  double fit = 0.0;
  double probe = 0.0;
};

class Chooser {
 public:
  Chooser(const Plan& plan, std::span<const PlanRays> rays, std::span<const Triangle> triangles,
          const Bvh& plain, TreesWanted wanted, bool or_plain)
      : plan_(plan), triangles_(triangles), plain_{plain, {}}, or_plain_(or_plain) {
    for (const PlanTree& tree : plan.trees)
      trees_.push_back(wanted == TreesWanted::kOneForAll ? OrderedTree{tree.tree.bvh, {}} : tree.tree);
    for (const PlanRays& some : rays)
      parts_.push_back(
          {thinned(some.fit, kCounted), thinned(some.probe, kCounted), some.query, some.expected});
  }

  [[nodiscard]] ChosenTree for_all() const {
    std::vector<std::size_t> open;
    for (std::size_t i = !or_plain_ && trees_.size() > 1 ? 1 : 0; i < trees_.size(); ++i) open.push_back(i);
    return choose("all", open, parts_);
  }

  [[nodiscard]] ChosenTree for_kind(std::size_t kind) const {
    const Decision& decision = plan_.decisions[kind];
    return choose(decision.rays, std::span(&decision.tree, 1), std::span(parts_).subspan(kind, 1));
  }

 private:
  [[nodiscard]] Cost cost_of(const OrderedTree& tree, std::span<const Part> parts) const {
    Cost sum;
    for (const Part& part : parts) {
      sum.fit += part.expected * mean_cost(tree, triangles_, part.fit, part.query);
      sum.probe += part.expected * mean_cost(tree, triangles_, part.probe, part.query);
    }
    return sum;
  }

  [[nodiscard]] ChosenTree choose(const std::string& rays, std::span<const std::size_t> open,
                                  std::span<const Part> parts) const {
    const Cost plain = cost_of(plain_, parts);
    ChosenTree best{rays, std::nullopt, "plain", 0.0, 0.0};
    Cost least = plain;
    for (const std::size_t i : open) {
      const Cost cost = cost_of(trees_[i], parts);
      if (best.tree ? cost.probe >= least.probe : or_plain_ && cost.probe >= plain.probe) continue;
      least = cost;
      best.tree = i;
      best.name = plan_.trees[i].name;
    }
    best.predicted = saving(least.fit, plain.fit);
    best.measured = saving(least.probe, plain.probe);
    return best;
  }

  const Plan& plan_;
  std::span<const Triangle> triangles_;
  OrderedTree plain_;
  bool or_plain_;
  std::vector<OrderedTree> trees_;
  std::vector<Part> parts_;
};

}  // namespace

std::vector<ChosenTree> choose_trees(const Plan& plan, std::span<const PlanRays> rays,
                                     std::span<const Triangle> triangles, const Bvh& plain,
                                     TreesWanted wanted, bool or_plain) {
  const Chooser chooser(plan, rays, triangles, plain, wanted, or_plain);
  if (wanted == TreesWanted::kOneForAll) return {chooser.for_all()};
  std::vector<ChosenTree> out;
  for (std::size_t i = 0; i < rays.size(); ++i) out.push_back(chooser.for_kind(i));
  return out;
}

}  // namespace gnomon
