// The question: do local trees with the exit rule answer as the global tree alone, and how often does the
// thesis' rule not? Over the thesis' set-ups, as they are, shrunk to half their size, and with the far end
// cut at the median depth of the scene; rays of the area, of a camera, and at random. One JSON row a set-up,
// form and rule on stdout.
//
//   exit_rule_bench CONFIGS.json SCENES [RAYS]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "gnomon/areas/area_rays.h"
#include "gnomon/device/trace_areas.h"
#include "gnomon/device/trace_device.h"
#include "gnomon/measure/set_up.h"
#include "gnomon/scene/generators.h"
#include "gnomon/scene/import.h"
#include "gnomon/scene/ray_set.h"
#include "gnomon/tree/top_level.h"
#include "gnomon_commit.h"
#include "paired.h"

namespace {

using gnomon::AreaKind;
using gnomon::InfluenceArea;
using gnomon::Ray;
using gnomon::bench::json;

constexpr const char* kHelp =
    "exit_rule_bench: do local trees with the exit rule answer as the global tree alone?\n\n"
    "  exit_rule_bench CONFIGS.json SCENES [RAYS]\n\n"
    "One JSON row a set-up, form of its area and rule on stdout.\n\n"
    "  CONFIGS.json   the thesis' set-ups, as for gnomon reproduce --configs\n"
    "  SCENES         the folder of their scenes\n"
    "  RAYS           of each kind; default: 4000\n\n"
    "GNOMON_DEVICE chooses another device.\n";
constexpr std::uint64_t kSeed = 1;

// Depth along the area's forward axis below which half of the triangles' middles lie.
double median_depth(const gnomon::Scene& scene, const gnomon::AreaFrame& frame) {
  std::vector<double> depths;
  for (const gnomon::Triangle& t : scene.triangles) {
    double depth = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
      depth += frame.forward[k] * ((t.v0[k] + t.v1[k] + t.v2[k]) / 3.0 - frame.origin[k]);
    depths.push_back(depth);
  }
  std::nth_element(depths.begin(), depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2),
                   depths.end());
  return depths[depths.size() / 2];
}

// The area with its window scaled by `width` and its length cut to `depth`.
InfluenceArea reshaped(const InfluenceArea& area, double width, double depth) {
  const gnomon::AreaFrame& frame = area.frame();
  if (area.kind() == AreaKind::kPlane) {
    gnomon::PlaneWindow window;
    window.point = frame.origin;
    window.direction = frame.forward;
    window.up = frame.up;
    window.half_width = width * area.half_window()[0];
    window.half_height = width * area.half_window()[1];
    window.depth = depth;
    return InfluenceArea::plane(window);
  }
  gnomon::PointView view;
  view.eye = frame.origin;
  view.direction = frame.forward;
  view.up = frame.up;
  view.fov_x = width * 2.0 * area.half_window()[0];
  view.fov_y = width * 2.0 * area.half_window()[1];
  view.near_distance = std::get<gnomon::Frustum>(area.region()).near_distance;
  view.far_distance = std::max(depth, 1.01 * view.near_distance);
  return InfluenceArea::point(view);
}

double depth_of(const InfluenceArea& area) {
  if (const auto* box = std::get_if<gnomon::OrientedBox>(&area.region())) return 2.0 * box->half[2];
  return std::get<gnomon::Frustum>(area.region()).far_distance;
}

// Counts answers that are not the global tree's, to the bit.
std::uint64_t wrong_hits(const std::vector<GnHit>& got, const std::vector<GnHit>& expected) {
  std::uint64_t wrong = 0;
  for (std::size_t i = 0; i < got.size(); ++i)
    wrong += std::memcmp(&got[i], &expected[i], sizeof(GnHit)) != 0 ? 1 : 0;
  return wrong;
}

class SceneRun {
 public:
  SceneRun(const gnomon::cl::Context& context, gnomon::Scene scene, std::uint64_t count)
      : context_(context),
        scene_(std::move(scene)),
        count_(count),
        tree_(gnomon::build_device(context, scene_.triangles)),
        tracer_(context, tree_),
        camera_(gnomon::primary_rays(scene_, count, kSeed)),
        random_(gnomon::random_rays(scene_, count, kSeed)) {}

  void run(const gnomon::SetUp& set_up) {
    const double depth = depth_of(set_up.area);
    const double middle = std::clamp(median_depth(scene_, set_up.area.frame()), 0.05 * depth, depth);
    row(set_up, "as published", set_up.area);
    row(set_up, "half size", reshaped(set_up.area, 0.5, 0.5 * depth));
    row(set_up, "far end at median depth", reshaped(set_up.area, 1.0, middle));
  }

 private:
  void row(const gnomon::SetUp& set_up, const char* form, const InfluenceArea& area) {
    const bool plane = area.kind() == AreaKind::kPlane;
    std::vector<Ray> rays = gnomon::area_rays(
        area, plane ? gnomon::RayMeasure::kParallel : gnomon::RayMeasure::kYawPitch, count_, kSeed);
    rays.insert(rays.end(), camera_.begin(), camera_.end());
    rays.insert(rays.end(), random_.begin(), random_.end());
    const auto expected = tracer_.closest(rays).hits;
    const auto occluded = tracer_.any(rays).occluded;
    json out = {{"schema", 1},
                {"bench", "exit_rule"},
                {"commit", GNOMON_COMMIT},
                {"device", context_.device().name},
                {"driver", context_.device().driver},
                {"set_up", set_up.label()},
                {"form", form},
                {"scene_hash", gnomon::scene_hash(scene_)},
                {"triangles", scene_.triangles.size()},
                {"seed", kSeed},
                {"rays", rays.size()}};
    for (const auto rule : {gnomon::FallbackRule::kExit, gnomon::FallbackRule::kPublished}) {
      gnomon::LocalTree local{area};
      if (rule == gnomon::FallbackRule::kPublished) local.membership = gnomon::Membership::kVertices;
      const auto forest = gnomon::build_forest(context_, scene_.triangles, std::span(&local, 1));
      const auto top = gnomon::build_top_level(forest.areas, gnomon::AreaLookup::kList);
      const auto device_top = gnomon::upload_top_level(context_, top, forest.shared_areas);
      gnomon::ForestTraceOptions options;
      options.rule = rule;
      const gnomon::ForestTracer tracer(context_, forest, device_top, options);
      std::uint64_t wrong_any = 0;
      const auto any = tracer.any(rays).occluded;
      for (std::size_t i = 0; i < any.size(); ++i) wrong_any += any[i] != occluded[i] ? 1 : 0;
      const std::string name = rule == gnomon::FallbackRule::kExit ? "exit_rule" : "published_rule";
      out[name] = {{"wrong_closest", wrong_hits(tracer.closest(rays).hits, expected)},
                   {"wrong_any", wrong_any},
                   {"local_triangles", forest.local.front().triangle_count}};
    }
    std::printf("%s\n", out.dump().c_str());
  }

  const gnomon::cl::Context& context_;
  gnomon::Scene scene_;
  std::uint64_t count_;
  gnomon::DeviceBvh tree_;
  gnomon::Tracer tracer_;
  std::vector<Ray> camera_;
  std::vector<Ray> random_;
};

gnomon::Scene load(const std::string& thesis_name, const std::filesystem::path& folder) {
  const std::string source = gnomon::scene_source_of(thesis_name);
  for (const gnomon::GeneratorInfo& generator : gnomon::generators()) {
    if (source == "gen:" + std::string(generator.name)) {
      return gnomon::generate_scene(generator.name, generator.default_triangles, kSeed);
    }
  }
  return gnomon::import_scene((folder / source).string());
}

}  // namespace

int main(int argc, char** argv) {
  if (gnomon::bench::taught(argc, argv, kHelp)) return 0;
  if (argc < 3) {
    std::fputs(kHelp, stderr);
    return 2;
  }
  try {
    const gnomon::cl::Context context = gnomon::bench::one_thread_context();
    const std::uint64_t count = argc > 3 ? gnomon::bench::count_from(argv[3], "RAYS") : 4000;
    std::map<std::string, SceneRun> scenes;
    for (const gnomon::SetUp& set_up : gnomon::read_set_ups(argv[1])) {
      if (gnomon::is_lost(set_up.scene)) continue;
      auto found = scenes.find(set_up.scene);
      if (found == scenes.end()) {
        found = scenes.try_emplace(set_up.scene, context, load(set_up.scene, argv[2]), count).first;
      }
      found->second.run(set_up);
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "exit_rule_bench: %s\n", error.what());
    return 1;
  }
}
