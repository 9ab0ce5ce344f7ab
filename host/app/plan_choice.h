// --plan: which tree a subcommand uses, the plain one of its build options or one fitted to its rays, and
// what came of the choice. Feeds the subcommands that build, trace and render.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "build_timing.h"
#include "console.h"
#include "gnomon/device/trace_device.h"
#include "gnomon/plan/chosen_trees.h"
#include "gnomon/plan/outlook.h"

namespace gnomon::app {

struct PlanRequest {
  std::string name = "auto";   // of PlanOptions::choice
  std::uint64_t expected = 0;  // rays to come; 0: those that the run itself traces
  bool asked = false;          // --plan was given
  std::string instead;         // an option that was given and says itself which tree; empty: none

  // Throws Error{kInvalidArgument}: no such tree.
  void check() const;
};

// --plan and --expect. After the options that name a tree, which --plan excludes. expect_help: what is
// reckoned with where it is not given.
void add_plan_options(CLI::App& command, PlanRequest& request, const std::string& expect_help);
// What was given; once the command line is parsed.
void settle(const CLI::App& command, PlanRequest& request);

struct PlanOutcome {
  std::string asked;               // empty: another option says which tree
  std::string reason;              // why there is no plan; empty where there is one
  std::optional<Outlook> outlook;  // where it was looked at
  std::optional<Plan> plan;
  std::vector<ChosenTree> chosen;  // one for each kind of rays, or one for all; none without a plan
  double seconds = 0.0;            // that planning took, wall clock

  // What is to be traced instead of the plain tree; null: that one.
  [[nodiscard]] const PlanTree* tree(std::size_t chosen_place) const;
};

struct PlanTask {
  const cl::Context& context;
  const Scene& scene;
  const TimedBuild& plain;
  std::vector<RaysToCome> to_come;
  std::string counted{};  // what they are, where their number alone puzzles: "1000 in each of 7 passes"
  // Rays to fit to and to judge by; asked for once it is clear that planning can pay.
  std::function<std::vector<PlanRays>()> draw;
  TreesWanted wanted = TreesWanted::kOneEach;
  // The tracer takes trees whose boxes stand along the rays, and trees with local ones.
  bool wide = false;
  bool packets = false;  // and rays that run together in packets
};

// Tells rays that ask lights where those shine.
void add_regions(std::vector<PlanRays>& rays, const Scene& scene);

// Plans where that can pay, or must since a tree was asked for by name. With auto what is kept costs probes
// less than the plain tree. One tree for all rays has no learnt order. Throws as make_plan.
[[nodiscard]] PlanOutcome plan_for(const PlanRequest& request, const PlanTask& task,
                                   const Progress& progress);
// No plan: `reason` says why.
[[nodiscard]] PlanOutcome no_plan(const PlanRequest& request, const std::string& reason);

// Whether a tracer of this flavour has slots, and so an order that can be learnt: the binary tree has none.
[[nodiscard]] bool has_slots(const cl::DeviceInfo& device, TraceFlavour flavour);

// Whether a tracer of this flavour takes trees whose boxes stand along the rays, and trees with local ones:
// wide or packet.
[[nodiscard]] bool traces_wide(const cl::DeviceInfo& device, TraceFlavour flavour);

// Whether it takes rays that run together in packets.
[[nodiscard]] bool takes_packets(const cl::DeviceInfo& device, TraceFlavour flavour);

// Makes `build` be of this tree: what took how long stays the plain tree's.
void adopt(TimedBuild& build, const PlanTask& task, const PlanTree& tree);

// "options"/"plan", null where another option says which tree, and "plan" with every decision.
void add_plan(Json& document, const PlanOutcome& outcome);
// A line or two for people.
[[nodiscard]] std::string describe(const PlanOutcome& outcome);

// When a plan is made and in which work it reckons; for the footer of --help.
[[nodiscard]] std::string explain_plans();

}  // namespace gnomon::app
