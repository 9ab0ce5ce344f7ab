// The numbered cases, by what they are about. Each makes its specimens anew from a seed. Feeds catalogue.cpp.
#pragma once

#include <functional>
#include <vector>

#include "gnomon/device/trace_areas.h"
#include "gnomon/scene/scene.h"
#include "gnomon/stability/case.h"

namespace gnomon::stability {

// A way to build and ways to trace: every case goes through all of them.
struct Builder {
  std::string name;
  BuildOptions options;
};
struct Flavour {
  std::string name;
  TraceOptions options;
};

// What a case is run with.
struct Bench {
  const cl::Context& context;
  std::vector<Builder> builders;
  std::vector<Flavour> flavours;
  std::uint64_t seed = 1;
  std::uint32_t rays = 256;   // of one kind on one specimen, about
  std::vector<Scene> scenes;  // given by the user
  Progress progress;
};

// Specimens to build, trace and judge; or checks of its own.
struct Case {
  CaseInfo info;
  std::function<std::vector<Specimen>(const Bench&)> specimens;
  std::function<std::vector<Verdict>(const Bench&, const CaseInfo&)> check;
};

void add_ray_cases(std::vector<Case>& cases);       // 1 to 11
void add_range_cases(std::vector<Case>& cases);     // 12 to 19
void add_geometry_cases(std::vector<Case>& cases);  // 21 to 39
void add_area_cases(std::vector<Case>& cases);      // 41 to 59
void add_machine_cases(std::vector<Case>& cases);   // 61 to 69

// Of t, in ulp: what exact-hits.md promises where there is double. Elsewhere the judge knows each hit's
// bound.
inline constexpr double kMostUlp = 0.5625;

// A soup of so many triangles in a hill, and rays that have their corners and middles of edges exactly: what
// is compared bit for bit, at other scales and on other machines.
[[nodiscard]] Specimen soup_and_hill(const Bench& bench, unsigned triangles);

// Checks of the geometry group that need more than specimens.
[[nodiscard]] std::vector<Verdict> check_scales(const Bench& bench, const CaseInfo& info);
[[nodiscard]] std::vector<Verdict> check_indices(const Bench& bench, const CaseInfo& info);

// Traces a specimen by every flavour through a tree, judges, and adds what came of it to the flavours'
// verdicts.
void judge_specimen(const Bench& bench, const Specimen& specimen, const DeviceBvh& tree,
                    std::span<Verdict> verdicts);
// The same for answers at hand.
void judge_answers(const Specimen& specimen, std::span<const Hit> hits, std::span<const std::uint32_t> any,
                   std::uint64_t invalid_rays, Verdict& verdict);
[[nodiscard]] Verdict empty_verdict(const Bench& bench, const CaseInfo& info, const std::string& builder,
                                    const std::string& flavour);

}  // namespace gnomon::stability
