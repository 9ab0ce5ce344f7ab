// The question: what does building for a light's rays cost beside building for surface area? Whole builds on
// the device, host loop and upload included. One process, rounds that alternate the two and swap their order,
// process CPU time on one thread; one JSON row a measure on stdout. A ratio above 1 says that the measure is
// slower.
//
//   heuristic_bench [--only MEASURE] [SCENE TRIANGLES]...   default: all measures, city 1000000 atrium
//   1000000
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "gnomon/areas/measure.h"
#include "gnomon/device/build_device.h"
#include "gnomon/scene/generators.h"
#include "gnomon_commit.h"
#include "paired.h"

namespace {

using gnomon::bench::json;
using gnomon::bench::spread_json;

constexpr const char* kHelp =
    "heuristic_bench: what building for a light's rays costs beside building for surface area\n\n"
    "  heuristic_bench [--only MEASURE] [SCENE TRIANGLES]...\n\n"
    "Whole builds on the device, one thread, processor time; rounds alternate the two. One JSON row a "
    "measure on\n"
    "stdout; a ratio above 1 says that the measure is slower.\n\n"
    "  SCENE      a generated scene (gnomon scene --help names them); default: city and atrium of 1000000 "
    "triangles\n"
    "  --only     one of: plane; plane, culled; point, solid angle; point, solid angle, culled; point, near "
    "plane,\n"
    "             culled; point, yaw and pitch, culled (quote it)\n\n"
    "GNOMON_DEVICE chooses another device.\n"
    "Example:  heuristic_bench --only plane cottage 20000\n";
constexpr int kRounds = 7;
constexpr std::uint64_t kSeed = 1;

struct Box {
  gnomon::Vec3d lo{1e300, 1e300, 1e300};
  gnomon::Vec3d hi{-1e300, -1e300, -1e300};
};

Box box_of(const gnomon::Scene& scene) {
  Box box;
  for (const gnomon::Triangle& t : scene.triangles) {
    for (const float* v : {t.v0, t.v1, t.v2}) {
      for (std::size_t k = 0; k < 3; ++k) {
        box.lo[k] = std::min(box.lo[k], static_cast<double>(v[k]));
        box.hi[k] = std::max(box.hi[k], static_cast<double>(v[k]));
      }
    }
  }
  return box;
}

// A sun from aslant, over all of the scene and over the middle quarter of it; a lamp in the middle that
// shines all ways; a spot of 60 by 60 degrees from a corner above, which sees most of the scene.
std::vector<std::pair<std::string, GnMeasure>> measures_for(const Box& box) {
  const gnomon::Vec3d middle{0.5 * (box.lo[0] + box.hi[0]), 0.5 * (box.lo[1] + box.hi[1]),
                             0.5 * (box.lo[2] + box.hi[2])};
  const gnomon::Vec3d size{box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]};
  const double reach = std::hypot(size[0], size[1], size[2]);
  const gnomon::Vec3d down{0.4, -0.8, 0.3};
  gnomon::PlaneWindow sun;
  sun.direction = down;
  sun.point = {middle[0] - reach * down[0], middle[1] - reach * down[1], middle[2] - reach * down[2]};
  sun.half_width = sun.half_height = reach;
  sun.depth = 3.0 * reach;
  gnomon::PlaneWindow patch = sun;
  patch.half_width = patch.half_height = 0.15 * reach;
  gnomon::PointView spot;
  spot.eye = {box.lo[0], box.hi[1] + 0.1 * reach, box.lo[2]};
  spot.direction = {middle[0] - spot.eye[0], middle[1] - spot.eye[1], middle[2] - spot.eye[2]};
  spot.fov_x = spot.fov_y = std::acos(-1.0) / 3.0;
  spot.near_distance = 1e-3 * reach;
  spot.far_distance = 2.0 * reach;
  const auto plane = gnomon::InfluenceArea::plane(sun);
  const auto window = gnomon::InfluenceArea::plane(patch);
  const auto lamp = gnomon::InfluenceArea::omni(middle, reach);
  const auto view = gnomon::InfluenceArea::point(spot);
  using gnomon::RayMeasure;
  return {{"plane", gnomon::measure_of(plane, RayMeasure::kParallel, false)},
          {"plane, culled", gnomon::measure_of(window, RayMeasure::kParallel, true)},
          {"point, solid angle", gnomon::measure_of(lamp, RayMeasure::kSolidAngle, false)},
          {"point, solid angle, culled", gnomon::measure_of(view, RayMeasure::kSolidAngle, true)},
          {"point, near plane, culled", gnomon::measure_of(view, RayMeasure::kNearPlane, true)},
          {"point, yaw and pitch, culled", gnomon::measure_of(view, RayMeasure::kYawPitch, true)}};
}

void run(const gnomon::cl::Context& context, const std::string& only, const std::string& name,
         std::uint64_t count) {
  const gnomon::Scene scene = gnomon::generate_scene(name, count, kSeed);
  const json common = {{"schema", 1},
                       {"bench", "heuristic"},
                       {"commit", GNOMON_COMMIT},
                       {"device", context.device().name},
                       {"driver", context.device().driver},
                       {"threads", 1},
                       {"clock", "process CPU time"},
                       {"scene", name},
                       {"scene_hash", gnomon::scene_hash(scene)},
                       {"triangles", scene.triangles.size()},
                       {"seed", kSeed}};
  const auto build = [&](const gnomon::BuildOptions& options) {
    static_cast<void>(gnomon::build_device(context, scene.triangles, options));
  };
  for (const auto& [measure_name, measure] : measures_for(box_of(scene))) {
    if (!only.empty() && measure_name != only) continue;
    gnomon::BuildOptions options;
    options.measure = measure;
    const auto times = gnomon::bench::measure(
        kRounds, [&] { build(options); }, [&] { build({}); });
    std::vector<double> ratios;
    for (std::size_t i = 0; i < times.ours.size(); ++i) ratios.push_back(times.ours[i] / times.peer[i]);
    json row = common;
    row["measure"] = measure_name;
    row["build_s"] = spread_json(times.ours);
    row["sah_build_s"] = spread_json(times.peer);
    row["ratio"] = spread_json(ratios);
    std::printf("%s\n", row.dump().c_str());
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (gnomon::bench::taught(argc, argv, kHelp)) return 0;
  try {
    std::string only;
    if (argc > 2 && std::string(argv[1]) == "--only") {
      only = argv[2];
      argc -= 2;
      argv += 2;
    }
    const gnomon::cl::Context context = gnomon::bench::one_thread_context();
    for (const auto& [name, triangles] : gnomon::bench::scenes_from(argc, argv))
      run(context, only, name, triangles);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "heuristic_bench: %s\n", error.what());
    return 1;
  }
}
