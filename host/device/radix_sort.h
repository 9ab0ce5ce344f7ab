// A stable radix sort of pairs on a device (kernels/radix_sort.cl), and its prefix sum by itself. Feeds the
// fast builder.
#pragma once

#include <cstdint>
#include <string>

#include "gnomon/cl/context.h"
#include "gnomon/cl/launch.h"

namespace gnomon {

// How a sort of `count` pairs is cut. Changes speed, never the result.
struct SortPlan {
  std::uint32_t count = 0;
  std::uint32_t work_group_size = 1;  // power of two; 1: the serial flavour
  std::uint32_t digit_bits = 8;       // 1..11, serial; 4 cooperative
  std::uint32_t chunk_size = 0;       // pairs one work-group moves
  [[nodiscard]] std::uint32_t chunks() const { return (count + chunk_size - 1) / chunk_size; }
  [[nodiscard]] std::uint64_t table_bytes() const;  // of the prefix sum's buffer
  [[nodiscard]] std::string program_options() const;
};

// chunk_size 0: as the device likes.
[[nodiscard]] SortPlan plan_sort(const cl::DeviceInfo& device, std::uint32_t count,
                                 std::uint32_t work_group_size, std::uint32_t chunk_size);

// Sorts plan.count pairs (uint2: key, value) by the lowest `bits` of their keys; equal keys stay in order. On
// return `pairs` holds them and `spare`, of the same size, anything. table: plan.table_bytes(). Enqueues
// only.
void radix_sort(const cl::Context& context, const SortPlan& plan, cl::Buffer& pairs, cl::Buffer& spare,
                const cl::Buffer& table, std::uint32_t bits, cl::StageTimes& times);

// Replaces `count` words by the sum of those before each and writes the sum of all behind them.
void scan_values(const cl::Context& context, const SortPlan& plan, const cl::Buffer& values,
                 std::uint32_t count, const char* stage, cl::StageTimes& times);

}  // namespace gnomon
