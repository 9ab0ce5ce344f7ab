// The radix sort and its prefix sum: sorted, stable, by the bits asked for, in both flavours and at chunks'
// edges.
#include <algorithm>
#include <catch2/catch.hpp>

#include "gnomon/device/radix_sort.h"
#include "gnomon/shared/fast_layout.h"
#include "support/device.h"
#include "support/shapes.h"

using gnomon::SortPlan;
using gnomon::test::context;
using Keys = std::vector<GnMortonKey>;

namespace {

Keys sorted_on_device(const Keys& keys, const SortPlan& plan, std::uint32_t bits) {
  auto pairs = context().create_buffer("pairs", keys.size() * sizeof(GnMortonKey));
  auto spare = context().create_buffer("spare", keys.size() * sizeof(GnMortonKey));
  const auto table = context().create_buffer("table", plan.table_bytes());
  context().upload_values<GnMortonKey>(pairs, keys);
  gnomon::cl::StageTimes times;
  gnomon::radix_sort(context(), plan, pairs, spare, table, bits, times);
  return context().download_values<GnMortonKey>(pairs, keys.size());
}

SortPlan plan_of(std::uint32_t count, std::uint32_t work_group_size, std::uint32_t digit_bits,
                 std::uint32_t chunk_size) {
  SortPlan plan;
  plan.count = count;
  plan.work_group_size = work_group_size;
  plan.digit_bits = digit_bits;
  plan.chunk_size = chunk_size;
  return plan;
}

// Values number the pairs, so that they tell where equal keys stood.
Keys random_keys(std::uint32_t count, std::uint32_t below, std::uint32_t seed) {
  gnomon::test::Random random(seed);
  Keys keys(count);
  for (std::uint32_t i = 0; i < count; ++i) keys[i] = {random.below(below) * (0x3fffffffU / below), i};
  return keys;
}

void require_sorted(const Keys& keys, const SortPlan& plan, std::uint32_t bits = 30) {
  CAPTURE(keys.size(), plan.work_group_size, plan.digit_bits, plan.chunk_size, bits);
  Keys expected = keys;
  const std::uint32_t mask = bits == 32 ? ~0U : (1U << bits) - 1;
  std::stable_sort(expected.begin(), expected.end(),
                   [&](const auto& a, const auto& b) { return (a.code & mask) < (b.code & mask); });
  const Keys got = sorted_on_device(keys, plan, bits);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    CAPTURE(i);
    REQUIRE(got[i].code == expected[i].code);
    REQUIRE(got[i].triangle == expected[i].triangle);
  }
}

}  // namespace

TEST_CASE("both flavours sort stably at every size around a chunk's and a tile's edge",
          "[serial][portable]") {
  for (const std::uint32_t count : {1U, 2U, 63U, 64U, 65U, 127U, 128U, 129U, 300U}) {
    for (const std::uint32_t below : {1U, 5U, 1000U}) {
      const Keys keys = random_keys(count, below, 140 + count);
      require_sorted(keys, plan_of(count, 1, 8, 64));
      require_sorted(keys, plan_of(count, 8, 4, 64));
      require_sorted(keys, plan_of(count, 16, 4, 100));  // a chunk ends within a tile
      require_sorted(keys, plan_of(count, 16, 4, 1000));
    }
  }
}

TEST_CASE("a small sort keeps to its buffers", "[memcheck]") {
  require_sorted(random_keys(150, 20, 141), plan_of(150, 1, 8, 64), 16);
  require_sorted(random_keys(150, 20, 142), plan_of(150, 8, 4, 100), 12);
}

TEST_CASE("every digit counts, and only the bits asked for", "[portable]") {
  Keys keys;
  for (std::uint32_t bit = 0; bit < 32; ++bit) {
    keys.push_back({1U << bit, 2 * bit});
    keys.push_back({~(1U << bit), 2 * bit + 1});
  }
  std::reverse(keys.begin(), keys.end());
  const auto count = static_cast<std::uint32_t>(keys.size());
  for (const std::uint32_t digit_bits : {1U, 4U, 8U, 11U}) {
    require_sorted(keys, plan_of(count, 1, digit_bits, 64), digit_bits * (32 / digit_bits));
  }
  require_sorted(keys, plan_of(count, 16, 4, 64), 32);
  require_sorted(keys, plan_of(count, 16, 4, 64), 8);
}

TEST_CASE("large sorts by the device's own plan are right in both flavours") {
  for (const std::uint32_t count : {4096U, 65536U, 100'003U}) {
    const Keys keys = random_keys(count, 9000, 143);
    require_sorted(keys, gnomon::plan_sort(context().device(), count, 1, 0));
    require_sorted(keys, gnomon::plan_sort(context().device(), count, 16, 0));
  }
}

TEST_CASE("prefix sums end with the sum of all", "[portable][memcheck]") {
  for (const std::uint32_t work_group_size : {1U, 8U, 16U}) {
    for (const std::uint32_t count : {1U, 15U, 16U, 17U, 100U}) {
      CAPTURE(work_group_size, count);
      std::vector<std::uint32_t> values(count + 1);
      for (std::uint32_t i = 0; i < count; ++i) values[i] = (i * 7 + 3) % 5;
      const auto buffer = context().create_buffer("values", values.size() * sizeof(std::uint32_t));
      context().upload_values<std::uint32_t>(buffer, values);
      gnomon::cl::StageTimes times;
      gnomon::scan_values(context(), plan_of(count, work_group_size, 4, 64), buffer, count, "scan", times);
      const auto got = context().download_values<std::uint32_t>(buffer, count + 1);
      std::uint32_t sum = 0;
      for (std::uint32_t i = 0; i <= count; ++i) {
        CAPTURE(i);
        REQUIRE(got[i] == sum);
        if (i < count) sum += values[i];
      }
    }
  }
}
