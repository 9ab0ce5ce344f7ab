// The question: how do build and trace grow with triangles, and what does a second compute unit bring?
// JSON rows on stdout.
//
//   scaling_bench sizes [--scenes terrain,random] [--most 10000000]   one thread, process CPU time
//   scaling_bench units [--scenes atrium] [--triangles N]     sub-devices of one device, wall time
//
// sizes: a size and ten times that size take turns, ten builds of the one against one build of the other, so
// that what the machine does meanwhile falls on both. growth is the larger's time over a single one of the
// smaller's; n_log_n what it would be if time went with n log n.
// units: the same work on sub-devices of 1, 2, 4 ... all compute units in turns; a ratio is the time on one
// unit over the time on so many.
#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <memory>

#include "contest.h"
#include "gnomon/cl/launch.h"
#include "gnomon/device/trace_device.h"
#include "gnomon/scene/generators.h"
#include "gnomon/scene/ray_set.h"
#include "gnomon_commit.h"

namespace {

using namespace gnomon::bench;
using gnomon::Hit;
using gnomon::Ray;
namespace cl = gnomon::cl;

constexpr std::uint64_t kSeed = 1;

struct Settings {
  std::vector<std::string> scenes{"terrain"};
  std::uint64_t least = 1000;
  std::uint64_t most = 10'000'000;
  std::uint64_t triangles = 1'000'000;
  std::uint64_t ray_count = 1'048'576;
  int rounds = 5;
};

json common_row(const char* part, const cl::DeviceInfo& device, const std::string& scene) {
  return {{"schema", 1},           {"bench", "scaling"},      {"part", part},   {"commit", GNOMON_COMMIT},
          {"device", device.name}, {"driver", device.driver}, {"scene", scene}, {"seed", kSeed}};
}

// Bytes this process has held at once at most since the last call. 0 where the system does not say.
std::uint64_t peak_bytes() {
  std::ifstream status("/proc/self/status");
  std::uint64_t bytes = 0;
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) bytes = std::stoull(line.substr(6)) << 10U;
  std::ofstream("/proc/self/clear_refs") << "5";
  return bytes;
}

// A scene, its tree and rays on one context.
class Load {
 public:
  Load(const cl::Context& context, const gnomon::Scene& scene, gnomon::Builder builder)
      : context_(context), scene_(scene) {
    options_.builder = builder;
    options_.cost_triangle = 0.25F;
  }
  void build() {
    tree_ = {};
    wide_ = {};
    report_ = {};
    tree_ = gnomon::build_device(context_, scene_.triangles, options_, &report_);
    wide_ = gnomon::collapse_device(context_, tree_, {}, &report_);
  }
  void prepare(const std::vector<Ray>& rays) {
    tracer_ = std::make_unique<gnomon::Tracer>(context_, wide_);
    count_ = static_cast<std::uint32_t>(rays.size());
    rays_ = context_.create_buffer("rays", rays.size() * sizeof(Ray));
    hits_ = context_.create_buffer("hits", rays.size() * sizeof(Hit));
    context_.upload_values<Ray>(rays_, rays);
  }
  void trace() { cl::wait(tracer_->enqueue_closest(rays_.mem.get(), hits_.mem.get(), count_)); }
  [[nodiscard]] std::vector<Hit> hits_of(const std::vector<Ray>& rays) const {
    return gnomon::Tracer(context_, wide_).closest(rays).hits;
  }
  [[nodiscard]] const gnomon::BuildReport& report() const { return report_; }
  [[nodiscard]] std::uint64_t wide_bytes() const { return wide_.bytes(); }
  [[nodiscard]] std::uint64_t tree_bytes() const { return tree_.bytes(); }

 private:
  const cl::Context& context_;
  const gnomon::Scene& scene_;
  gnomon::BuildOptions options_;
  gnomon::BuildReport report_;
  gnomon::DeviceBvh tree_;
  gnomon::DeviceWideBvh wide_;
  std::unique_ptr<gnomon::Tracer> tracer_;
  std::uint32_t count_ = 0;
  cl::Buffer rays_, hits_;
};

void put(const json& row) {
  std::printf("%s\n", row.dump().c_str());
  std::fflush(stdout);
}

// Builds of `small` against ones of `large`, of about `factor` times its triangles. All memory that builds
// give back is kept for the next, or large ones alone would wait for the system to clear pages; what one
// takes at once is measured before, on a context that keeps what contexts do.
void build_row(const json& common, const gnomon::Scene& small, const gnomon::Scene& large,
               gnomon::Builder builder, int rounds) {
  const auto n = static_cast<double>(small.triangles.size());
  const auto m = static_cast<double>(large.triangles.size());
  const int factor = std::max(1, static_cast<int>(std::lround(m / n)));
  (void)peak_bytes();
  {
    const cl::Context usual = one_thread_context();
    Load(usual, large, builder).build();
  }
  const std::uint64_t at_once = peak_bytes();
  cl::ContextOptions keeps_all;
  keeps_all.spare_bytes = std::numeric_limits<std::size_t>::max();
  const cl::Context context = one_thread_context(keeps_all);
  Load one(context, small, builder);
  Load other(context, large, builder);
  std::vector<Contestant> contest{{"small",
                                   [&] {
                                     for (int i = 0; i < factor; ++i) one.build();
                                   }},
                                  {"large", [&] { other.build(); }}};
  run_contest(contest, rounds);
  std::vector<double> growth;
  for (std::size_t i = 0; i < contest[0].cpu_seconds.size(); ++i)
    growth.push_back(contest[1].cpu_seconds[i] * factor / contest[0].cpu_seconds[i]);
  json row = common;
  row["task"] = "build";
  row["builder"] = to_string(builder);
  row["triangles"] = large.triangles.size();
  row["smaller"] = small.triangles.size();
  row["clock"] = "process CPU time";
  row["build_s"] = spread_json(contest[1].cpu_seconds);
  row["growth"] = spread_json(growth);
  row["n_log_n"] = m * std::log2(m) / (n * std::log2(n));
  row["tree_bytes"] = other.tree_bytes();
  row["wide_bytes"] = other.wide_bytes();
  row["scratch_bytes"] = other.report().scratch_bytes;
  row["peak_bytes"] = at_once;
  put(row);
}

void trace_rows(const json& common, const cl::Context& context, const gnomon::Scene& scene,
                const Settings& settings) {
  Load load(context, scene, gnomon::Builder::kBalanced);
  load.build();
  const auto primary = gnomon::primary_rays(scene, settings.ray_count, kSeed);
  const auto bounce = gnomon::bounce_rays(scene, primary, load.hits_of(primary), settings.ray_count, kSeed);
  for (const auto& [kind, rays] : {std::pair{"primary", &primary}, std::pair{"bounce", &bounce}}) {
    if (rays->empty()) continue;
    load.prepare(*rays);
    std::vector<Contestant> contest{{kind, [&] { load.trace(); }}};
    run_contest(contest, settings.rounds);
    json row = common;
    row["task"] = "closest hit";
    row["rays"] = kind;
    row["ray_count"] = rays->size();
    row["triangles"] = scene.triangles.size();
    row["clock"] = "process CPU time";
    row["trace_s"] = spread_json(contest[0].cpu_seconds);
    put(row);
  }
}

void run_sizes(const Settings& settings) {
  const cl::Context context = one_thread_context();
  for (const std::string& name : settings.scenes) {
    const json common = common_row("sizes", context.device(), name);
    gnomon::Scene small = gnomon::generate_scene(name, settings.least, kSeed);
    for (std::uint64_t n = 10 * settings.least; n <= settings.most; n *= 10) {
      gnomon::Scene large = gnomon::generate_scene(name, n, kSeed);
      for (const auto builder : {gnomon::Builder::kBalanced, gnomon::Builder::kFast})
        build_row(common, small, large, builder, settings.rounds);
      trace_rows(common, context, large, settings);
      small = std::move(large);
    }
  }
}

struct SubDevice {
  cl_device_id id = nullptr;
  cl_context context = nullptr;
  cl_command_queue queue = nullptr;
  SubDevice(cl_device_id parent, cl_uint units) {
    const cl_device_partition_property by_count[] = {CL_DEVICE_PARTITION_BY_COUNTS,
                                                     static_cast<cl_device_partition_property>(units),
                                                     CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0};
    cl::check(clCreateSubDevices(parent, by_count, 1, &id, nullptr), "clCreateSubDevices",
              std::to_string(units) + " compute units");
    cl_int status = CL_SUCCESS;
    context = clCreateContext(nullptr, 1, &id, nullptr, nullptr, &status);
    cl::check(status, "clCreateContext", "a sub-device");
    queue = clCreateCommandQueue(context, id, 0, &status);
    cl::check(status, "clCreateCommandQueue", "a sub-device");
  }
  SubDevice(const SubDevice&) = delete;
  SubDevice& operator=(const SubDevice&) = delete;
  ~SubDevice() {
    clReleaseCommandQueue(queue);
    clReleaseContext(context);
    clReleaseDevice(id);
  }
};

// Times of every contestant against those of the first, which has one unit.
void put_units(const json& common, const std::vector<Contestant>& contest, const std::vector<cl_uint>& units,
               const json& extra) {
  for (std::size_t i = 0; i < contest.size(); ++i) {
    json row = common;
    row.update(extra);
    row["units"] = units[i];
    row["clock"] = "wall";
    row["seconds"] = spread_json(contest[i].wall_seconds);
    row["speed_up"] = spread_json(speed_ratios(contest[i].wall_seconds, contest[0].wall_seconds));
    put(row);
  }
}

void run_units(const Settings& settings) {
  const char* choice = std::getenv("GNOMON_DEVICE");
  const auto device = cl::choose_device(cl::list_devices(), choice == nullptr ? "" : choice);
  std::vector<cl_uint> units{1};
  while (2 * units.back() <= device.compute_units) units.push_back(2 * units.back());
  if (units.back() != device.compute_units) units.push_back(device.compute_units);
  for (const std::string& name : settings.scenes) {
    const gnomon::Scene scene = gnomon::generate_scene(name, settings.triangles, kSeed);
    json common = common_row("units", device, name);
    common["triangles"] = scene.triangles.size();
    std::vector<std::unique_ptr<SubDevice>> parts;
    std::vector<std::unique_ptr<cl::Context>> contexts;
    std::vector<std::unique_ptr<Load>> loads;
    for (const cl_uint count : units) {
      parts.push_back(std::make_unique<SubDevice>(device.device, count));
      const SubDevice& part = *parts.back();
      contexts.push_back(std::make_unique<cl::Context>(part.context, part.id, part.queue));
      loads.push_back(std::make_unique<Load>(*contexts.back(), scene, gnomon::Builder::kBalanced));
    }
    const auto contest_of = [&](void (Load::*work)()) {
      std::vector<Contestant> contest;
      for (std::size_t i = 0; i < units.size(); ++i)
        contest.push_back({std::to_string(units[i]), [&loads, i, work] { (*loads[i].*work)(); }});
      run_contest(contest, settings.rounds);
      return contest;
    };
    put_units(common, contest_of(&Load::build), units, {{"task", "build"}});
    const auto primary = gnomon::primary_rays(scene, settings.ray_count, kSeed);
    const auto bounce =
        gnomon::bounce_rays(scene, primary, loads.front()->hits_of(primary), settings.ray_count, kSeed);
    for (const auto& [kind, rays] : {std::pair{"primary", &primary}, std::pair{"bounce", &bounce}}) {
      for (const auto& load : loads) load->prepare(*rays);
      put_units(common, contest_of(&Load::trace), units,
                {{"task", "closest hit"}, {"rays", kind}, {"ray_count", rays->size()}});
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App program("scaling_bench: how build and trace grow, one JSON row a measurement on stdout");
  program.require_subcommand(1);
  CLI::App* const sizes = program.add_subcommand("sizes", "from 1,000 triangles up, times ten each");
  CLI::App* const units = program.add_subcommand("units", "1, 2, 4 ... all compute units of the device");
  for (CLI::App* part : {sizes, units}) {
    part->add_option("--scenes", settings.scenes, "generators, by commas")
        ->delimiter(',')
        ->capture_default_str();
    part->add_option("--ray-count", settings.ray_count, "rays a batch")->capture_default_str();
    part->add_option("--rounds", settings.rounds, "that count")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
  }
  sizes->add_option("--least", settings.least, "triangles of the smallest scene")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 31U))
      ->capture_default_str();
  sizes->add_option("--most", settings.most, "triangles of the largest scene")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 31U))
      ->capture_default_str();
  units->add_option("--triangles", settings.triangles, "of the scene")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 31U))
      ->capture_default_str();
  CLI11_PARSE(program, argc, argv);
  try {
    if (sizes->parsed()) run_sizes(settings);
    if (units->parsed()) run_units(settings);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "scaling_bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
