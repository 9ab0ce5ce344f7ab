#include "gnomon/device/radix_sort.h"

#include <algorithm>
#include <utility>

#include "gnomon/cl/program.h"

namespace gnomon {

namespace {

const std::vector<std::string> kSources = {"radix_sort.cl"};
constexpr std::uint32_t kMostBits = 11;

}  // namespace

std::uint64_t SortPlan::table_bytes() const {
  return ((std::uint64_t{chunks()} << digit_bits) + 1) * sizeof(std::uint32_t);
}

std::string SortPlan::program_options() const {
  return "-DGN_WGS=" + std::to_string(work_group_size) + " -DGN_DIGIT_BITS=" + std::to_string(digit_bits) +
         " -DGN_KIND=0u";
}

SortPlan plan_sort(const cl::DeviceInfo& device, std::uint32_t count, std::uint32_t work_group_size,
                   std::uint32_t chunk_size) {
  SortPlan plan;
  plan.count = count;
  plan.work_group_size = work_group_size;
  const bool serial = work_group_size == 1;
  // Many digits mean few passes; their counters must be few beside the pairs, and stay in the cache.
  plan.digit_bits = !serial ? 4 : count < (1U << 16U) ? 8 : kMostBits;
  // A chunk's counts cost as much as so many pairs; on GPUs a thousand groups are plenty.
  const std::uint32_t share = serial ? count / (4 * std::max(1U, device.compute_units)) : count / 1024;
  plan.chunk_size = chunk_size != 0 ? chunk_size : std::max(4096U, share + 1);
  return plan;
}

void radix_sort(const cl::Context& context, const SortPlan& plan, cl::Buffer& pairs, cl::Buffer& spare,
                const cl::Buffer& table, std::uint32_t bits, cl::StageTimes& times) {
  if (plan.count == 0) return;
  const auto kernel = [&](const char* name) {
    return context.programs().kernel(kSources, plan.program_options(), name);
  };
  const cl::Handle<cl_kernel> count_digits = kernel("count_digits");
  const cl::Handle<cl_kernel> scatter = kernel("scatter_by_digit");
  const std::uint32_t chunks = plan.chunks();
  const std::size_t local = plan.work_group_size;
  for (std::uint32_t shift = 0; shift < bits; shift += plan.digit_bits) {
    cl::set_arguments(count_digits.get(), pairs, table, plan.count, plan.chunk_size, chunks, shift);
    times.add("sort", cl::enqueue(context.queue(), count_digits.get(), chunks * local, local));
    scan_values(context, plan, table, chunks << plan.digit_bits, "sort", times);
    cl::set_arguments(scatter.get(), pairs, spare, table, plan.count, plan.chunk_size, chunks, shift);
    times.add("sort", cl::enqueue(context.queue(), scatter.get(), chunks * local, local));
    std::swap(pairs.mem, spare.mem);
  }
}

void scan_values(const cl::Context& context, const SortPlan& plan, const cl::Buffer& values,
                 std::uint32_t count, const char* stage, cl::StageTimes& times) {
  const cl::Handle<cl_kernel> scan =
      context.programs().kernel(kSources, plan.program_options(), "scan_values");
  cl::set_arguments(scan.get(), values, count);
  times.add(stage, cl::enqueue(context.queue(), scan.get(), plan.work_group_size, plan.work_group_size));
}

}  // namespace gnomon
