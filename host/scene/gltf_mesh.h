// Turning glTF primitives into triangles. Not for where nodes stand (gltf_nodes) or reading bytes
// (gltf_accessor). Feeds gltf_import.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gnomon/scene/gltf_accessor.h"
#include "gnomon/scene/gltf_materials.h"
#include "gnomon/scene/triangle_check.h"

namespace gnomon {

// One primitive that has triangles, its accessors open.
struct GltfPrimitive {
  std::string place;  // `mesh 2 "Body", primitive 0`
  const AccessorView* positions = nullptr;
  const AccessorView* indices = nullptr;  // null: corners in order
  int mode = TINYGLTF_MODE_TRIANGLES;
  std::uint64_t triangle_count = 0;
  std::uint32_t material_id = 0;
};

struct GltfMesh {
  std::vector<GltfPrimitive> primitives;
  std::uint64_t triangle_count = 0;
};

// The meshes of one document, each opened at first use. Document and scene must outlive this.
class GltfMeshes {
 public:
  // Materials must be in the scene already; skipped primitives go into its report.
  GltfMeshes(const GltfDocument& document, Scene& scene);

  // Throws Error{kBadScene} for a mesh, accessor or material that does not exist or makes no sense.
  [[nodiscard]] const GltfMesh& open(int mesh, const std::string& place);

 private:
  [[nodiscard]] std::optional<GltfPrimitive> open_primitive(const tinygltf::Primitive& source,
                                                            std::string place);

  const GltfDocument& document_;
  Scene& scene_;
  GltfAccessors accessors_;
  MaterialIds material_ids_;
  std::vector<std::optional<GltfMesh>> meshes_;
};

// Appends a primitive's triangles, placed by `world`; a mirroring transform turns their winding so that faces
// stay outwards. Gives the indices of those kept when `wants_indices`, for area lights. Throws
// Error{kBadScene} for an index out of range, and as TriangleSink::add does.
std::vector<std::uint32_t> add_primitive(const GltfPrimitive& primitive, const glm::dmat4& world,
                                         bool wants_indices, Scene& scene, TriangleSink& sink);

}  // namespace gnomon
