// A report made by hand: three methods of ours and a peer, two kinds of rays, numbers that can be reckoned in
// the head. Feeds the tests of host/compare.
#pragma once

#include <string>
#include <vector>

#include "gnomon/compare/report.h"

namespace gnomon::compare::test {

struct SampleMethod {
  std::string name;
  Family family;
  std::vector<double> build_s;
  std::vector<double> primary_s, bounce_s;  // of 1000 rays, by round
  std::uint64_t bytes;
  std::uint64_t wrong;  // of 100 judged rays of each kind
};

inline void add(DeviceReport& device, const SampleMethod& m) {
  device.methods.push_back(
      {m.name, m.family, "what " + m.name + " is", m.family == Family::kPeer ? "" : "--some"});
  BuildRow build;
  build.method = m.name;
  build.rounds = {m.build_s, m.build_s};
  build.bytes = m.bytes;
  build.tree_hash = m.family == Family::kPeer ? "" : "0123456789abcdef";
  build.sah_cost = m.family == Family::kPeer ? 0.0 : 40.0;
  build.flavour = "packet";
  device.builds.push_back(build);
  for (const auto& [kind, seconds] : {std::pair{"primary", m.primary_s}, std::pair{"bounce", m.bounce_s}}) {
    TraceRow trace;
    trace.method = m.name;
    trace.kind = kind;
    trace.rays = 1000;
    trace.hits = 900;
    trace.passes = 3;
    trace.rounds = {seconds, seconds};
    trace.counted = m.family != Family::kPeer;
    trace.boxes_per_ray = trace.counted ? 25.0 : 0.0;
    trace.triangles_per_ray = trace.counted ? 6.0 : 0.0;
    device.traces.push_back(trace);
    AccuracyRow accuracy;
    accuracy.method = m.name;
    accuracy.kind = kind;
    accuracy.same_as = m.family == Family::kPeer || m.name == "sah-balanced" ? "" : "sah-balanced";
    accuracy.judged = 100;
    accuracy.hits = 90;
    accuracy.lost = m.wrong;
    accuracy.max_t_error_ulp = m.family == Family::kPeer ? 3.5 : 0.5;
    accuracy.t_error_steps = {{0.5, 80}, {m.family == Family::kPeer ? 3.5 : 0.75, 10}};
    device.accuracies.push_back(accuracy);
    if (m.family != Family::kPeer) device.predictions.push_back({m.name, kind, 500, 30.0, 36.0, 0.5});
  }
}

// sah-fast builds in half the time and traces at half the speed; sah-best takes four times as long and traces
// twice as fast; the peer is faster still, and wrong.
inline Report sample_report() {
  DeviceReport device;
  device.name = "a device <of> sorts";
  device.driver = "1.0";
  device.platform = "a platform";
  device.opencl = "OpenCL 1.2";
  device.kind = "cpu";
  device.compute_units = 2;
  add(device,
      {"sah-balanced", Family::kSurface, {1.0, 1.0, 1.0}, {2.0, 2.0, 2.0}, {4.0, 4.0, 4.0}, 1 << 20, 0});
  add(device, {"sah-fast", Family::kSurface, {0.5, 0.5, 0.5}, {4.0, 4.0, 4.0}, {8.0, 8.0, 8.0}, 1 << 20, 0});
  add(device, {"sah-best", Family::kSurface, {4.0, 4.0, 4.0}, {1.0, 1.0, 1.25}, {2.0, 2.0, 2.5}, 2 << 20, 0});
  add(device,
      {"embree-default", Family::kPeer, {0.25, 0.25, 0.25}, {0.5, 0.5, 0.5}, {1.0, 1.0, 1.0}, 3 << 20, 2});
  for (const auto& [name, seconds] : {std::pair{"sah-balanced", 1.0}, std::pair{"sah-fast", 0.5}})
    for (const double size : {308.0, 1234.0})
      device.sizes.push_back({name,
                              "primary",
                              static_cast<std::uint64_t>(size),
                              1000,
                              true,
                              {{seconds * size, seconds * size}, {seconds, seconds}},
                              {{4.0, 4.0}, {4.0, 4.0}}});
  device.areas = {{"sah-balanced", "light 0 (a <sun>)", 1000, 20.0, 5.0},
                  {"pah", "light 0 (a <sun>)", 1000, 10.0, 2.5},
                  {"auto", "light 0 (a <sun>)", 1000, 5.0, 1.25}};
  device.decisions = {{"auto", "primary", "closest", 1e6, "sah-mix", "10 % <cheaper>", 640, 20.0, 18.0, 4.5}};
  device.left_out = {{"pah-plane@light", "build", "no time: the budget is 1 s"}};
  device.done = {"builds", "trace primary", "trace bounce"};
  device.pictures.png = {{"", "not really a PNG"}, {"sah-balanced", std::string("\0\1\2\3", 4)}};
  device.pictures.mean = {{"sah-balanced", 12.5}};
  device.pictures.white = 40.0;
  device.pictures.width = 2;
  device.pictures.height = 1;
  device.complete = true;
  Report report;
  report.version = "0.1.0";
  report.commit = "abcdef";
  report.command = "gnomon compare 'a </script> b'";
  report.scene = "a </script> b";
  report.scene_name = "a scene & more";
  report.scene_hash = "fedcba9876543210";
  report.triangles = 1234;
  report.options = {{"seed of rays", "1"}};
  report.devices = {device};
  return report;
}

}  // namespace gnomon::compare::test
