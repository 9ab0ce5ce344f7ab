// Tracing a batch with a reference walk: what the binary and the wide tree's references share. Not public.
// Feeds trace_reference.cpp and trace_wide_reference.cpp.
#pragma once

#include <span>

#include "gnomon/shared/hit_math.h"
#include "gnomon/tree/trace_reference.h"

namespace gnomon {

// make_walk(ray) gives a walk with run(), best and counters, which finish(walk) sees when it is over. Rays
// that are not traceable are counted and miss.
template <typename MakeWalk, typename Finish>
ReferenceTrace trace_by(std::span<const Ray> rays, const MakeWalk& make_walk, const Finish& finish) {
  ReferenceTrace out;
  out.hits.reserve(rays.size());
  out.counters.reserve(rays.size());
  for (Ray ray : rays) {
    ray.tmin = gn_finite_tmin(ray.tmin);
    ray.tmax = gn_finite_tmax(ray.tmax);
    auto walk = make_walk(ray);
    if (gn_ray_is_valid(&ray) != 0) {
      walk.run();
    } else {
      out.invalid_rays += 1;
    }
    out.hits.push_back(walk.best);
    out.counters.push_back(walk.counters);
    finish(walk);
  }
  return out;
}

template <typename MakeWalk>
ReferenceTrace trace_by(std::span<const Ray> rays, const MakeWalk& make_walk) {
  return trace_by(rays, make_walk, [](const auto&) {});
}

}  // namespace gnomon
