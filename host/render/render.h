// A picture of a scene through a tree on a device, in one of two ways. A preview: camera rays, direct light
// by shadow rays, a sky, matt surfaces, light that bounced once, smoothed; what bounced more often is a
// guess. Or path tracing (path_tracer.h), which guesses nothing and is noisy. Feeds the command line; both
// show the tree at work, and a leak in it as a speck.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gnomon/base/progress.h"
#include "gnomon/device/trace_device.h"
#include "gnomon/render/path_tracer.h"
#include "gnomon/render/picture.h"

namespace gnomon {

struct RenderOptions {
  std::uint32_t width = 1280;  // pixels, 1..16384
  std::uint32_t height = 720;  // width times height up to 2^26
  std::uint32_t samples = 4;   // camera rays per pixel, 1..4096
  std::uint64_t seed = 1;      // equal seeds, equal pictures
  bool heat_map = false;       // also count the boxes each camera ray tests; compiles a second program
  // render_paths through one tree: shadow rays light by light (TraceOptions::lights). Pays where they cost
  // much: a city's pictures took 0.8 of the time, a hall's 1.02. The same picture either way.
  bool sort_by_light = false;

  // Throws Error{kInvalidArgument} naming the option, its value and its range.
  void check() const;
};

struct RenderResult {
  Picture picture;
  std::vector<float>
      coverage;  // share of each pixel's camera rays that met a surface: weights for auto_exposure
  std::vector<float> boxes;  // with heat_map: mean boxes tested by a pixel's camera rays
  std::uint64_t camera_rays = 0;
  std::uint64_t other_rays = 0;    // to lights and for light that bounced
  double kernel_ms = 0.0;          // of all rays; 0 without profiling
  std::vector<std::string> notes;  // what was assumed, one sentence each
};

// A preview through the scene's first camera, or default_camera(scene). `tree` must be built over
// scene.triangles. Works in tiles: rays and hits take a bounded amount of memory, the host keeps 64 bytes a
// pixel. More than eight lights are sampled. Throws Error: kInvalidArgument (options), kOutOfMemory, kDevice,
// kCancelled.
[[nodiscard]] RenderResult render(const cl::Context& context, const DeviceBvh& tree, const Scene& scene,
                                  const RenderOptions& options = {}, const Progress& progress = {});

// The same by path tracing, through trees over scene.triangles. `tree` is the closest tracer's, for the heat
// map. `observer` sees every ray that is traced.
[[nodiscard]] RenderResult render_paths(const cl::Context& context, const PathTracers& tracers,
                                        const DeviceBvh& tree, const Scene& scene,
                                        const RenderOptions& options = {}, const Progress& progress = {},
                                        const RayObserver& observer = {});
// Through one tree.
[[nodiscard]] RenderResult render_paths(const cl::Context& context, const DeviceBvh& tree, const Scene& scene,
                                        const RenderOptions& options = {}, const Progress& progress = {},
                                        const RayObserver& observer = {});

}  // namespace gnomon
