// A sample of the rays a path tracer traces: bounded, even within each kind, light and depth, the same for
// the same picture however its work was cut. Not for files (scene/ray_record.h). Feeds the command line.
#pragma once

#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "gnomon/render/path_tracer.h"
#include "gnomon/scene/ray_record.h"

namespace gnomon {

class RayRecorder {
 public:
  // Keeps `most` rays at most. Every ray has a number that seed, path, depth and use decide; a stratum keeps
  // those with the smallest (bottom-k sampling, Cohen and Kaplan 2007).
  RayRecorder(std::uint64_t most, std::uint64_t seed) : most_(most), seed_(seed) {}

  // For PathTracer::add_samples.
  void add(const TracedRays& traced);

  // Strata in order of kind, light and depth, rays of a stratum in the walk over the picture and its samples.
  // A stratum with fewer rays than an even share gives the rest to others.
  [[nodiscard]] RayRecord record() const;

 private:
  struct Kept {
    std::uint64_t number;
    PathId path;
    std::uint32_t bounce;
    Ray ray;
  };
  struct Stratum {
    std::uint64_t traced = 0;
    std::uint64_t limit = UINT64_MAX;  // larger numbers are not kept
    std::vector<Kept> kept;
  };
  using Key = std::tuple<RecordedKind, std::uint32_t, std::uint32_t>;  // kind, light, depth

  [[nodiscard]] std::uint64_t even_share() const;
  void trim();

  std::uint64_t most_;
  std::uint64_t seed_;
  std::map<Key, Stratum> strata_;
};

}  // namespace gnomon
