// What every bench needs: process CPU time, pairs timed in alternation, spreads as JSON, scenes from the
// command line. Not for charts. Feeds the files of this folder.
#pragma once

#include <time.h>

#include <cstdint>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "arguments.h"
#include "gnomon/base/stats.h"
#include "gnomon/cl/context.h"

namespace gnomon::bench {

using nlohmann::json;

// CPU time of all threads: time lost to other processes does not count.
inline double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

inline json spread_json(const std::vector<double>& values) {
  const Spread s = spread_of(values);
  return {{"median", s.median}, {"min", s.min}, {"max", s.max}, {"n", s.count}};
}

// Seconds of both sides over the rounds; the one that goes first changes every round.
struct Paired {
  std::vector<double> ours;
  std::vector<double> peer;
};

template <typename Ours, typename Peer>
Paired measure(int rounds, const Ours& ours, const Peer& peer) {
  const auto timed = [](const auto& work) {
    const double start = cpu_seconds();
    work();
    return cpu_seconds() - start;
  };
  ours();
  peer();
  Paired out;
  for (int round = 0; round < rounds; ++round) {
    if (round % 2 == 0) {
      out.ours.push_back(timed(ours));
      out.peer.push_back(timed(peer));
    } else {
      out.peer.push_back(timed(peer));
      out.ours.push_back(timed(ours));
    }
  }
  return out;
}

using SceneList = std::vector<std::pair<std::string, std::uint64_t>>;

// SCENE TRIANGLES pairs, or two large scenes. Throws invalid_argument for what is neither.
inline SceneList scenes_from(int argc, char** argv) {
  SceneList scenes;
  for (int i = 1; i < argc; i += 2)
    scenes.emplace_back(argv[i],
                        count_from(i + 1 < argc ? argv[i + 1] : "", std::string("triangles of ") + argv[i]));
  if (scenes.empty()) scenes = {{"city", 1'000'000}, {"atrium", 1'000'000}};
  return scenes;
}

// GNOMON_DEVICE or the default choice, on one thread where that is PoCL.
inline cl::Context one_thread_context(const cl::ContextOptions& options = {}) {
  // Before the first OpenCL call: PoCL reads it once.
  setenv("POCL_MAX_PTHREAD_COUNT", "1", 0);
  const char* choice = std::getenv("GNOMON_DEVICE");
  return cl::Context(cl::choose_device(cl::list_devices(), choice == nullptr ? "" : choice), options);
}

}  // namespace gnomon::bench
