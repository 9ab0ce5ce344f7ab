#include "gnomon/plan/ray_sample.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "gnomon/base/error.h"
#include "gnomon/shared/hit_math.h"

namespace gnomon {

const char* to_string(Query query) {
  return query == Query::kClosest ? "closest" : query == Query::kAny ? "any" : "every";
}

std::vector<Ray> thinned(std::span<const Ray> rays, std::uint64_t count) {
  if (rays.size() <= count) return {rays.begin(), rays.end()};
  std::vector<Ray> out;
  out.reserve(count);
  // The middle of each of `count` equal runs.
  for (std::uint64_t i = 0; i < count; ++i) out.push_back(rays[(2 * i + 1) * rays.size() / (2 * count)]);
  return out;
}

namespace {

double cost_of(const GnRayCounters& count) {
  return count.boxes == 0 ? 0.0 : kBoxCost * (count.boxes - 1.0) + kTriangleCost * count.triangles;
}

}  // namespace

std::vector<Ray> segments_of(const Bvh& bvh, std::span<const Triangle> triangles, std::span<const Ray> rays,
                             Query query, double* cost) {
  std::vector<Ray> out;
  out.reserve(rays.size());
  const ReferenceTrace trace =
      query == Query::kClosest ? trace_reference(bvh, triangles, rays, false) : ReferenceTrace{};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Ray ray = rays[i];
    if (gn_ray_is_valid(&ray) == 0) continue;
    if (query == Query::kClosest && trace.hits[i].primitive != GN_NONE) ray.tmax = trace.hits[i].t;
    if (query == Query::kClosest && cost != nullptr) *cost += cost_of(trace.counters[i]);
    ray.tmin = gn_finite_tmin(ray.tmin);
    ray.tmax = gn_finite_tmax(ray.tmax);
    out.push_back(ray);
  }
  return out;
}

namespace {

GnRayCounters count_every(const Bvh& bvh, Ray ray) {
  GnRayCounters counters{0, 0};
  if (bvh.nodes.empty() || gn_ray_is_valid(&ray) == 0) return counters;
  ray.tmin = gn_finite_tmin(ray.tmin);
  const GnRayFrame frame = gn_ray_frame(&ray);
  const GnBoxRay turned = bvh.frame ? gn_box_ray(&*bvh.frame, &ray) : GnBoxRay{};
  const float limit = gn_slab_limit(gn_finite_tmax(ray.tmax));
  std::vector<std::uint32_t> waiting{0};
  while (!waiting.empty()) {
    const Node& node = bvh.nodes[waiting.back()];
    waiting.pop_back();
    counters.boxes += 1;
    const float entry = bvh.frame ? gn_framed_box_entry(&turned, node.lo, node.hi, ray.tmin, limit)
                                  : gn_box_entry(&frame, node.lo, node.hi, ray.tmin, limit);
    if (!(entry < GN_INFINITY)) continue;
    counters.triangles += node.count;
    if (node.count > 0) continue;
    waiting.push_back(node.first);
    waiting.push_back(node.first + 1);
  }
  return counters;
}

}  // namespace

std::vector<std::vector<std::uint32_t>> rays_by_tree(const OrderedTree& tree, std::span<const Ray> rays) {
  std::vector<std::vector<std::uint32_t>> out(tree.local.size() + 1);
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    const std::uint32_t region = region_of(tree.local, rays[i]);
    out[region == GN_NONE ? 0 : region + 1].push_back(i);
  }
  return out;
}

namespace {

// A ray's tree and ranks.
struct Part {
  const Bvh& bvh;
  std::span<const float> ranks;
};

Part part_of(const OrderedTree& tree, std::size_t place) {
  if (place == 0) return {tree.bvh, tree.ranks};
  return {tree.local[place - 1].bvh, tree.local[place - 1].ranks};
}

using Places = std::vector<std::uint32_t>;

// Calls visit(tree, rays, their places) for each tree that has rays.
template <typename Visit>
void for_each_part(const OrderedTree& tree, std::span<const Ray> rays, const Visit& visit) {
  const std::vector<std::vector<std::uint32_t>> places = rays_by_tree(tree, rays);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].empty()) continue;
    std::vector<Ray> own;
    own.reserve(places[i].size());
    for (const std::uint32_t place : places[i]) own.push_back(rays[place]);
    visit(i, own, places[i]);
  }
}

}  // namespace

ReferenceTrace trace_ordered(const OrderedTree& tree, std::span<const Triangle> triangles,
                             std::span<const Ray> rays, bool any_hit) {
  ReferenceTrace out;
  out.hits.resize(rays.size());
  out.counters.resize(rays.size());
  for_each_part(tree, rays, [&](std::size_t place, const std::vector<Ray>& own, const Places& places) {
    const Part part = part_of(tree, place);
    const ReferenceTrace trace = trace_reference(part.bvh, triangles, own, any_hit, part.ranks);
    for (std::size_t i = 0; i < places.size(); ++i) {
      out.hits[places[i]] = trace.hits[i];
      out.counters[places[i]] = trace.counters[i];
    }
    out.invalid_rays += trace.invalid_rays;
  });
  return out;
}

namespace {

std::vector<double> costs_in(const Part& part, std::span<const Triangle> triangles, std::span<const Ray> rays,
                             Query query) {
  std::vector<GnRayCounters> counters;
  if (query == Query::kEvery) {
    for (const Ray& ray : rays) counters.push_back(count_every(part.bvh, ray));
  } else {
    counters = trace_reference(part.bvh, triangles, rays, query == Query::kAny, part.ranks).counters;
  }
  std::vector<double> out;
  out.reserve(rays.size());
  for (const GnRayCounters& count : counters) out.push_back(cost_of(count));
  return out;
}

}  // namespace

std::vector<double> ray_costs(const OrderedTree& tree, std::span<const Triangle> triangles,
                              std::span<const Ray> rays, Query query) {
  if (tree.local.empty()) return costs_in(part_of(tree, 0), triangles, rays, query);
  std::vector<double> out(rays.size());
  for_each_part(tree, rays, [&](std::size_t place, const std::vector<Ray>& own, const Places& places) {
    const std::vector<double> costs = costs_in(part_of(tree, place), triangles, own, query);
    const std::size_t looked_at = place == 0 ? tree.local.size() : place;
    for (std::size_t i = 0; i < places.size(); ++i)
      out[places[i]] = costs[i] + kRegionCost * static_cast<double>(looked_at);
  });
  return out;
}

std::array<double, 3> mean_components(std::span<const Ray> rays) {
  std::array<double, 3> mean{};
  double count = 0.0;
  for (const Ray& ray : rays) {
    if (gn_ray_is_valid(&ray) == 0) continue;
    double square = 0.0;
    for (const float d : ray.direction) square += double{d} * double{d};
    for (std::size_t k = 0; k < 3; ++k) mean[k] += std::fabs(double{ray.direction[k]}) / std::sqrt(square);
    count += 1.0;
  }
  for (double& m : mean) m /= std::max(count, 1.0);
  return mean;
}

std::array<float, 3> mixed_weights(std::span<const Ray> rays, float share) {
  if (!(share >= 0.0F && share <= 1.0F)) {
    throw Error(ErrorCode::kInvalidArgument, "the share of the rays' own measure in a mixture is " +
                                                 std::to_string(share) + "; it must lie in [0, 1]");
  }
  const std::array<double, 3> mean = mean_components(rays);
  const double sum = mean[0] + mean[1] + mean[2];
  if (sum == 0.0) return {1.0F, 1.0F, 1.0F};
  std::array<float, 3> out{};
  for (std::size_t k = 0; k < 3; ++k)
    out[k] = static_cast<float>(double{share} * 3.0 * mean[k] / sum + (1.0 - double{share}));
  return out;
}

}  // namespace gnomon
