// A scene as the path tracer's kernels read it: a table each of surfaces, lights and emissive triangles. Not
// for tracing. Feeds path_tracer.cpp and path_reference.cpp.
#pragma once

#include <string>
#include <vector>

#include "gnomon/render/path_options.h"
#include "gnomon/shared/path_layout.h"

namespace gnomon {

struct PathScene {
  GnPathFrame frame{};
  std::vector<GnSurface> surfaces;   // the scene's materials
  std::vector<GnPathLight> lights;   // those that shine, and the sky as the last; a sun where there are none
  std::vector<float> light_rows;     // the same, as lanes read them (path_layout.h)
  std::vector<GnEmitter> emitters;   // triangles of area lights, light after light
  std::vector<GnEmitterLink> links;  // sorted by triangle
  std::vector<std::string> names;    // of lights
  std::vector<std::string> notes;    // what was assumed, one sentence each
  [[nodiscard]] std::uint32_t cells() const;  // places in the walk over the picture, those beyond it included
};

// Through the scene's first camera, or default_camera(scene). Emissive triangles that no light of the scene
// names shine too, but only scattered rays find them. Throws as options.check().
[[nodiscard]] PathScene make_path_scene(const Scene& scene, const PathOptions& options);

}  // namespace gnomon
