// A tree built once and kept: written to a file, read back, traced. Also written plainly for read_bvh2.cpp.
#include <gnomon/gnomon.h>

#include <cstdio>

int main() {
  try {
    const gnomon::Scene scene = gnomon::generate_scene("city", 5000, 1);
    const gnomon::cl::Context context(gnomon::cl::choose_device(gnomon::cl::list_devices(), ""));
    gnomon::BuildOptions options;
    options.builder = gnomon::Builder::kBest;
    const auto built = gnomon::download_bvh(context, gnomon::build_device(context, scene.triangles, options));
    gnomon::save_tree("city.gnb", built, options, scene.triangles);
    gnomon::export_bvh2("city.bvh2", built, scene.triangles);

    // Another day. The file knows its scene, and refuses another; what loads is sound.
    const gnomon::StoredTree kept = gnomon::load_tree("city.gnb", scene.triangles);
    const gnomon::DeviceBvh tree = gnomon::upload_bvh(context, kept.bvh, scene.triangles);
    const auto hits = gnomon::Tracer(context, tree).closest(gnomon::primary_rays(scene, 10000, 1)).hits;
    std::size_t met = 0;
    for (const gnomon::Hit& hit : hits) met += hit.primitive != GN_NONE ? 1 : 0;
    std::printf("%s tree of %zu nodes, %zu of %zu rays hit\n", gnomon::to_string(kept.options.builder),
                kept.bvh.nodes.size(), met, hits.size());
    return met > 0 && gnomon::tree_hash(kept.bvh) == gnomon::tree_hash(built) ? 0 : 1;
  } catch (const gnomon::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
