#include <gnomon/gnomon.h>

#include <algorithm>
#include <cstdio>

int main() {
  try {
    const gnomon::Scene scene =
        gnomon::generate_scene("city", 20000, 1);  // or gnomon::import_scene("my.glb")
    const gnomon::cl::Context context(gnomon::cl::choose_device(gnomon::cl::list_devices(), ""));
    const gnomon::DeviceBvh tree = gnomon::build_device(context, scene.triangles);
    const gnomon::Tracer tracer(context, tree);
    const std::vector<gnomon::Ray> rays = gnomon::primary_rays(scene, 10000, 1);
    const std::vector<gnomon::Hit> hits = tracer.closest(rays).hits;
    const auto met =
        std::count_if(hits.begin(), hits.end(), [](const auto& hit) { return hit.primitive != GN_NONE; });
    std::printf("%zu of %zu rays hit something\n", static_cast<std::size_t>(met), rays.size());
    return met > 0 ? 0 : 1;
  } catch (const gnomon::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
