// How build and trace times of our first methods grow with the scene, in one contest over all sizes.
#include <array>

#include "gnomon/compare/contest.h"
#include "gnomon/compare/run_steps.h"

namespace gnomon::compare {
namespace {

constexpr std::uint64_t kLeastTriangles = 400;
constexpr std::uint64_t kMostRays = 16'384;
constexpr std::array<std::uint64_t, 3> kParts{64, 16, 4};  // of the scene's triangles, and all of them

// Evenly spread over the triangles in their order. Lights that shine from triangles keep those that stay.
Scene thinned(const Scene& scene, std::uint64_t count) {
  Scene out = scene;
  const std::uint64_t all = scene.triangles.size();
  std::vector<std::uint32_t> place(all, 0xffffffffU);
  out.triangles.clear();
  out.material_ids.clear();
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t from = i * all / count;
    place[from] = static_cast<std::uint32_t>(i);
    out.triangles.push_back(scene.triangles[from]);
    out.material_ids.push_back(scene.material_ids[from]);
  }
  for (Light& light : out.lights) {
    std::vector<std::uint32_t> kept;
    for (const std::uint32_t triangle : light.triangles)
      if (place[triangle] != 0xffffffffU) kept.push_back(place[triangle]);
    light.triangles = std::move(kept);
  }
  std::erase_if(out.lights,
                [](const Light& light) { return light.kind == LightKind::kArea && light.triangles.empty(); });
  return out;
}

// A scene of one size with methods at work on it, and its rays.
struct Size {
  const Scene* scene = nullptr;
  std::unique_ptr<Scene> own;  // none: the run's
  std::vector<std::unique_ptr<Entrant>> made;
  std::vector<Entrant*> entrants;
  Batch batch;
};

class Sizes {
 public:
  explicit Sizes(RunState& run) : run_(run) {
    for (const Entered& entered : run.entered) {
      const std::string& name = entered.method->facts.name;
      if (name == kBaseline || name == "sah-fast" || name == "sah-best") names_.push_back(name);
    }
  }

  void all() {
    const double until = run_.deadline(kSizesWeight, kSizesWeight + kAreasWeight + kPictureWeight);
    const std::string& kind = run_.options.kinds.front();
    thinned_ = !can_be_made_anew();
    for (const std::uint64_t part : kParts) enter(part);
    if (sizes_.empty()) return;
    enter_whole();
    std::vector<Contestant> builds;
    std::vector<Contestant> traces;
    for (Size& size : sizes_) {
      for (Entrant* const entrant : size.entrants) {
        builds.push_back({[entrant] {
                            entrant->build({});
                            entrant->forget_tree();
                          },
                          {}});
        traces.push_back({[entrant, &size] { entrant->trace(size.batch); }, {}});
      }
    }
    const auto say = [&](int done, int most) { run_.tell("sizes", static_cast<double>(done) / most); };
    run_contest(builds, run_.options.rounds, until, wall_now, say);
    for (Size& size : sizes_) {
      Entrant& first = *size.entrants.front();
      size.batch = make_batch(
          run_.context, *size.scene, [&first](std::span<const Ray> rays) { return first.closest(rays); },
          kind, std::min(run_.options.ray_count, kMostRays), run_.options.seed);
      if (size.batch.rays.empty()) return;
    }
    run_contest(traces, 1, until, wall_now);  // warms up
    for (Contestant& contestant : traces) contestant.rounds = {};
    run_contest(traces, run_.options.rounds, until, wall_now, say);
    run_.say_rounds("sizes",
                    std::min(builds.front().rounds.wall_s.size(), traces.front().rounds.wall_s.size()));
    std::size_t place = 0;
    for (const Size& size : sizes_) {
      for (const std::string& name : names_) {
        run_.report.sizes.push_back({name, kind, size.scene->triangles.size(), size.batch.rays.size(),
                                     thinned_, builds[place].rounds, traces[place].rounds});
        ++place;
      }
    }
  }

 private:
  // Generators have a least count: what cannot be made at the least size is thinned at all of them.
  [[nodiscard]] bool can_be_made_anew() const {
    if (!run_.options.at_size) return false;
    try {
      for (const std::uint64_t part : kParts) {
        const std::uint64_t count = run_.scene.triangles.size() / part;
        if (count < kLeastTriangles) continue;
        static_cast<void>(run_.options.at_size(count));
        return true;
      }
    } catch (const Error& error) {
      if (error.code() != ErrorCode::kInvalidArgument) throw;
    }
    return false;
  }

  void enter(std::uint64_t part) {
    const std::uint64_t count = run_.scene.triangles.size() / part;
    if (count < kLeastTriangles) return;
    Size size;
    size.own = std::make_unique<Scene>(thinned_ ? thinned(run_.scene, count) : run_.options.at_size(count));
    size.scene = size.own.get();
    const std::vector<Method> methods = own_methods(run_.context, *size.scene, {});
    for (const std::string& name : names_) {
      for (const Method& method : methods) {
        if (method.facts.name != name) continue;
        size.made.push_back(method.enter());
        size.entrants.push_back(size.made.back().get());
      }
    }
    sizes_.push_back(std::move(size));
  }

  void enter_whole() {
    Size size;
    size.scene = &run_.scene;
    for (const std::string& name : names_) {
      for (Entered& entered : run_.entered)
        if (entered.method->facts.name == name) size.entrants.push_back(entered.entrant.get());
    }
    sizes_.push_back(std::move(size));
  }

  RunState& run_;
  bool thinned_ = false;
  std::vector<std::string> names_;
  std::vector<Size> sizes_;
};

}  // namespace

void time_sizes(RunState& run) {
  if (run.is_done("sizes")) return;
  if (run.spent() > run.options.seconds) {
    run.leave_out("", "sizes", "no time" + run.budget());
  } else {
    run.tell("sizes", 0.0);
    Sizes(run).all();
  }
  run.finish("sizes");
}

}  // namespace gnomon::compare
