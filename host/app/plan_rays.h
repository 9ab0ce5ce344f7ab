// The rays a plan is made for, and what it says: what `plan` and --plan share.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "gnomon/device/build_device.h"
#include "gnomon/plan/choose.h"
#include "gnomon/scene/ray_set.h"

namespace gnomon::app {

// Rays of a kind that a scene's camera and lights give: fitted to those of seed + 1, judged by those of seed
// + 2, so that neither are the rays of `seed`. `tree` finds where rays start that need hits.
[[nodiscard]] PlanRays rays_to_plan_for(RayKind kind, const Scene& scene, const cl::Context& context,
                                        const DeviceBvh& tree, double expected, std::uint64_t seed,
                                        const Progress& progress);

// Recorded rays: every other one is fitted to, the rest judge.
[[nodiscard]] PlanRays rays_to_plan_for(const std::string& name, Query query, std::span<const Ray> recorded,
                                        double expected);

// The decisions, for people.
[[nodiscard]] std::string plan_table(const Plan& plan);

// "--expect": rays that a tree must repay itself over.
void add_expected_rays(CLI::App& command, std::uint64_t& expected);

// For the footer of --help.
extern const char* const kPlanHelp;

}  // namespace gnomon::app
