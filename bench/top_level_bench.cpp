// How fast are the areas of a point found, and how many candidates are false? The thesis' random areas and
// points, by list, tree and octree, on the host and on the device. One JSON row per structure on stdout.
//   top_level_bench [AREAS LEVELS]...   octree levels 4..LEVELS; default: 4 7 10 7 20 9 40 7 80 7
#include <ctime>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "arguments.h"
#include "gnomon/areas/shared_area.h"
#include "gnomon/base/stats.h"
#include "gnomon/device/find_areas.h"
#include "gnomon/scene/steady_random.h"
#include "gnomon_commit.h"

namespace {

using gnomon::AreaLookup;
using gnomon::InfluenceArea;
using gnomon::SteadyRandom;
using gnomon::TopLevel;
using gnomon::Vec3d;
using nlohmann::json;

constexpr const char* kHelp =
    "top_level_bench: how fast the areas of a point are found, and how many candidates are false\n\n"
    "  top_level_bench [AREAS LEVELS]...\n\n"
    "The thesis' random areas and points, by list, tree and octree, on the host and on the device, one "
    "thread, processor\n"
    "time. One JSON row a structure on stdout.\n\n"
    "  AREAS    how many; LEVELS: the octree's deepest, from 4 up; default: 4 7 10 7 20 9 40 7 80 7\n\n"
    "GNOMON_DEVICE chooses another device.\n"
    "Example:  top_level_bench 4 5\n";
constexpr int kRounds = 7;
constexpr std::size_t kQueries = 65536;
constexpr std::uint64_t kSeed = 1;
constexpr std::uint32_t kFirstLevel = 4;

// CPU time of all threads: time lost to other processes does not count.
double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Vec3d point_in(SteadyRandom& random, const Vec3d& lo, const Vec3d& hi) {
  Vec3d p{};
  for (std::size_t k = 0; k < 3; ++k) p[k] = random.between(lo[k], hi[k]);
  return p;
}

// configs.json, octree_vs_aabbs_benchmark: half plane, half point areas.
std::vector<InfluenceArea> thesis_areas(std::uint32_t count) {
  std::vector<InfluenceArea> areas;
  for (std::uint32_t i = 0; i < count; ++i) {
    SteadyRandom random(kSeed, i);
    const Vec3d place = point_in(random, {2, 2, 2}, {6, 6, 6});
    const Vec3d direction = point_in(random, {-1, -1, -1}, {1, 1, 1});
    if (i % 2 == 0) {
      gnomon::PlaneWindow window;
      window.point = place;
      window.direction = direction;
      window.half_width = random.between(1.0, 5.0);
      window.half_height = random.between(1.0, 5.0);
      window.depth = random.between(2.0, 10.0);
      areas.push_back(InfluenceArea::plane(window));
    } else {
      constexpr double kDegree = gnomon::kPi / 180.0;
      gnomon::PointView view;
      view.eye = place;
      view.direction = direction;
      view.fov_x = random.between(20.0, 100.0) * kDegree;
      view.fov_y = random.between(20.0, 100.0) * kDegree;
      view.near_distance = random.between(1.0, 2.0);
      view.far_distance = view.near_distance + random.between(2.0, 10.0);
      areas.push_back(InfluenceArea::point(view));
    }
  }
  return areas;
}

// The thesis' query points, as starts of rays; the same ones for every structure, which they were not there.
std::vector<gnomon::Ray> query_rays() {
  std::vector<gnomon::Ray> rays(kQueries);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    SteadyRandom random(kSeed + 1, i);
    const Vec3d p = point_in(random, {2, 2, 2}, {4, 6, 3});
    for (std::size_t k = 0; k < 3; ++k) rays[i].origin[k] = static_cast<float>(p[k]);
    rays[i].direction[2] = 1.0F;
  }
  return rays;
}

// One structure under test and its times; areas, points and checks are shared.
struct Candidate {
  TopLevel top;
  gnomon::DeviceTopLevel on_device;
  double build_ms = 0.0;
  std::uint32_t level = 0;
  std::vector<double> host_s, device_all_s, device_first_s;
  std::uint64_t offered = 0;
  std::uint64_t holding = 0;
};

class Bench {
 public:
  Bench(const gnomon::cl::Context& context, std::uint32_t count, std::uint32_t levels)
      : context_(context), areas_(thesis_areas(count)), rays_(query_rays()) {
    // Every direction is affine: the first area that has the point is the answer.
    for (const InfluenceArea& area : areas_) shared_.push_back(gnomon::to_shared(area, 1.0));
    add(AreaLookup::kList, 0);
    add(AreaLookup::kBvh, 0);
    for (std::uint32_t level = kFirstLevel; level <= levels; ++level) add(AreaLookup::kOctree, level);
  }

  void run() {
    for (int round = -1; round < kRounds; ++round) {  // the first one warms up
      for (Candidate& candidate : candidates_) measure(candidate, round >= 0);
    }
    for (const Candidate& candidate : candidates_) print(candidate);
  }

 private:
  void add(AreaLookup lookup, std::uint32_t level) {
    Candidate candidate;
    const double start = cpu_seconds();
    candidate.top = gnomon::build_top_level(areas_, lookup, {level, false});
    candidate.build_ms = 1e3 * (cpu_seconds() - start);
    candidate.on_device = gnomon::upload_top_level(context_, candidate.top, shared_);
    candidate.level = level;
    candidates_.push_back(std::move(candidate));
  }

  // On the host: candidates, then the region itself in double. On the device the kernels' arithmetic.
  std::uint64_t query_all(const TopLevel& top) const {
    std::uint64_t holding = 0;
    for (const gnomon::Ray& ray : rays_) {
      const gnomon::Ray3d exact = gnomon::to_ray3d(ray);
      for (const std::uint32_t area : gnomon::candidates(top, ray.origin))
        holding += areas_[area].contains(exact.origin) ? 1 : 0;
    }
    return holding;
  }

  void measure(Candidate& candidate, bool keep) const {
    const double start = cpu_seconds();
    const std::uint64_t holding = query_all(candidate.top);
    const double host_s = cpu_seconds() - start;
    const gnomon::AreaFinder finder(context_, candidate.on_device);
    const auto counted = finder.count(rays_);
    const auto chosen = finder.choose(rays_);
    if (!keep) return;
    candidate.host_s.push_back(host_s);
    candidate.device_all_s.push_back(1e-3 * counted.kernel_ms);
    candidate.device_first_s.push_back(1e-3 * chosen.kernel_ms);
    candidate.offered = 0;
    for (const std::uint32_t offers : counted.offered) candidate.offered += offers;
    candidate.holding = holding;
  }

  static json rates(const std::vector<double>& seconds) {
    std::vector<double> values;
    for (const double s : seconds) values.push_back(1e-6 * static_cast<double>(kQueries) / s);
    const gnomon::Spread s = gnomon::spread_of(values);
    return {{"median", s.median}, {"min", s.min}, {"max", s.max}, {"n", s.count}};
  }

  // Paired with the list of the same round; above 1: faster than it.
  static json ratios(const std::vector<double>& list, const std::vector<double>& ours) {
    std::vector<double> values;
    for (std::size_t i = 0; i < ours.size(); ++i) values.push_back(list[i] / ours[i]);
    const gnomon::Spread s = gnomon::spread_of(values);
    return {{"median", s.median}, {"min", s.min}, {"max", s.max}, {"n", s.count}};
  }

  void print(const Candidate& c) const {
    const Candidate& list = candidates_.front();
    const auto queries = static_cast<double>(kQueries);
    json row = {{"schema", 1},
                {"bench", "top_level"},
                {"commit", GNOMON_COMMIT},
                {"device", context_.device().name},
                {"driver", context_.device().driver},
                {"threads", 1},
                {"host_clock", "process CPU time"},
                {"device_clock", "kernel events"},
                {"seed", kSeed},
                {"areas", areas_.size()},
                {"queries", kQueries},
                {"structure", gnomon::to_string(c.top.lookup)},
                {"bytes", c.top.bytes()},
                {"build_ms", c.build_ms},
                {"host_mqueries_per_s", rates(c.host_s)},
                {"device_mqueries_per_s", rates(c.device_all_s)},
                {"device_first_mqueries_per_s", rates(c.device_first_s)},
                {"host_ratio_to_list", ratios(list.host_s, c.host_s)},
                {"device_ratio_to_list", ratios(list.device_all_s, c.device_all_s)},
                {"device_first_ratio_to_list", ratios(list.device_first_s, c.device_first_s)},
                {"candidates_per_query", static_cast<double>(c.offered) / queries},
                {"areas_per_query", static_cast<double>(c.holding) / queries},
                {"false_per_true_candidate",
                 static_cast<double>(c.offered - c.holding) / static_cast<double>(c.holding)}};
    if (c.top.lookup == AreaLookup::kOctree) {
      row["max_level"] = c.level;
      row["cells"] = c.top.cells.size();
    }
    std::printf("%s\n", row.dump().c_str());
    std::fflush(stdout);
  }

  const gnomon::cl::Context& context_;
  std::vector<InfluenceArea> areas_;
  std::vector<GnArea> shared_;
  std::vector<gnomon::Ray> rays_;
  std::vector<Candidate> candidates_;
};

}  // namespace

int main(int argc, char** argv) {
  if (gnomon::bench::taught(argc, argv, kHelp)) return 0;
  // Before the first OpenCL call: PoCL reads it once.
  setenv("POCL_MAX_PTHREAD_COUNT", "1", 0);
  try {
    const char* choice = std::getenv("GNOMON_DEVICE");
    const gnomon::cl::Context context(
        gnomon::cl::choose_device(gnomon::cl::list_devices(), choice == nullptr ? "" : choice));
    std::vector<std::pair<std::uint32_t, std::uint32_t>> cases;
    for (int i = 1; i < argc; i += 2)
      cases.emplace_back(gnomon::bench::count_from(argv[i], "AREAS"),
                         gnomon::bench::count_from(i + 1 < argc ? argv[i + 1] : "", "LEVELS"));
    if (cases.empty()) cases = {{4, 7}, {10, 7}, {20, 9}, {40, 7}, {80, 7}};
    for (const auto& [areas, levels] : cases) Bench(context, areas, levels).run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "top_level_bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
