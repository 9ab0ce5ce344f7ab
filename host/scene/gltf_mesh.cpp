#include "gnomon/scene/gltf_mesh.h"

#include <algorithm>
#include <array>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "gnomon/scene/gltf_extensions.h"
#include "gnomon/scene/import_message.h"

namespace gnomon {
namespace {

using Corners = std::array<std::uint64_t, 3>;

bool is_points_or_lines(int mode) {
  return mode >= TINYGLTF_MODE_POINTS && mode <= TINYGLTF_MODE_LINE_STRIP;
}

std::uint64_t count_triangles(int mode, std::uint64_t corner_count) {
  if (mode == TINYGLTF_MODE_TRIANGLES) return corner_count / 3;
  return corner_count < 3 ? 0 : corner_count - 2;
}

// Which corners make triangle t; glTF 2.0, section 3.7.2.1.
Corners corners_of(int mode, std::uint64_t t) {
  if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) return {t, t + 1 + t % 2, t + 2 - t % 2};
  if (mode == TINYGLTF_MODE_TRIANGLE_FAN) return {t + 1, t + 2, 0};
  return {3 * t, 3 * t + 1, 3 * t + 2};
}

std::uint64_t vertex_of(const GltfPrimitive& primitive, std::uint64_t corner) {
  if (primitive.indices == nullptr) return corner;
  const std::uint32_t vertex = read_index(*primitive.indices, corner);
  if (vertex >= primitive.positions->count) {
    bad_scene(primitive.place + ": index " + std::to_string(corner) + " is " + std::to_string(vertex) +
              ", and there are " + std::to_string(primitive.positions->count) + " vertices" +
              std::string(kExportAgain));
  }
  return vertex;
}

// Places vertices; the identity leaves them bitwise as they are, even a negative zero.
class Placer {
 public:
  explicit Placer(const glm::dmat4& world)
      : world_(world),
        is_identity_(world == glm::dmat4(1.0)),
        mirrors_(glm::determinant(glm::dmat3(world)) < 0.0) {}

  void place(const AccessorView& positions, std::uint64_t vertex, float out[3]) const {
    glm::dvec3 p = read_position(positions, vertex);
    if (!is_identity_) p = glm::dvec3(world_ * glm::dvec4(p, 1.0));
    for (int axis = 0; axis < 3; ++axis) out[axis] = to_coordinate(p[axis]);
  }

  [[nodiscard]] Triangle place(const AccessorView& positions, Corners vertices) const {
    if (mirrors_) std::swap(vertices[1], vertices[2]);
    Triangle triangle;
    place(positions, vertices[0], triangle.v0);
    place(positions, vertices[1], triangle.v1);
    place(positions, vertices[2], triangle.v2);
    return triangle;
  }

 private:
  glm::dmat4 world_;
  bool is_identity_;
  bool mirrors_;
};

// Strips repeat a vertex to jump; what that makes is no triangle and needs no policy.
bool is_stitch(int mode, const Corners& v) {
  return mode == TINYGLTF_MODE_TRIANGLE_STRIP && (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]);
}

}  // namespace

GltfMeshes::GltfMeshes(const GltfDocument& document, Scene& scene)
    : document_(document),
      scene_(scene),
      accessors_(document),
      material_ids_(scene.materials),
      meshes_(document.model.meshes.size()) {}

const GltfMesh& GltfMeshes::open(int mesh, const std::string& place) {
  if (mesh < 0 || static_cast<std::size_t>(mesh) >= meshes_.size()) {
    bad_scene(place + ": mesh " + std::to_string(mesh) + " does not exist, there are " +
              std::to_string(meshes_.size()) + std::string(kExportAgain));
  }
  const auto index = static_cast<std::size_t>(mesh);
  if (meshes_[index]) return *meshes_[index];
  const tinygltf::Mesh& source = document_.model.meshes[index];
  GltfMesh opened;
  for (std::size_t i = 0; i < source.primitives.size(); ++i) {
    const std::string name = numbered("mesh", index, source.name) + ", primitive " + std::to_string(i);
    auto primitive = open_primitive(source.primitives[i], name);
    if (!primitive || primitive->triangle_count == 0) continue;
    // At most 2^53 corners each and as many primitives as the file has bytes for: no overflow.
    opened.triangle_count += primitive->triangle_count;
    opened.primitives.push_back(std::move(*primitive));
  }
  const bool is_morphed =
      std::any_of(source.weights.begin(), source.weights.end(), [](double w) { return w != 0.0; });
  if (is_morphed) {
    scene_.report.notes.push_back("Morph targets are not read: " + numbered("mesh", index, source.name) +
                                  " has its basic shape.");
  }
  meshes_[index] = std::move(opened);
  return *meshes_[index];
}

std::optional<GltfPrimitive> GltfMeshes::open_primitive(const tinygltf::Primitive& source,
                                                        std::string place) {
  const auto attribute = source.attributes.find("POSITION");
  // The specification lets clients skip a primitive without positions.
  if (is_points_or_lines(source.mode) || attribute == source.attributes.end()) {
    ++scene_.report.primitives_skipped;
    return std::nullopt;
  }
  if (source.mode > TINYGLTF_MODE_TRIANGLE_FAN) {
    bad_scene(place + ": mode " + std::to_string(source.mode) + " does not exist" +
              std::string(kExportAgain));
  }
  GltfPrimitive primitive;
  primitive.positions = &accessors_.positions(attribute->second, place);
  // Draco's fallback data is optional; without it every position would read as zero.
  if (source.extensions.count("KHR_draco_mesh_compression") > 0 && primitive.positions->data == nullptr) {
    bad_scene(place + " is compressed with Draco; " + std::string(kDecompress));
  }
  if (source.indices >= 0) primitive.indices = &accessors_.indices(source.indices, place);
  const std::uint64_t corner_count = (primitive.indices ? primitive.indices : primitive.positions)->count;
  primitive.mode = source.mode;
  primitive.triangle_count = count_triangles(source.mode, corner_count);
  if (source.mode == TINYGLTF_MODE_TRIANGLES && corner_count % 3 != 0) {
    scene_.report.notes.push_back(place + " has " + std::to_string(corner_count) +
                                  " corners; the last, incomplete triangle was left out.");
  }
  primitive.material_id = material_ids_.of(source.material, place);
  primitive.place = std::move(place);
  return primitive;
}

std::vector<std::uint32_t> add_primitive(const GltfPrimitive& primitive, const glm::dmat4& world,
                                         bool wants_indices, Scene& scene, TriangleSink& sink) {
  std::vector<std::uint32_t> kept;
  const Placer placer(world);
  for (std::uint64_t t = 0; t < primitive.triangle_count; ++t) {
    Corners vertices = corners_of(primitive.mode, t);
    for (std::uint64_t& corner : vertices) corner = vertex_of(primitive, corner);
    if (is_stitch(primitive.mode, vertices)) continue;
    const Triangle triangle = placer.place(*primitive.positions, vertices);
    const auto place = [&] { return primitive.place + ", triangle " + std::to_string(t); };
    if (sink.add(triangle, primitive.material_id, place) && wants_indices) {
      kept.push_back(static_cast<std::uint32_t>(scene.triangles.size() - 1));
    }
  }
  return kept;
}

}  // namespace gnomon
