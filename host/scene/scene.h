// A scene as building, tracing and the picture need it: triangles in world space, cameras, lights and four
// material values. Not for textures, animation or instancing. Feeds primitives, ray sets, areas and the
// renderer.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gnomon/shared/layout.h"

namespace gnomon {

using Triangle = GnTriangle;
using Vec3 = std::array<float, 3>;

// What a surface looks like: linear RGB reflectance in [0, 1], emitted radiance, roughness and metalness in
// [0, 1] (glTF's metallic-roughness). A surface of roughness 1 that is no metal is matt.
struct Material {
  std::string name;
  Vec3 base_color{0.8F, 0.8F, 0.8F};
  Vec3 emission{0.0F, 0.0F, 0.0F};
  float roughness = 1.0F;
  float metallic = 0.0F;
};

// A perspective camera. forward and up are unit and orthogonal.
struct Camera {
  std::string name;
  Vec3 position{0.0F, 0.0F, 0.0F};
  Vec3 forward{0.0F, 0.0F, -1.0F};
  Vec3 up{0.0F, 1.0F, 0.0F};
  float fov_y = 0.8F;   // full vertical angle, radians
  float aspect = 0.0F;  // width / height; 0: the picture's own
};

enum class LightKind { kPoint, kSpot, kDirectional, kArea };

// A light. Which fields mean something depends on its kind.
struct Light {
  std::string name;
  LightKind kind = LightKind::kPoint;
  Vec3 position{0.0F, 0.0F, 0.0F};  // point, spot; area: centroid of its surface
  Vec3 direction{0.0F, 0.0F,
                 -1.0F};         // spot, directional: unit, the way light travels; area: mean unit normal
  Vec3 color{1.0F, 1.0F, 1.0F};  // intensity (point, spot: W/sr), irradiance (directional), radiance (area)
  float range = 0.0F;            // point, spot: 0 means without limit
  float inner_cone = 0.0F;       // spot: half angles, radians
  float outer_cone = 0.785398F;
  std::vector<std::uint32_t> triangles;  // area: indices of its emissive triangles
};

// What an importer left out or assumed. Every count is shown to the user.
struct ImportReport {
  std::uint64_t non_finite_dropped = 0;  // triangles with NaN, infinite or out-of-range coordinates
  std::uint64_t zero_area_dropped = 0;   // triangles whose three corners are collinear or equal
  std::uint64_t primitives_skipped = 0;  // points and lines: nothing to trace
  std::vector<std::string> notes;        // anything else a user should know, one sentence each
  [[nodiscard]] std::uint64_t dropped() const { return non_finite_dropped + zero_area_dropped; }
};

struct Scene {
  std::string name;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> material_ids;  // one per triangle, index into materials
  std::vector<Material> materials;          // never empty when triangles are there
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  ImportReport report;
};

// What to do with triangles that cannot be traced (NaN, infinite, out of range, zero area).
enum class InvalidPolicy {
  kReject,  // the first one is an Error{kBadScene} naming its place
  kDrop,    // leave it out and count it in the report
  // As kDrop, but triangles of zero area stay. Nothing hits them; trees of programs that keep them have them.
  kKeepFlat,
};

// Coordinates beyond this magnitude are invalid: box areas times counts stay finite in float below it.
inline constexpr float kMaxCoordinate = 281474976710656.0F;  // 2^48

// Axis-aligned bounds of all triangles; an empty scene gives {+inf, -inf}.
struct Bounds {
  Vec3 lo;
  Vec3 hi;
};
[[nodiscard]] Bounds bounds_of(const Scene& scene);

// 64-bit hash (XXH3) of everything that decides tree and rays: triangles, in order. 16 lower-case hex digits.
[[nodiscard]] std::string scene_hash(const Scene& scene);
// The same as a number.
[[nodiscard]] std::uint64_t triangles_hash(std::span<const Triangle> triangles);

}  // namespace gnomon
