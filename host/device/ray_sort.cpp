#include "gnomon/device/ray_sort.h"

#include <algorithm>
#include <bit>
#include <string>
#include <vector>

#include "gnomon/cl/program.h"
#include "gnomon/device/ray_batches.h"
#include "gnomon/shared/light_key.h"
#include "gnomon/shared/ray_key.h"

namespace gnomon {
namespace {

// 512 counters stay in a CPU's nearest cache.
constexpr std::uint32_t kDigitBits = 9;
static_assert(GN_RAY_KEY_BITS % kDigitBits == 0 && GN_LIGHT_KEY_BITS % kDigitBits == 0);

}  // namespace

RaySort::RaySort(const cl::Context& context, const GnBounds& bounds, std::span<const RayLight> lights)
    : context_(context), bounds_(bounds), light_count_(static_cast<std::uint32_t>(lights.size())) {
  if (lights.empty()) return;
  if (lights.size() > GN_MOST_RAY_LIGHTS) {
    throw Error(ErrorCode::kInvalidArgument, "rays are sorted by up to " +
                                                 std::to_string(GN_MOST_RAY_LIGHTS) + " lights, not by " +
                                                 std::to_string(lights.size()));
  }
  std::vector<GnRayLight> packed;
  for (const RayLight& light : lights) {
    packed.push_back({{light.place[0], light.place[1], light.place[2]}, light.is_sun ? 1U : 0U});
  }
  lights_ = context.create_buffer("ray_lights", packed.size() * sizeof(GnRayLight));
  context.upload_values<GnRayLight>(lights_, packed);
}

bool RaySort::by_light(std::size_t answer_bytes) const {
  return light_count_ != 0 && answer_bytes != sizeof(Hit);
}

SortPlan RaySort::plan_for(std::uint32_t count) const {
  const cl::DeviceInfo& device = context_.device();
  const auto widest =
      static_cast<std::uint32_t>(std::bit_floor(std::min<std::uint64_t>(device.max_work_group, 64)));
  SortPlan plan = plan_sort(device, count, device.is_cpu && device.loop_limit == 0 ? 1 : widest, 0);
  if (plan.work_group_size == 1) plan.digit_bits = kDigitBits;
  const std::uint64_t turns =
      std::max(std::uint64_t{plan.chunk_size}, std::uint64_t{plan.chunks()} << plan.digit_bits);
  if (device.loop_limit != 0 && turns > device.loop_limit) {
    throw Error(ErrorCode::kInvalidArgument, device.name + " ends loops after " +
                                                 std::to_string(device.loop_limit) +
                                                 " turns, too few to sort " + std::to_string(count) +
                                                 " rays; trace fewer at once, or do not sort them");
  }
  return plan;
}

void RaySort::make_room(const SortPlan& plan, std::size_t answer_bytes, bool counters) {
  const auto grow = [&](cl::Buffer& buffer, const char* name, std::size_t bytes) {
    if (buffer.bytes < bytes) buffer = context_.create_buffer(name, bytes);
  };
  const std::size_t rays = std::max(plan.count, 1U);
  grow(keys_, "ray_keys", rays * sizeof(GnMortonKey));
  grow(spare_keys_, "spare_ray_keys", rays * sizeof(GnMortonKey));
  grow(digits_, "ray_digits", plan.table_bytes());
  grow(rays_, "sorted_rays", rays * sizeof(Ray));
  grow(answers_, "sorted_answers", rays * answer_bytes);
  if (counters) grow(counters_, "sorted_counters", rays * sizeof(GnRayCounters));
}

template <typename... Arguments>
cl::Handle<cl_event> RaySort::launch_items(const Kernel& which, std::uint32_t count,
                                           std::span<const cl_event> wait_for,
                                           const Arguments&... arguments) const {
  const cl::Handle<cl_kernel> kernel = context_.programs().kernel({"ray_sort.cl"}, which.options, which.name);
  cl::set_arguments(kernel.get(), arguments..., count);
  const auto local =
      static_cast<std::size_t>(std::bit_floor(std::min<std::uint64_t>(context_.device().max_work_group, 64)));
  const std::size_t items =
      (std::size_t{std::max(count, 1U)} + which.rays_per_item - 1) / which.rays_per_item;
  return cl::enqueue(context_.queue(), kernel.get(), (items + local - 1) / local * local, local, wait_for);
}

void RaySort::find_keys(const SortPlan& plan, const Launch& launch, bool by_light,
                        std::span<const cl_event> wait_for, cl::StageTimes& times) const {
  const float* lo = bounds_.lo;
  const float extent = std::max({bounds_.hi[0] - lo[0], bounds_.hi[1] - lo[1], bounds_.hi[2] - lo[2]});
  const float scale = gn_bin_scale(0.0F, extent, by_light ? GN_PLACE_CELLS : GN_RAY_CELLS);
  if (!by_light) {
    times.add("sort rays", launch_items({"find_ray_keys"}, launch.count, wait_for, launch.rays, keys_, lo[0],
                                        lo[1], lo[2], scale));
    return;
  }
  // Lanes of lanes.h, where work-items do not stand side by side.
  const bool lanes = plan.work_group_size == 1;
  const Kernel kernel{"find_light_keys", lanes ? "-DGN_WGS=1" : "", lanes ? 4U : 1U};
  times.add("sort rays", launch_items(kernel, launch.count, wait_for, launch.rays, keys_, lights_,
                                      light_count_, lo[0], lo[1], lo[2], scale));
}

Launch RaySort::begin(const Launch& launch, std::size_t answer_bytes, bool counters,
                      std::span<const cl_event> wait_for, cl::StageTimes& times) {
  const SortPlan plan = plan_for(launch.count);
  make_room(plan, answer_bytes, counters);
  const bool lights = by_light(answer_bytes);
  find_keys(plan, launch, lights, wait_for, times);
  radix_sort(context_, plan, keys_, spare_keys_, digits_, lights ? GN_LIGHT_KEY_BITS : GN_RAY_KEY_BITS,
             times);
  times.add("sort rays", launch_items({"gather_rays"}, launch.count, {}, launch.rays, keys_, rays_));
  return {rays_.mem.get(), answers_.mem.get(), counters ? counters_.mem.get() : launch.counters,
          launch.count};
}

cl::Handle<cl_event> RaySort::end(const Launch& launch, std::size_t answer_bytes, bool counters,
                                  cl::StageTimes& times) {
  if (counters) {
    times.add("sort rays", launch_items({"scatter_2"}, launch.count, {}, counters_, keys_, launch.counters));
  }
  return launch_items({answer_bytes == sizeof(Hit) ? "scatter_4" : "scatter_1"}, launch.count, {}, answers_,
                      keys_, launch.answers);
}

double RaySort::run(const Launch& launch, std::size_t answer_bytes, bool counters,
                    const std::function<double(const Launch&)>& trace) {
  cl::StageTimes times;
  double ms = trace(begin(launch, answer_bytes, counters, {}, times));
  const auto last = end(launch, answer_bytes, counters, times);
  cl::wait(last);
  ms += event_ms(last);
  for (const auto& [stage, stage_ms] : times.milliseconds()) ms += stage_ms;
  return ms;
}

}  // namespace gnomon
