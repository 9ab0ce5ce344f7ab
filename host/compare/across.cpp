#include "gnomon/compare/across.h"

#include <algorithm>
#include <memory>

#include "gnomon/compare/contest.h"

namespace gnomon::compare {
namespace {

constexpr const char* kStep = "across";

class Across {
 public:
  Across(std::span<const AcrossDevice> devices, const Scene& scene, const RunOptions& options,
         const Progress& progress)
      : devices_(devices), scene_(scene), options_(options), progress_(progress), start_(wall_now()) {}

  void all() {
    for (const AcrossDevice& device : devices_) {
      tell("first build on " + device.report->name, 0.0);
      device.report->across.clear();
      entrants_.push_back(own_methods(*device.context, scene_, {}).front().enter());
      entrants_.back()->build({});
    }
    std::vector<Contestant> contest;
    for (const auto& entrant : entrants_)
      contest.push_back({[&entrant] {
                           entrant->build({});
                           entrant->forget_tree();
                         },
                         {}});
    hold(contest, "builds", until(1.0, 1.0 + static_cast<double>(options_.kinds.size())));
    keep(contest, "", 0);
    for (std::size_t i = 0; i < options_.kinds.size(); ++i)
      trace(options_.kinds[i], until(1.0, static_cast<double>(options_.kinds.size() - i)));
  }

 private:
  void tell(const std::string& stage, double done) const {
    gnomon::report(progress_, "over devices: " + stage, done);
  }
  [[nodiscard]] double until(double weight, double weights_left) const {
    return wall_now() + std::max(0.0, options_.seconds - (wall_now() - start_)) * weight / weights_left;
  }

  void hold(std::vector<Contestant>& contest, const std::string& stage, double deadline) const {
    run_contest(contest, options_.rounds, deadline, wall_now,
                [&](int done, int most) { tell(stage, static_cast<double>(done) / most); });
  }

  void keep(const std::vector<Contestant>& contest, const std::string& kind, std::uint64_t rays) const {
    for (std::size_t i = 0; i < devices_.size(); ++i)
      devices_[i].report->across.push_back({kind, rays, contest[i].rounds});
  }

  // The same rays on each device.
  [[nodiscard]] std::vector<Batch> batches(const std::string& kind, std::uint64_t count) const {
    std::vector<Batch> out;
    for (const AcrossDevice& device : devices_)
      out.push_back(make_batch(
          *device.context, scene_,
          [this](std::span<const Ray> rays) { return entrants_.front()->closest(rays); }, kind, count,
          options_.seed));
    return out;
  }

  void trace(const std::string& kind, double deadline) const {
    tell(kind, 0.0);
    if (batches(kind, kLeastRays).front().rays.empty()) return;
    const auto seconds_per_ray = [&](std::uint64_t count) {
      const std::vector<Batch> some = batches(kind, count);
      const double begun = wall_now();
      for (std::size_t i = 0; i < entrants_.size(); ++i) entrants_[i]->trace(some[i]);
      return (wall_now() - begun) / static_cast<double>(some.front().rays.size());
    };
    const std::vector<Batch> rays =
        batches(kind, fitting_rays(options_.ray_count, options_.rounds, deadline, wall_now, seconds_per_ray));
    std::vector<Contestant> contest;
    for (std::size_t i = 0; i < entrants_.size(); ++i)
      contest.push_back({[this, &rays, i] { entrants_[i]->trace(rays[i]); }, {}});
    hold(contest, kind, deadline);
    keep(contest, kind, rays.front().rays.size());
  }

  std::span<const AcrossDevice> devices_;
  const Scene& scene_;
  const RunOptions& options_;
  const Progress& progress_;
  double start_;
  std::vector<std::unique_ptr<Entrant>> entrants_;
};

bool has_it(const AcrossDevice& device) {
  const auto& done = device.report->done;
  return std::find(done.begin(), done.end(), kStep) != done.end();
}

}  // namespace

void run_across(std::span<const AcrossDevice> devices, const Scene& scene, const RunOptions& options,
                const std::function<void()>& after_step, const Progress& progress) {
  if (devices.size() < 2 || std::all_of(devices.begin(), devices.end(), has_it)) return;
  Across(devices, scene, options, progress).all();
  for (const AcrossDevice& device : devices)
    if (!has_it(device)) device.report->done.emplace_back(kStep);
  after_step();
}

}  // namespace gnomon::compare
