#include "gnomon/plan/child_order.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "gnomon/base/error.h"
#include "gnomon/shared/hit_math.h"
#include "gnomon/shared/measure_math.h"
#include "gnomon/tree/box_frame.h"
#include "gnomon/tree/parents_first.h"

namespace gnomon {

namespace {

void require(bool ok, const char* option, float value, const char* range) {
  if (ok) return;
  throw Error(ErrorCode::kInvalidArgument, std::string("order option ") + option + " = " +
                                               std::to_string(value) + " is outside its range " + range);
}

// How likely a ray that meets a node is stopped below it, and what looking there costs.
struct Expectation {
  float hit = 0.0F;
  float cost = 0.0F;
};

// What a sampled ray finds in a subtree.
struct Outcome {
  bool hit = false;
  float cost = 0.0F;
};

struct SampleRay {
  Ray ray;
  GnRayFrame frame;
  float limit;
};

class Learner {
 public:
  Learner(const Bvh& bvh, std::span<const Triangle> triangles, std::span<const Ray> rays,
          const OrderOptions& options)
      : bvh_(bvh), triangles_(triangles), options_(options), prior_(bvh.nodes.size()) {
    for (Ray ray : rays) {
      if (gn_ray_is_valid(&ray) == 0) continue;
      ray.tmin = gn_finite_tmin(ray.tmin);
      ray.tmax = gn_finite_tmax(ray.tmax);
      rays_.push_back({ray, gn_ray_frame(&ray), gn_slab_limit(ray.tmax)});
    }
  }

  ChildOrder run() {
    expect();
    order_.ranks.resize(bvh_.nodes.size());
    for (std::size_t i = 0; i < prior_.size(); ++i) order_.ranks[i] = rank_of(prior_[i].hit, prior_[i].cost);
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < rays_.size(); ++i) {
      if (meets(rays_[i], bvh_.nodes[0])) all.push_back(i);
    }
    for (const Outcome& outcome : look(0, all)) order_.sample_cost += double{outcome.cost};
    if (!rays_.empty()) order_.sample_cost /= static_cast<double>(rays_.size());
    return std::move(order_);
  }

 private:
  static float rank_of(float hit, float cost) { return cost > 0.0F ? hit / cost : 0.0F; }

  static bool meets(const SampleRay& ray, const Node& node) {
    return gn_box_entry(&ray.frame, node.lo, node.hi, ray.ray.tmin, ray.limit) < GN_INFINITY;
  }

  // What the box of a triangle's projections along the axes would measure; at most its own box's measure.
  [[nodiscard]] float seen_area(const Triangle& t) const {
    float area = 0.0F;
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3;
      const int b = (k + 2) % 3;
      const float doubled =
          (t.v1[a] - t.v0[a]) * (t.v2[b] - t.v0[b]) - (t.v1[b] - t.v0[b]) * (t.v2[a] - t.v0[a]);
      area += options_.face_weights[static_cast<std::size_t>(k)] * 0.5F * std::fabs(doubled);
    }
    return area;
  }

  // From areas alone, children before parents: rays meet a box as its measure says, are stopped the more the
  // more triangles show, and look at all that they meet.
  void expect() {
    const std::vector<std::uint32_t> order = parents_first(bvh_);
    std::vector<float> shown(bvh_.nodes.size());
    std::vector<float> work(bvh_.nodes.size());
    for (auto at = order.rbegin(); at != order.rend(); ++at) {
      const Node& node = bvh_.nodes[*at];
      const float measure = gn_linear_measure(options_.face_weights.data(), node.lo, node.hi);
      if (node.count > 0) {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
          shown[*at] += seen_area(triangles_[bvh_.primitives[i]]);
        work[*at] = options_.cost_triangle * static_cast<float>(node.count) * measure;
      } else {
        shown[*at] = shown[node.first] + shown[node.first + 1];
        work[*at] = options_.cost_inner * measure + work[node.first] + work[node.first + 1];
      }
      // Of x layers a share x / (1 + x) stops rays: below 1, and without the libm, which machines differ in.
      const bool flat = !(measure > 0.0F);
      prior_[*at] = {flat ? 0.0F : shown[*at] / (measure + shown[*at]), flat ? 1.0F : work[*at] / measure};
    }
  }

  // Outcomes of the rays that meet a node; sets the ranks below it. As deep as the tree.
  std::vector<Outcome> look(std::uint32_t index, const std::vector<std::uint32_t>& rays) {
    std::vector<Outcome> out(rays.size());
    if (rays.empty()) return out;
    const Node& node = bvh_.nodes[index];
    order_.work += static_cast<double>(rays.size()) *
                   double{node.count > 0 ? options_.cost_triangle * static_cast<float>(node.count)
                                         : options_.cost_inner};
    if (node.count > 0) {
      for (std::size_t i = 0; i < rays.size(); ++i) out[i] = look_at_leaf(node, rays_[rays[i]]);
      return out;
    }
    std::array<std::vector<std::uint32_t>, 2> places;  // in `rays`, of those that meet the child
    std::array<std::vector<Outcome>, 2> below;
    for (std::uint32_t side = 0; side < 2; ++side) {
      const std::uint32_t child = node.first + side;
      std::vector<std::uint32_t> met;
      for (std::uint32_t i = 0; i < rays.size(); ++i) {
        if (!meets(rays_[rays[i]], bvh_.nodes[child])) continue;
        places[side].push_back(i);
        met.push_back(rays[i]);
      }
      below[side] = look(child, met);
      order_.ranks[child] = learnt_rank(child, below[side]);
    }
    const std::uint32_t first = order_.ranks[node.first] >= order_.ranks[node.first + 1] ? 0 : 1;
    for (Outcome& outcome : out) outcome.cost = options_.cost_inner;
    for (const std::uint32_t side : {first, 1 - first}) {
      for (std::size_t i = 0; i < places[side].size(); ++i) {
        Outcome& outcome = out[places[side][i]];
        if (outcome.hit) continue;
        outcome.hit = below[side][i].hit;
        outcome.cost += below[side][i].cost;
      }
    }
    return out;
  }

  [[nodiscard]] float learnt_rank(std::uint32_t node, const std::vector<Outcome>& outcomes) const {
    float hits = options_.prior_rays * prior_[node].hit;
    float cost = options_.prior_rays * prior_[node].cost;
    for (const Outcome& outcome : outcomes) {
      hits += outcome.hit ? 1.0F : 0.0F;
      cost += outcome.cost;
    }
    return rank_of(hits, cost);
  }

  [[nodiscard]] Outcome look_at_leaf(const Node& leaf, const SampleRay& ray) const {
    Outcome out;
    for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count && !out.hit; ++i) {
      const Triangle& triangle = triangles_[bvh_.primitives[i]];
      Hit hit{};
      out.cost += options_.cost_triangle;
      out.hit = gn_triangle_hit(&ray.frame, triangle.v0, triangle.v1, triangle.v2, &hit) != 0 &&
                hit.t >= ray.ray.tmin && hit.t <= ray.ray.tmax;
    }
    return out;
  }

  const Bvh& bvh_;
  std::span<const Triangle> triangles_;
  const OrderOptions& options_;
  std::vector<SampleRay> rays_;
  std::vector<Expectation> prior_;
  ChildOrder order_;
};

}  // namespace

void OrderOptions::check() const {
  for (const float w : face_weights)
    require(w >= 0.0F && std::isfinite(w), "face_weights", w, "of finite numbers >= 0");
  require(prior_rays > 0.0F && std::isfinite(prior_rays), "prior_rays", prior_rays, "of finite numbers > 0");
  require(cost_inner > 0.0F && cost_inner <= 1000.0F, "cost_inner", cost_inner, "(0, 1000]");
  require(cost_triangle > 0.0F && cost_triangle <= 1000.0F, "cost_triangle", cost_triangle, "(0, 1000]");
}

ChildOrder learn_order(const Bvh& bvh, std::span<const Triangle> triangles, std::span<const Ray> rays,
                       const OrderOptions& options) {
  options.check();
  refuse_frame(bvh.frame, "learn_order");
  if (bvh.nodes.empty()) return {};
  return Learner(bvh, triangles, rays, options).run();
}

}  // namespace gnomon
