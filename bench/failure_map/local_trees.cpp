#include "local_trees.h"

#include <cmath>
#include <stdexcept>

#include "gnomon/areas/membership.h"
#include "gnomon/tree/trace_reference.h"

namespace gnomon::bench {

namespace {

struct Answers {
  std::vector<Hit> hits;
  Work work;  // in all, not a ray
};

Answers trace(const Bvh& tree, std::span<const GnTriangle> triangles, std::span<const GnRay> rays) {
  const ReferenceTrace traced = trace_reference(tree, triangles, rays, false);
  Answers out{traced.hits, {}};
  for (const GnRayCounters& counters : traced.counters) {
    out.work.boxes += counters.boxes;
    out.work.triangles += counters.triangles;
  }
  return out;
}

Work a_ray(const Work& all, double count) {
  return {all.boxes / count, all.triangles / count};
}

void add(Work& sum, const Work& more) {
  sum.boxes += more.boxes;
  sum.triangles += more.triangles;
}

}  // namespace

LocalFigures local_figures(const CaseScene& scene, const InfluenceArea& area, std::span<const GnRay> rays) {
  const std::vector<GnTriangle>& all = scene.scene.triangles;
  std::vector<GnTriangle> inside;
  for (const std::uint32_t member : members(area, all)) inside.push_back(all[member]);
  const Bvh global = build_reference(all);
  const Bvh local = build_reference(inside);
  const auto count = static_cast<double>(rays.size());
  LocalFigures out;
  out.share = static_cast<double>(inside.size()) / static_cast<double>(all.size());
  const Answers alone = trace(global, all, rays);
  out.global = a_ray(alone.work, count);
  std::vector<GnRay> up_to_exit;
  std::vector<GnRay> to_the_end;
  std::vector<GnRay> after;  // what the exit rule asks of the global tree
  std::vector<std::size_t> served;
  double hits = 0.0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    hits += alone.hits[i].primitive != GN_NONE ? 1.0 : 0.0;
    const auto exit = area.exit_distance(to_ray3d(rays[i]));
    if (!exit) {
      after.push_back(rays[i]);
      continue;
    }
    served.push_back(i);
    to_the_end.push_back(rays[i]);
    up_to_exit.push_back(rays[i]);
    up_to_exit.back().tmax = static_cast<float>(*exit * (1.0 - 0x1p-20));
  }
  out.hit_share = hits / count;
  std::vector<GnRay> again = after;  // what the published rule asks of it
  const Answers exact = trace(local, inside, up_to_exit);
  const Answers loose = trace(local, inside, to_the_end);
  for (std::size_t s = 0; s < served.size(); ++s) {
    if (exact.hits[s].primitive == GN_NONE) {
      after.push_back(rays[served[s]]);
      after.back().tmin = up_to_exit[s].tmax;
    }
    if (loose.hits[s].primitive == GN_NONE) {
      again.push_back(rays[served[s]]);
    } else {
      out.wrong += loose.hits[s].t != alone.hits[served[s]].t ? 1 : 0;
    }
  }
  out.left_share = static_cast<double>(after.size()) / count;
  Work by_exit = exact.work;
  add(by_exit, trace(global, all, after).work);
  Work published = loose.work;
  add(published, trace(global, all, again).work);
  out.by_exit = a_ray(by_exit, count);
  out.published = a_ray(published, count);
  return out;
}

InfluenceArea shortened(const InfluenceArea& area, double share) {
  const AreaFrame& frame = area.frame();
  const auto* const box = std::get_if<OrientedBox>(&area.region());
  if (box == nullptr) throw std::runtime_error("only plane areas are shortened");
  PlaneWindow window;
  window.point = frame.origin;
  window.direction = frame.forward;
  window.up = frame.up;
  window.half_width = area.half_window()[0];
  window.half_height = area.half_window()[1];
  window.depth = 2.0 * share * box->half[2];
  return InfluenceArea::plane(window);
}

}  // namespace gnomon::bench
