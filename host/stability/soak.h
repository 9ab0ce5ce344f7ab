// The long run: rays of many kinds through scenes at many distances from the origin, traced by every flavour
// and judged ray by ray, in chunks, so that any number of rays takes the same memory. Not the catalogue.
// Feeds the command.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gnomon/cl/context.h"
#include "gnomon/scene/scene.h"
#include "gnomon/tree/oracle.h"

namespace gnomon::stability {

struct SoakOptions {
  std::uint64_t rays = 1'000'000;  // in all, shared evenly by scenes and distances; at least one for each
  std::uint64_t seed = 1;
  std::uint32_t chunk = 1U << 16U;  // rays at a time
  unsigned threads = 0;             // of the judge; 0: all
  std::vector<Scene> scenes;        // empty: some that are generated
};

// What the rays of one scene at one distance gave, for one builder.
struct SoakPart {
  std::string scene;
  std::string scene_hash;
  std::string builder;
  std::uint64_t triangles = 0;
  double offset = 0.0;  // from the origin on every axis, in units of the scene's longest side
  std::uint64_t rays = 0;
  std::uint64_t at_corners = 0;       // of them, aimed at corners,
  std::uint64_t at_edges = 0;         // at middles of edges,
  std::uint64_t exactly = 0;          // and of both, so that the ray truly has the point
  std::uint64_t invalid = 0;          // refused by the tracer
  std::uint64_t flavours_differ = 0;  // rays that two flavours answer otherwise
  OracleReport oracle;
  // Exact: the device has double; elsewhere only losses count (case.h), and each hit has its own bound on t.
  [[nodiscard]] bool ok(bool exact) const;
};

struct SoakReport {
  std::vector<SoakPart> parts;
  std::vector<std::string> flavours;
  double seconds = 0.0;
  bool stopped = false;                  // before all rays were judged, at the caller's wish
  [[nodiscard]] SoakPart total() const;  // sums; scene, hash and offset are left empty
};

// The caller's progress function also hears how long it will take yet; when it returns false, what has been
// judged is returned. Throws Error as builders and tracers do, kInvalidArgument (no rays, no chunk).
[[nodiscard]] SoakReport soak(const cl::Context& context, const SoakOptions& options,
                              const Progress& progress = {});

}  // namespace gnomon::stability
