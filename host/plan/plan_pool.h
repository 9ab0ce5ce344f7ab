// The trees a plan chooses from, made when they are asked for; each goes on from another one. Not public.
// Feeds choose.cpp.
#pragma once

#include <map>
#include <string>

#include "gnomon/plan/choose.h"

namespace gnomon {

// A tree split to single triangles, before its leaves are joined, and the work from the baseline to it.
struct LooseTree {
  Bvh bvh;
  std::vector<float> measures;  // by which its leaves are joined
  double units = 0.0;
};

class PlanPool {
 public:
  // All must outlive it.
  PlanPool(std::span<const Triangle> triangles, const PlanOptions& options, const PlanBuilder& builder);

  [[nodiscard]] const PlanTree& baseline() const { return baseline_; }
  [[nodiscard]] double baseline_units() const { return baseline_units_; }
  [[nodiscard]] double work() const { return work_; }  // on candidates so far, units

  // From here on candidates are for these rays.
  void aim_at(const PlanRays& rays);
  // A baseline ray by area alone: no ray is traced for this.
  [[nodiscard]] double expected_cost() const;
  // What a candidate will surely cost beside the baseline, before it is made.
  [[nodiscard]] double least_price(const std::string& name) const;
  // A candidate's tree with what it cost, and the cost of a fitted ray in it.
  struct Entry {
    PlanTree tree;
    double fit_cost = 0.0;
  };
  [[nodiscard]] Entry make(const std::string& name);
  [[nodiscard]] double baseline_fit_cost();

 private:
  const LooseTree& loose(const std::string& name);
  [[nodiscard]] LooseTree made(const std::string& name);
  [[nodiscard]] Bvh built(const std::array<float, 3>& weights) const;
  [[nodiscard]] Bvh moved(const Bvh& bvh, const std::array<float, 3>& weights) const;
  [[nodiscard]] double fit_cost(OrderedTree& tree, bool learn);
  [[nodiscard]] double build_price() const;
  [[nodiscard]] double pass_price() const;

  std::span<const Triangle> triangles_;
  const PlanOptions& options_;
  const PlanBuilder& builder_;
  Bvh loose_baseline_;
  PlanTree baseline_;
  double baseline_units_ = 0.0;
  double work_ = 0.0;
  Query query_ = Query::kClosest;
  std::vector<Ray> fit_;
  std::vector<Ray> segments_;
  std::array<float, 3> weights_{1.0F, 1.0F, 1.0F};
  std::map<std::string, LooseTree> loose_;
};

}  // namespace gnomon
