#include "gnomon/scene/ray_record.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

#include "gnomon/base/error.h"
#include "gnomon/scene/read_file.h"
#include "gnomon/scene/write_file.h"

namespace gnomon {
namespace {

static_assert(std::endian::native == std::endian::little, "the files hold records as they lie in memory");

constexpr std::array<char, 8> kMagic{'G', 'N', 'M', 'N', 'R', 'A', 'Y', 'S'};
constexpr std::uint32_t kVersion = 1;
constexpr std::array<std::string_view, 4> kKindNames{"camera", "bounce", "shadow", "other"};

struct FileHeader {
  std::array<char, 8> magic;
  std::uint32_t version;
  std::uint32_t header_bytes;
  std::uint32_t strata;
  std::uint32_t stratum_bytes;
  std::uint64_t rays;
  std::uint32_t ray_bytes;
  std::uint32_t zero;
  std::uint64_t seed;
  std::uint64_t content_hash;
  std::uint64_t header_hash;
};
static_assert(sizeof(FileHeader) == 64);

struct FileStratum {
  std::uint32_t kind;
  std::uint32_t light;
  std::uint32_t depth;
  std::uint32_t zero;
  std::uint64_t traced;
  std::uint64_t stored;
};
static_assert(sizeof(FileStratum) == 32);

std::uint64_t header_hash(const FileHeader& header) {
  return XXH3_64bits(&header, offsetof(FileHeader, header_hash));
}

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw Error(ErrorCode::kBadScene, name + " is not a usable ray record: " + why);
}

FileHeader read_header(std::span<const unsigned char> bytes, const std::string& name) {
  FileHeader header{};
  if (bytes.size() < sizeof header) refuse(name, "it is shorter than a header, 64 bytes");
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.magic != kMagic) refuse(name, "it does not start with GNMNRAYS");
  if (header.version != kVersion)
    refuse(name, "its version is " + std::to_string(header.version) + ", this program reads version 1");
  if (header.header_hash != header_hash(header)) refuse(name, "its header is damaged");
  if (header.header_bytes != sizeof(FileHeader) || header.stratum_bytes != sizeof(FileStratum) ||
      header.ray_bytes != sizeof(Ray) || header.zero != 0)
    refuse(name, "the sizes in its header are not those of version 1");
  return header;
}

// Sizes are compared without products that could overflow.
void check_size(std::uint64_t size, const FileHeader& header, const std::string& name) {
  std::uint64_t left = size - sizeof(FileHeader);
  if (header.strata > left / sizeof(FileStratum)) refuse(name, "it is cut short");
  left -= header.strata * sizeof(FileStratum);
  if (header.rays > left / sizeof(Ray)) refuse(name, "it is cut short");
  if (left != header.rays * sizeof(Ray)) refuse(name, "it is longer than its header says");
}

RayStratum to_stratum(const FileStratum& in, const std::string& name) {
  if (in.kind >= kKindNames.size() || in.zero != 0 || in.stored > in.traced)
    refuse(name, "a stratum makes no sense");
  return {static_cast<RecordedKind>(in.kind), in.light, in.depth, in.traced, in.stored};
}

// Nothing where the strata's rays are not exactly `rays`.
bool adds_up(const std::vector<RayStratum>& strata, std::uint64_t rays) {
  std::uint64_t left = rays;
  for (const RayStratum& stratum : strata) {
    if (stratum.stored > left) return false;
    left -= stratum.stored;
  }
  return left == 0;
}

}  // namespace

std::string_view to_string(RecordedKind kind) {
  return kKindNames[static_cast<std::size_t>(kind)];
}

std::optional<RecordedKind> recorded_kind_from(std::string_view name) {
  const auto* const found = std::find(kKindNames.begin(), kKindNames.end(), name);
  if (found == kKindNames.end()) return std::nullopt;
  return static_cast<RecordedKind>(found - kKindNames.begin());
}

bool is_ray_record(const std::filesystem::path& file) {
  try {
    const auto bytes = read_file(file, kMagic.size());
    return bytes.size() == kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
  } catch (const Error&) {
    return false;
  }
}

RayRecord parse_ray_record(std::span<const unsigned char> bytes, const std::string& name) {
  const FileHeader header = read_header(bytes, name);
  check_size(bytes.size(), header, name);
  const auto content = bytes.subspan(sizeof header);
  if (XXH3_64bits(content.data(), content.size()) != header.content_hash)
    refuse(name, "its rays are damaged: the checksum differs");
  RayRecord record;
  record.seed = header.seed;
  for (std::uint32_t i = 0; i < header.strata; ++i) {
    FileStratum stratum{};
    std::memcpy(&stratum, content.data() + i * sizeof stratum, sizeof stratum);
    record.strata.push_back(to_stratum(stratum, name));
  }
  if (!adds_up(record.strata, header.rays)) refuse(name, "its strata do not add up to its rays");
  record.rays.resize(header.rays);
  if (!record.rays.empty())
    std::memcpy(record.rays.data(), content.data() + header.strata * sizeof(FileStratum),
                header.rays * sizeof(Ray));
  return record;
}

RayRecord read_ray_record(const std::filesystem::path& file) {
  return parse_ray_record(read_file(file), file.string());
}

std::vector<unsigned char> ray_record_bytes(const RayRecord& record) {
  if (!adds_up(record.strata, record.rays.size()))
    throw Error(ErrorCode::kInvalidArgument, "a ray record's strata do not add up to its rays");
  std::vector<unsigned char> bytes(sizeof(FileHeader) + record.strata.size() * sizeof(FileStratum) +
                                   record.rays.size() * sizeof(Ray));
  unsigned char* const content = bytes.data() + sizeof(FileHeader);
  unsigned char* at = content;
  for (const RayStratum& s : record.strata) {
    if (s.stored > s.traced)
      throw Error(ErrorCode::kInvalidArgument, "a ray record's stratum stores more rays than were traced");
    const FileStratum out{static_cast<std::uint32_t>(s.kind), s.light, s.depth, 0, s.traced, s.stored};
    std::memcpy(at, &out, sizeof out);
    at += sizeof out;
  }
  if (!record.rays.empty()) std::memcpy(at, record.rays.data(), record.rays.size() * sizeof(Ray));
  FileHeader header{kMagic,
                    kVersion,
                    sizeof(FileHeader),
                    static_cast<std::uint32_t>(record.strata.size()),
                    sizeof(FileStratum),
                    record.rays.size(),
                    sizeof(Ray),
                    0,
                    record.seed,
                    XXH3_64bits(content, bytes.size() - sizeof(FileHeader)),
                    0};
  header.header_hash = header_hash(header);
  std::memcpy(bytes.data(), &header, sizeof header);
  return bytes;
}

void write_ray_record(const std::filesystem::path& file, const RayRecord& record) {
  const std::vector<unsigned char> bytes = ray_record_bytes(record);
  write_file(file, std::as_bytes(std::span(bytes)));
}

RayRecord only_kinds(const RayRecord& record, std::span<const RecordedKind> kinds) {
  if (kinds.empty()) return record;
  RayRecord out;
  out.seed = record.seed;
  auto first = record.rays.begin();
  for (const RayStratum& stratum : record.strata) {
    const auto last = first + static_cast<std::ptrdiff_t>(stratum.stored);
    if (std::find(kinds.begin(), kinds.end(), stratum.kind) != kinds.end()) {
      out.strata.push_back(stratum);
      out.rays.insert(out.rays.end(), first, last);
    }
    first = last;
  }
  return out;
}

}  // namespace gnomon
