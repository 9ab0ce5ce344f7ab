// How long work tells its caller how far it is and learns that it should stop. Not for printing: the command
// line decides whether and where a line appears. Feeds importers, builders, tracers and the oracle.
#pragma once

#include <functional>
#include <string_view>

#include "gnomon/base/error.h"

namespace gnomon {

// Called now and then with the stage's name and its share done in [0, 1]. Returning false cancels the work,
// which then throws Error{kCancelled}. An empty function means: no reports, never cancelled.
using Progress = std::function<bool(std::string_view stage, double done)>;

// Reports, and throws Error{kCancelled} when the caller wants to stop.
inline void report(const Progress& progress, std::string_view stage, double done) {
  if (progress && !progress(stage, done)) throw Error(ErrorCode::kCancelled, "cancelled");
}

}  // namespace gnomon
