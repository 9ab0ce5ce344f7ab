#include "plan_choice.h"

#include <algorithm>
#include <chrono>

#include "device_builder.h"
#include "gnomon/areas/areas_from_scene.h"
#include "gnomon/compare/words.h"
#include "numbers.h"
#include "options.h"

namespace gnomon::app {
namespace {

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

void add_regions(std::vector<PlanRays>& rays, const Scene& scene) {
  const std::vector<InfluenceArea> regions = bounded_areas_of_lights(scene);
  for (PlanRays& kind : rays) {
    if (kind.query == Query::kAny) kind.regions = regions;
  }
}

PlanOutcome plan_for(const PlanRequest& request, const PlanTask& task, const Progress& progress) {
  if (!request.instead.empty()) return no_plan(request, request.instead + " says which tree");
  if ((request.name.starts_with("light") || request.name == "local-rays") && !task.wide) {
    throw Error(ErrorCode::kInvalidArgument,
                "--plan " + request.name +
                    " is for trace and render through wide or packet, on a CPU: nothing else takes trees "
                    "whose boxes stand along the rays or that have local ones, and no file holds one");
  }
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
  how.light_space = task.wide;
  how.local_trees = task.wide;
  how.packets = task.packets;
  std::vector<PlanRays> rays = task.draw();
  if (task.wide) add_regions(rays, task.scene);
  out.plan = make_plan(task.scene.triangles, rays, how, device_builder(task.context), progress);
  out.chosen = choose_trees(*out.plan, rays, task.scene.triangles, task.plain.host, task.wanted, !by_name);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

bool has_slots(const cl::DeviceInfo& device, TraceFlavour flavour) {
  if (flavour != TraceFlavour::kAuto) return flavour != TraceFlavour::kThread;
  return device.is_cpu && device.loop_limit == 0;
}

bool traces_wide(const cl::DeviceInfo& device, TraceFlavour flavour) {
  return has_slots(device, flavour) && flavour != TraceFlavour::kCompact;
}

bool takes_packets(const cl::DeviceInfo& device, TraceFlavour flavour) {
  return traces_wide(device, flavour) && flavour != TraceFlavour::kWide;
}

void adopt(TimedBuild& build, const PlanTask& task, const PlanTree& tree) {
  build.fitted = true;
  // Of parts of triangles: checks are to know, and those who read the file.
  if (tree.tree.bvh.primitives.size() > task.scene.triangles.size()) build.options.builder = Builder::kBest;
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
