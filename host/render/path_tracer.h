// A path tracer in wavefronts over any tracer: rays, hits and paths stay on the device, batch after batch.
// Solves the rendering equation for what a scene's materials say: matt and glossy surfaces, point, spot, sun
// and area lights, a sky. Not for smoothing or showing pictures (film.h, tone.h). Feeds render.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gnomon/base/progress.h"
#include "gnomon/device/trace_device.h"
#include "gnomon/render/path_options.h"
#include "gnomon/render/picture.h"

namespace gnomon {

// What a ray was traced for.
enum class RayUse : std::uint32_t {
  kCamera,
  kBounce,  // from a surface, for the closest hit
  kShadow,  // from a surface to a light, for any hit
};

// Whose ray it was: a place in the walk over the picture, eight by eight pixels at a time, and a sample.
struct PathId {
  std::uint32_t cell;
  std::uint32_t sample;
};

// Rays about to be traced together.
struct TracedRays {
  RayUse use;
  std::uint32_t bounce;  // surfaces that their paths have met
  std::span<const Ray> rays;
  std::span<const PathId> paths;          // one per ray
  std::span<const std::uint32_t> lights;  // shadow rays: the light's number (PathTracer::light_names)
};
using RayObserver = std::function<void(const TracedRays&)>;

struct PathCounts {
  std::uint64_t camera_rays = 0;
  std::uint64_t bounce_rays = 0;
  std::uint64_t shadow_rays = 0;
  double trace_ms = 0.0;  // device time of the rays; 0 without profiling
  double shade_ms = 0.0;  // of everything else
};

// What traces rays that look for the nearest hit, and what traces those that ask lights: trees over the same
// triangles give the same picture.
struct PathTracers {
  const Tracer& closest;
  const Tracer& any;
};

class PathTracer {
 public:
  // `tracer` must trace a tree over scene.triangles on `context`; all three must outlive this. Through the
  // scene's first camera, else default_camera(scene). Throws Error: kInvalidArgument, kOutOfMemory, kDevice.
  PathTracer(const cl::Context& context, const Tracer& tracer, const Scene& scene,
             const PathOptions& options = {});
  PathTracer(const cl::Context& context, const PathTracers& tracers, const Scene& scene,
             const PathOptions& options = {});
  PathTracer(PathTracer&&) noexcept;
  ~PathTracer();

  // Traces `count` more paths through every pixel. What the picture becomes does not depend on how its
  // samples are divided into calls. `observer` sees every ray, batch by batch; that brings rays to the host.
  // Throws Error: kOutOfMemory, kDevice, kCancelled; the samples are not whole then.
  void add_samples(std::uint32_t count, const Progress& progress = {}, const RayObserver& observer = {});

  [[nodiscard]] std::uint32_t samples() const;
  // The mean over samples; black before there is one.
  [[nodiscard]] Picture picture() const;
  // The share of each pixel's camera rays that met a surface.
  [[nodiscard]] std::vector<float> coverage() const;
  // Sums over samples, as the device holds them: radiance, and how many camera rays met a surface.
  [[nodiscard]] std::vector<std::array<float, 4>> film() const;
  [[nodiscard]] const PathCounts& counts() const;
  // What was assumed, one sentence each.
  [[nodiscard]] const std::vector<std::string>& notes() const;
  [[nodiscard]] const std::vector<std::string>& light_names() const;
  // The pixel (row by row from the top left) of a place in the walk, or GN_NONE.
  [[nodiscard]] std::uint32_t pixel_of(std::uint32_t cell) const;

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

}  // namespace gnomon
