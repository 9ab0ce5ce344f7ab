// The question: how fast are build and trace beside Embree 3.13 on the same scene and rays, and what do they
// cost in boxes and triangles? One process; rounds in which all contestants run once, in turning order. One
// JSON row a measurement on stdout, in the shape of Google Benchmark's (name, real_time, cpu_time, time_unit)
// with our own fields beside. Ratios are claims; absolute times are direction only.
//
//   gnomon_bench [--scenes city,atrium,FILE.glb] [--triangles N] [--rays primary,bounce] [--rounds N] ...
//
// Inside the measured time: ours, the launches (rays and hits stay in device buffers); Embree's, filling its
// ray structures from the same array and writing answers back, as any caller with a batch must.
#include <getopt.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <numeric>
#include <optional>
#include <random>
#include <thread>

#include "contest.h"
#include "embree_peer.h"
#include "gnomon/cl/launch.h"
#include "gnomon/device/trace_device.h"
#include "gnomon/scene/generators.h"
#include "gnomon/scene/import.h"
#include "gnomon_commit.h"

namespace {

using namespace gnomon::bench;
using gnomon::Hit;
using gnomon::Ray;

// A block tests eight triangles at the price of about two visits: leaves near that size are right, and the
// collapse merges smaller ones anyway.
gnomon::BuildOptions options_for_wide_trees() {
  gnomon::BuildOptions options;
  options.cost_triangle = 0.25F;
  return options;
}

struct Settings {
  std::vector<std::string> scenes{"atrium", "city", "terrain", "random"};
  std::uint64_t triangles = 1'000'000;
  std::vector<std::string> rays{"primary",  "bounce",      "bounce-shuffled", "shadow",
                                "sun-axis", "sun-oblique", "random"};
  std::vector<std::string> flavours{"wide"};
  std::uint64_t ray_count = 262'144;
  std::uint64_t seed = 1;
  int rounds = 7;
  bool all_threads = false;
  bool build = true;
  gnomon::BuildOptions options = options_for_wide_trees();
  gnomon::CollapseOptions collapse;
};

const char* const kHelp =
    "gnomon_bench: build and trace beside Embree, one JSON row a measurement\n"
    "  --scenes LIST     generators or files, by commas (atrium,city,terrain,random)\n"
    "  --triangles N     of generated scenes (1000000)\n"
    "  --rays LIST       primary bounce bounce-shuffled shadow sun-axis sun-oblique random; or none (all)\n"
    "  --flavours LIST   wide portable thread (wide)\n"
    "  --ray-count N     rays a batch (262144)\n"
    "  --rounds N        that count (7)\n"
    "  --seed N          of scenes and rays (1)\n"
    "  --threads 1|all   (1)\n"
    "  --no-build        leave out the build rows\n"
    "  --leaf N --bins N --cost-traversal X --cost-triangle X --cost-node X --cost-block X   of our trees\n"
    "  --subtree N       triangles that one work-group builds alone (0: as the device likes)\n";

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    if (comma > at) parts.push_back(text.substr(at, comma - at));
    at = comma + 1;
  }
  return parts;
}

std::optional<Settings> settings_from(int argc, char** argv) {
  Settings s;
  const option names[] = {
      {"scenes", 1, nullptr, 's'},        {"triangles", 1, nullptr, 't'}, {"rays", 1, nullptr, 'r'},
      {"flavours", 1, nullptr, 'f'},      {"ray-count", 1, nullptr, 'n'}, {"rounds", 1, nullptr, 'R'},
      {"seed", 1, nullptr, 'S'},          {"threads", 1, nullptr, 'T'},   {"no-build", 0, nullptr, 'B'},
      {"leaf", 1, nullptr, 'l'},          {"bins", 1, nullptr, 'b'},      {"cost-traversal", 1, nullptr, 'v'},
      {"cost-triangle", 1, nullptr, 'i'}, {"cost-node", 1, nullptr, 'N'}, {"cost-block", 1, nullptr, 'K'},
      {"subtree", 1, nullptr, 'u'},       {"help", 0, nullptr, 'h'},      {nullptr, 0, nullptr, 0}};
  for (int c = 0; (c = getopt_long(argc, argv, "", names, nullptr)) != -1;) {
    const auto number = [] { return std::strtoull(optarg, nullptr, 10); };
    const auto real = [] { return std::strtof(optarg, nullptr); };
    switch (c) {
      case 's':
        s.scenes = split(optarg);
        break;
      case 't':
        s.triangles = number();
        break;
      case 'r':
        s.rays = std::string(optarg) == "none" ? std::vector<std::string>{} : split(optarg);
        break;
      case 'f':
        s.flavours = split(optarg);
        break;
      case 'n':
        s.ray_count = number();
        break;
      case 'R':
        s.rounds = static_cast<int>(number());
        break;
      case 'S':
        s.seed = number();
        break;
      case 'T':
        s.all_threads = std::string(optarg) == "all";
        break;
      case 'B':
        s.build = false;
        break;
      case 'l':
        s.options.max_leaf_size = static_cast<std::uint32_t>(number());
        break;
      case 'b':
        s.options.bins = static_cast<std::uint32_t>(number());
        break;
      case 'v':
        s.options.cost_traversal = real();
        break;
      case 'i':
        s.options.cost_triangle = real();
        break;
      case 'N':
        s.collapse.cost_node = real();
        break;
      case 'K':
        s.collapse.cost_block = real();
        break;
      case 'u':
        s.options.subtree_size = static_cast<std::uint32_t>(number());
        break;
      case 'h':
        std::fputs(kHelp, stdout);
        return std::nullopt;
      default:
        throw std::runtime_error("see gnomon_bench --help");
    }
  }
  return s;
}

gnomon::Scene scene_from(const std::string& name, const Settings& settings) {
  for (const auto& generator : gnomon::generators())
    if (generator.name == name) return gnomon::generate_scene(name, settings.triangles, settings.seed);
  return gnomon::import_scene(name);
}

// Shadow rays to a sun: from the hits of primary rays towards where the light comes from.
std::vector<Ray> sun_rays(const gnomon::Scene& scene, const std::vector<Ray>& primary,
                          const std::vector<Hit>& hits, const Settings& settings, const float to_sun[3]) {
  auto rays = gnomon::bounce_rays(scene, primary, hits, settings.ray_count, settings.seed);
  for (Ray& ray : rays) std::copy_n(to_sun, 3, ray.direction);
  return rays;
}

class SceneBench {
 public:
  SceneBench(const gnomon::cl::Context& context, const Settings& settings, const std::string& name)
      : context_(context), settings_(settings), scene_(scene_from(name, settings)) {
    threads_ = settings.all_threads ? std::max(1U, std::thread::hardware_concurrency()) : 1;
    common_ = {{"schema", 1},
               {"bench", "gnomon"},
               {"commit", GNOMON_COMMIT},
               {"device", context.device().name},
               {"driver", context.device().driver},
               {"threads", threads_},
               {"scene", name},
               {"scene_hash", gnomon::scene_hash(scene_)},
               {"triangles", scene_.triangles.size()},
               {"seed", settings.seed},
               {"leaf", settings.options.max_leaf_size},
               {"cost_traversal", settings.options.cost_traversal},
               {"cost_block", settings.collapse.cost_block}};
  }

  void run() {
    EmbreeScene fast(scene_.triangles, EmbreeQuality::kMedium, false, threads_);
    EmbreeScene robust(scene_.triangles, EmbreeQuality::kMedium, true, threads_);
    if (settings_.build) {
      build_rows(fast);
    } else {
      build_ours();
      fast.build();
    }
    if (settings_.rays.empty()) return;
    robust.build();
    const gnomon::Tracer tracer(context_, wide_);
    primary_ = gnomon::primary_rays(scene_, settings_.ray_count, settings_.seed);
    hits_ = tracer.closest(primary_).hits;
    for (const std::string& kind : settings_.rays) trace_rows(kind, {&fast, &robust});
  }

 private:
  void build_ours() {
    report_ = {};
    tree_ = gnomon::build_device(context_, scene_.triangles, settings_.options, &report_);
    wide_ = gnomon::collapse_device(context_, tree_, settings_.collapse, &report_);
  }

  void build_rows(EmbreeScene& peer) {
    std::vector<Contestant> contest{{"balanced", [&] { build_ours(); }},
                                    {peer.name(), [&] { peer.build(); }}};
    run_contest(contest, settings_.rounds);
    json extra;
    for (const auto& [stage, ms] : report_.stages) extra["stages_ms"][stage] = ms;
    const gnomon::Bvh bvh = gnomon::download_bvh(context_, tree_);
    const gnomon::WideBvh wide = gnomon::download_wide(context_, wide_);
    const auto stats = gnomon::stats_of(wide);
    extra["tree_hash"] = gnomon::tree_hash(bvh);
    extra["wide_hash"] = gnomon::tree_hash(wide);
    extra["sah_cost"] = gnomon::stats_of(bvh, {}).sah_cost;
    extra["mean_leaf"] = gnomon::stats_of(bvh, {}).mean_leaf;
    extra["expected_nodes"] = stats.expected_nodes;
    extra["expected_blocks"] = stats.expected_blocks;
    extra["mean_children"] = stats.mean_children;
    extra["mean_block"] = stats.mean_block;
    extra["bytes_per_triangle"] =
        static_cast<double>(stats.bytes) / static_cast<double>(scene_.triangles.size());
    put_rows("build", contest, 1, static_cast<double>(scene_.triangles.size()), extra);
  }

  std::vector<Ray> rays_of(const std::string& kind) {
    if (kind == "primary") return primary_;
    if (kind == "random") return gnomon::random_rays(scene_, settings_.ray_count, settings_.seed);
    if (kind == "shadow")
      return gnomon::shadow_rays(scene_, primary_, hits_, settings_.ray_count, settings_.seed);
    const float axis[3] = {0.0F, 1.0F, 0.0F};
    const float oblique[3] = {0.4F, 0.8F, 0.45F};
    if (kind == "sun-axis") return sun_rays(scene_, primary_, hits_, settings_, axis);
    if (kind == "sun-oblique") return sun_rays(scene_, primary_, hits_, settings_, oblique);
    auto rays = gnomon::bounce_rays(scene_, primary_, hits_, settings_.ray_count, settings_.seed);
    if (kind == "bounce") return rays;
    if (kind != "bounce-shuffled") throw std::runtime_error("no rays are called " + kind + "; see --help");
    std::mt19937_64 random(settings_.seed);
    for (std::size_t i = rays.size(); i > 1; --i) std::swap(rays[i - 1], rays[random() % i]);
    return rays;
  }

  void trace_rows(const std::string& kind, const std::vector<const EmbreeScene*>& peers) {
    const std::vector<Ray> rays = rays_of(kind);
    if (rays.empty()) return;
    const bool any = kind == "shadow" || kind.starts_with("sun");
    const auto count = static_cast<std::uint32_t>(rays.size());
    const auto ray_buffer = context_.create_buffer("rays", rays.size() * sizeof(Ray));
    const auto answers = context_.create_buffer("answers", rays.size() * sizeof(Hit));
    context_.upload_values<Ray>(ray_buffer, rays);
    std::vector<Contestant> contest;
    std::vector<std::unique_ptr<gnomon::Tracer>> tracers;
    for (const std::string& flavour : settings_.flavours) {
      tracers.push_back(make_tracer(flavour, false));
      const gnomon::Tracer& tracer = *tracers.back();
      contest.push_back({flavour, [&, any] {
                           const auto event =
                               any ? tracer.enqueue_any(ray_buffer.mem.get(), answers.mem.get(), count)
                                   : tracer.enqueue_closest(ray_buffer.mem.get(), answers.mem.get(), count);
                           gnomon::cl::wait(event);
                         }});
    }
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint32_t> occluded(rays.size());
    for (const EmbreeScene* peer : peers) {
      contest.push_back(
          {peer->name() + " 1", [&, peer] { any ? peer->any(rays, occluded) : peer->closest(rays, hits); }});
      if (kind != "primary" && !any) continue;
      contest.push_back({peer->name() + " 16",
                         [&, peer] { any ? peer->any16(rays, occluded) : peer->closest16(rays, hits); }});
    }
    run_contest(contest, settings_.rounds);
    json extra = {{"rays", kind}, {"ray_count", rays.size()}};
    add_counts(extra, rays, any);
    put_rows(any ? "any hit" : "closest hit", contest, settings_.flavours.size(),
             static_cast<double>(rays.size()), extra);
  }

  std::unique_ptr<gnomon::Tracer> make_tracer(const std::string& flavour, bool counters) {
    gnomon::TraceOptions options;
    options.counters = counters;
    options.portable = flavour == "portable";
    if (flavour != "thread") return std::make_unique<gnomon::Tracer>(context_, wide_, options);
    options.flavour = gnomon::TraceFlavour::kThread;
    return std::make_unique<gnomon::Tracer>(context_, tree_, options);
  }

  // Means over all rays: exact claims, one pass.
  void add_counts(json& row, const std::vector<Ray>& rays, bool any) {
    const auto tracer = make_tracer(settings_.flavours.front(), true);
    const auto result = any ? tracer->any(rays) : tracer->closest(rays);
    double boxes = 0.0;
    double triangles = 0.0;
    for (const GnRayCounters& c : result.counters) {
      boxes += c.boxes;
      triangles += c.triangles;
    }
    row["boxes_per_ray"] = boxes / static_cast<double>(rays.size());
    row["triangles_per_ray"] = triangles / static_cast<double>(rays.size());
  }

  // A row for each of ours beside each peer.
  void put_rows(const std::string& task, const std::vector<Contestant>& contest, std::size_t ours,
                double items, const json& extra) {
    const bool wall = threads_ > 1;
    for (std::size_t a = 0; a < ours; ++a) {
      for (std::size_t b = ours; b < contest.size(); ++b) {
        const auto seconds = [&](std::size_t i) {
          return wall ? contest[i].wall_seconds : contest[i].cpu_seconds;
        };
        json row = common_;
        row["name"] = task + "/" + std::string(common_["scene"]) + "/" + extra.value("rays", "") + "/" +
                      contest[a].name + "/" + contest[b].name;
        row["task"] = task;
        row["ours"] = contest[a].name;
        row["peer"] = contest[b].name;
        row["clock"] = wall ? "wall" : "process CPU time";
        row["time_unit"] = "ns";
        row["real_time"] = gnomon::spread_of(contest[a].wall_seconds).median * 1e9 / items;
        row["cpu_time"] = gnomon::spread_of(contest[a].cpu_seconds).median * 1e9 / items;
        row["peer_real_time"] = gnomon::spread_of(contest[b].wall_seconds).median * 1e9 / items;
        row["peer_cpu_time"] = gnomon::spread_of(contest[b].cpu_seconds).median * 1e9 / items;
        row["ratio"] = spread_json(speed_ratios(seconds(a), seconds(b)));
        row.update(extra);
        std::printf("%s\n", row.dump().c_str());
        std::fflush(stdout);
      }
    }
  }

  const gnomon::cl::Context& context_;
  const Settings& settings_;
  gnomon::Scene scene_;
  unsigned threads_ = 1;
  gnomon::DeviceBvh tree_;
  gnomon::DeviceWideBvh wide_;
  gnomon::BuildReport report_;
  std::vector<Ray> primary_;
  std::vector<Hit> hits_;
  json common_;
};

gnomon::cl::Context context_for(const Settings& settings) {
  if (!settings.all_threads) return one_thread_context();
  const char* choice = std::getenv("GNOMON_DEVICE");
  return gnomon::cl::Context(
      gnomon::cl::choose_device(gnomon::cl::list_devices(), choice == nullptr ? "" : choice));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const auto settings = settings_from(argc, argv);
    if (!settings) return 0;
    const gnomon::cl::Context context = context_for(*settings);
    for (const std::string& name : settings->scenes) SceneBench(context, *settings, name).run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gnomon_bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
