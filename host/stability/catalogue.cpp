#include "gnomon/stability/catalogue.h"

#include <algorithm>
#include <limits>
#include <string>

#include "gnomon/stability/cases.h"
#include "gnomon/stability/flavours.h"
#include "gnomon/tree/candidate_tree.h"

namespace gnomon::stability {

namespace {

// From here on the judge takes the tree.
constexpr std::size_t kManyTriangles = 4000;

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  add_ray_cases(cases);
  add_range_cases(cases);
  add_geometry_cases(cases);
  add_area_cases(cases);
  add_machine_cases(cases);
  return cases;
}

// Keeps the one of that name; of none, all.
template <typename Way>
std::vector<Way> chosen(std::vector<Way> ways, const std::string& name, const std::string& what) {
  if (name.empty()) return ways;
  std::string names;
  for (const Way& way : ways) {
    if (way.name == name) return {way};
    names += (names.empty() ? "" : ", ") + way.name;
  }
  throw Error(ErrorCode::kInvalidArgument,
              "stability: there is no " + what + " \"" + name + "\" on this device; there are " + names);
}

Bench bench_of(const cl::Context& context, const CatalogueOptions& options, const Progress& progress) {
  if (options.rays < 1 || options.rays > 1000000) {
    throw Error(ErrorCode::kInvalidArgument, "stability: rays must be 1 to 1000000");
  }
  return {context,
          chosen(builders(), options.builder, "builder"),
          chosen(flavours_of(context.device()), options.flavour, "flavour"),
          options.seed,
          options.rays,
          options.scenes,
          progress};
}

std::vector<Verdict> run_specimens(const Bench& bench, const Case& one) {
  std::vector<Verdict> all;
  const std::vector<Specimen> specimens = one.specimens(bench);
  for (const Builder& builder : bench.builders) {
    std::vector<Verdict> verdicts;
    for (const Flavour& flavour : bench.flavours)
      verdicts.push_back(empty_verdict(bench, one.info, builder.name, flavour.name));
    for (const Specimen& specimen : specimens) {
      judge_specimen(bench, specimen, build_device(bench.context, specimen.triangles, builder.options),
                     verdicts);
    }
    all.insert(all.end(), verdicts.begin(), verdicts.end());
  }
  return all;
}

bool wanted(const CatalogueOptions& options, std::uint32_t number) {
  return options.only.empty() ||
         std::find(options.only.begin(), options.only.end(), number) != options.only.end();
}

}  // namespace

Verdict empty_verdict(const Bench& bench, const CaseInfo& info, const std::string& builder,
                      const std::string& flavour) {
  Verdict verdict;
  verdict.info = info;
  verdict.builder = builder;
  verdict.flavour = flavour;
  verdict.exact = bench.context.device().fp64;
  verdict.most_ulp = verdict.exact ? kMostUlp : std::numeric_limits<double>::infinity();
  return verdict;
}

void judge_answers(const Specimen& specimen, std::span<const Hit> hits, std::span<const std::uint32_t> any,
                   std::uint64_t invalid_rays, Verdict& verdict) {
  OracleOptions options;
  options.max_rays = specimen.rays.size();
  options.time_budget = std::chrono::hours(24);
  options.pairs_of_floats = !verdict.exact;
  const CandidateTree tree(specimen.triangles.size() < kManyTriangles ? std::span<const Triangle>()
                                                                      : std::span(specimen.triangles));
  if (specimen.triangles.size() >= kManyTriangles) options.tree = &tree;
  const OracleReport report = judge(specimen.triangles, specimen.rays, hits, any, options);
  verdict.triangles += specimen.triangles.size();
  verdict.invalid_rays += invalid_rays;
  verdict.oracle.add(report);
  if (invalid_rays != specimen.invalid) {
    verdict.fault(std::to_string(invalid_rays) + " rays are refused, not " +
                  std::to_string(specimen.invalid));
  }
  if (specimen.in_order && report.ties > 0) {
    verdict.fault(std::to_string(report.ties) +
                  " rays name another triangle than the first of equally near ones");
  }
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const bool hit = hits[i].primitive != GN_NONE;
    if ((specimen.expect == Expect::kAllHit && !hit) ||
        (specimen.expect == Expect::kNoneHit && hit && verdict.exact))
      verdict.fault("ray " + std::to_string(i) + (hit ? " hits" : " misses"));
  }
}

void judge_specimen(const Bench& bench, const Specimen& specimen, const DeviceBvh& tree,
                    std::span<Verdict> verdicts) {
  for (std::size_t f = 0; f < bench.flavours.size(); ++f) {
    const Tracer tracer(bench.context, tree, bench.flavours[f].options);
    const TraceResult closest = tracer.closest(specimen.rays);
    const TraceResult any = tracer.any(specimen.rays);
    judge_answers(specimen, closest.hits, any.occluded, closest.invalid_rays, verdicts[f]);
    if (any.invalid_rays != closest.invalid_rays) verdicts[f].fault("any hit refuses other rays");
  }
}

std::vector<CaseInfo> catalogue() {
  std::vector<CaseInfo> infos;
  for (const Case& one : all_cases()) infos.push_back(one.info);
  return infos;
}

std::vector<Verdict> run_catalogue(const cl::Context& context, const CatalogueOptions& options,
                                   const Progress& progress) {
  const std::vector<Case> cases = all_cases();
  for (const std::uint32_t number : options.only) {
    if (std::none_of(cases.begin(), cases.end(), [&](const Case& c) { return c.info.number == number; }))
      throw Error(ErrorCode::kInvalidArgument, "stability: there is no case " + std::to_string(number) +
                                                   "; gnomon stability --list names them all");
  }
  const Bench bench = bench_of(context, options, progress);
  std::vector<Verdict> verdicts;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (!wanted(options, cases[i].info.number)) continue;
    report(progress, std::to_string(cases[i].info.number) + " " + cases[i].info.name,
           static_cast<double>(i) / static_cast<double>(cases.size()));
    const std::vector<Verdict> more =
        cases[i].check ? cases[i].check(bench, cases[i].info) : run_specimens(bench, cases[i]);
    verdicts.insert(verdicts.end(), more.begin(), more.end());
  }
  return verdicts;
}

std::vector<Specimen> specimens_of(const cl::Context& context, std::uint32_t number,
                                   const CatalogueOptions& options) {
  for (const Case& one : all_cases()) {
    if (one.info.number == number && one.specimens) return one.specimens(bench_of(context, options, {}));
  }
  return {};
}

}  // namespace gnomon::stability
