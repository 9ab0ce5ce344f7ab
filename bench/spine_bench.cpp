// The question: how fast are build and trace beside Embree 3.13 (MEDIUM) on the same scene and rays?
// One process, rounds that alternate the two and swap their order, process CPU time on one thread; one JSON
// row a measurement on stdout. Ratios are claims; absolute rates are direction only. Charts and README read
// the rows.
//
//   spine_bench [SCENE TRIANGLES]...   default: city 1000000 atrium 1000000
//
// What is inside the measured time: ours, filling nothing (rays and hits stay in device buffers) and the
// launch; Embree's, filling an RTCRayHit per ray from the same array and writing a 16-byte hit back, as any
// caller with a batch must.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "gnomon/cl/launch.h"
#include "gnomon/device/trace_device.h"
#include "gnomon/peers/embree_peer.h"
#include "gnomon/scene/generators.h"
#include "gnomon/scene/ray_set.h"
#include "gnomon_commit.h"
#include "paired.h"

namespace {

using gnomon::Hit;
using gnomon::Ray;
using gnomon::bench::json;
using gnomon::bench::measure;
using gnomon::bench::Paired;
using gnomon::bench::spread_json;
using gnomon::peers::EmbreeQuality;
using gnomon::peers::EmbreeScene;

constexpr const char* kHelp =
    "spine_bench: how fast build and trace are beside Embree's MEDIUM on the same scene and rays\n\n"
    "  spine_bench [SCENE TRIANGLES]...\n\n"
    "One thread, processor time; rounds alternate the two. One JSON row a measurement on stdout; README's "
    "table is made\n"
    "of them. Ratios are claims, rates are direction only.\n\n"
    "  SCENE   a generated scene (gnomon scene --help names them); default: city and atrium of 1000000 "
    "triangles\n\n"
    "GNOMON_DEVICE chooses another device.\n"
    "Example:  spine_bench cottage 20000\n";
constexpr int kRounds = 7;
constexpr std::uint64_t kRays = 262144;
constexpr std::uint64_t kSeed = 1;

// Rates in millions a second, and the ratio's median over rounds (above 1: we are faster).
void add_rates(json& row, const Paired& times, double items, const char* unit) {
  std::vector<double> ours, peer, ratios;
  for (std::size_t i = 0; i < times.ours.size(); ++i) {
    ours.push_back(items * 1e-6 / times.ours[i]);
    peer.push_back(items * 1e-6 / times.peer[i]);
    ratios.push_back(times.peer[i] / times.ours[i]);
  }
  row[std::string("gnomon_") + unit] = spread_json(ours);
  row[std::string("embree_") + unit] = spread_json(peer);
  row["ratio"] = spread_json(ratios);
}

// One scene: its rows' common part, both libraries' trees, the measurements.
class SceneBench {
 public:
  SceneBench(const gnomon::cl::Context& context, const std::string& name, std::uint64_t triangles)
      : context_(context), scene_(gnomon::generate_scene(name, triangles, kSeed)) {
    common_ = {{"schema", 1},
               {"bench", "spine"},
               {"commit", GNOMON_COMMIT},
               {"device", context.device().name},
               {"driver", context.device().driver},
               {"peer", "Embree 3.13.5 MEDIUM"},
               {"threads", 1},
               {"clock", "process CPU time"},
               {"scene", name},
               {"scene_hash", gnomon::scene_hash(scene_)},
               {"triangles", scene_.triangles.size()},
               {"seed", kSeed}};
  }

  void run() {
    EmbreeScene fast(scene_.triangles, EmbreeQuality::kMedium, false);
    EmbreeScene robust(scene_.triangles, EmbreeQuality::kMedium, true);
    build_row(fast);
    robust.build();
    const gnomon::Tracer tracer(context_, tree_);
    const auto primary = gnomon::primary_rays(scene_, kRays, kSeed);
    const auto hits = tracer.closest(primary).hits;
    trace_rows("primary", primary, tracer, fast, robust);
    trace_rows("bounce", gnomon::bounce_rays(scene_, primary, hits, kRays, kSeed), tracer, fast, robust);
    trace_rows("shadow", gnomon::shadow_rays(scene_, primary, hits, kRays, kSeed), tracer, fast, robust);
    trace_rows("random", gnomon::random_rays(scene_, kRays, kSeed), tracer, fast, robust);
  }

 private:
  void build_row(EmbreeScene& peer) {
    gnomon::BuildReport report;
    const auto ours = [&] { tree_ = gnomon::build_device(context_, scene_.triangles, {}, &report); };
    json row = common_;
    row["task"] = "build";
    add_rates(row, measure(kRounds, ours, [&] { peer.build(); }),
              static_cast<double>(scene_.triangles.size()), "mtris_per_s");
    for (const auto& [stage, ms] : report.stages) row["stages_ms"][stage] = ms;
    const gnomon::Bvh bvh = gnomon::download_bvh(context_, tree_);
    row["tree_hash"] = gnomon::tree_hash(bvh);
    row["sah_cost"] = gnomon::stats_of(bvh, {}).sah_cost;
    std::printf("%s\n", row.dump().c_str());
  }

  void trace_rows(const char* kind, const std::vector<Ray>& rays, const gnomon::Tracer& tracer,
                  const EmbreeScene& fast, const EmbreeScene& robust) {
    const auto count = static_cast<std::uint32_t>(rays.size());
    const bool any = std::string(kind) == "shadow";
    const auto ray_buffer = context_.create_buffer("rays", rays.size() * sizeof(Ray));
    const auto answer_buffer = context_.create_buffer("answers", rays.size() * sizeof(Hit));
    context_.upload_values<Ray>(ray_buffer, rays);
    const auto ours = [&] {
      gnomon::cl::wait(any ? tracer.enqueue_any(ray_buffer.mem.get(), answer_buffer.mem.get(), count)
                           : tracer.enqueue_closest(ray_buffer.mem.get(), answer_buffer.mem.get(), count));
    };
    for (const EmbreeScene* peer : {&fast, &robust}) {
      std::vector<Hit> hits(rays.size());
      std::vector<std::uint32_t> occluded(rays.size());
      const auto theirs = [&] { any ? peer->any(rays, occluded) : peer->closest(rays, hits); };
      json row = common_;
      row["task"] = any ? "any hit" : "closest hit";
      row["rays"] = kind;
      row["ray_count"] = rays.size();
      row["peer_mode"] = peer == &robust ? "ROBUST" : "default";
      add_rates(row, measure(kRounds, ours, theirs), static_cast<double>(rays.size()), "mrays_per_s");
      row["differing_answers"] =
          any ? differing_any(answer_buffer, occluded) : differing_closest(answer_buffer, hits);
      std::printf("%s\n", row.dump().c_str());
      std::fflush(stdout);
    }
  }

  // Rays for which one side hits and the other misses, or t differs by more than 1e-4 relative.
  std::uint64_t differing_closest(const gnomon::cl::Buffer& answers, const std::vector<Hit>& peer) const {
    const auto ours = context_.download_values<Hit>(answers, peer.size());
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < peer.size(); ++i) {
      const bool hit = ours[i].primitive != GN_NONE;
      const bool peer_hit = peer[i].primitive != RTC_INVALID_GEOMETRY_ID;
      const bool apart = hit && peer_hit && std::fabs(ours[i].t - peer[i].t) > 1e-4F * peer[i].t;
      count += hit != peer_hit || apart ? 1 : 0;
    }
    return count;
  }
  std::uint64_t differing_any(const gnomon::cl::Buffer& answers,
                              const std::vector<std::uint32_t>& peer) const {
    const auto ours = context_.download_values<std::uint32_t>(answers, peer.size());
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < peer.size(); ++i) count += ours[i] != peer[i] ? 1 : 0;
    return count;
  }

  const gnomon::cl::Context& context_;
  gnomon::Scene scene_;
  gnomon::DeviceBvh tree_;
  json common_;
};

}  // namespace

int main(int argc, char** argv) {
  if (gnomon::bench::taught(argc, argv, kHelp)) return 0;
  try {
    const gnomon::cl::Context context = gnomon::bench::one_thread_context();
    for (const auto& [name, triangles] : gnomon::bench::scenes_from(argc, argv)) {
      SceneBench(context, name, triangles).run();
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "spine_bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
