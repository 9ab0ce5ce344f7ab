#include "gnomon/tree/trace_reference.h"

#include <limits>

#include "gnomon/base/error.h"
#include "gnomon/shared/hit_math.h"
#include "gnomon/tree/reference_batch.h"

namespace gnomon {

namespace {

struct Waiting {
  std::uint32_t node;
  float entry;
};

class Walk {
 public:
  Walk(const Bvh& bvh, std::span<const Triangle> triangles, const Ray& ray, bool any_hit,
       std::span<const float> ranks)
      : bvh_(bvh),
        triangles_(triangles),
        ray_(ray),
        any_hit_(any_hit),
        ranks_(any_hit ? ranks : std::span<const float>{}),
        frame_(gn_ray_frame(&ray)) {
    limit_ = gn_slab_limit(ray.tmax);
    if (bvh.frame) turned_ = gn_box_ray(&*bvh.frame, &ray);
  }

  void run() {
    if (bvh_.nodes.empty()) return;
    std::vector<Waiting> waiting;
    if (!(entry_of(0) < GN_INFINITY)) return;
    waiting.reserve(64);  // deep enough for most
    waiting.push_back({0, ray_.tmin});
    while (!waiting.empty()) {
      const Waiting next = waiting.back();
      waiting.pop_back();
      if (next.entry > limit_) continue;
      const Node& node = bvh_.nodes[next.node];
      if (node.count > 0) {
        if (test_leaf(node)) return;
      } else {
        push_children(node, waiting);
      }
    }
  }

  Hit best{std::numeric_limits<float>::infinity(), 0.0F, 0.0F, GN_NONE};
  GnRayCounters counters{0, 0};

 private:
  float entry_of(std::uint32_t index) {
    counters.boxes += 1;
    const Node& node = bvh_.nodes[index];
    return turned_ ? gn_framed_box_entry(&*turned_, node.lo, node.hi, ray_.tmin, limit_)
                   : gn_box_entry(&frame_, node.lo, node.hi, ray_.tmin, limit_);
  }

  // The nearer child, or the one of higher rank, is tested next; of equals the left one.
  void push_children(const Node& node, std::vector<Waiting>& waiting) {
    const Waiting left{node.first, entry_of(node.first)};
    const Waiting right{node.first + 1, entry_of(node.first + 1)};
    const bool left_first =
        ranks_.empty() ? left.entry <= right.entry : ranks_[left.node] >= ranks_[right.node];
    for (const Waiting& child : {left_first ? right : left, left_first ? left : right}) {
      if (child.entry < GN_INFINITY) waiting.push_back(child);
    }
  }

  // True when the walk is over.
  bool test_leaf(const Node& leaf) {
    for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
      const std::uint32_t primitive = bvh_.primitives[i];
      const Triangle& triangle = triangles_[primitive];
      Hit hit{0.0F, 0.0F, 0.0F, primitive};
      counters.triangles += 1;
      if (gn_triangle_hit(&frame_, triangle.v0, triangle.v1, triangle.v2, &hit) == 0) continue;
      if (!(hit.t >= ray_.tmin && hit.t <= ray_.tmax)) continue;
      if (best.primitive != GN_NONE && gn_hit_is_nearer(&hit, &best) == 0) continue;
      best = hit;
      limit_ = gn_slab_limit(hit.t);
      if (any_hit_) return true;
    }
    return false;
  }

  const Bvh& bvh_;
  std::span<const Triangle> triangles_;
  const Ray& ray_;
  bool any_hit_;
  std::span<const float> ranks_;
  GnRayFrame frame_;
  std::optional<GnBoxRay> turned_;
  float limit_ = 0.0F;
};

}  // namespace

ReferenceTrace trace_reference(const Bvh& bvh, std::span<const Triangle> triangles, std::span<const Ray> rays,
                               bool any_hit, std::span<const float> ranks) {
  if (!ranks.empty() && ranks.size() != bvh.nodes.size()) {
    throw Error(ErrorCode::kInvalidArgument, std::to_string(ranks.size()) + " ranks for a tree of " +
                                                 std::to_string(bvh.nodes.size()) +
                                                 " nodes; learn them from this tree");
  }
  return trace_by(rays, [&](const Ray& ray) { return Walk(bvh, triangles, ray, any_hit, ranks); });
}

}  // namespace gnomon
