// Rays and hits as raw little-endian records.
#include <bit>
#include <cstring>
#include <string>

#include "gnomon/base/error.h"
#include "gnomon/scene/ray_set.h"
#include "gnomon/scene/read_file.h"
#include "gnomon/scene/write_file.h"

namespace gnomon {

static_assert(std::endian::native == std::endian::little, "the files hold records as they lie in memory");

std::vector<Ray> read_rays(const std::filesystem::path& file) {
  const std::vector<unsigned char> bytes = read_file(file);
  if (bytes.size() % sizeof(Ray) != 0) {
    throw Error(ErrorCode::kBadScene, file.string() + " is not a ray file: its size, " +
                                          std::to_string(bytes.size()) + " bytes, is not a multiple of " +
                                          std::to_string(sizeof(Ray)));
  }
  std::vector<Ray> rays(bytes.size() / sizeof(Ray));
  if (!rays.empty()) std::memcpy(rays.data(), bytes.data(), bytes.size());
  return rays;
}

void write_rays(const std::filesystem::path& file, std::span<const Ray> rays) {
  write_file(file, std::as_bytes(rays));
}
void write_hits(const std::filesystem::path& file, std::span<const Hit> hits) {
  write_file(file, std::as_bytes(hits));
}

}  // namespace gnomon
