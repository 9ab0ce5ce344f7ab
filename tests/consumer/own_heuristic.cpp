// A tree by a heuristic of one's own. A measure is one function of a box, in kernels/shared/custom_measure.h;
// what stands there is a worked example, the chance that a ball of radius half_width touches the box. Change
// it, build, and builders on every device and the reference follow; host/notes/heuristics.md says what a
// measure must keep.
#include <gnomon/gnomon.h>

#include <cstdio>

int main() {
  try {
    const gnomon::Scene scene = gnomon::generate_scene("city", 5000, 1);
    const gnomon::cl::Context context(gnomon::cl::choose_device(gnomon::cl::list_devices(), ""));
    gnomon::BuildOptions options;
    options.measure.kind = GN_MEASURE_CUSTOM;
    options.measure.half_width = 2.0F;  // the balls' radius
    const auto tree = gnomon::download_bvh(context, gnomon::build_device(context, scene.triangles, options));

    const gnomon::Bvh reference = gnomon::build_reference(scene.triangles, options);
    const gnomon::Bvh by_area = gnomon::build_reference(scene.triangles);
    const bool same = gnomon::tree_hash(tree) == gnomon::tree_hash(reference);
    const bool sound = !gnomon::check_bvh(tree, scene.triangles, options);
    std::printf("%s: %zu nodes, %s the reference's, %s surface area's\n",
                gnomon::heuristic_name(options).c_str(), tree.nodes.size(), same ? "bit for bit" : "not",
                gnomon::tree_hash(tree) == gnomon::tree_hash(by_area) ? "also" : "not");
    return same && sound ? 0 : 1;
  } catch (const gnomon::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
