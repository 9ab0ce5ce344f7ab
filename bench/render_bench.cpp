// The question: what does a whole picture take with a plan (`render --plan auto`), or with shadow rays light
// by light (`--order light`), beside the balanced tree and rays as they come? Both in one process, one thread
// of PoCL: builds, planning and collapse once a round, then samples in turns, a few at a time; process CPU
// time. The pictures are the same bits, or the bench fails. What rays take, by the device's clock, is also
// told apart from what their paths take. JSON rows on stdout, one a scene and way.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "gnomon/render/picture_tracing.h"
#include "gnomon/render/render.h"
#include "gnomon/scene/generators.h"
#include "gnomon_commit.h"
#include "paired.h"
#include "planned_tracers.h"
#include "render_plan.h"

namespace {

using namespace gnomon;
using nlohmann::json;

constexpr std::uint64_t kSceneSeed = 1;

struct Settings {
  std::vector<std::string> scenes{"atrium"};
  std::vector<std::string> ways{"plan"};
  std::uint64_t triangles = 250'000;
  std::uint32_t size = 512;  // of the picture, both ways
  std::uint32_t samples = 64;
  std::uint32_t turn = 4;  // samples at a time
  int rounds = 5;
  std::uint64_t seed = 1;
};

// Seconds of one picture: CPU time, but for the last two, which the device's clock tells.
struct Seconds {
  double ready = 0.0;  // building, and with a plan planning
  double render = 0.0;
  double trace = 0.0;
  double shade = 0.0;
  [[nodiscard]] double whole() const { return ready + render; }
  // All that a tree is to blame for.
  [[nodiscard]] double of_rays() const { return ready + trace; }
};

// One way to make the picture: what it builds, and the picture so far.
class Side {
 public:
  // `way`: "plan", "light", or "balanced", which is neither.
  Side(const cl::Context& context, const Scene& scene, const Settings& settings, const std::string& way)
      : scene_(scene) {
    RenderOptions picture;
    picture.width = picture.height = settings.size;
    picture.samples = settings.samples;
    picture.seed = settings.seed;
    const double start = bench::cpu_seconds();
    build_ = app::build_for_use(context, scene, {}, {}, {});
    app::PlanRequest request;
    if (way != "plan") request.instead = way;
    plan_ = app::plan_picture(request, picture, context, build_, scene, {});
    tracers_ = std::make_unique<app::PlannedTracers>(
        context, scene_, build_, plan_, picture_tracing(context.device(), scene, way == "light"));
    PathOptions how;
    how.width = how.height = settings.size;
    how.seed = settings.seed;
    paths_ = std::make_unique<PathTracer>(context, tracers_->tracers(), scene_, how);
    seconds_.ready = bench::cpu_seconds() - start;
  }

  void add(std::uint32_t samples) {
    const double start = bench::cpu_seconds();
    paths_->add_samples(samples);
    seconds_.render += bench::cpu_seconds() - start;
  }

  [[nodiscard]] Seconds seconds() const {
    Seconds out = seconds_;
    out.trace = 1e-3 * paths_->counts().trace_ms;
    out.shade = 1e-3 * paths_->counts().shade_ms;
    return out;
  }
  [[nodiscard]] std::vector<std::array<float, 4>> film() const { return paths_->film(); }
  [[nodiscard]] std::uint64_t rays() const {
    const PathCounts& counts = paths_->counts();
    return counts.camera_rays + counts.bounce_rays + counts.shadow_rays;
  }
  [[nodiscard]] const app::PlanOutcome& plan() const { return plan_; }

 private:
  const Scene& scene_;
  app::TimedBuild build_;
  app::PlanOutcome plan_;
  std::unique_ptr<app::PlannedTracers> tracers_;
  std::unique_ptr<PathTracer> paths_;
  Seconds seconds_;
};

struct Round {
  Seconds ours, balanced;
};

class Bench {
 public:
  Bench(const Settings& settings, const cl::Context& context) : settings_(settings), context_(context) {}

  void run(const std::string& name, const std::string& way) {
    const Scene scene = generate_scene(name, settings_.triangles, kSceneSeed);
    static_cast<void>(round_of(scene, way, settings_.turn, 0));  // compiles what is not yet
    std::vector<Round> rounds;
    for (int i = 0; i < settings_.rounds; ++i) rounds.push_back(round_of(scene, way, settings_.samples, i));
    print(name, scene, way, rounds);
  }

 private:
  // Planned for all of the settings' samples, of which so many are made.
  Round round_of(const Scene& scene, const std::string& way, std::uint32_t samples, int number) {
    std::array<std::unique_ptr<Side>, 2> sides;  // that way, and balanced
    const auto in_turn = [&](std::uint32_t turn, const auto& work) {
      const bool ours_first = (turn + static_cast<std::uint32_t>(number)) % 2 == 0;
      work(ours_first ? 0 : 1);
      work(ours_first ? 1 : 0);
    };
    in_turn(0, [&](std::size_t side) {
      sides[side] = std::make_unique<Side>(context_, scene, settings_, side == 0 ? way : "balanced");
    });
    for (std::uint32_t done = 0; done < samples; done += settings_.turn) {
      const std::uint32_t some = std::min(settings_.turn, samples - done);
      in_turn(done / settings_.turn, [&](std::size_t side) { sides[side]->add(some); });
    }
    if (sides[0]->film() != sides[1]->film())
      throw std::runtime_error("the pictures differ: a tree is wrong");
    rays_ = sides[0]->rays();
    plan_ = sides[0]->plan().reason;
    for (const ChosenTree& one : sides[0]->plan().chosen)
      plan_ += (plan_.empty() ? "" : "; ") + one.rays + ": " + one.name;
    return {sides[0]->seconds(), sides[1]->seconds()};
  }

  void print(const std::string& name, const Scene& scene, const std::string& way,
             const std::vector<Round>& rounds) const {
    const auto spread = [&](const auto& of) {
      std::vector<double> values;
      for (const Round& round : rounds) values.push_back(of(round));
      return bench::spread_json(values);
    };
    json row = {{"schema", 1},
                {"bench", "render"},
                {"commit", GNOMON_COMMIT},
                {"device", context_.device().name},
                {"driver", context_.device().driver},
                {"scene", name},
                {"scene_hash", scene_hash(scene)},
                {"triangles", scene.triangles.size()},
                {"size", settings_.size},
                {"samples", settings_.samples},
                {"seed", settings_.seed},
                {"way", way},
                {"ray_count", rays_},
                {"plan", plan_}};
    const auto add = [&](const std::string& before, Seconds Round::*side) {
      row[before + "ready_s"] = spread([&](const Round& r) { return (r.*side).ready; });
      row[before + "render_s"] = spread([&](const Round& r) { return (r.*side).render; });
      row[before + "trace_s"] = spread([&](const Round& r) { return (r.*side).trace; });
      row[before + "shade_s"] = spread([&](const Round& r) { return (r.*side).shade; });
    };
    add("", &Round::ours);
    add("balanced_", &Round::balanced);
    row["whole_ratio"] = spread([](const Round& r) { return r.ours.whole() / r.balanced.whole(); });
    row["rays_ratio"] = spread([](const Round& r) { return r.ours.of_rays() / r.balanced.of_rays(); });
    row["trace_ratio"] = spread([](const Round& r) { return r.ours.trace / r.balanced.trace; });
    std::printf("%s\n", row.dump().c_str());
    std::fflush(stdout);
  }

  const Settings& settings_;
  const cl::Context& context_;
  std::uint64_t rays_ = 0;
  std::string plan_;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("What a whole picture takes with a plan, or sorted shadow rays, beside the balanced tree.");
  Settings settings;
  app.add_option("--scenes", settings.scenes, "generated scenes")->delimiter(',')->capture_default_str();
  app.add_option("--ways", settings.ways, "plan, light: what stands beside the balanced tree")
      ->delimiter(',')
      ->check(CLI::IsMember({"plan", "light"}))
      ->capture_default_str();
  app.add_option("--triangles", settings.triangles)->capture_default_str();
  app.add_option("--size", settings.size, "of the picture, both ways")->capture_default_str();
  app.add_option("--samples", settings.samples, "a pixel")->check(CLI::Range(1, 4096))->capture_default_str();
  app.add_option("--turn", settings.turn, "samples at a time")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--rounds", settings.rounds)->check(CLI::Range(1, 99))->capture_default_str();
  app.add_option("--seed", settings.seed)->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    const cl::Context context = bench::one_thread_context();
    Bench bench(settings, context);
    for (const std::string& scene : settings.scenes)
      for (const std::string& way : settings.ways) bench.run(scene, way);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
