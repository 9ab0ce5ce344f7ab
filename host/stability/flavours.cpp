#include "gnomon/stability/flavours.h"

namespace gnomon::stability {

std::vector<Builder> builders() {
  return {{"balanced", {}}};
}

std::vector<Flavour> flavours_of(const cl::DeviceInfo& device) {
  TraceOptions thread;
  thread.flavour = TraceFlavour::kThread;
  std::vector<Flavour> flavours{{"thread", thread}};
  if (device.loop_limit != 0) return flavours;  // such devices trace the binary tree
  TraceOptions wide;
  wide.flavour = TraceFlavour::kWide;
  flavours.push_back({"wide", wide});
  wide.portable = true;
  flavours.push_back({"wide portable", wide});
  return flavours;
}

}  // namespace gnomon::stability
