// A million camera rays, then what they see bounced on: closest hits, any hits, and the work a ray causes.
#include <gnomon/gnomon.h>

#include <cstdio>

int main() {
  try {
    const gnomon::Scene scene = gnomon::generate_scene("atrium", 30000, 1);
    const gnomon::cl::Context context(gnomon::cl::choose_device(gnomon::cl::list_devices(), ""));
    const gnomon::DeviceBvh tree = gnomon::build_device(context, scene.triangles);
    const gnomon::Tracer tracer(context, tree);
    const auto rays = gnomon::primary_rays(scene, 1000000, 1);
    const gnomon::TraceResult seen = tracer.closest(rays);
    const auto shadow = gnomon::shadow_rays(scene, rays, seen.hits, 1000000, 1);
    std::size_t dark = 0;
    for (const std::uint32_t blocked : tracer.any(shadow).occluded) dark += blocked;

    gnomon::TraceOptions counting;
    counting.counters = true;
    const auto few = gnomon::bounce_rays(scene, rays, seen.hits, 10000, 1);
    double boxes = 0;
    for (const GnRayCounters& work : gnomon::Tracer(context, tree, counting).closest(few).counters)
      boxes += work.boxes;
    std::printf(
        "%zu rays in %.0f ms on the device; %zu of %zu shadow rays are blocked; %.1f boxes a bounce\n",
        rays.size(), seen.kernel_ms, dark, shadow.size(), boxes / static_cast<double>(few.size()));
    return dark > 0 && dark < shadow.size() && boxes > 0 ? 0 : 1;
  } catch (const gnomon::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
