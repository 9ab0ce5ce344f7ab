// Decides for one kind of rays which of a plan's trees they are traced through. Not public. Feeds choose.cpp.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "gnomon/plan/plan_pool.h"

namespace gnomon {

class Chooser {
 public:
  // Trees go to the end of `trees`. All must outlive it.
  Chooser(std::span<const Triangle> triangles, const PlanRays& rays, const PlanOptions& options,
          PlanPool& pool, std::vector<PlanTree>& trees);
  [[nodiscard]] Decision run();

 private:
  [[nodiscard]] const std::string& base() const { return pool_.baseline().name; }
  // By name.
  void take(const std::string& name);
  void take_local();
  void note_regions(const LocalSets& local);
  void note_kept(const LocalSets& local);
  [[nodiscard]] std::string no_region(const LocalSets& local) const;
  std::size_t add(PlanTree tree);
  // By trial.
  void decide();
  bool consider_frame(double hope);
  void consider_local(double hope);
  bool consider(const std::string& name);
  bool judge(const std::string& name, PlanPool::Entry candidate, double more_price);
  void forget_kept();
  void explain(const Race& race, const Trial& trial, bool better, bool kept);
  void limit_probes();
  [[nodiscard]] Race run_race(const OrderedTree& candidate);
  [[nodiscard]] double framed_cost();
  [[nodiscard]] double work_of(bool framed) const;
  [[nodiscard]] std::vector<double> baseline_costs(std::size_t first, std::size_t count);
  [[nodiscard]] std::vector<double> traced(const OrderedTree& tree, std::size_t first, std::size_t count);

  std::span<const Triangle> triangles_;
  const PlanRays& rays_;
  const PlanOptions& options_;
  PlanPool& pool_;
  std::vector<Ray> probes_;
  std::vector<double> baseline_costs_;  // of the first probes
  double most_saved_ = 0.0;             // beyond its price, by what is kept
  double kept_price_ = 0.0;
  std::vector<PlanTree>& trees_;
  Decision decision_;
};

}  // namespace gnomon
