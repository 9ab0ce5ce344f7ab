// Recorded rays in files (.gnr): a sample of what a renderer traced, by what each ray was for, with how many
// there were. For whoever records or replays rays; not for choosing the sample (render/ray_recorder.h). Feeds
// trace, validate and planning.
//
// A file is little-endian throughout:
//   0   8  magic "GNMNRAYS"
//   8   4  version, 1
//  12   4  size of this header, 64
//  16   4  number of strata
//  20   4  size of a stratum, 32
//  24   8  number of rays
//  32   4  size of a ray, 32
//  36   4  0
//  40   8  seed of the sample
//  48   8  XXH3 (64 bits, seed 0) of everything after this header
//  56   8  XXH3 of the 56 bytes before
//  then strata:
//   0   4  kind: 0 camera, 1 bounce, 2 shadow, 3 other
//   4   4  light that shadow rays ask, numbered by whoever recorded; all ones for other kinds
//   8   4  surfaces that the paths had met, at least; the last stratum of a kind holds all deeper ones
//  12   4  0
//  16   8  rays traced
//  24   8  rays stored, no more than traced
//  then the strata's rays, one stratum after another, each 8 float32: origin, tmin, direction, tmax.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gnomon/scene/scene.h"

namespace gnomon {

using Ray = GnRay;

enum class RecordedKind : std::uint32_t { kCamera, kBounce, kShadow, kOther };
[[nodiscard]] std::string_view to_string(RecordedKind kind);
[[nodiscard]] std::optional<RecordedKind> recorded_kind_from(std::string_view name);

inline constexpr std::uint32_t kNoLight = 0xffffffffU;

// Rays of one kind, to one light, at one depth: `stored` of `traced`, every subset of that size as likely as
// any other.
struct RayStratum {
  RecordedKind kind = RecordedKind::kOther;
  std::uint32_t light = kNoLight;
  std::uint32_t depth = 0;
  std::uint64_t traced = 0;
  std::uint64_t stored = 0;
};

struct RayRecord {
  std::uint64_t seed = 0;
  std::vector<RayStratum> strata;
  std::vector<Ray> rays;  // stratum after stratum
};

// Whether a file starts like a record. False also where it cannot be read.
[[nodiscard]] bool is_ray_record(const std::filesystem::path& file);

// Throws Error: kIo, kOutOfMemory; kBadScene for a file that is no record, of another version, cut short or
// damaged, saying which.
[[nodiscard]] RayRecord read_ray_record(const std::filesystem::path& file);
[[nodiscard]] RayRecord parse_ray_record(std::span<const unsigned char> bytes, const std::string& name);

// Whole or not at all. Throws Error: kIo; kInvalidArgument where strata and rays do not add up.
void write_ray_record(const std::filesystem::path& file, const RayRecord& record);
[[nodiscard]] std::vector<unsigned char> ray_record_bytes(const RayRecord& record);

// The strata of these kinds with their rays; all of them where `kinds` is empty.
[[nodiscard]] RayRecord only_kinds(const RayRecord& record, std::span<const RecordedKind> kinds);

}  // namespace gnomon
