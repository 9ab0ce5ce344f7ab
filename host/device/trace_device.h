// Tracing batches of rays through a tree on a device. Not for making rays or judging hits. Feeds the command
// line, the renderer, benches. Both ways to call it: with host memory (blocking, any batch size), or with the
// caller's buffers (only enqueues, returns an event).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "gnomon/base/progress.h"
#include "gnomon/cl/context.h"
#include "gnomon/cl/launch.h"
#include "gnomon/device/build_device.h"
#include "gnomon/device/collapse_device.h"
#include "gnomon/device/compact_device.h"

namespace gnomon {

using Ray = GnRay;
using Hit = GnHit;

// How rays are traced; the answers are the same bits.
enum class TraceFlavour : std::uint32_t {
  kAuto,     // on CPUs that let loops run packet where it pays and wide where not, told from what packets do;
             // thread elsewhere
  kThread,   // the binary tree, one box at a time: one ray per work-item is the parallelism
  kWide,     // the wide tree, eight boxes at a time: explicit vectors are
  kPacket,   // the same; where 64 or 16 consecutive rays run together (through a point, or parallel), as one
  kCompact,  // half of the wide tree's memory or less, one ray per work-item: for devices where memory
             // traffic decides
};
[[nodiscard]] const char* to_string(TraceFlavour flavour);

// What hits are worth.
enum class Accuracy : std::uint32_t {
  kWatertight,  // decided exactly, t right to the last bit or so (host/notes/exact-hits.md)
  // By floats alone, wide and packet flavours only: about a tenth faster, and wrong where rays pass edges or
  // start on surfaces: hits may be lost, added or far off (host/notes/stability.md says how many).
  kFast,
};
[[nodiscard]] const char* to_string(Accuracy accuracy);

// What many rays go to or come from: a point, or a sun, whose rays are parallel.
struct RayLight {
  bool is_sun = false;
  std::array<float, 3> place{};  // the point; of a sun the way its rays go, in either sense
};

struct TraceOptions {
  TraceFlavour flavour = TraceFlavour::kAuto;
  Accuracy accuracy = Accuracy::kWatertight;
  bool portable = false;  // wide and packet: OpenCL C alone, without the device compiler's own instructions
  // Also count boxes and triangles per ray; slower. Rays of a packet count what their sixteen were tested
  // against, the first also what was tested for all at once.
  bool counters = false;
  // Trace each batch in the order of its rays' origins along a curve through the scene: pays where rays that
  // follow each other start far apart. Answers stay in the caller's order, and are the same bits.
  bool sort_rays = false;
  // Up to 31 whose shadow rays are to be traced together: any-hit batches go light by light, neighbours one
  // after another, so that packets can take them, and rays of none of these last. For rays in no order, or
  // mixed; nobody needs to say which ray is whose.
  std::vector<RayLight> lights;
  std::uint32_t work_group_size = 64;  // power of two up to the device's limit
  // A ray's nodes and triangles per launch; rays that need more go on in another launch. 0: all in one,
  // unless the device ends long loops (DeviceInfo::loop_limit). For devices that stop kernels which run for
  // long.
  std::uint32_t step_limit = 0;
};

// Answers of a batch. One of hits and occluded is filled, by the call made.
struct TraceResult {
  std::vector<Hit> hits;                // closest(): one per ray
  std::vector<std::uint32_t> occluded;  // any(): 1 or 0 per ray
  std::vector<GnRayCounters> counters;  // when asked for
  std::uint64_t invalid_rays = 0;       // NaN, infinite origin or zero direction: they miss
  double kernel_ms = 0.0;               // device time; 0 without profiling
};

struct Launch;  // ray_batches.h
struct Passes;
// Enqueues pass number `pass` of a launch, after the given events.
using EnqueuePass = std::function<cl::Handle<cl_event>(const Launch&, const Passes&, std::uint32_t pass,
                                                       std::span<const cl_event> wait_for)>;
struct TracePlan;
class RaySort;

// Holds the kernels for one tree. The context and the tree must outlive it.
class Tracer {
 public:
  // Wide, packet and compact collapse the tree first and keep the result; leaves too large for it leave kAuto
  // with the thread flavour. Where boxes stand in a frame (gnomon/tree/box_frame.h) only wide and packet
  // will do. Throws Error: kDevice, kOutOfMemory, kInvalidArgument.
  Tracer(const cl::Context& context, const DeviceBvh& tree, const TraceOptions& options = {});
  // Traces a wide tree, or for the compact flavour what it makes of it; the flavour asked for must not be
  // thread. Throws the same.
  Tracer(const cl::Context& context, const DeviceWideBvh& tree, const TraceOptions& options = {});
  // Traces a compact tree; the flavour asked for must be compact or left to us. Throws the same.
  Tracer(const cl::Context& context, const DeviceCompactBvh& tree, const TraceOptions& options = {});
  Tracer(Tracer&&) noexcept;
  ~Tracer();

  // Blocking. Throws Error: kOutOfMemory, kDevice, kCancelled.
  [[nodiscard]] TraceResult closest(std::span<const Ray> rays, const Progress& progress = {}) const;
  [[nodiscard]] TraceResult any(std::span<const Ray> rays, const Progress& progress = {}) const;

  // Enqueue on the context's queue and return: rays holds `count` GnRay; hits receives `count` GnHit,
  // occluded `count` uint32. Waits for the given events on the device. Options' counters are not available
  // this way. With a step limit this enqueues as many passes as the tree could need at worst, and needs
  // memory for `count` stacks. The event is the last command's; `times` gets those of all that took time, of
  // passes only the last.
  [[nodiscard]] cl::Handle<cl_event> enqueue_closest(cl_mem rays, cl_mem hits, std::uint32_t count,
                                                     std::span<const cl_event> wait_for = {},
                                                     cl::StageTimes* times = nullptr) const;
  [[nodiscard]] cl::Handle<cl_event> enqueue_any(cl_mem rays, cl_mem occluded, std::uint32_t count,
                                                 std::span<const cl_event> wait_for = {},
                                                 cl::StageTimes* times = nullptr) const;
  [[nodiscard]] TraceFlavour flavour() const { return flavour_; }
  // Rays so far that were not traceable, over all calls. Blocks until earlier launches are done.
  [[nodiscard]] std::uint64_t invalid_rays() const;

 private:
  [[nodiscard]] bool collapse(const DeviceBvh& tree, const TraceOptions& options);
  void trace_binary(const DeviceBvh& tree, const TraceOptions& options);
  void trace_wide(const DeviceWideBvh& tree, const TraceOptions& options);
  void trace_compact(const DeviceCompactBvh& tree, const TraceOptions& options);
  void set_up(const char* source);
  [[nodiscard]] cl::Handle<cl_event> enqueue(const cl::Handle<cl_kernel>& kernel, const Launch& launch,
                                             const Passes& passes, std::uint32_t pass,
                                             std::span<const cl_event> wait_for) const;
  [[nodiscard]] EnqueuePass enqueuer(const cl::Handle<cl_kernel>& kernel) const;
  [[nodiscard]] RaySort* sort_for(std::size_t answer_bytes) const;
  [[nodiscard]] cl::Handle<cl_event> enqueue_batch(const cl::Handle<cl_kernel>& kernel, const Launch& launch,
                                                   std::size_t answer_bytes,
                                                   std::span<const cl_event> wait_for,
                                                   cl::StageTimes* times) const;
  template <typename Answer>
  [[nodiscard]] TraceResult trace_all(const cl::Handle<cl_kernel>& kernel, std::span<const Ray> rays,
                                      std::vector<Answer> TraceResult::*answers,
                                      const Progress& progress) const;

  const cl::Context& context_;
  TraceFlavour flavour_;
  DeviceWideBvh collapsed_;     // when the tracer made it
  DeviceCompactBvh compacted_;  // the same
  cl_mem nodes_ = nullptr;
  cl_mem triangles_ = nullptr;
  std::unique_ptr<TracePlan> plan_;
  std::unique_ptr<RaySort> sort_;  // when rays are to be sorted
  bool sorts_closest_;             // those of closest hits, too
  cl::Handle<cl_kernel> closest_;
  cl::Handle<cl_kernel> any_;
  cl::Buffer invalid_;
  cl::Buffer no_counters_;
  cl::Buffer frame_;    // that boxes stand in; none: empty
  cl::Buffer regions_;  // with trees of their own; none: empty
};

}  // namespace gnomon
