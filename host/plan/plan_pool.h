// The trees a plan chooses from, made when they are asked for. Not public. Feeds choose.cpp.
#pragma once

#include <string>

#include "gnomon/plan/choose.h"
#include "gnomon/plan/light_space.h"
#include "gnomon/plan/local_sets.h"

namespace gnomon {

class PlanPool {
 public:
  // All must outlive it.
  PlanPool(std::span<const Triangle> triangles, const PlanOptions& options, const PlanBuilder& builder);

  // "sah", or "best" where spatial splits pay.
  [[nodiscard]] const PlanTree& baseline() const { return baseline_; }
  [[nodiscard]] double baseline_units() const { return baseline_units_; }
  [[nodiscard]] double work() const { return work_; }  // beyond the baseline so far, units

  // From here on candidates are for these rays. Nothing is traced yet.
  void aim_at(const PlanRays& rays);
  // A baseline ray by area alone: no ray is traced for this.
  [[nodiscard]] double expected_cost();
  // What a candidate will take at most beside the baseline, before it is made.
  [[nodiscard]] double likely_price(const std::string& name);
  // How oblique the rays are, and what they see of the baseline's boxes, put in a frame along them, over what
  // they see of them as they are. No ray is traced for this.
  [[nodiscard]] double obliquity() const { return light_.obliquity; }
  [[nodiscard]] double framed_share();
  // The baseline with its boxes in that frame; after framed_share().
  [[nodiscard]] const OrderedTree& framed_baseline() const { return framed_baseline_; }
  // A candidate's tree with what it took, and the share of its weight that sampled rays saved.
  struct Entry {
    PlanTree tree;
    double fit_gain = 0.0;
  };
  [[nodiscard]] Entry make(const std::string& name);
  // Regions of the rays that leave triangles out; with `detected`, among those that detect finds, too.
  [[nodiscard]] LocalSets find_local(bool detected);
  // What their trees will take at most.
  [[nodiscard]] double likely_local_price(const LocalSets& local) const;
  // Trees over their triangles; other rays go through `others`, which costs nothing here.
  [[nodiscard]] Entry make_local(const LocalSets& local, const PlanTree& others);

 private:
  // What trees are made of: the scene and the rays as they are, or turned.
  struct Space {
    std::span<const Triangle> triangles;
    std::span<const Ray> fit;
    std::array<float, 3> weights;
    std::optional<BoxFrame> frame{};
  };
  [[nodiscard]] Space world() const { return {triangles_, fit_, weights_}; }
  [[nodiscard]] Space along_rays();
  [[nodiscard]] Bvh built(std::span<const Triangle> triangles, const std::array<float, 3>& weights,
                          bool parts = false) const;
  [[nodiscard]] Bvh moved(const Bvh& bvh, const std::array<float, 3>& weights) const;
  void move_by_areas(const Space& space, bool sampled, Entry& entry);
  void move_by_segments(const Space& space, Entry& entry);
  void fit(const Bvh& from, const Space& space, Entry& entry);
  void learn(PlanTree& tree, const Space& space);
  [[nodiscard]] PlanTree tree_for(const LocalSet& set, const std::vector<Ray>& rays, Entry& entry) const;
  [[nodiscard]] float own_share() const;  // of the rays' own measure in weights
  [[nodiscard]] double build_price() const;
  [[nodiscard]] double move_price() const;
  [[nodiscard]] double for_all(double price) const;  // of one a triangle, or part

  std::span<const Triangle> triangles_;
  const PlanOptions& options_;
  const PlanBuilder& builder_;
  bool parts_ = false;  // the baseline is of parts of triangles
  Bvh loose_baseline_;  // split to single triangles
  PlanTree baseline_;
  double baseline_units_ = 0.0;
  double work_ = 0.0;
  Query query_ = Query::kClosest;
  const PlanRays* rays_ = nullptr;
  std::vector<Ray> fit_;
  double expected_cost_ = -1.0;  // negative: not reckoned yet
  std::array<float, 3> weights_{1.0F, 1.0F, 1.0F};
  LightSpace light_;
  // Along the rays; made when it is asked for.
  std::optional<BoxFrame> frame_;
  std::vector<Triangle> turned_triangles_;
  std::vector<Ray> turned_fit_;
  OrderedTree framed_baseline_;
};

}  // namespace gnomon
