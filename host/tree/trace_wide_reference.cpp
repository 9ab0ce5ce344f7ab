#include "gnomon/tree/trace_wide_reference.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "gnomon/shared/hit_math.h"
#include "gnomon/tree/reference_batch.h"

namespace gnomon {
namespace {

// A child to visit: where the ray enters it, its slot in the three lowest bits, so that they are told apart.
struct Waiting {
  std::uint32_t key;
  std::uint32_t link;
  [[nodiscard]] float entry() const { return std::bit_cast<float>(key & ~7U); }
};

class Walk {
 public:
  Walk(const WideBvh& wide, const Ray& ray, bool any_hit)
      : wide_(wide), ray_(ray), any_hit_(any_hit), frame_(gn_ray_frame(&ray)) {
    limit_ = limit_for(ray.tmax);
    std::copy(ray.origin, ray.origin + 3, boxes_.near_origin);
    std::copy(ray.origin, ray.origin + 3, boxes_.far_origin);
    std::copy(frame_.inverse, frame_.inverse + 3, boxes_.inverse);
    if (wide.frame) boxes_ = gn_box_ray(&*wide.frame, &ray);
    for (int k = 0; k < 3; ++k) {
      far_inverse_[k] = gn_slab_limit(gn_abs(boxes_.inverse[k]));
      if (boxes_.inverse[k] < 0.0F) far_inverse_[k] = -far_inverse_[k];
    }
    far_margin_ = ray.tmin < 0.0F ? -4.0F * GN_SLAB_SLACK * ray.tmin : 0.0F;
  }

  void run() {
    const std::uint32_t region = gn_region_of(&ray_, frame_.inverse, wide_.regions.data(),
                                              static_cast<std::uint32_t>(wide_.regions.size()));
    std::vector<Waiting> waiting{{0, region == GN_NONE ? 0 : wide_.regions[region].root}};
    while (!waiting.empty()) {
      const Waiting next = waiting.back();
      waiting.pop_back();
      if (!any_hit_ && next.entry() > std::max(limit_, 0.0F)) continue;
      if ((next.link & GN_LEAF_LINK) == 0) {
        push_children(wide_.nodes[next.link], waiting);
      } else if (test_leaf(next.link)) {
        break;
      }
    }
    if (!any_hit_) settle();
  }

  Hit best{std::numeric_limits<float>::infinity(), 0.0F, 0.0F, GN_NONE};
  GnRayCounters counters{0, 0};
  WideSteps steps;

 private:
  // Boxes entered at infinity are missed, as in gn_box_entry.
  static float limit_for(float t) { return std::min(gn_slab_limit(t), std::numeric_limits<float>::max()); }

  // Whether the ray may meet a slot's box, and where it enters it.
  bool meets(const WideNode& node, std::uint32_t slot, float& entry) const {
    float near = ray_.tmin;
    float far = limit_;
    for (int k = 0; k < 3; ++k) {
      const int backwards = boxes_.inverse[k] < 0.0F ? 1 : 0;
      const float first = node.planes[2 * k + backwards][slot] - boxes_.near_origin[k];
      const float second = node.planes[2 * k + 1 - backwards][slot] - boxes_.far_origin[k];
      near = gn_max(first * boxes_.inverse[k], near);
      far = gn_min(std::fma(second, far_inverse_[k], far_margin_), far);
    }
    entry = near;
    return near <= far;
  }

  // The last pushed is visited next: the nearest for closest hits, the largest for any hit.
  void push_children(const WideNode& node, std::vector<Waiting>& waiting) {
    const std::size_t before = waiting.size();
    steps.nodes += 1;
    for (std::uint32_t slot = 0; slot < GN_WIDTH; ++slot) {
      float entry = 0.0F;
      if (node.links[slot] != GN_NONE) counters.boxes += 1;
      if (!meets(node, slot, entry)) continue;
      const auto bits = std::bit_cast<std::uint32_t>(gn_max(entry, 0.0F));
      waiting.push_back({(bits & ~7U) | slot, node.links[slot]});
    }
    if (any_hit_) return;
    std::sort(waiting.begin() + static_cast<std::ptrdiff_t>(before), waiting.end(),
              [](const Waiting& a, const Waiting& b) { return a.key > b.key; });
  }

  // True when the walk is over.
  bool test_leaf(std::uint32_t link) {
    const GnLeaf leaf = gn_leaf_at(wide_.leaves.data(), link);
    counters.triangles += leaf.count;
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
      if (i % GN_WIDTH == 0) steps.blocks += 1;
      test_triangle(gn_seat_in(leaf, i));
      if (any_hit_ && found_) return true;
    }
    return false;
  }

  void test_triangle(std::uint32_t seat) {
    const GnTriangle t = triangle_in(wide_, seat);
    const GnEdges e = gn_triangle_edges(&frame_, t.v0, t.v1, t.v2);
    const int verdict = gn_edges_verdict(&e);
    if (verdict == 0) return;
    if (verdict < 0) return test_exactly(seat, verdict);
    float error = 0.0F;
    const float at =
        gn_met_at(e.az, e.bz, e.cz, e.u, e.v, e.w, e.bound, e.z, frame_.inverse[frame_.kz], &error);
    test_met(seat, at - error, at + error);
  }

  // A triangle that is met for certain, by floats between nearest and farthest.
  void test_met(std::uint32_t seat, float nearest, float farthest) {
    if (!(farthest - nearest < GN_INFINITY)) return test_exactly(seat, -1);  // something overflowed
    if (farthest < ray_.tmin || nearest > ray_.tmax) return;
    if (found_ && nearest > farthest_) return;
    if (!(nearest >= ray_.tmin && farthest <= ray_.tmax && (!found_ || farthest < nearest_)))
      return test_exactly(seat, 1);
    found_ = true;
    pending_ = true;
    seat_ = seat;
    best.primitive = number_in(wide_, seat);
    nearest_ = nearest;
    farthest_ = farthest;
    limit_ = limit_for(farthest);
  }

  bool resolve(std::uint32_t seat, int verdict, Hit& hit) const {
    const GnTriangle t = triangle_in(wide_, seat);
    hit.primitive = number_in(wide_, seat);
    return gn_triangle_resolve(&frame_, t.v0, t.v1, t.v2, verdict, &hit) != 0;
  }

  // Whether two triangles that are met for certain lie in one plane across an axis and have the same t there.
  [[nodiscard]] bool meet_at_once(std::uint32_t seat, std::uint32_t other) const {
    const GnTriangle a = triangle_in(wide_, seat);
    const GnTriangle b = triangle_in(wide_, other);
    for (std::uint32_t k = 0; k < 3; ++k) {
      const float plane = a.v0[k];
      const auto is_in = [&](const float* corner) { return corner[k] == plane; };
      if (is_in(a.v1) && is_in(a.v2) && is_in(b.v0) && is_in(b.v1) && is_in(b.v2))
        return gn_plane_has_one_t(&frame_, k, plane) != 0;
    }
    return false;
  }

  void test_exactly(std::uint32_t seat, int verdict) {
    const std::uint32_t number = number_in(wide_, seat);
    if (found_ && number == best.primitive) return;  // in another leaf of a tree of parts
    if (verdict > 0 && pending_ && meet_at_once(seat_, seat)) {
      if (number > best.primitive) return;
      seat_ = seat;
      best.primitive = number;
      return;
    }
    steps.exact += 1;
    Hit hit{};
    if (!resolve(seat, verdict, hit) || !(hit.t >= ray_.tmin && hit.t <= ray_.tmax)) return;
    settle();
    if (!found_ || gn_hit_is_nearer(&hit, &best) != 0) take(hit);
  }

  // Makes a hit that floats found exact.
  void settle() {
    Hit hit{};
    if (pending_ && resolve(seat_, 1, hit)) take(hit);
  }

  void take(const Hit& hit) {
    best = hit;
    found_ = true;
    pending_ = false;
    nearest_ = farthest_ = hit.t;
    limit_ = limit_for(hit.t);
  }

  const WideBvh& wide_;
  const Ray& ray_;
  bool any_hit_;
  GnRayFrame frame_;
  GnBoxRay boxes_{};
  float far_inverse_[3];
  float far_margin_ = 0.0F;
  float limit_ = 0.0F;
  bool found_ = false;
  bool pending_ = false;  // floats found the nearest hit so far; what it is exactly is not worked out yet
  std::uint32_t seat_ = 0;
  float nearest_ = std::numeric_limits<float>::infinity();  // the nearest hit so far lies between
  float farthest_ = std::numeric_limits<float>::infinity();
};

}  // namespace

ReferenceTrace trace_wide_reference(const WideBvh& wide, std::span<const Ray> rays, bool any_hit,
                                    std::vector<WideSteps>* steps) {
  if (steps != nullptr) steps->clear();
  return trace_by(
      rays, [&](const Ray& ray) { return Walk(wide, ray, any_hit); },
      [&](const Walk& walk) {
        if (steps != nullptr) steps->push_back(walk.steps);
      });
}

}  // namespace gnomon
