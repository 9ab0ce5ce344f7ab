#include "plan_choice.h"

#include <algorithm>
#include <chrono>

#include "gnomon/compare/words.h"
#include "numbers.h"
#include "options.h"
#include "plan_rays.h"

namespace gnomon::app {
namespace {

double mean_cost(const OrderedTree& tree, const Scene& scene, std::span<const Ray> rays, Query query) {
  const std::vector<double> costs = ray_costs(tree, scene.triangles, rays, query);
  double sum = 0.0;
  for (const double cost : costs) sum += cost;
  return costs.empty() ? 0.0 : sum / static_cast<double>(costs.size());
}

double saving(double cost, double plain) {
  return plain > 0.0 ? 1.0 - cost / plain : 0.0;
}

// As many as a race sees at most.
constexpr std::uint64_t kCounted = 1024;

// Rays that one tree is chosen for.
struct Part {
  std::vector<Ray> fit, probe;
  Query query;
  double expected;
};

struct Cost {
  double fit = 0.0;
  double probe = 0.0;
};

Cost cost_of(const OrderedTree& tree, const Scene& scene, std::span<const Part> parts) {
  Cost sum;
  for (const Part& part : parts) {
    sum.fit += part.expected * mean_cost(tree, scene, part.fit, part.query);
    sum.probe += part.expected * mean_cost(tree, scene, part.probe, part.query);
  }
  return sum;
}

Part part_of(const PlanRays& rays) {
  return {thinned(rays.fit, kCounted), thinned(rays.probe, kCounted), rays.query, rays.expected};
}

// Chooses among some trees of the plan and, with auto, the plain one.
ChosenTree choose(const std::string& rays, const Plan& plan, const std::vector<OrderedTree>& trees,
                  std::span<const std::size_t> open, const PlanTask& task, std::span<const Part> parts,
                  bool or_plain) {
  const Cost plain = cost_of({task.plain.host, {}}, task.scene, parts);
  ChosenTree best{rays, std::nullopt, "plain", 0.0, 0.0};
  Cost least = plain;
  for (const std::size_t i : open) {
    const Cost cost = cost_of(trees[i], task.scene, parts);
    if (best.tree ? cost.probe >= least.probe : or_plain && cost.probe >= plain.probe) continue;
    least = cost;
    best.tree = i;
    best.name = plan.trees[i].name;
  }
  best.predicted = saving(least.fit, plain.fit);
  best.measured = saving(least.probe, plain.probe);
  return best;
}

std::vector<ChosenTree> choices(const Plan& plan, std::span<const PlanRays> rays, const PlanTask& task,
                                bool by_name) {
  std::vector<OrderedTree> trees;
  for (const PlanTree& tree : plan.trees)
    trees.push_back(task.wanted == TreesWanted::kOneForAll ? OrderedTree{tree.tree.bvh, {}} : tree.tree);
  std::vector<Part> parts;
  for (const PlanRays& some : rays) parts.push_back(part_of(some));
  std::vector<ChosenTree> out;
  if (task.wanted == TreesWanted::kOneForAll) {
    std::vector<std::size_t> open;
    for (std::size_t i = by_name && trees.size() > 1 ? 1 : 0; i < trees.size(); ++i) open.push_back(i);
    out.push_back(choose("all", plan, trees, open, task, parts, !by_name));
    return out;
  }
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::size_t kept = plan.decisions[i].tree;
    out.push_back(
        choose(rays[i].name, plan, trees, std::span(&kept, 1), task, std::span(&parts[i], 1), !by_name));
  }
  return out;
}

std::string percent(double share) {
  return fixed(100.0 * share, 1) + " %";
}

std::string most_share() {
  return fixed(100.0 * OutlookOptions().most_share, 0) + " %";
}

// Why planning is not even tried.
std::string too_few(const PlanTask& task, const Outlook& outlook) {
  double rays = 0.0;
  for (const RaysToCome& kind : task.to_come) rays += kind.expected;
  const std::string counted = task.counted.empty() ? "" : " (" + task.counted + ")";
  std::string text =
      "too few rays to come, " + compare::count_text(rays) + counted + ": planning would take ";
  if (outlook.price < outlook.work) {
    text += compare::significant(100.0 * outlook.price / outlook.work, 2) + " % of";
  } else {
    text += compare::count_text(outlook.price / std::max(1.0, outlook.work)) + " times";
  }
  return text + " their work, more than " + most_share();
}

}  // namespace

void PlanRequest::check() const {
  PlanOptions how;
  how.choice = name;
  how.check();
}

void add_plan_options(CLI::App& command, PlanRequest& request, const std::string& expect_help) {
  const char* const group = "Plan";
  CLI::Option* const plan =
      command
          .add_option(
              "--plan", request.name,
              "auto: a tree fitted to these rays where that surely pays, else the plain one; or a tree "
              "by name, without a test (gnomon plan --help). Options that say which tree leave no plan")
          ->type_name("NAME")
          ->group(group)
          ->capture_default_str();
  for (CLI::Option* const other : command.get_options()) {
    if (other->get_group() == kTreeGroup || other->get_group() == kRaysGroup) plan->excludes(other);
  }
  add_count(command, "--expect", request.expected, expect_help)->group(group)->default_str("");
}

void settle(const CLI::App& command, PlanRequest& request) {
  request.asked = command.get_option("--plan")->count() > 0;
  for (const CLI::Option* const option : command.get_options()) {
    const bool says_which = option->get_group() == kTreeGroup || option->get_group() == kRaysGroup;
    if (says_which && option->count() > 0 && request.instead.empty()) request.instead = option->get_name();
  }
}

const PlanTree* PlanOutcome::tree(std::size_t chosen_place) const {
  if (!plan || !chosen[chosen_place].tree) return nullptr;
  return &plan->trees[*chosen[chosen_place].tree];
}

PlanOutcome no_plan(const PlanRequest& request, const std::string& reason) {
  PlanOutcome out;
  if (request.instead.empty()) out.asked = request.name;
  out.reason = reason;
  return out;
}

PlanOutcome plan_for(const PlanRequest& request, const PlanTask& task, const Progress& progress) {
  if (!request.instead.empty()) return no_plan(request, request.instead + " says which tree");
  PlanOutcome out;
  out.asked = request.name;
  const bool by_name = request.name != "auto";
  if (!by_name) {
    out.outlook = outlook_of(task.plain.host, task.scene.triangles, task.to_come);
    if (!out.outlook->pays) {
      out.reason = too_few(task, *out.outlook);
      return out;
    }
  }
  const auto start = std::chrono::steady_clock::now();
  PlanOptions how;
  how.choice = request.name;
  const std::vector<PlanRays> rays = task.draw();
  out.plan = make_plan(task.scene.triangles, rays, how, device_builder(task.context), progress);
  out.chosen = choices(*out.plan, rays, task, by_name);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

bool has_slots(const cl::DeviceInfo& device, TraceFlavour flavour) {
  if (flavour != TraceFlavour::kAuto) return flavour != TraceFlavour::kThread;
  return device.is_cpu && device.loop_limit == 0;
}

void adopt(TimedBuild& build, const PlanTask& task, const PlanTree& tree) {
  build.host = tree.tree.bvh;
  build.tree = upload_bvh(task.context, build.host, task.scene.triangles);
  build.hash = tree_hash(build.host);
  build.stats = stats_of(build.host, build.options);
}

void add_plan(Json& document, const PlanOutcome& outcome) {
  document["options"]["plan"] = outcome.asked.empty() ? Json(nullptr) : Json(outcome.asked);
  Json chosen = Json::array();
  for (const ChosenTree& one : outcome.chosen) {
    chosen.push_back({{"rays", one.rays},
                      {"tree", one.name},
                      {"predicted_saving", one.predicted},
                      {"measured_saving", one.measured}});
  }
  Json plan = {{"made", outcome.plan.has_value()},
               {"reason", outcome.reason},
               {"work_units", outcome.outlook ? Json(outcome.outlook->work) : Json(nullptr)},
               {"price_units", outcome.outlook ? Json(outcome.outlook->price) : Json(nullptr)},
               {"seconds", outcome.seconds},
               {"chosen", chosen},
               {"trees", Json::array()},
               {"decisions", Json::array()}};
  if (outcome.plan) plan.update(Json::parse(to_json(*outcome.plan)));
  document["plan"] = std::move(plan);
}

std::string explain_plans() {
  return "A plan is a tree fitted to a sample of the rays to come (--expect says how many). It is made "
         "where, "
         "as\nreckoned beforehand, planning takes at most " +
         most_share() + " of their work. Work is counted, not timed: 1.0 a\nbox tested, 1.2 a triangle.\n";
}

std::string describe(const PlanOutcome& outcome) {
  if (outcome.asked.empty()) return "none: " + outcome.reason;
  if (!outcome.plan) return "none, the plain tree: " + outcome.reason;
  std::string text;
  for (const ChosenTree& one : outcome.chosen) {
    text += (text.empty() ? "" : "; ") + one.rays + " rays: " + one.name;
    if (one.tree) {
      text += ", " + percent(one.measured) + " less work than the plain tree's on probe rays (predicted " +
              percent(one.predicted) + ")";
    }
  }
  return text + "; planning took " + fixed(outcome.seconds, 2) + " s";
}

}  // namespace gnomon::app
