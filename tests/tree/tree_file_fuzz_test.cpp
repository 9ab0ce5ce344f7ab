// Forty thousand damaged tree files, the same ones on every run: each gives a tree that keeps every promise
// and can be walked, or is refused with an Error. Sizes and checksums mostly fit what was damaged, so that
// the damage gets past them. Run it under the preset asan, too: it is there that a read one byte too far
// fails.
#include <catch2/catch.hpp>
#include <random>

#include "gnomon/tree/bvh_check.h"
#include "gnomon/tree/trace_reference.h"
#include "tree_file_tools.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

constexpr int kRoundsPerShape = 5000;

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  std::size_t below(std::size_t limit) {
    return limit == 0 ? 0 : static_cast<std::size_t>(engine_() % limit);
  }

 private:
  std::mt19937_64 engine_;
};

// Numbers at which ranges end.
std::uint32_t nasty(Dice& dice) {
  constexpr std::uint32_t kNumbers[] = {
      0,          1,          2,          3,          8,          16,          64,          89,
      90,         91,         255,        256,        0x7fffffff, 0x80000000U, 0xfffffffeU, 0xffffffffU,
      0x7fc00000, 0x7f800000, 0x3f800000, 0x3e800000, 100,        1000};
  return kNumbers[dice.below(std::size(kNumbers))];
}

std::size_t word_at(const FileBytes& bytes, Dice& dice) {
  const bool header = dice.below(3) == 0;
  return 4 * dice.below((header ? kHeaderBytes : bytes.size()) / 4);
}

// A count grown or shrunk, with bytes for it or without.
void damage_count(FileBytes& bytes, Dice& dice) {
  const std::size_t at = dice.below(2) == 0 ? kNodesAt : kOrderAt;
  const std::size_t size = at == kNodesAt ? 32 : 4;
  const auto count = value_at<std::uint32_t>(bytes, at);
  const auto more = static_cast<std::uint32_t>(1 + dice.below(3));
  switch (dice.below(4)) {
    case 0:
      set_at<std::uint32_t>(bytes, at, count + more);
      break;
    case 1:
      set_at<std::uint32_t>(bytes, at, nasty(dice));
      break;
    case 2: {
      set_at<std::uint32_t>(bytes, at, count + more);
      const std::size_t from = bytes.size() > kHeaderBytes + more * size ? bytes.size() - more * size : 0;
      const FileBytes tail(bytes.begin() + static_cast<std::ptrdiff_t>(from), bytes.end());
      for (std::size_t i = 0; i < more * size; ++i) bytes.push_back(tail[i % tail.size()]);
      break;
    }
    default:
      if (count < more || bytes.size() < kHeaderBytes + more * size) break;
      set_at<std::uint32_t>(bytes, at, count - more);
      bytes.resize(bytes.size() - more * size);
  }
}

// Two places of the body change their contents: nodes with nodes, entries of the leaf order with others.
void swap_parts(FileBytes& bytes, Dice& dice) {
  const std::size_t nodes = value_at<std::uint32_t>(bytes, kNodesAt);
  const bool order = dice.below(2) == 0;
  const std::size_t size = order ? 4 : 32;
  const std::size_t begin = order ? kHeaderBytes + 32 * nodes : kHeaderBytes;
  const std::size_t count = order ? (bytes.size() - std::min(begin, bytes.size())) / 4 : nodes;
  if (count == 0 || begin + count * size > bytes.size()) return;
  const std::size_t a = begin + size * dice.below(count);
  const std::size_t b = dice.below(2) == 0 && a + 2 * size <= begin + count * size
                            ? a + size
                            : begin + size * dice.below(count);
  if (a == b) return;
  std::swap_ranges(bytes.begin() + static_cast<std::ptrdiff_t>(a),
                   bytes.begin() + static_cast<std::ptrdiff_t>(a + size),
                   bytes.begin() + static_cast<std::ptrdiff_t>(b));
}

void damage(FileBytes& bytes, Dice& dice) {
  if (bytes.size() < kHeaderBytes) return;
  switch (dice.below(6)) {
    case 0:
      bytes[dice.below(bytes.size())] ^= static_cast<std::byte>(1U << dice.below(8));
      break;
    case 1:
      set_at<std::uint32_t>(bytes, word_at(bytes, dice), nasty(dice));
      break;
    case 2:
      bytes.resize(dice.below(bytes.size()));
      break;
    case 3:
      damage_count(bytes, dice);
      break;
    case 4:
      swap_parts(bytes, dice);
      break;
    default: {  // one word for another
      const std::size_t to = word_at(bytes, dice);
      set_at(bytes, to, value_at<std::uint32_t>(bytes, word_at(bytes, dice)));
    }
  }
}

struct Tally {
  int loaded = 0;
  int refused = 0;
};

// Any exception but Error leaves the test case and fails it.
void try_file(const FileBytes& bytes, const KeptShape& shape, const std::vector<GnRay>& rays, Tally& tally) {
  try {
    const StoredTree stored = tree_from_bytes(bytes, shape.triangles);
    const auto fault = check_bvh(stored.bvh, shape.triangles, stored.options);
    if (fault) FAIL(fault->what);
    if (!shape.triangles.empty()) {
      const auto traced = trace_reference(stored.bvh, shape.triangles, rays, false);
      REQUIRE(traced.hits.size() == rays.size());
    }
    ++tally.loaded;
  } catch (const Error& error) {
    REQUIRE(std::string(error.what()).size() > 10);
    ++tally.refused;
  }
}

}  // namespace

TEST_CASE("a damaged tree file gives a sound tree or is refused") {
  Tally all;
  std::uint64_t seed = 1;
  const auto rays = random_rays(4, 12);
  for (const KeptShape& shape : kept_shapes()) {
    CAPTURE(shape.name);
    const FileBytes whole = file_of(shape);
    Dice dice(seed++);
    Tally tally;
    for (int round = 0; round < kRoundsPerShape; ++round) {
      FileBytes bytes = whole;
      for (std::size_t steps = 1 + dice.below(2); steps > 0; --steps) damage(bytes, dice);
      if (dice.below(16) != 0) settle(bytes);
      INFO("round " << round);
      try_file(bytes, shape, rays, tally);
    }
    // Both must be common: damage that is always noticed early, or never, would test little.
    CHECK(tally.loaded > kRoundsPerShape / 50);
    CHECK(tally.refused > kRoundsPerShape / 5);
    all.loaded += tally.loaded;
    all.refused += tally.refused;
  }
  INFO(all.loaded << " loaded, " << all.refused << " refused");
  CHECK(all.loaded + all.refused == 8 * kRoundsPerShape);
}
