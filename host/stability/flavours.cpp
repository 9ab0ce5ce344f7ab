#include "gnomon/stability/flavours.h"

namespace gnomon::stability {

std::vector<Builder> builders() {
  BuildOptions fast;
  fast.builder = gnomon::Builder::kFast;
  BuildOptions best;
  best.builder = gnomon::Builder::kBest;
  return {{"balanced", {}}, {"fast", fast}, {"best", best}};
}

std::vector<Flavour> flavours_of(const cl::DeviceInfo& device) {
  TraceOptions thread;
  thread.flavour = TraceFlavour::kThread;
  std::vector<Flavour> flavours{{"thread", thread}};
  if (device.loop_limit != 0) return flavours;  // such devices trace the binary tree
  TraceOptions wide;
  wide.flavour = TraceFlavour::kWide;
  flavours.push_back({"wide", wide});
  TraceOptions packet;
  packet.flavour = TraceFlavour::kPacket;
  flavours.push_back({"packet", packet});
  TraceOptions compact;
  compact.flavour = TraceFlavour::kCompact;
  flavours.push_back({"compact", compact});
  wide.portable = packet.portable = true;
  flavours.push_back({"wide portable", wide});
  flavours.push_back({"packet portable", packet});
  return flavours;
}

}  // namespace gnomon::stability
