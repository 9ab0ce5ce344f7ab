#include "gnomon/render/path_tracer.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "gnomon/cl/launch.h"
#include "gnomon/cl/program.h"
#include "gnomon/device/radix_sort.h"
#include "gnomon/render/path_scene.h"
#include "gnomon/shared/path_math.h"

namespace gnomon {
namespace {

constexpr std::uint32_t kPathsAtOnce = 1U << 18U;
// Where every ray keeps a stack in memory, and launches must be small.
constexpr std::uint32_t kPathsInPasses = 1U << 13U;
constexpr std::uint32_t kChunk = 256;  // rays that one work-item packs

// What a device that ends loops may be asked for at a step: every light is looked at twice.
constexpr std::uint32_t kTurnsPerLight = 64;

template <typename T>
cl::Buffer table_of(const cl::Context& context, const char* name, std::span<const T> values) {
  cl::Buffer buffer = context.create_buffer(name, std::max<std::size_t>(values.size_bytes(), sizeof(T)));
  context.upload_values<T>(buffer, values);
  return buffer;
}

// The scene in device memory.
struct Tables {
  Tables(const cl::Context& context, const Scene& scene, const PathScene& paths)
      : frame(table_of<GnPathFrame>(context, "path_frame", std::span(&paths.frame, 1))),
        triangles(table_of<Triangle>(context, "path_triangles", scene.triangles)),
        surface_ids(table_of<std::uint32_t>(context, "surface_ids", scene.material_ids)),
        surfaces(table_of<GnSurface>(context, "surfaces", paths.surfaces)),
        lights(table_of<GnPathLight>(context, "path_lights", paths.lights)),
        light_rows(table_of<float>(context, "path_light_rows", paths.light_rows)),
        emitters(table_of<GnEmitter>(context, "emitters", paths.emitters)),
        links(table_of<GnEmitterLink>(context, "emitter_links", paths.links)) {}
  cl::Buffer frame, triangles, surface_ids, surfaces, lights, light_rows, emitters, links;
};

// What a batch of paths needs.
struct Room {
  Room(const cl::Context& context, std::size_t n)
      : paths(context.create_buffer("paths", n * sizeof(GnPath))),
        lit(context.create_buffer("lit", n * sizeof(GnLit))),
        rays(context.create_buffer("path_rays", n * sizeof(Ray))),
        hits(context.create_buffer("path_hits", n * sizeof(Hit))),
        owners(context.create_buffer("ray_owners", n * sizeof(std::uint32_t))),
        next_rays(context.create_buffer("next_rays", n * sizeof(Ray))),
        next_owners(context.create_buffer("next_owners", n * sizeof(std::uint32_t))),
        shadow_rays(context.create_buffer("shadow_rays", n * sizeof(Ray))),
        asked_rays(context.create_buffer("asked_rays", n * sizeof(Ray))),
        asked_owners(context.create_buffer("asked_owners", n * sizeof(std::uint32_t))),
        occluded(context.create_buffer("occluded", n * sizeof(std::uint32_t))),
        counts(context.create_buffer("ray_counts", (n / kChunk + 2) * sizeof(std::uint32_t))) {}
  cl::Buffer paths, lit, rays, hits, owners, next_rays, next_owners, shadow_rays, asked_rays, asked_owners,
      occluded, counts;
};

// Part of the picture, some samples of it.
struct Batch {
  std::uint32_t first_cell, cells, first_sample, samples;
  [[nodiscard]] std::uint32_t paths() const { return cells * samples; }
  [[nodiscard]] PathId id_of(std::uint32_t path) const {
    return {first_cell + path % cells, first_sample + path / cells};
  }
};

void refuse_many_lights(const cl::DeviceInfo& device, std::size_t lights) {
  if (device.loop_limit == 0 || lights <= device.loop_limit / kTurnsPerLight) return;
  throw Error(ErrorCode::kDevice, device.name + " ends long loops, so paths can have at most " +
                                      std::to_string(device.loop_limit / kTurnsPerLight) + " lights, not " +
                                      std::to_string(lights) + "; use another device");
}

}  // namespace

class PathTracer::Work {
 public:
  Work(const cl::Context& context, const PathTracers& tracers, const Scene& scene, const PathOptions& options)
      : context_(context),
        tracers_(tracers),
        options_(options),
        scene_(make_path_scene(scene, options)),
        at_once_(paths_at_once()),
        lanes_(context.device().is_cpu && context.device().loop_limit == 0),
        tables_(context, scene, scene_),
        room_(context, at_once_),
        film_(context.create_buffer("film", pixels() * sizeof(std::array<float, 4>))) {
    refuse_many_lights(context.device(), scene_.lights.size());
    scan_.digit_bits = 8;
    step_ = context.programs().kernel({"path.cl"}, lanes_ ? "-DGN_WGS=1" : "", "step_paths");
    for (auto [kernel, name] : {std::pair{&begin_, "begin_paths"},
                                {&count_, "count_rays"},
                                {&pack_, "pack_rays"},
                                {&add_light_, "add_light"},
                                {&add_to_film_, "add_to_film"}})
      *kernel = context.programs().kernel({"path.cl"}, "", name);
  }

  void add_samples(std::uint32_t count, const Progress& progress, const RayObserver& observer) {
    const std::uint32_t cells = scene_.cells();
    const std::uint32_t together = std::max(1U, at_once_ / cells);
    const std::uint32_t last = samples_ + count;
    const std::uint64_t all = std::uint64_t{cells} * count;
    std::uint64_t done = 0;
    while (samples_ < last) {
      const std::uint32_t samples = std::min(together, last - samples_);
      for (std::uint32_t cell = 0; cell < cells; cell += at_once_) {
        const Batch batch{cell, std::min(at_once_, cells - cell), samples_, samples};
        const auto share = [&](double part) {
          return (static_cast<double>(done) + part * static_cast<double>(batch.paths())) /
                 static_cast<double>(all);
        };
        trace_batch(batch, observer, [&](double part) { report(progress, "render", share(part)); });
        done += batch.paths();
      }
      samples_ += samples;
    }
  }

  [[nodiscard]] std::size_t pixels() const { return std::size_t{options_.width} * options_.height; }
  [[nodiscard]] std::vector<std::array<float, 4>> film() const {
    if (samples_ == 0) return std::vector<std::array<float, 4>>(pixels());
    return context_.download_values<std::array<float, 4>>(film_, pixels());
  }

  const cl::Context& context_;
  const PathTracers tracers_;
  PathOptions options_;
  PathScene scene_;
  PathCounts counts_;
  std::uint32_t samples_ = 0;

 private:
  [[nodiscard]] std::uint32_t paths_at_once() const {
    const std::uint32_t suits = context_.device().loop_limit == 0 ? kPathsAtOnce : kPathsInPasses;
    const std::uint32_t wanted = options_.paths_at_once == 0 ? suits : options_.paths_at_once;
    return std::min(std::max(wanted, 1U), kPathsAtOnce);
  }

  [[nodiscard]] std::size_t group_size() const {
    return std::min<std::uint64_t>(std::bit_floor(std::max(1U, options_.work_group_size)),
                                   std::bit_floor(context_.device().max_work_group));
  }

  template <typename... Arguments>
  void launch_in(std::size_t local, const cl::Handle<cl_kernel>& kernel, std::size_t items,
                 const Arguments&... arguments) {
    cl::set_arguments(kernel.get(), arguments...);
    shading_.add("shade",
                 cl::enqueue(context_.queue(), kernel.get(), (items + local - 1) / local * local, local));
  }

  template <typename... Arguments>
  void launch(const cl::Handle<cl_kernel>& kernel, std::size_t items, const Arguments&... arguments) {
    launch_in(group_size(), kernel, items, arguments...);
  }

  template <typename... Arguments>
  void launch_on_scene(std::size_t local, const cl::Handle<cl_kernel>& kernel, std::size_t items,
                       const Arguments&... arguments) {
    launch_in(local, kernel, items, tables_.frame, tables_.triangles, tables_.surface_ids, tables_.surfaces,
              tables_.lights, tables_.light_rows, tables_.emitters, tables_.links, arguments...);
  }

  // With lanes a work-group is one item, which takes as many paths.
  void step(std::uint32_t bounce, std::uint32_t count) {
    const std::size_t local = lanes_ ? 1 : group_size();
    const std::uint32_t each = lanes_ ? static_cast<std::uint32_t>(group_size()) : 1;
    launch_on_scene(local, step_, (std::size_t{count} + each - 1) / each, room_.paths, room_.rays, room_.hits,
                    room_.owners, room_.next_rays, room_.shadow_rays, room_.lit, bounce, count, each);
  }

  void trace_batch(const Batch& batch, const RayObserver& observer,
                   const std::function<void(double)>& progress) {
    std::uint32_t count = batch.paths();
    launch_on_scene(group_size(), begin_, count, room_.paths, room_.rays, room_.owners, batch.first_cell,
                    batch.cells, batch.first_sample, count);
    // Places beyond the picture have no ray.
    count = pack(count, room_.rays, room_.owners, room_.next_rays, room_.next_owners);
    for (std::uint32_t bounce = 0; count > 0; ++bounce) {
      std::swap(room_.rays, room_.next_rays);
      std::swap(room_.owners, room_.next_owners);
      progress(1.0 - static_cast<double>(count) / batch.paths());
      (bounce == 0 ? counts_.camera_rays : counts_.bounce_rays) += count;
      show(observer, bounce == 0 ? RayUse::kCamera : RayUse::kBounce, bounce, batch, room_.rays, room_.owners,
           count);
      static_cast<void>(
          tracers_.closest.enqueue_closest(room_.rays.mem.get(), room_.hits.mem.get(), count, {}, &tracing_));
      step(bounce, count);
      ask_lights(batch, observer, bounce, count);
      if (bounce + 1 >= options_.max_bounces) break;
      // Into the buffers just read: no kernel needs their rays any more, and pack() wants other ones to
      // write.
      std::swap(room_.rays, room_.next_rays);
      count = pack(count, room_.rays, room_.owners, room_.next_rays, room_.next_owners);
    }
    launch(add_to_film_, batch.cells, tables_.frame, room_.paths, film_, batch.first_cell, batch.cells,
           batch.first_sample, batch.samples);
    collect_times();
  }

  void ask_lights(const Batch& batch, const RayObserver& observer, std::uint32_t bounce,
                  std::uint32_t count) {
    const std::uint32_t asked =
        pack(count, room_.shadow_rays, room_.owners, room_.asked_rays, room_.asked_owners);
    if (asked == 0) return;
    counts_.shadow_rays += asked;
    show(observer, RayUse::kShadow, bounce + 1, batch, room_.asked_rays, room_.asked_owners, asked);
    static_cast<void>(
        tracers_.any.enqueue_any(room_.asked_rays.mem.get(), room_.occluded.mem.get(), asked, {}, &tracing_));
    launch(add_light_, asked, room_.paths, room_.asked_owners, room_.occluded, room_.lit, asked);
  }

  // Returns how many rays there are; blocks.
  std::uint32_t pack(std::uint32_t count, const cl::Buffer& rays, const cl::Buffer& owners,
                     const cl::Buffer& packed, const cl::Buffer& packed_owners) {
    const std::uint32_t chunks = (count + kChunk - 1) / kChunk;
    launch(count_, chunks, rays, room_.counts, count, kChunk);
    scan_values(context_, scan_, room_.counts, chunks, "shade", shading_);
    launch(pack_, chunks, rays, owners, room_.counts, packed, packed_owners, count, kChunk);
    return context_.download_values<std::uint32_t>(room_.counts, 1, chunks).front();
  }

  void show(const RayObserver& observer, RayUse use, std::uint32_t bounce, const Batch& batch,
            const cl::Buffer& rays, const cl::Buffer& owners, std::uint32_t count) {
    if (!observer) return;
    const auto values = context_.download_values<Ray>(rays, count);
    const auto whose = context_.download_values<std::uint32_t>(owners, count);
    std::vector<PathId> paths(count);
    std::transform(whose.begin(), whose.end(), paths.begin(),
                   [&](std::uint32_t path) { return batch.id_of(path); });
    std::vector<std::uint32_t> lights;
    if (use == RayUse::kShadow) {
      const auto lit = context_.download_values<GnLit>(room_.lit, batch.paths());
      for (const std::uint32_t path : whose) lights.push_back(lit[path].light);
    }
    observer({use, bounce, values, paths, lights});
  }

  void collect_times() {
    const auto sum = [](cl::StageTimes& times) {
      double ms = 0.0;
      for (const auto& [stage, stage_ms] : times.milliseconds()) ms += stage_ms;
      times = {};
      return ms;
    };
    counts_.trace_ms += sum(tracing_);
    counts_.shade_ms += sum(shading_);
  }

  std::uint32_t at_once_;
  bool lanes_;  // of lanes.h, where work-items do not stand side by side
  Tables tables_;
  Room room_;
  cl::Buffer film_;
  SortPlan scan_;
  cl::Handle<cl_kernel> begin_, step_, count_, pack_, add_light_, add_to_film_;
  cl::StageTimes tracing_, shading_;
};

PathTracer::PathTracer(const cl::Context& context, const Tracer& tracer, const Scene& scene,
                       const PathOptions& options)
    : PathTracer(context, PathTracers{tracer, tracer}, scene, options) {}
PathTracer::PathTracer(const cl::Context& context, const PathTracers& tracers, const Scene& scene,
                       const PathOptions& options)
    : work_(std::make_unique<Work>(context, tracers, scene, options)) {}
PathTracer::PathTracer(PathTracer&&) noexcept = default;
PathTracer::~PathTracer() = default;

void PathTracer::add_samples(std::uint32_t count, const Progress& progress, const RayObserver& observer) {
  work_->add_samples(count, progress, observer);
}
std::uint32_t PathTracer::samples() const {
  return work_->samples_;
}
const PathCounts& PathTracer::counts() const {
  return work_->counts_;
}
const std::vector<std::string>& PathTracer::notes() const {
  return work_->scene_.notes;
}
const std::vector<std::string>& PathTracer::light_names() const {
  return work_->scene_.names;
}
std::uint32_t PathTracer::pixel_of(std::uint32_t cell) const {
  return gn_pixel_of(&work_->scene_.frame, cell);
}
std::vector<std::array<float, 4>> PathTracer::film() const {
  return work_->film();
}

Picture PathTracer::picture() const {
  Picture picture{work_->options_.width, work_->options_.height, {}};
  const float share = work_->samples_ == 0 ? 0.0F : 1.0F / static_cast<float>(work_->samples_);
  for (const auto& sum : film()) picture.pixels.push_back({share * sum[0], share * sum[1], share * sum[2]});
  return picture;
}

std::vector<float> PathTracer::coverage() const {
  std::vector<float> coverage;
  const float share = work_->samples_ == 0 ? 0.0F : 1.0F / static_cast<float>(work_->samples_);
  for (const auto& sum : film()) coverage.push_back(share * sum[3]);
  return coverage;
}

}  // namespace gnomon
