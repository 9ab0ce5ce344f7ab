#include "gnomon/compare/report.h"

#include <algorithm>

namespace gnomon::compare {

const char* to_string(Family family) {
  switch (family) {
    case Family::kSurface:
      return "surface area";
    case Family::kRays:
      return "rays of one source";
    case Family::kMixture:
      return "mixture";
    case Family::kPeer:
      return "peer";
  }
  return "?";
}

bool Report::complete() const {
  return !devices.empty() && std::all_of(devices.begin(), devices.end(),
                                         [](const DeviceReport& device) { return device.complete; });
}

const std::vector<double>& seconds_of(const Rounds& rounds, const std::string& clock) {
  return clock == "cpu" ? rounds.cpu_s : rounds.wall_s;
}

}  // namespace gnomon::compare
