// The question: where do heuristics predict badly, degenerate or lose work, and why? Every way to build a
// tree under every light of failure_map/cases.cpp, by counts that are the same on every machine: nothing is
// timed. Then the failures, each with its reason put to a check. One JSON row a line on stdout;
// failure_map_page makes the page of them.
//
//   failure_map_bench [--triangles N] [--rays N] [SCENE...]
#include <cstdio>
#include <cstring>
#include <exception>

#include "failure_map/claims.h"
#include "failure_map/figures.h"
#include "gnomon_commit.h"
#include "paired.h"

namespace {

using gnomon::bench::json;
using namespace gnomon::bench;

constexpr const char* kHelp =
    "failure_map_bench: where heuristics predict badly, degenerate or lose work, and why\n\n"
    "  failure_map_bench [--triangles N] [--rays N] [SCENE...]\n\n"
    "Every way to build a tree under every light, by counts: nothing is timed, no device is needed. One JSON "
    "row a line on\n"
    "stdout; failure_map_page makes the page of them.\n\n"
    "  SCENE          a generated scene that the map has; default: all of them\n"
    "  --triangles    of each scene; default: what the map is made for\n"
    "  --rays         of each kind; default: 4000\n\n"
    "Example:  failure_map_bench --triangles 7000 --rays 200 cottage\n";

struct Options {
  std::uint64_t triangles = 0;  // 0: what each scene's recipe says
  std::uint64_t rays = 4000;
  std::vector<std::string> scenes;
};

Options options_from(int argc, char** argv) {
  Options options;
  int i = 1;
  const auto value = [&](const char* name) { return count_from(i + 1 < argc ? argv[++i] : "", name); };
  for (; i < argc; ++i) {
    if (std::strcmp(argv[i], "--triangles") == 0) {
      options.triangles = value("--triangles");
    } else if (std::strcmp(argv[i], "--rays") == 0) {
      options.rays = value("--rays");
    } else {
      options.scenes.emplace_back(argv[i]);
    }
  }
  if (options.scenes.empty()) options.scenes = case_generators();
  return options;
}

json to_json(const Work& work) {
  return {{"boxes", work.boxes}, {"triangles", work.triangles}};
}

json row_of(const TreeFigures& tree) {
  const auto inner = static_cast<double>(tree.tally.inner_nodes > 0 ? tree.tally.inner_nodes : 1);
  double fallbacks = 0.0;
  for (const std::uint64_t count : tree.tally.fallback_on) fallbacks += static_cast<double>(count);
  return {{"tree_hash", gnomon::tree_hash(tree.tree)},
          {"depth", tree.stats.max_depth},
          {"mean_leaf", tree.stats.mean_leaf},
          {"largest_leaf", tree.stats.largest_leaf},
          {"sah_cost", tree.stats.sah_cost},
          {"axes_tried", static_cast<double>(tree.tally.axes_tried) / inner},
          {"fallback_share", fallbacks / inner},
          {"idle_share", tree.idle_share},
          {"overlap_4", tree.overlap_4 ? json(*tree.overlap_4) : json(nullptr)},
          {"predicted", tree.predicted},
          {"predicted_surface", tree.predicted_surface},
          {"pierced", tree.pierced.mean},
          {"pierced_error", tree.pierced.standard_error},
          {"closest", to_json(tree.closest)},
          {"any", to_json(tree.any)},
          {"shadow", to_json(tree.shadow)},
          {"other", to_json(tree.other)}};
}

void print(const json& row) {
  std::printf("%s\n", row.dump().c_str());
  std::fflush(stdout);
}

json common_of(const CaseScene& scene, const LightCase& light, const CaseRays& rays) {
  return {{"schema", 1},
          {"bench", "failure_map"},
          {"commit", GNOMON_COMMIT},
          {"case", light.name},
          {"light", light.light},
          {"scene", scene.generator},
          {"scene_hash", gnomon::scene_hash(scene.scene)},
          {"triangles", scene.scene.triangles.size()},
          {"seeds", {{"scene", kSceneSeed}, {"rays", kMeasureSeed}, {"fit", kFitSeed}}},
          {"rays", {{"own", rays.own.size()}, {"shadow", rays.shadow.size()}, {"other", rays.other.size()}}}};
}

void run(const std::string& generator, const Options& options, Findings& findings) {
  const CaseScene scene = make_case(generator, options.triangles);
  for (const LightCase& light : scene.lights) {
    const CaseRays rays = rays_of(scene, light, options.rays);
    std::map<std::string, TreeFigures> trees;
    for (const Method& method : methods_for(light)) {
      const TreeFigures& figures =
          trees.emplace(method.name, figures_of(scene, light, method, rays)).first->second;
      json row = common_of(scene, light, rays);
      row["kind"] = "tree";
      row["method"] = method.name;
      row.update(row_of(figures));
      print(row);
    }
    findings.look_at({scene, light, rays, trees});
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (taught(argc, argv, kHelp)) return 0;
  try {
    const Options options = options_from(argc, argv);
    Findings findings;
    for (const std::string& generator : options.scenes) run(generator, options, findings);
    for (json row : findings.rows()) {
      row.update({{"schema", 1}, {"bench", "failure_map"}, {"commit", GNOMON_COMMIT}});
      print(row);
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "failure_map_bench: %s\n", error.what());
    return 1;
  }
}
