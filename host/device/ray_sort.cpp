#include "gnomon/device/ray_sort.h"

#include <algorithm>
#include <bit>
#include <string>

#include "gnomon/cl/program.h"
#include "gnomon/device/ray_batches.h"
#include "gnomon/shared/ray_key.h"

namespace gnomon {

SortPlan RaySort::plan_for(std::uint32_t count) const {
  const cl::DeviceInfo& device = context_.device();
  const auto widest =
      static_cast<std::uint32_t>(std::bit_floor(std::min<std::uint64_t>(device.max_work_group, 64)));
  SortPlan plan = plan_sort(device, count, device.is_cpu && device.loop_limit == 0 ? 1 : widest, 0);
  if (plan.work_group_size == 1) plan.digit_bits = GN_RAY_KEY_BITS / 2;
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
cl::Handle<cl_event> RaySort::launch_items(const char* name, std::uint32_t count,
                                           std::span<const cl_event> wait_for,
                                           const Arguments&... arguments) const {
  const cl::Handle<cl_kernel> kernel = context_.programs().kernel({"ray_sort.cl"}, "", name);
  cl::set_arguments(kernel.get(), arguments..., count);
  const auto local =
      static_cast<std::size_t>(std::bit_floor(std::min<std::uint64_t>(context_.device().max_work_group, 64)));
  const std::size_t global = (std::size_t{std::max(count, 1U)} + local - 1) / local * local;
  return cl::enqueue(context_.queue(), kernel.get(), global, local, wait_for);
}

Launch RaySort::begin(const Launch& launch, std::size_t answer_bytes, bool counters,
                      std::span<const cl_event> wait_for, cl::StageTimes& times) {
  const SortPlan plan = plan_for(launch.count);
  make_room(plan, answer_bytes, counters);
  const float extent =
      std::max({bounds_.hi[0] - bounds_.lo[0], bounds_.hi[1] - bounds_.lo[1], bounds_.hi[2] - bounds_.lo[2]});
  const float scale = gn_bin_scale(0.0F, extent, GN_RAY_CELLS);
  times.add("sort rays", launch_items("find_ray_keys", launch.count, wait_for, launch.rays, keys_,
                                      bounds_.lo[0], bounds_.lo[1], bounds_.lo[2], scale));
  radix_sort(context_, plan, keys_, spare_keys_, digits_, GN_RAY_KEY_BITS, times);
  times.add("sort rays", launch_items("gather_rays", launch.count, {}, launch.rays, keys_, rays_));
  return {rays_.mem.get(), answers_.mem.get(), counters ? counters_.mem.get() : launch.counters,
          launch.count};
}

cl::Handle<cl_event> RaySort::end(const Launch& launch, std::size_t answer_bytes, bool counters,
                                  cl::StageTimes& times) {
  if (counters) {
    times.add("sort rays", launch_items("scatter_2", launch.count, {}, counters_, keys_, launch.counters));
  }
  return launch_items(answer_bytes == sizeof(Hit) ? "scatter_4" : "scatter_1", launch.count, {}, answers_,
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
