// A user's program with a local tree for a light: built by the light's own heuristic, found through a top
// level, and answering as the global tree alone does.
#include <gnomon/gnomon.h>

#include <cstdio>
#include <cstring>

int main() {
  try {
    const gnomon::Scene scene = gnomon::generate_scene("city", 20000, 1);
    const gnomon::cl::Context context(gnomon::cl::choose_device(gnomon::cl::list_devices(), ""));
    std::vector<gnomon::LocalTree> local_trees;
    for (const gnomon::LightArea& light : gnomon::areas_of_lights(scene)) {
      gnomon::LocalTree tree{light.area};
      if (light.area.kind() == gnomon::AreaKind::kPlane)
        tree.options.measure = gnomon::measure_of(light.area, gnomon::RayMeasure::kParallel, true);
      local_trees.push_back(tree);
    }
    if (local_trees.empty()) return 1;
    const gnomon::DeviceForest forest = gnomon::build_forest(context, scene.triangles, local_trees);
    const gnomon::TopLevel top = gnomon::build_top_level(forest.areas, gnomon::AreaLookup::kList);
    const gnomon::DeviceTopLevel on_device = gnomon::upload_top_level(context, top, forest.shared_areas);
    const gnomon::ForestTracer tracer(context, forest, on_device);
    // The areas as the lights have them: the forest's own are grown, so that rays from these windows start
    // inside.
    const gnomon::InfluenceArea& first = local_trees.front().area;
    const bool parallel = first.kind() == gnomon::AreaKind::kPlane;
    const auto rays = gnomon::area_rays(
        first, parallel ? gnomon::RayMeasure::kParallel : gnomon::RayMeasure::kSolidAngle, 5000, 1);
    std::size_t served = 0;
    for (const std::uint32_t area : gnomon::AreaFinder(context, on_device).choose(rays).areas)
      served += area != GN_NONE ? 1 : 0;
    const auto hits = tracer.closest(rays).hits;
    const gnomon::DeviceBvh tree = gnomon::build_device(context, scene.triangles);
    const auto expected = gnomon::Tracer(context, tree).closest(rays).hits;
    const bool same = std::memcmp(hits.data(), expected.data(), hits.size() * sizeof(gnomon::Hit)) == 0;
    std::printf("%zu of %zu rays start in %zu areas; answers are %s\n", served, rays.size(),
                local_trees.size(), same ? "the global tree's" : "different");
    return same && served > rays.size() / 2 ? 0 : 1;
  } catch (const gnomon::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
