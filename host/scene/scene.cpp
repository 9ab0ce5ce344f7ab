#include "gnomon/scene/scene.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstdio>
#include <limits>

namespace gnomon {

Bounds bounds_of(const Scene& scene) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  Bounds box{{kInf, kInf, kInf}, {-kInf, -kInf, -kInf}};
  for (const Triangle& triangle : scene.triangles) {
    for (const float* v : {triangle.v0, triangle.v1, triangle.v2}) {
      for (unsigned axis = 0; axis < 3; ++axis) {
        if (v[axis] < box.lo[axis]) box.lo[axis] = v[axis];
        if (v[axis] > box.hi[axis]) box.hi[axis] = v[axis];
      }
    }
  }
  return box;
}

std::uint64_t triangles_hash(std::span<const Triangle> triangles) {
  return XXH3_64bits(triangles.data(), triangles.size_bytes());
}

std::string scene_hash(const Scene& scene) {
  const std::uint64_t value = triangles_hash(scene.triangles);
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

}  // namespace gnomon
