// The question: how fast are build and trace beside Embree 3.13 on the same scene and rays, and what do they
// cost in boxes and triangles? One process; rounds in which all contestants run once, in turning order. One
// JSON row a measurement on stdout, in the shape of Google Benchmark's (name, real_time, cpu_time, time_unit)
// with our own fields beside. Ratios are claims; absolute times are direction only.
//
//   gnomon_bench [--scenes city,atrium,FILE.glb] [--triangles N] [--rays primary,bounce] [--rounds N] ...
//
// Inside the measured time: ours, the launches (rays and hits stay in device buffers); Embree's, filling its
// ray structures from the same array and writing answers back, as any caller with a batch must.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <random>
#include <string_view>
#include <thread>
#include <utility>

#include "contest.h"
#include "gnomon/cl/launch.h"
#include "gnomon/device/trace_device.h"
#include "gnomon/peers/embree_peer.h"
#include "gnomon/render/picture_tracing.h"
#include "gnomon/scene/generators.h"
#include "gnomon/scene/import.h"
#include "gnomon_bench/settings.h"
#include "gnomon_commit.h"

namespace {

using namespace gnomon::bench;
using namespace gnomon::peers;
using gnomon::Hit;
using gnomon::Ray;

gnomon::Scene scene_from(const std::string& name, const Settings& settings) {
  for (const auto& generator : gnomon::generators())
    if (generator.name == name) return gnomon::generate_scene(name, settings.triangles, settings.seed);
  return gnomon::import_scene(name);
}

class SceneBench {
 public:
  SceneBench(const gnomon::cl::Context& context, const Settings& settings, const std::string& name)
      : context_(context),
        settings_(settings),
        options_(settings.options),
        scene_(scene_from(name, settings)) {
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
               {"bins", settings.options.bins},
               {"max_leaf", settings.options.max_leaf_size},
               {"cost_traversal", settings.options.cost_traversal},
               {"cost_triangle", settings.options.cost_triangle},
               {"cost_node", settings.collapse.cost_node},
               {"cost_block", settings.collapse.cost_block}};
  }

  void run() {
    for (const std::string& builder : settings_.builders) {
      options_.builder = builder == "fast"   ? gnomon::Builder::kFast
                         : builder == "best" ? gnomon::Builder::kBest
                                             : gnomon::Builder::kBalanced;
      run_builder(builder == "fast"   ? EmbreeQuality::kLow
                  : builder == "best" ? EmbreeQuality::kHigh
                                      : EmbreeQuality::kMedium);
    }
  }

 private:
  // Balanced trees beside Embree in both its modes; fast ones beside its own fast ones, best ones beside its
  // best.
  void run_builder(EmbreeQuality quality) {
    EmbreeScene fast(scene_.triangles, quality, false, threads_);
    EmbreeScene robust(scene_.triangles, quality, true, threads_);
    if (settings_.build) {
      build_rows(fast);
    } else {
      build_ours();
      fast.build();
    }
    if (settings_.rays.front() == "none") return;
    std::vector<const EmbreeScene*> peers{&fast};
    if (quality == EmbreeQuality::kMedium) {
      robust.build();
      peers.push_back(&robust);
    }
    const gnomon::Tracer tracer(context_, wide_);
    primary_ = gnomon::primary_rays(scene_, settings_.ray_count, settings_.seed);
    hits_ = tracer.closest(primary_).hits;
    for (const std::string& kind : settings_.rays) trace_rows(kind, peers);
  }

  void build_ours() {
    report_ = {};
    tree_ = gnomon::build_device(context_, scene_.triangles, options_, &report_);
    wide_ = gnomon::collapse_device(context_, tree_, settings_.collapse, &report_);
  }

  void build_rows(EmbreeScene& peer) {
    std::vector<Contestant> contest{{to_string(options_.builder), [&] { build_ours(); }},
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
    extra["leaf_triangles"] = bvh.primitives.size();
    extra["bytes_per_triangle"] =
        static_cast<double>(stats.bytes) / static_cast<double>(scene_.triangles.size());
    add_compact(extra);
    put_rows("build", contest, {json::object()}, static_cast<double>(scene_.triangles.size()), extra);
  }

  // What the compact form of the same tree takes, and how long making it took, once.
  void add_compact(json& extra) {
    gnomon::BuildReport report;
    const auto compact = gnomon::compact_device(context_, wide_, &report);
    extra["compact_bytes_per_triangle"] =
        static_cast<double>(compact.bytes()) / static_cast<double>(scene_.triangles.size());
    extra["compact_ms"] = report.total_ms;
  }

  std::vector<Ray> rays_of(const std::string& kind) {
    const std::string_view shuffled = "-shuffled";
    if (kind.ends_with(shuffled)) {
      std::vector<Ray> rays = rays_of(kind.substr(0, kind.size() - shuffled.size()));
      std::mt19937_64 random(settings_.seed);
      for (std::size_t i = rays.size(); i > 1; --i) std::swap(rays[i - 1], rays[random() % i]);
      return rays;
    }
    lights_ = gnomon::ray_lights_of(scene_);
    if (kind == "primary") return primary_;
    if (kind == "random") return gnomon::random_rays(scene_, settings_.ray_count, settings_.seed);
    if (kind == "shadow")
      return gnomon::shadow_rays(scene_, primary_, hits_, settings_.ray_count, settings_.seed);
    if (kind == "sun-axis") return rays_to(sun_along({0.0F, -1.0F, 0.0F}));
    if (kind == "sun-oblique") return rays_to(sun_along({-0.399F, -0.798F, -0.449F}));
    if (kind == "point") return rays_to(some_point());
    return gnomon::bounce_rays(scene_, primary_, hits_, settings_.ray_count, settings_.seed);
  }

  static gnomon::Light sun_along(const gnomon::Vec3& direction) {
    gnomon::Light sun;
    sun.kind = gnomon::LightKind::kDirectional;
    sun.direction = direction;
    return sun;
  }

  // The scene's first point light, without its range, or one above the middle.
  gnomon::Light some_point() const {
    for (gnomon::Light light : scene_.lights) {
      if (light.kind != gnomon::LightKind::kPoint) continue;
      light.range = 0.0F;
      return light;
    }
    const gnomon::Bounds box = gnomon::bounds_of(scene_);
    gnomon::Light light;
    light.position = {0.5F * (box.lo[0] + box.hi[0]), box.hi[1] + 0.1F * (box.hi[0] - box.lo[0]),
                      0.5F * (box.lo[2] + box.hi[2])};
    return light;
  }

  // Shadow rays from the hits of primary rays, as if this were the scene's only light.
  std::vector<Ray> rays_to(const gnomon::Light& light) {
    auto lights = std::exchange(scene_.lights, {light});
    auto rays = gnomon::shadow_rays(scene_, primary_, hits_, settings_.ray_count, settings_.seed);
    lights_ = gnomon::ray_lights_of(scene_);
    scene_.lights = std::move(lights);
    return rays;
  }

  void trace_rows(const std::string& kind, const std::vector<const EmbreeScene*>& peers) {
    const std::vector<Ray> rays = rays_of(kind);
    if (rays.empty()) return;
    const bool any = kind.starts_with("shadow") || kind.starts_with("sun") || kind.starts_with("point");
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
      if ((kind != "primary" && !any) || options_.builder != gnomon::Builder::kBalanced) continue;
      contest.push_back({peer->name() + " 16",
                         [&, peer] { any ? peer->any16(rays, occluded) : peer->closest16(rays, hits); }});
    }
    run_contest(contest, settings_.rounds);
    const json extra = {{"rays", kind}, {"ray_count", rays.size()}};
    std::vector<json> counts;
    for (const std::string& flavour : settings_.flavours) counts.push_back(work_of(flavour, rays, any));
    put_rows(any ? "any hit" : "closest hit", contest, counts, static_cast<double>(rays.size()), extra);
  }

  std::unique_ptr<gnomon::Tracer> make_tracer(const std::string& flavour, bool counters) {
    gnomon::TraceOptions options;
    options.counters = counters;
    options.portable = flavour.starts_with("portable");
    options.sort_rays = flavour.ends_with("sorted");
    if (flavour == "light-sorted") options.lights = lights_;
    options.flavour = flavour == "auto" || options.sort_rays ? gnomon::TraceFlavour::kAuto
                      : flavour.ends_with("packet")          ? gnomon::TraceFlavour::kPacket
                                                             : gnomon::TraceFlavour::kWide;
    if (flavour == "compact") options.flavour = gnomon::TraceFlavour::kCompact;
    if (flavour != "thread") return std::make_unique<gnomon::Tracer>(context_, wide_, options);
    options.flavour = gnomon::TraceFlavour::kThread;
    return std::make_unique<gnomon::Tracer>(context_, tree_, options);
  }

  // Means over all rays: exact claims, one pass.
  json work_of(const std::string& flavour, const std::vector<Ray>& rays, bool any) {
    const auto tracer = make_tracer(flavour, true);
    const auto result = any ? tracer->any(rays) : tracer->closest(rays);
    double boxes = 0.0;
    double triangles = 0.0;
    for (const GnRayCounters& c : result.counters) {
      boxes += c.boxes;
      triangles += c.triangles;
    }
    const auto count = static_cast<double>(rays.size());
    return {{"boxes_per_ray", boxes / count}, {"triangles_per_ray", triangles / count}};
  }

  // A row for each of ours, which come first and whose work is known, beside each peer.
  void put_rows(const std::string& task, const std::vector<Contestant>& contest,
                const std::vector<json>& work, double items, const json& extra) {
    const bool wall = threads_ > 1;
    const std::size_t ours = work.size();
    for (std::size_t a = 0; a < ours; ++a) {
      for (std::size_t b = ours; b < contest.size(); ++b) {
        const auto seconds = [&](std::size_t i) {
          return wall ? contest[i].wall_seconds : contest[i].cpu_seconds;
        };
        json row = common_;
        row["name"] = task + "/" + std::string(common_["scene"]) + "/" + extra.value("rays", "") + "/" +
                      contest[a].name + "/" + contest[b].name;
        row["task"] = task;
        row["builder"] = to_string(options_.builder);
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
        row.update(work[a]);
        std::printf("%s\n", row.dump().c_str());
        std::fflush(stdout);
      }
    }
  }

  const gnomon::cl::Context& context_;
  const Settings& settings_;
  gnomon::BuildOptions options_;
  gnomon::Scene scene_;
  unsigned threads_ = 1;
  gnomon::DeviceBvh tree_;
  gnomon::DeviceWideBvh wide_;
  gnomon::BuildReport report_;
  std::vector<Ray> primary_;
  std::vector<Hit> hits_;
  std::vector<gnomon::RayLight> lights_;  // that the rays made last go to
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
  Settings settings;
  CLI::App program("gnomon_bench: build and trace beside Embree, one JSON row a measurement on stdout");
  add_options(program, settings);
  CLI11_PARSE(program, argc, argv);
  try {
    const gnomon::cl::Context context = context_for(settings);
    for (const std::string& name : settings.scenes) SceneBench(context, settings, name).run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gnomon_bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
