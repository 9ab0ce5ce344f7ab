#include "plan_rays.h"

#include <algorithm>
#include <cmath>

#include "gnomon/compare/words.h"
#include "gnomon/device/trace_device.h"
#include "numbers.h"
#include "options.h"
#include "ray_batch.h"
#include "table.h"

namespace gnomon::app {

namespace {

// As many as plans can take and a race can want; kinds that need hits get fewer than they ask for.
constexpr std::uint64_t kDrawnRays = 4096;

// What a tree that is kept gains; else why none is.
std::string reason_of(const Decision& decision, const std::string& baseline) {
  const auto kept = std::find_if(decision.trials.begin(), decision.trials.end(),
                                 [&](const Trial& trial) { return trial.name == decision.kept; });
  if (kept == decision.trials.end() || !(kept->price > 0.0) || !(decision.baseline_cost > 0.0))
    return decision.reason;
  return fixed(100.0 * (1.0 - kept->standing.cost / kept->standing.baseline), 1) +
         " % less work a ray than " + baseline + "'s, by rays drawn apart; over " +
         compare::count_text(decision.expected) + " rays that saves " +
         compare::significant(kept->saving / kept->price) + " times what the tree takes to make";
}

// Regions that leave triangles out, and whether they have trees of their own.
std::string local_trees(const Decision& decision) {
  std::string text;
  for (const LocalUse& use : decision.local) {
    text += (text.empty() ? "  with trees of their own for " : "; ") + fixed(100.0 * use.share, 0) +
            " % of the rays over " + compare::count_text(static_cast<double>(use.triangles)) + " triangles";
  }
  return text.empty() ? text : text + "\n";
}

}  // namespace

const char* const kPlanHelp =
    "Trees to choose from:\n"
    "  sah        three axes, surface area, subtrees moved; near child first: the baseline\n"
    "  best       the same over parts of the triangles that waste much: the baseline where there are any\n"
    "  sah-order  the same tree; any hit looks first where sampled rays were stopped for the least work\n"
    "  sah-mix    subtrees moved on, by surface area mixed with how the rays see boxes\n"
    "  sah-rays   and then by sampled rays\n"
    "  sah-segments  the same, many moves at a time, by the device: for GPUs; on CPUs some 25 times as long\n"
    "  sah-seen   subtrees moved on by what the bundles and pencils found in the rays see of boxes, less "
    "where "
    "it is hidden;\n"
    "             takes some 30 times as long as moves by surface area\n"
    "  seen-rays  and then by sampled rays\n"
    "  mix        built by that mixture from the start\n"
    "  mix-rays   and then by sampled rays\n"
    "  light-mix  as mix, with boxes that stand along the rays: for a sun oblique to the scene; on CPUs "
    "alone\n"
    "  light-rays and then by sampled rays\n"
    "  best-order, best-rays  as sah-order and sah-rays, of best\n"
    "  local-rays  sah-rays, and a tree of its own for rays that stay where few of the triangles are, in a "
    "spot light's\n"
    "             cone say; on CPUs alone\n"
    "All but sah and best have the learnt order for any hit. auto tries them on rays drawn apart, keeps one "
    "that is surely\n"
    "2 % cheaper than the baseline and repays its price over the rays to come, and else keeps the baseline. "
    "Costs are counts,\n"
    "1.0 a box and 1.2 a triangle, in the binary tree: the same plan on every machine. In the table, price "
    "is "
    "what making the\n"
    "tree takes beside the baseline, in box tests; saves is what it saves over all rays to come "
    "(--expect).\n";

PlanRays rays_to_plan_for(RayKind kind, const Scene& scene, const cl::Context& context, const DeviceBvh& tree,
                          double expected, std::uint64_t seed, const Progress& progress) {
  const Tracer tracer(context, tree);
  PlanRays out;
  out.name = std::string(to_string(kind));
  out.query = asks_any_hit(kind) ? Query::kAny : Query::kClosest;
  out.fit = make_rays(kind, scene, tracer, kDrawnRays, seed + 1, progress);
  out.probe = make_rays(kind, scene, tracer, kDrawnRays, seed + 2, progress);
  out.expected = expected;
  out.together = run_together(kind, scene);
  return out;
}

PlanRays rays_to_plan_for(const std::string& name, Query query, std::span<const Ray> recorded,
                          double expected) {
  PlanRays out{name, query, {}, {}, expected};
  for (std::size_t i = 0; i < recorded.size(); ++i) (i % 2 == 0 ? out.fit : out.probe).push_back(recorded[i]);
  return out;
}

std::string plan_table(const Plan& plan) {
  const auto count_text = [](double count) {
    return (count < 0.0 ? "-" : "") + compare::count_text(std::fabs(count));
  };
  std::string text;
  const std::string& baseline = plan.trees.front().name;
  for (const Decision& decision : plan.decisions) {
    text += decision.rays + " rays, " + (decision.query == Query::kAny ? "any hit" : "closest hit") + ": " +
            decision.kept + "\n  " + reason_of(decision, baseline) + "\n";
    text += local_trees(decision);
    if (decision.trials.empty()) continue;
    Table table({"tree", "cost a ray", "of " + baseline, "+-", "probes", "verdict", "price", "saves"});
    table.add({baseline, fixed(decision.baseline_cost, 2), "1.000", "", std::to_string(decision.probes), "",
               "", ""});
    for (const Trial& trial : decision.trials) {
      const double base = trial.standing.baseline;
      const auto of_base = [&](double value) {
        return base > 0.0 ? fixed(value / base, 3) : std::string("-");
      };
      table.add({trial.name, fixed(trial.standing.cost, 2), of_base(trial.standing.cost),
                 of_base(trial.standing.error), std::to_string(trial.standing.rays),
                 to_string(trial.standing.verdict), count_text(trial.price), count_text(trial.saving)});
    }
    text += table.text();
  }
  const double share = plan.baseline_units > 0.0 ? plan.planning_units / plan.baseline_units : 0.0;
  return text + "costs, prices and what is saved are in box tests\nplanning took " + fixed(share, 2) +
         " of the work of building " + baseline + "\n";
}

void add_expected_rays(CLI::App& command, std::uint64_t& expected) {
  add_count(command, "--expect", expected, "rays of a kind to come, that a tree must repay itself over");
}

}  // namespace gnomon::app
