#include "gnomon/stability/soak.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "gnomon/scene/generators.h"
#include "gnomon/stability/aim.h"
#include "gnomon/stability/flavours.h"
#include "gnomon/stability/soak_rays.h"
#include "gnomon/tree/candidate_tree.h"

namespace gnomon::stability {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::vector<Scene> scenes_of(const SoakOptions& options) {
  if (!options.scenes.empty()) return options.scenes;
  std::vector<Scene> scenes;
  for (const auto& [name, triangles] :
       {std::pair{"atrium", 60000}, {"city", 60000}, {"crowd", 30000}, {"terrain", 30000}}) {
    scenes.push_back(generate_scene(name, static_cast<std::uint64_t>(triangles), 1));
  }
  return scenes;
}

// Every corner moved alike, and rounded to float there.
Triangles moved(Triangles triangles, float offset) {
  for (Triangle& t : triangles) {
    for (float* v : {t.v0, t.v1, t.v2}) {
      for (std::size_t k = 0; k < 3; ++k) v[k] += offset;
    }
  }
  return triangles;
}

// How far the whole run is, for people.
class Clockwork {
 public:
  Clockwork(const Progress& progress, std::uint64_t rays)
      : progress_(progress), rays_(static_cast<double>(rays)) {}
  // False: stop.
  bool tell(std::uint64_t more) {
    done_ += static_cast<double>(more);
    if (!progress_) return true;
    const double left = done_ > 0.0 ? seconds_since(start_) * (rays_ - done_) / done_ : 0.0;
    const auto minutes = static_cast<std::uint64_t>(left / 60.0);
    const auto seconds = static_cast<std::uint64_t>(left) % 60;
    return progress_("soak: " + std::to_string(static_cast<std::uint64_t>(done_)) + " rays judged, " +
                         std::to_string(minutes) + " min " + std::to_string(seconds) + " s left",
                     done_ / rays_);
  }
  [[nodiscard]] double seconds() const { return seconds_since(start_); }

 private:
  const Progress& progress_;
  double rays_;
  double done_ = 0.0;
  Clock::time_point start_ = Clock::now();
};

// One scene at one distance: its tree and one tracer per flavour.
class Station {
 public:
  Station(const cl::Context& context, Triangles triangles, const Builder& builder,
          const std::vector<Flavour>& flavours)
      : pairs_of_floats_(!context.device().fp64),
        triangles_(std::move(triangles)),
        tree_(build_device(context, triangles_, builder.options)),
        candidates_(triangles_) {
    for (const Flavour& flavour : flavours) tracers_.emplace_back(context, tree_, flavour.options);
  }

  void judge_chunk(std::span<const Ray> rays, unsigned threads, SoakPart& part) const {
    const TraceResult closest = tracers_[0].closest(rays);
    const TraceResult any = tracers_[0].any(rays);
    std::vector<std::uint32_t> differ(rays.size());
    for (std::size_t f = 1; f < tracers_.size(); ++f) {
      const std::vector<Hit> hits = tracers_[f].closest(rays).hits;
      const std::vector<std::uint32_t> occluded = tracers_[f].any(rays).occluded;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        if (std::memcmp(&hits[i], &closest.hits[i], sizeof(Hit)) != 0 || occluded[i] != any.occluded[i])
          differ[i] = 1;
      }
    }
    OracleOptions options;
    options.max_rays = rays.size();
    options.time_budget = std::chrono::hours(1000);
    options.threads = threads;
    options.pairs_of_floats = pairs_of_floats_;
    options.tree = &candidates_;
    OracleReport report = judge(triangles_, rays, closest.hits, any.occluded, options);
    for (std::uint64_t& bad : report.bad_rays) bad += part.rays;
    part.oracle.add(report);
    part.rays += rays.size();
    part.invalid += closest.invalid_rays;
    part.flavours_differ += static_cast<std::uint64_t>(std::count(differ.begin(), differ.end(), 1U));
  }

  [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }

 private:
  bool pairs_of_floats_;
  Triangles triangles_;
  DeviceBvh tree_;
  CandidateTree candidates_;
  std::vector<Tracer> tracers_;
};

// Adds the part; false: stopped.
bool run_part(const Station& station, const SoakOptions& options, std::uint64_t rays, SoakPart& part,
              Clockwork& clock) {
  const RaySource source(station.triangles(), options.seed);
  std::vector<Ray> chunk;
  while (part.rays < rays) {
    chunk.clear();
    const std::uint64_t count = std::min<std::uint64_t>(options.chunk, rays - part.rays);
    for (std::uint64_t i = 0; i < count; ++i) chunk.push_back(source.draw(part.rays + i, part));
    station.judge_chunk(chunk, options.threads, part);
    if (!clock.tell(count)) return false;
  }
  return true;
}

}  // namespace

bool SoakPart::ok(bool exact) const {
  const std::uint64_t wrong = exact ? oracle.mismatches() : oracle.lost + oracle.any_closest_disagree;
  return wrong == 0 && invalid == 0 && flavours_differ == 0 && (!exact || oracle.max_t_error_ulp <= kMostUlp);
}

SoakPart SoakReport::total() const {
  SoakPart sum;
  for (const SoakPart& part : parts) {
    sum.triangles += part.triangles;
    sum.rays += part.rays;
    sum.at_corners += part.at_corners;
    sum.at_edges += part.at_edges;
    sum.exactly += part.exactly;
    sum.invalid += part.invalid;
    sum.flavours_differ += part.flavours_differ;
    sum.oracle.add(part.oracle);
  }
  return sum;
}

SoakReport soak(const cl::Context& context, const SoakOptions& options, const Progress& progress) {
  if (options.rays == 0 || options.chunk == 0)
    throw Error(ErrorCode::kInvalidArgument, "soak: there must be rays, and some in a chunk");
  const std::vector<Scene> scenes = scenes_of(options);
  const std::vector<Flavour> flavours = flavours_of(context.device());
  const double offsets[] = {0.0, 1e3, 1e5};
  SoakReport report;
  for (const Flavour& flavour : flavours) report.flavours.push_back(flavour.name);
  const std::uint64_t places = scenes.size() * std::size(offsets) * builders().size();
  const std::uint64_t each = (options.rays + places - 1) / places;
  Clockwork clock(progress, each * places);
  for (const Scene& scene : scenes) {
    if (scene.triangles.empty())
      throw Error(ErrorCode::kBadScene, "soak: scene " + scene.name + " has no triangles");
    const double size = extent_of(scene.triangles).size();
    for (const double offset : offsets) {
      for (const Builder& builder : builders()) {
        if (report.stopped) break;
        const Station station(context, moved(scene.triangles, static_cast<float>(offset * size)), builder,
                              flavours);
        SoakPart part;
        part.scene = scene.name;
        part.scene_hash = scene_hash(scene);
        part.builder = builder.name;
        part.triangles = scene.triangles.size();
        part.offset = offset;
        report.stopped = !run_part(station, options, each, part, clock);
        report.parts.push_back(part);
      }
    }
  }
  report.seconds = clock.seconds();
  return report;
}

}  // namespace gnomon::stability
