// The question: how much of what trees for given rays save in counts do they save in time? Every candidate of
// gnomon/plan on generated scenes, traced on a device through its wide tree: rounds in which all trees trace
// the same rays once, in an order that turns, process CPU time. JSON rows on stdout, one a scene, kind of
// rays and tree.
//
//   ray_aware_time [--scenes atrium,city] [--triangles 100000] [--rays 65536] [--rounds 9]
//
// Trees are fitted to rays of one seed, chosen by those of another and timed on a third's. Counts are those
// of the binary tree, 1.0 a box and 1.2 a triangle, on a share of the timed rays.
#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>

#include "contest.h"
#include "device_builder.h"
#include "gnomon/cl/launch.h"
#include "gnomon/device/join_wide.h"
#include "gnomon/device/trace_device.h"
#include "gnomon/plan/choose.h"
#include "gnomon/scene/generators.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/trace_wide_reference.h"
#include "gnomon_commit.h"
#include "paired.h"
#include "ray_aware/set_ups.h"

namespace {

using namespace gnomon;
using bench::AwareSetUp;
using bench::RayCase;
using nlohmann::json;

constexpr std::uint64_t kCounted = 4096;

struct Settings {
  std::vector<std::string> scenes{"atrium", "city", "forest", "crowd", "cottage"};
  std::uint64_t triangles = 100'000;
  std::uint64_t rays = 65'536;
  int rounds = 9;
  double expected = 1e9;  // enough for any tree to repay itself: what it brings is the question
};

struct Work {
  double boxes = 0.0;
  double triangles = 0.0;
};

Work mean_of(const std::vector<GnRayCounters>& counters) {
  Work sum;
  for (const GnRayCounters& ray : counters) {
    sum.boxes += ray.boxes;
    sum.triangles += ray.triangles;
  }
  const auto rays = static_cast<double>(counters.size());
  return {sum.boxes / rays, sum.triangles / rays};
}

// Steps of a ray by itself in the wide tree.
struct Steps {
  double nodes = 0.0;
  double blocks = 0.0;
  double exact = 0.0;
};

Steps mean_of(const std::vector<WideSteps>& steps) {
  Steps sum;
  for (const WideSteps& ray : steps) {
    sum.nodes += ray.nodes;
    sum.blocks += ray.blocks;
    sum.exact += ray.exact;
  }
  const auto rays = static_cast<double>(steps.size());
  return {sum.nodes / rays, sum.blocks / rays, sum.exact / rays};
}

// A tree ready to be traced.
class Entrant {
 public:
  Entrant(const cl::Context& context, std::string name, OrderedTree tree, std::span<const Triangle> triangles)
      : name_(std::move(name)), tree_(std::move(tree)), device_(upload_bvh(context, tree_.bvh, triangles)) {
    wide_ = collapse_with_regions(context, device_, triangles, tree_.local, tree_.ranks, tree_.weights);
    tracer_ = std::make_unique<Tracer>(context, wide_);
    TraceOptions counting;
    counting.counters = true;
    counter_ = std::make_unique<Tracer>(context, wide_, counting);
    counting.flavour = TraceFlavour::kWide;
    alone_ = std::make_unique<Tracer>(context, wide_, counting);
  }

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const OrderedTree& tree() const { return tree_; }
  [[nodiscard]] const Tracer& tracer() const { return *tracer_; }
  [[nodiscard]] const DeviceWideBvh& wide() const { return wide_; }
  // As it is timed; and each ray by itself, whatever runs beside it.
  [[nodiscard]] TraceResult counted(std::span<const Ray> rays, bool any) const {
    return ask(*counter_, rays, any);
  }
  [[nodiscard]] TraceResult alone(std::span<const Ray> rays, bool any) const {
    return ask(*alone_, rays, any);
  }

 private:
  [[nodiscard]] static TraceResult ask(const Tracer& tracer, std::span<const Ray> rays, bool any) {
    return any ? tracer.any(rays) : tracer.closest(rays);
  }

  std::string name_;
  OrderedTree tree_;
  DeviceBvh device_;
  DeviceWideBvh wide_;
  std::unique_ptr<Tracer> tracer_, counter_, alone_;
};

class Bench {
 public:
  Bench(const Settings& settings, const cl::Context& context) : settings_(settings), context_(context) {}

  void run(const std::string& scene) {
    const AwareSetUp made =
        bench::generated_set_up(scene, generate_scene(scene, settings_.triangles, 1), settings_.rays);
    const Bvh plain = download_bvh(context_, build_device(context_, made.triangles));
    std::vector<const RayCase*> cases;
    std::vector<PlanRays> asked;
    for (const RayCase& rays : made.cases) {
      // Every box on the way is not what a tracer does.
      if (rays.query == Query::kEvery) continue;
      cases.push_back(&rays);
      asked.push_back(bench::to_plan_for(rays, settings_.expected));
    }
    PlanOptions options;
    options.keep_tried = true;
    options.light_space = true;
    options.local_trees = true;
    options.packets = true;
    const Plan plan = make_plan(made.triangles, asked, options, app::device_builder(context_));
    for (std::size_t i = 0; i < cases.size(); ++i)
      run_case(made, *cases[i], plain, plan.trees, plan.decisions[i]);
  }

 private:
  void run_case(const AwareSetUp& set_up, const RayCase& rays, const Bvh& plain,
                const std::vector<PlanTree>& trees, const Decision& decision) {
    std::vector<Entrant> entrants;
    entrants.emplace_back(context_, "balanced", OrderedTree{plain, {}}, set_up.triangles);
    entrants.emplace_back(context_, trees.front().name, trees.front().tree, set_up.triangles);
    for (const Trial& trial : decision.trials)
      entrants.emplace_back(context_, trial.name, trees[trial.tree].tree, set_up.triangles);
    report(set_up, rays, entrants, time(entrants, rays), decision.kept);
  }

  [[nodiscard]] std::vector<std::vector<double>> time(const std::vector<Entrant>& entrants,
                                                      const RayCase& rays) const {
    const std::vector<Ray>& measure = rays.draws.measure;
    const auto count = static_cast<std::uint32_t>(measure.size());
    const cl::Buffer in = context_.create_buffer("rays", measure.size() * sizeof(Ray));
    const cl::Buffer out = context_.create_buffer("answers", measure.size() * sizeof(Hit));
    context_.upload_values<Ray>(in, measure);
    std::vector<bench::Contestant> contestants;
    for (const Entrant& entrant : entrants) {
      contestants.push_back({entrant.name(), [&, tracer = &entrant.tracer()] {
                               const auto done =
                                   rays.query == Query::kAny
                                       ? tracer->enqueue_any(in.mem.get(), out.mem.get(), count)
                                       : tracer->enqueue_closest(in.mem.get(), out.mem.get(), count);
                               cl::wait(done);
                             }});
    }
    bench::run_contest(contestants, settings_.rounds);
    std::vector<std::vector<double>> seconds;
    for (const bench::Contestant& one : contestants) seconds.push_back(one.cpu_seconds);
    return seconds;
  }

  void report(const AwareSetUp& set_up, const RayCase& rays, const std::vector<Entrant>& entrants,
              const std::vector<std::vector<double>>& seconds, const std::string& kept) const {
    const bool any = rays.query == Query::kAny;
    const std::vector<Ray> some = thinned(rays.draws.measure, kCounted);
    const auto answers = [&](std::size_t i) { return entrants[i].counted(rays.draws.measure, any); };
    const TraceResult expected = answers(0);
    const auto count = static_cast<double>(rays.draws.measure.size());
    for (std::size_t i = 0; i < entrants.size(); ++i) {
      const TraceResult counted = answers(i);
      const Work traced = mean_of(counted.counters);
      const Work wide = mean_of(entrants[i].alone(rays.draws.measure, any).counters);
      const ReferenceTrace trace = trace_ordered(entrants[i].tree(), set_up.triangles, some, any);
      const Work binary = mean_of(trace.counters);
      std::vector<WideSteps> each;
      const WideBvh wide_tree = download_wide(context_, entrants[i].wide());
      const std::vector<Hit> hits = trace_wide_reference(wide_tree, some, any, &each).hits;
      const Steps steps = mean_of(each);
      std::vector<double> ns;
      for (const double s : seconds[i]) ns.push_back(1e9 * s / count);
      const json row = {{"schema", 1},
                        {"bench", "ray_aware_time"},
                        {"commit", GNOMON_COMMIT},
                        {"device", context_.device().name},
                        {"driver", context_.device().driver},
                        {"scene", set_up.name},
                        {"triangles", set_up.triangles.size()},
                        {"rays", rays.rays},
                        {"query", to_string(rays.query)},
                        {"tree", entrants[i].name()},
                        {"kept", kept},
                        {"measured_rays", rays.draws.measure.size()},
                        {"boxes_per_ray", binary.boxes - 1.0},
                        {"triangles_per_ray", binary.triangles},
                        {"cost", kBoxCost * (binary.boxes - 1.0) + kTriangleCost * binary.triangles},
                        {"traced_boxes_per_ray", traced.boxes},
                        {"traced_triangles_per_ray", traced.triangles},
                        {"wide_boxes_per_ray", wide.boxes},
                        {"wide_triangles_per_ray", wide.triangles},
                        {"wide_nodes_per_ray", steps.nodes},
                        {"wide_blocks_per_ray", steps.blocks},
                        {"wide_exact_per_ray", steps.exact},
                        {"wide_nodes", entrants[i].wide().node_count},
                        {"wide_blocks", stats_of(wide_tree).blocks},
                        {"ns_per_ray", bench::spread_json(ns)},
                        // Of the baseline and of the balanced builder's tree, round by round.
                        {"time_of_sah", bench::spread_json(bench::speed_ratios(seconds[1], seconds[i]))},
                        {"time_of_balanced", bench::spread_json(bench::speed_ratios(seconds[0], seconds[i]))},
                        {"different_hits", differing(expected, counted)}};
      std::printf("%s\n", row.dump().c_str());
    }
    std::fflush(stdout);
  }

  static std::uint64_t differing(const TraceResult& a, const TraceResult& b) {
    std::uint64_t different = 0;
    for (std::size_t i = 0; i < a.occluded.size(); ++i) different += a.occluded[i] != b.occluded[i] ? 1 : 0;
    for (std::size_t i = 0; i < a.hits.size(); ++i) {
      const Hit& x = a.hits[i];
      const Hit& y = b.hits[i];
      different += x.primitive != y.primitive || x.t != y.t || x.u != y.u || x.v != y.v ? 1 : 0;
    }
    return different;
  }

  const Settings& settings_;
  const cl::Context& context_;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("What trees for given rays save in time, beside what they save in counts.");
  Settings settings;
  app.add_option("--scenes", settings.scenes)->delimiter(',');
  app.add_option("--triangles", settings.triangles);
  app.add_option("--rays", settings.rays, "to time");
  app.add_option("--rounds", settings.rounds);
  CLI11_PARSE(app, argc, argv);
  try {
    const cl::Context context = bench::one_thread_context();
    Bench bench(settings, context);
    for (const std::string& scene : settings.scenes) bench.run(scene);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
