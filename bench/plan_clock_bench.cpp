// The question: what does a plan take by the clock, beside the build of its baseline? Every set-up of
// ray_aware_bench, a plan for one kind of rays at a time, trees built by the device; process CPU time. What
// of that makes the tree that is kept is told by a plan that is asked for this tree, which tries and probes
// nothing. JSON rows on stdout, one a set-up and kind of rays.
//
//   plan_clock_bench thesis --configs CONFIGS.json --scenes DIR [--only WORD]
//   plan_clock_bench generated [--scenes atrium,city] [--triangles 100000]
#include <CLI/CLI.hpp>

#include <cstdio>

#include "device_builder.h"
#include "gnomon/plan/choose.h"
#include "gnomon_commit.h"
#include "paired.h"
#include "ray_aware/set_up_commands.h"
#include "ray_aware/set_ups.h"

namespace {

using namespace gnomon;
using bench::AwareSetUp;
using bench::RayCase;
using nlohmann::json;

struct Settings {
  bench::SetUpSources sources;
  double expected = 16'777'216.0;  // 64 a pixel of 512 x 512
  int rounds = 5;
};

// Milliseconds of one plan.
struct Clock {
  double baseline = 0.0;
  double planning = 0.0;  // all beyond it
};

class Bench {
 public:
  Bench(const Settings& settings, const cl::Context& context) : settings_(settings), context_(context) {}

  void run(const AwareSetUp& set_up) const {
    for (const RayCase& rays : set_up.cases) run_case(set_up, rays);
  }

 private:
  // The plan says when its baseline stands: at the first kind of rays.
  [[nodiscard]] Plan timed(const AwareSetUp& set_up, const PlanRays& rays, const std::string& choice,
                           Clock& clock) const {
    PlanOptions options;
    options.choice = choice;
    options.light_space = true;
    options.local_trees = true;
    options.packets = true;
    double built = 0.0;
    const Progress watch = [&](std::string_view stage, double) {
      if (stage == rays.name) built = bench::cpu_seconds();
      return true;
    };
    const double start = bench::cpu_seconds();
    Plan plan =
        make_plan(set_up.triangles, std::span(&rays, 1), options, app::device_builder(context_), watch);
    clock = {1e3 * (built - start), 1e3 * (bench::cpu_seconds() - built)};
    return plan;
  }

  void run_case(const AwareSetUp& set_up, const RayCase& rays) const {
    const PlanRays asked = bench::to_plan_for(rays, settings_.expected);
    Clock clock, making;
    const Plan plan = timed(set_up, asked, "auto", clock);  // compiles what is not yet
    const std::string& kept = plan.decisions.front().kept;
    std::vector<double> baseline, planning, shares, own_shares;
    for (int round = 0; round < settings_.rounds; ++round) {
      static_cast<void>(timed(set_up, asked, "auto", clock));
      static_cast<void>(timed(set_up, asked, kept, making));
      baseline.push_back(clock.baseline);
      planning.push_back(clock.planning);
      shares.push_back(clock.planning / clock.baseline);
      own_shares.push_back((clock.planning - making.planning) / clock.baseline);
    }
    const json row = {{"schema", 1},
                      {"bench", "plan_clock"},
                      {"commit", GNOMON_COMMIT},
                      {"device", context_.device().name},
                      {"driver", context_.device().driver},
                      {"family", set_up.family},
                      {"set_up", set_up.name},
                      {"triangles", set_up.triangles.size()},
                      {"rays", rays.rays},
                      {"query", to_string(rays.query)},
                      {"kept", kept},
                      {"priced_share", plan.planning_units / plan.baseline_units},
                      {"priced_own_share", (plan.planning_units - plan.kept_units) / plan.baseline_units},
                      {"baseline_ms", bench::spread_json(baseline)},
                      {"planning_ms", bench::spread_json(planning)},
                      {"share", bench::spread_json(shares)},
                      {"own_share", bench::spread_json(own_shares)}};
    std::printf("%s\n", row.dump().c_str());
    std::fflush(stdout);
  }

  const Settings& settings_;
  const cl::Context& context_;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("What plans take by the clock, beside the build of their baseline.");
  Settings settings;
  const bench::SetUpCommands commands = bench::add_set_up_commands(app, settings.sources);
  app.add_option("--expected", settings.expected, "rays that trees must repay themselves over");
  app.add_option("--rounds", settings.rounds);
  CLI11_PARSE(app, argc, argv);
  try {
    const cl::Context context = bench::one_thread_context();
    const Bench bench(settings, context);
    const auto run = [&](const AwareSetUp& made) { bench.run(made); };
    if (commands.thesis->parsed()) bench::for_each_thesis_set_up(settings.sources, run);
    if (commands.generated->parsed()) bench::for_each_generated_set_up(settings.sources, run);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
