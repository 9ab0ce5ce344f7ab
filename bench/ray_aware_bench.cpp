// The question: which trees cost given rays less than the best surface-area tree, and does the plan choose
// them? Every candidate of gnomon/plan on the thesis' set-ups and on generated scenes, by counts. JSON rows
// on stdout, one a set-up, kind of rays and tree.
//
//   ray_aware_bench thesis --configs CONFIGS.json --scenes DIR [--only WORD]
//   ray_aware_bench generated [--scenes atrium,city] [--triangles 100000]
//
// Cost of a ray: 1.0 a box test, 1.2 a triangle test; two boxes a node visited, the root's not counted. Trees
// are fitted to rays of one seed, chosen by those of another and measured on a third's.
#include <CLI/CLI.hpp>

#include <array>
#include <cstdio>
#include <map>
#include <sstream>

#include <nlohmann/json.hpp>

#include "gnomon/plan/choose.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon_commit.h"
#include "ray_aware/set_up_commands.h"
#include "ray_aware/set_ups.h"

namespace {

using namespace gnomon;
using bench::AwareSetUp;
using bench::RayCase;
using nlohmann::json;

struct Settings {
  bench::SetUpSources sources;
  std::string query;
  double expected = 16'777'216.0;  // 64 a pixel of 512 x 512
  PlanOptions plan;
};

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

// The reference builder, which makes each tree of a set-up once.
class Builder {
 public:
  [[nodiscard]] PlanBuilder get() {
    PlanBuilder out = reference_builder();
    out.build = [this](std::span<const Triangle> triangles, const BuildOptions& options) {
      const float* w = options.measure.weights;
      const auto [at, fresh] = built_.try_emplace(
          {triangles_hash(triangles), {w[0], w[1], w[2], static_cast<float>(options.builder)}});
      if (fresh) at->second = build_reference(triangles, options);
      return at->second;
    };
    out.optimise = [this](const Bvh& bvh, const OptimiseOptions& options) {
      if (!options.areas.empty() || !options.segments.empty()) return optimise_reference(bvh, options);
      const auto [at, fresh] = moved_.try_emplace({tree_hash(bvh), options.face_weights});
      if (fresh) at->second = optimise_reference(bvh, options);
      return at->second;
    };
    return out;
  }

 private:
  // By scene, face weights and builder.
  std::map<std::pair<std::uint64_t, std::array<float, 4>>, Bvh> built_;
  std::map<std::pair<std::string, std::array<float, 3>>, Bvh> moved_;
};

class Bench {
 public:
  Bench(const Settings& settings, const AwareSetUp& set_up) : settings_(settings), set_up_(set_up) {}

  void run() {
    for (const RayCase& rays : set_up_.cases) {
      if (settings_.query.empty() || settings_.query == to_string(rays.query)) run_case(rays);
    }
  }

 private:
  void run_case(const RayCase& rays) {
    const std::vector<PlanRays> asked{bench::to_plan_for(rays, settings_.expected)};
    const Plan plan = make_plan(set_up_.triangles, asked, settings_.plan, builder_.get());
    const Decision& decision = plan.decisions.front();
    // Of parts of triangles where spatial splits pay; else there is nothing like it in the pool.
    const std::string own = plan.trees.front().name;
    PlanOptions plain = settings_.plan;
    plain.choice = "sah";
    const Plan sah = make_plan(set_up_.triangles, asked, plain, builder_.get());
    const OrderedTree& baseline = sah.trees.front().tree;
    const std::vector<Hit> expected =
        trace_ordered(baseline, set_up_.triangles, rays.draws.measure, rays.query == Query::kAny).hits;
    json start = {{"schema", 1},
                  {"bench", "ray_aware"},
                  {"commit", GNOMON_COMMIT},
                  {"family", set_up_.family},
                  {"set_up", set_up_.name},
                  {"triangles", set_up_.triangles.size()},
                  {"rays", rays.rays},
                  {"query", to_string(rays.query)},
                  {"measured_rays", rays.draws.measure.size()}};
    row(start, "sah", baseline, rays, expected, json::object());
    for (const std::string& name : candidate_names()) {
      if (name == "sah" || (name.ends_with("-order") && rays.query != Query::kAny)) continue;
      if (name.starts_with("best") && own != "best") continue;
      if (name.starts_with("light") && decision.obliquity < settings_.plan.least_oblique) continue;
      PlanOptions options = settings_.plan;
      options.choice = name;
      const Plan other = make_plan(set_up_.triangles, asked, options, builder_.get());
      const PlanTree& tree = other.trees[other.decisions.front().tree];
      json more = {{"build_units", tree.build_units}};
      if (name == "local-rays") {
        if (other.decisions.front().local.empty()) continue;
        more.update(local_figures(other.decisions.front()));
      }
      if (name.starts_with("light")) {
        more["obliquity"] = other.decisions.front().obliquity;
        more["framed_share"] = other.decisions.front().framed_share;
      }
      for (const Trial& trial : decision.trials) {
        if (trial.name == name) more.update(figures_of(trial));
      }
      row(start, name, tree.tree, rays, expected, more);
      // The same tree, near child first: what the order alone brings.
      if (rays.query == Query::kAny && name != "best" && name != "local-rays" && !name.ends_with("-order"))
        row(start, name + " near", {tree.tree.bvh, {}}, rays, expected, json::object());
    }
    row(start, "auto", plan.trees[decision.tree].tree, rays, expected,
        {{"baseline", own},
         {"kept", decision.kept},
         {"reason", decision.reason},
         {"probes", decision.probes},
         {"baseline_units", plan.baseline_units},
         {"planning_units", plan.planning_units},
         {"kept_units", plan.kept_units},
         {"probe_units", decision.probe_units}});
    std::fflush(stdout);
  }

  static json local_figures(const Decision& decision) {
    std::uint64_t triangles = 0;
    double share = 0.0;
    for (const LocalUse& use : decision.local) {
      triangles += use.triangles;
      share += use.share;
    }
    return {{"local_trees", decision.local.size()}, {"local_triangles", triangles}, {"local_share", share}};
  }

  // Of a candidate that was tried.
  static json figures_of(const Trial& trial) {
    const Standing& standing = trial.standing;
    return {{"fit_gain", trial.fit_gain},
            {"probe_gain", standing.baseline > 0.0 ? 1.0 - standing.cost / standing.baseline : 0.0},
            {"verdict", to_string(standing.verdict)},
            {"price_units", trial.price}};
  }

  void row(json out, const std::string& tree, const OrderedTree& in, const RayCase& rays,
           const std::vector<Hit>& expected, const json& more) const {
    const bool any = rays.query == Query::kAny;
    const std::vector<Hit> hits = trace_ordered(in, set_up_.triangles, rays.draws.measure, any).hits;
    std::uint64_t different = 0;
    std::uint64_t met = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const bool same = any ? (hits[i].primitive == GN_NONE) == (expected[i].primitive == GN_NONE)
                            : hits[i].primitive == expected[i].primitive && hits[i].t == expected[i].t &&
                                  hits[i].u == expected[i].u && hits[i].v == expected[i].v;
      different += same ? 0 : 1;
      met += hits[i].primitive != GN_NONE ? 1 : 0;
    }
    out["tree"] = tree;
    out["cost"] = mean_of(ray_costs(in, set_up_.triangles, rays.draws.measure, rays.query));
    out["hit_share"] = static_cast<double>(met) / static_cast<double>(hits.size());
    out["different_hits"] = different;
    out.update(more);
    std::printf("%s\n", out.dump().c_str());
  }

  const Settings& settings_;
  const AwareSetUp& set_up_;
  Builder builder_;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Trees for given rays beside the best surface-area tree, by counts.");
  Settings settings;
  const bench::SetUpCommands commands = bench::add_set_up_commands(app, settings.sources);
  settings.plan.light_space = settings.plan.local_trees = true;  // trees are traced by the reference
  app.add_option("--query", settings.query, "closest, any or every alone");
  app.add_option("--rays", settings.sources.rays, "to measure on");
  app.add_option("--expected", settings.expected, "rays that trees must repay themselves over");
  app.add_option("--fit-rays", settings.plan.fit_rays);
  app.add_option("--mixture", settings.plan.mixture_share);
  app.add_option("--prior", settings.plan.prior_share);
  app.add_option("--sample-share", settings.plan.sample_share, "of the baseline's build, for sampled rays");
  app.add_option("--least-met", settings.plan.sampled.least_met);
  app.add_option("--least-saved", settings.plan.sampled.least_saved);
  app.add_option("--passes", settings.plan.optimise.max_passes);
  app.add_option("--share", settings.plan.optimise.share);
  CLI11_PARSE(app, argc, argv);
  try {
    const auto run = [&](const AwareSetUp& made) { Bench(settings, made).run(); };
    if (commands.thesis->parsed()) bench::for_each_thesis_set_up(settings.sources, run);
    if (commands.generated->parsed()) bench::for_each_generated_set_up(settings.sources, run);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
