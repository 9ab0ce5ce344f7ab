// Records of rays: what is written is read, others can write it from the documented layout, and thousands of
// damaged files are refused without a read outside them.
#include "gnomon/scene/ray_record.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <catch2/catch.hpp>
#include <cstring>

#include "file_damage.h"
#include "gnomon/base/error.h"

using namespace gnomon;
using Bytes = std::vector<unsigned char>;

namespace {

RayRecord small_record() {
  RayRecord record;
  record.seed = 0x1234567890abcdefULL;
  record.strata = {{RecordedKind::kCamera, kNoLight, 0, 100, 2},
                   {RecordedKind::kBounce, kNoLight, 1, 5, 0},
                   {RecordedKind::kShadow, 3, 1, 3, 3}};
  for (int i = 0; i < 5; ++i) {
    const auto x = static_cast<float>(i);
    record.rays.push_back({{x, 1.0F, 2.0F}, 0.0F, {0.0F, x + 1.0F, 0.0F}, 10.0F * x});
  }
  return record;
}

void require_same(const RayRecord& a, const RayRecord& b) {
  REQUIRE(a.seed == b.seed);
  REQUIRE(a.strata.size() == b.strata.size());
  for (std::size_t i = 0; i < a.strata.size(); ++i) {
    CAPTURE(i);
    REQUIRE(a.strata[i].kind == b.strata[i].kind);
    REQUIRE(a.strata[i].light == b.strata[i].light);
    REQUIRE(a.strata[i].depth == b.strata[i].depth);
    REQUIRE(a.strata[i].traced == b.strata[i].traced);
    REQUIRE(a.strata[i].stored == b.strata[i].stored);
  }
  REQUIRE(a.rays.size() == b.rays.size());
  if (!a.rays.empty()) REQUIRE(std::memcmp(a.rays.data(), b.rays.data(), a.rays.size() * sizeof(Ray)) == 0);
}

void append(Bytes& bytes, std::uint64_t value, int count) {
  for (int i = 0; i < count; ++i) bytes.push_back(static_cast<unsigned char>(value >> (8 * i)));
}

std::string refusal(const Bytes& bytes) {
  try {
    static_cast<void>(parse_ray_record(bytes, "x.gnr"));
  } catch (const Error& error) {
    REQUIRE(error.code() == ErrorCode::kBadScene);
    return error.what();
  }
  return {};
}

// With both checksums right again, so that what is behind them is tried.
Bytes resealed(Bytes bytes) {
  if (bytes.size() < 64) return bytes;
  const std::uint64_t content = XXH3_64bits(bytes.data() + 64, bytes.size() - 64);
  std::memcpy(bytes.data() + 48, &content, sizeof content);
  const std::uint64_t header = XXH3_64bits(bytes.data(), 56);
  std::memcpy(bytes.data() + 56, &header, sizeof header);
  return bytes;
}

}  // namespace

TEST_CASE("a record is read as it was written") {
  const gnomon_test::TemporaryFolder folder;
  const auto file = folder.path() / "a.gnr";
  for (const RayRecord& record : {small_record(), RayRecord{}}) {
    write_ray_record(file, record);
    REQUIRE(is_ray_record(file));
    require_same(read_ray_record(file), record);
  }
  folder.write("raw", std::string(64, 'x'));
  REQUIRE_FALSE(is_ray_record(folder.path() / "raw"));
  REQUIRE_FALSE(is_ray_record(folder.path() / "none"));
  REQUIRE_THROWS_AS(read_ray_record(folder.path() / "none"), Error);
}

TEST_CASE("the file is what the documentation says, byte for byte") {
  Bytes content;
  for (const std::array<std::uint64_t, 5>& s : {std::array<std::uint64_t, 5>{0, 0xffffffffU, 0, 100, 2},
                                                {1, 0xffffffffU, 1, 5, 0},
                                                {2, 3, 1, 3, 3}}) {
    for (std::size_t i = 0; i < 3; ++i) append(content, s[i], 4);
    append(content, 0, 4);
    append(content, s[3], 8);
    append(content, s[4], 8);
  }
  for (const Ray& ray : small_record().rays) {
    for (const float value : {ray.origin[0], ray.origin[1], ray.origin[2], ray.tmin, ray.direction[0],
                              ray.direction[1], ray.direction[2], ray.tmax}) {
      std::uint32_t bits = 0;
      std::memcpy(&bits, &value, sizeof bits);
      append(content, bits, 4);
    }
  }
  Bytes bytes{'G', 'N', 'M', 'N', 'R', 'A', 'Y', 'S'};
  for (const std::uint64_t word : {1U, 64U, 3U, 32U}) append(bytes, word, 4);
  append(bytes, 5, 8);
  append(bytes, 32, 4);
  append(bytes, 0, 4);
  append(bytes, 0x1234567890abcdefULL, 8);
  append(bytes, XXH3_64bits(content.data(), content.size()), 8);
  append(bytes, XXH3_64bits(bytes.data(), 56), 8);
  bytes.insert(bytes.end(), content.begin(), content.end());
  REQUIRE(ray_record_bytes(small_record()) == bytes);
  require_same(parse_ray_record(bytes, "x"), small_record());
}

TEST_CASE("what is wrong with a file is said") {
  using Catch::Contains;
  const Bytes good = ray_record_bytes(small_record());
  Bytes bytes = good;
  bytes[0] = 'X';
  CHECK_THAT(refusal(bytes), Contains("GNMNRAYS") && Contains("x.gnr"));
  bytes = good;
  bytes[8] = 2;
  CHECK_THAT(refusal(resealed(bytes)), Contains("version is 2"));
  bytes = good;
  bytes[17] ^= 1U;
  CHECK_THAT(refusal(bytes), Contains("header is damaged"));
  bytes = good;
  bytes.back() ^= 1U;
  CHECK_THAT(refusal(bytes), Contains("checksum"));
  bytes = good;
  bytes.pop_back();
  CHECK_THAT(refusal(bytes), Contains("cut short"));
  bytes = good;
  bytes.push_back(0);
  CHECK_THAT(refusal(bytes), Contains("longer"));
  bytes = good;
  bytes[12] = 65;
  CHECK_THAT(refusal(resealed(bytes)), Contains("sizes"));
  bytes = good;
  bytes[64] = 4;
  CHECK_THAT(refusal(resealed(bytes)), Contains("stratum"));
  bytes = good;
  bytes[64 + 24] = 3;  // stored, which no longer adds up
  CHECK_THAT(refusal(resealed(bytes)), Contains("add up"));
  bytes = good;
  bytes[64 + 24] = 101;  // of 100 traced
  CHECK_THAT(refusal(resealed(bytes)), Contains("stratum"));
  CHECK_THAT(refusal({}), Contains("shorter"));
  CHECK_THAT(refusal(Bytes(good.begin(), good.begin() + 64)), Contains("cut short"));
}

TEST_CASE("records that do not add up are not written") {
  RayRecord record = small_record();
  record.rays.pop_back();
  REQUIRE_THROWS_AS(ray_record_bytes(record), Error);
  record = small_record();
  record.strata[0].traced = 1;
  REQUIRE_THROWS_AS(ray_record_bytes(record), Error);
}

TEST_CASE("kinds are chosen with their rays") {
  const std::vector<RecordedKind> shadow{RecordedKind::kShadow};
  const RayRecord chosen = only_kinds(small_record(), shadow);
  REQUIRE(chosen.strata.size() == 1);
  REQUIRE(chosen.rays.size() == 3);
  REQUIRE(chosen.rays.front().origin[0] == 2.0F);
  require_same(only_kinds(small_record(), {}), small_record());
  REQUIRE(only_kinds(small_record(), std::vector{RecordedKind::kOther}).rays.empty());
  for (const RecordedKind kind :
       {RecordedKind::kCamera, RecordedKind::kBounce, RecordedKind::kShadow, RecordedKind::kOther})
    REQUIRE(recorded_kind_from(to_string(kind)) == kind);
  REQUIRE_FALSE(recorded_kind_from("sideways"));
}

TEST_CASE("damaged records are refused, or read as records that add up") {
  gnomon_test::Dice dice(17);
  const Bytes good = ray_record_bytes(small_record());
  const std::string other(200, '\x01');
  int refused = 0;
  int read = 0;
  for (int round = 0; round < 6000; ++round) {
    std::string file(good.begin(), good.end());
    for (std::size_t steps = 1 + dice.below(3); steps > 0; --steps) gnomon_test::damage(file, other, dice);
    Bytes bytes(file.begin(), file.end());
    if (round % 3 != 0) bytes = resealed(bytes);
    // In memory of exactly its size, so that the sanitizers see a read one byte too far.
    CAPTURE(round);
    try {
      const RayRecord record = parse_ray_record(bytes, "x");
      std::uint64_t stored = 0;
      for (const RayStratum& stratum : record.strata) stored += stratum.stored;
      REQUIRE(stored == record.rays.size());
      REQUIRE(ray_record_bytes(record) == bytes);
      read += 1;
    } catch (const Error& error) {
      REQUIRE(error.code() == ErrorCode::kBadScene);
      refused += 1;
    }
  }
  CAPTURE(refused, read);
  CHECK(refused > 1000);
  CHECK(read > 300);
}
