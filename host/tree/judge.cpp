// Compares a device's answers with the oracle's. A device rounds, so near tmin and tmax it may or may not see
// a hit: the judge asks the oracle for the hits that every correct device sees (safe: inside the range by
// more than the tolerance) and for those that some may see (possible: inside it when widened by the
// tolerance).
#include <algorithm>
#include <atomic>
#include <cassert>
#include <chrono>
#include <cmath>
#include <future>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "gnomon/tree/candidate_tree.h"
#include "gnomon/tree/candidates.h"
#include "gnomon/tree/exact_hit.h"
#include "gnomon/tree/pair_bound.h"

namespace gnomon {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint64_t kBundle =
    32;  // rays judged together: they share the copying of triangles into blocks
constexpr std::size_t kBadRaysKept = 16;

// Spacing of floats at t: that of the smallest normal below it (devices may flush), that of the largest
// beyond it.
double float_ulp(double t) {
  const double magnitude = std::fabs(t);
  if (magnitude > std::numeric_limits<float>::max()) return 0x1p104;
  if (magnitude < std::numeric_limits<float>::min()) return std::numeric_limits<float>::min();
  return std::ldexp(1.0, std::ilogb(magnitude) - 23);
}

struct Batch {
  std::span<const Triangle> triangles;
  std::span<const Ray> rays;
  std::span<const Hit> hits;
  std::span<const std::uint32_t> any;
  const OracleOptions& options;

  // Of what the device says of a triangle that this ray meets.
  [[nodiscard]] double tolerance(std::uint64_t index, const FoundHit& found) const {
    const double pairs = options.pairs_of_floats ? pair_error_bound(rays[index], *found.triangle) : 0.0;
    return options.t_tolerance_ulp * float_ulp(found.hit.t) + found.hit.t_error + pairs;
  }
};

// What the triangles say about one ray, gathered over all candidates.
struct Findings {
  bool hit = false;  // some exact t lies in the range
  FoundHit safe;     // closest safe hit
  std::uint32_t safe_primitive = GN_NONE;
  double nearest_doubtful = kInfinity;  // t of the closest hit that is possible but not safe
  bool reported_t_exists = false;       // some possible hit is where the device reports one

  [[nodiscard]] bool has_safe() const { return safe.triangle != nullptr; }
  [[nodiscard]] bool has_doubtful() const { return nearest_doubtful < kInfinity; }
  // Whether correct devices may differ about the closest hit.
  [[nodiscard]] bool is_ambiguous() const {
    return has_doubtful() && (!has_safe() || nearest_doubtful <= safe.hit.t);
  }
};

bool is_possible(const Ray& ray, const ExactHit& hit, double tolerance) {
  const FiniteRange range(ray);
  return hit.t >= range.tmin - tolerance && hit.t <= range.tmax + tolerance;
}

bool is_safe(const Ray& ray, const ExactHit& hit, double tolerance) {
  const FiniteRange range(ray);
  return hit.t >= range.tmin + tolerance && hit.t <= range.tmax - tolerance;
}

// Whether a hit is nearer than the closest safe one so far, or as near with a lower number: triangles come in
// any order.
bool comes_first(const Ray& ray, const FoundHit& found, std::uint32_t primitive, const Findings& findings) {
  if (nearer(ray, found, findings.safe)) return true;
  return primitive < findings.safe_primitive && !nearer(ray, findings.safe, found);
}

void gather(const Batch& batch, std::uint64_t index, std::uint32_t primitive, Findings& findings) {
  const Ray& ray = batch.rays[index];
  const FoundHit found{&batch.triangles[primitive], exact_intersect(ray, batch.triangles[primitive])};
  if (!found.hit.inside) return;
  const double tolerance = batch.tolerance(index, found);
  if (!is_possible(ray, found.hit, tolerance)) return;
  findings.hit = findings.hit || in_range(ray, found);
  if (!batch.hits.empty() && std::fabs(batch.hits[index].t - found.hit.t) <= tolerance) {
    findings.reported_t_exists = true;
  }
  if (!is_safe(ray, found.hit, tolerance)) {
    findings.nearest_doubtful = std::min(findings.nearest_doubtful, found.hit.t);
  } else if (!findings.has_safe() || comes_first(ray, found, primitive, findings)) {
    findings.safe = found;
    findings.safe_primitive = primitive;
  }
}

// The counter a wrong answer goes to; null: the answer stands.
using Fault = std::uint64_t OracleReport::*;

Fault fault_of_closest(const Batch& batch, std::uint64_t index, const Findings& findings) {
  const Hit& reported = batch.hits[index];
  if (reported.primitive == GN_NONE) return findings.has_safe() ? &OracleReport::lost : nullptr;
  if (reported.primitive >= batch.triangles.size()) return &OracleReport::wrong_primitive;
  if (findings.has_safe() && reported.t > findings.safe.hit.t + batch.tolerance(index, findings.safe)) {
    return &OracleReport::lost;
  }
  if (!findings.reported_t_exists) return &OracleReport::false_hits;
  const Triangle& triangle = batch.triangles[reported.primitive];
  const ExactHit named = exact_intersect(batch.rays[index], triangle);
  const double tolerance = batch.tolerance(index, {&triangle, named});
  const bool there = named.inside && std::fabs(reported.t - named.t) <= tolerance &&
                     is_possible(batch.rays[index], named, tolerance);
  return there ? nullptr : &OracleReport::wrong_primitive;
}

Fault fault_of_any(bool reported, const Findings& findings) {
  if (findings.has_safe()) return reported ? nullptr : &OracleReport::lost;
  return reported && !findings.has_doubtful() ? &OracleReport::false_hits : nullptr;
}

// How exact a hit that stands is. A NaN in u or v is an error without bound.
void measure(const Hit& reported, const ExactHit& exact, OracleReport& report) {
  const double t_error = std::fabs(reported.t - exact.t) / float_ulp(exact.t);
  report.max_t_error_ulp = std::max(report.max_t_error_ulp, t_error);
  report.t_errors.add(t_error);
  for (const double error : {std::fabs(reported.u - exact.u), std::fabs(reported.v - exact.v)}) {
    report.max_uv_error = std::max(report.max_uv_error, std::isnan(error) ? kInfinity : error);
  }
}

// Books a closest-hit answer that stands.
void accept_closest(const Batch& batch, std::uint64_t index, const Findings& findings, OracleReport& report) {
  const Hit& reported = batch.hits[index];
  const bool hit = reported.primitive != GN_NONE;
  if (hit) measure(reported, exact_intersect(batch.rays[index], batch.triangles[reported.primitive]), report);
  if (findings.is_ambiguous()) {
    report.range_ambiguous += 1;
    if (hit != findings.hit) report.range_rounded += 1;
  } else if (hit && reported.primitive != findings.safe_primitive) {
    report.ties += 1;
  }
}

// With both answers at hand the any-hit is held against the closest hit, itself judged: one fault, one count.
void judge_ray(const Batch& batch, std::uint64_t index, const Findings& findings, OracleReport& report) {
  report.rays_judged += 1;
  if (findings.hit) report.hits += 1;
  Fault fault = nullptr;
  if (!batch.hits.empty()) {
    fault = fault_of_closest(batch, index, findings);
    if (fault == nullptr) accept_closest(batch, index, findings, report);
  } else if (!batch.any.empty()) {
    fault = fault_of_any(batch.any[index] != 0, findings);
    if (fault == nullptr && findings.has_doubtful() && !findings.has_safe()) {
      report.range_ambiguous += 1;
      if ((batch.any[index] != 0) != findings.hit) report.range_rounded += 1;
    }
  }
  if (fault != nullptr) report.*fault += 1;
  const bool disagree = !batch.hits.empty() && !batch.any.empty() &&
                        (batch.any[index] != 0) != (batch.hits[index].primitive != GN_NONE);
  if (disagree) report.any_closest_disagree += 1;
  if (fault != nullptr || disagree) report.bad_rays.push_back(index);
}

// An evenly strided sample of the batch, cut into bundles that are each spread over the whole of it: whatever
// prefix of bundles the budget allows is an even sample too.
struct Sample {
  std::uint64_t given;
  std::uint64_t taken;
  std::uint64_t bundles;

  // At least as many bundles as threads, where there are rays enough.
  Sample(std::uint64_t rays, std::uint64_t limit, std::uint64_t threads)
      : given(rays),
        taken(std::min(rays, limit)),
        bundles(std::max((taken + kBundle - 1) / kBundle, std::min(taken, threads))) {}

  // place * given / taken without overflow (taken below 2^32).
  [[nodiscard]] std::uint64_t ray(std::uint64_t place) const {
    return place * (given / taken) + place * (given % taken) / taken;
  }
};

// An end of a range moved by more than the tolerance of any t near it.
double widened(double end, double outwards, double tolerance_ulp) {
  return std::isinf(end) ? end : end + outwards * 2.0 * (tolerance_ulp + 1.0) * float_ulp(end);
}

// One ray by the tree: no farther than the closest safe hit, as nothing behind that counts.
void judge_by_tree(const Batch& batch, std::uint64_t index, OracleReport& report) {
  const Ray& ray = batch.rays[index];
  const double tolerance = batch.options.t_tolerance_ulp;
  const FiniteRange range(ray);
  // How far off pairs of floats are is known of each triangle only.
  const bool pairs = batch.options.pairs_of_floats;
  const double tmin = pairs ? -kInfinity : widened(range.tmin, -1.0, tolerance);
  const double tmax = pairs ? kInfinity : widened(range.tmax, 1.0, tolerance);
  Findings findings;
  batch.options.tree->visit(ray, tmin, tmax, [&](std::uint32_t primitive) {
    gather(batch, index, primitive, findings);
    return findings.has_safe() && !pairs ? widened(findings.safe.hit.t, 1.0, tolerance) : tmax;
  });
  judge_ray(batch, index, findings, report);
}

void judge_bundle(const Batch& batch, const Sample& sample, std::uint64_t bundle, OracleReport& report) {
  std::vector<std::uint64_t> indices;
  std::vector<LineFilter> filters;
  std::vector<Findings> findings;
  for (std::uint64_t place = bundle; place < sample.taken; place += sample.bundles) {
    const std::uint64_t index = sample.ray(place);
    if (!is_traceable(batch.rays[index])) {
      judge_ray(batch, index, Findings{}, report);
    } else if (batch.options.tree != nullptr) {
      judge_by_tree(batch, index, report);
    } else {
      indices.push_back(index);
      filters.emplace_back(batch.rays[index]);
    }
  }
  if (indices.empty()) return;
  findings.resize(indices.size());
  visit_candidates(filters, batch.triangles, [&](std::size_t slot, std::uint32_t primitive) {
    gather(batch, indices[slot], primitive, findings[slot]);
  });
  for (std::size_t slot = 0; slot < indices.size(); ++slot) {
    judge_ray(batch, indices[slot], findings[slot], report);
  }
}

// Where the threads meet: each takes the next bundle until none is left, time is up or someone stops them.
struct Shared {
  std::atomic<std::uint64_t> next{0};
  std::atomic<bool> stop{false};
  Clock::time_point start = Clock::now();
};

// Judges bundles until there are none. Calls progress only where it is given one: on the caller's own thread.
OracleReport work(const Batch& batch, const Sample& sample, Shared& shared, const Progress& progress) {
  OracleReport part;
  while (!shared.stop) {
    if (std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - shared.start) >=
        batch.options.time_budget) {
      break;
    }
    const std::uint64_t bundle = shared.next.fetch_add(1);
    if (bundle >= sample.bundles) break;
    judge_bundle(batch, sample, bundle, part);
    gnomon::report(progress, "oracle", static_cast<double>(bundle + 1) / static_cast<double>(sample.bundles));
  }
  return part;
}

void require_length(std::size_t given, std::size_t rays, const char* what) {
  if (given == 0 || given == rays) return;
  throw Error(ErrorCode::kInvalidArgument,
              "oracle: " + std::to_string(given) + " " + what + " for " + std::to_string(rays) + " rays");
}

}  // namespace

OracleReport judge(std::span<const Triangle> triangles, std::span<const Ray> rays, std::span<const Hit> hits,
                   std::span<const std::uint32_t> any, const OracleOptions& options,
                   const Progress& progress) {
  assert(triangles.size() < GN_NONE);
  require_length(hits.size(), rays.size(), "closest hits");
  require_length(any.size(), rays.size(), "any-hit answers");
  const Batch batch{triangles, rays, hits, any, options};
  const unsigned threads =
      std::max(1U, options.threads != 0 ? options.threads : std::thread::hardware_concurrency());
  const Sample sample(rays.size(), options.max_rays, threads);
  Shared shared;
  std::vector<std::future<OracleReport>> helpers;  // a future of std::async waits for its thread when it goes
  OracleReport report;
  try {
    for (std::uint64_t i = 1; i < std::min<std::uint64_t>(threads, sample.bundles); ++i) {
      helpers.push_back(std::async(std::launch::async, [&] { return work(batch, sample, shared, {}); }));
    }
    report = work(batch, sample, shared, progress);
    for (std::future<OracleReport>& helper : helpers) report.add(helper.get());
  } catch (...) {
    shared.stop = true;
    throw;
  }
  report.rays_given = rays.size();
  report.budget_exhausted = report.rays_judged < sample.taken;
  std::sort(report.bad_rays.begin(), report.bad_rays.end());
  if (report.bad_rays.size() > kBadRaysKept) report.bad_rays.resize(kBadRaysKept);
  gnomon::report(progress, "oracle", 1.0);
  return report;
}

}  // namespace gnomon
