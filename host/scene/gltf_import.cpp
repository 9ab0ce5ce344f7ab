#include <algorithm>
#include <utility>

#include "gnomon/scene/area_light.h"
#include "gnomon/scene/gltf_document.h"
#include "gnomon/scene/gltf_lights.h"
#include "gnomon/scene/gltf_materials.h"
#include "gnomon/scene/gltf_mesh.h"
#include "gnomon/scene/gltf_nodes.h"
#include "gnomon/scene/import.h"
#include "gnomon/scene/import_message.h"
#include "gnomon/scene/read_file.h"
#include "gnomon/scene/triangle_check.h"

namespace gnomon {
namespace {

// A mesh where it stands, ready to be turned into triangles.
struct PlacedMesh {
  PlacedNode placed;
  const GltfMesh* mesh;
};

// Opens every mesh in use and counts all triangles before any is made.
std::vector<PlacedMesh> plan_meshes(const GltfDocument& document, const std::vector<PlacedNode>& nodes,
                                    const ImportOptions& options, GltfMeshes& meshes, Scene& scene) {
  std::vector<PlacedMesh> plan;
  std::uint64_t triangle_count = 0;
  std::size_t skinned = 0;
  for (const PlacedNode& placed : nodes) {
    const tinygltf::Node& node = document.model.nodes[placed.node];
    if (node.mesh < 0) continue;
    const GltfMesh& mesh = meshes.open(node.mesh, numbered("node", placed.node, node.name));
    require_room(triangle_count, mesh.triangle_count, options);
    triangle_count += mesh.triangle_count;
    if (mesh.triangle_count > 0) plan.push_back({placed, &mesh});
    if (node.skin >= 0) ++skinned;
  }
  if (skinned > 0) {
    scene.report.notes.push_back("Skins are not read: " + std::to_string(skinned) +
                                 " nodes are in their rest pose.");
  }
  scene.triangles.reserve(static_cast<std::size_t>(triangle_count));
  scene.material_ids.reserve(static_cast<std::size_t>(triangle_count));
  return plan;
}

// An emissive primitive is one light wherever its mesh stands.
void add_mesh(const GltfDocument& document, const PlacedMesh& item, Scene& scene, TriangleSink& sink) {
  for (const GltfPrimitive& primitive : item.mesh->primitives) {
    const Material& material = scene.materials[primitive.material_id];
    auto kept = add_primitive(primitive, item.placed.world, emits(material), scene, sink);
    if (kept.empty()) continue;
    const std::string& node_name = document.model.nodes[item.placed.node].name;
    scene.lights.push_back(
        make_area_light(scene, material.name.empty() ? node_name : material.name, material, std::move(kept)));
  }
}

// A file that only uses, but does not require, instancing says that one of each is an acceptable picture.
void note_instancing(const tinygltf::Model& model, std::vector<std::string>& notes) {
  const auto& used = model.extensionsUsed;
  if (std::find(used.begin(), used.end(), "EXT_mesh_gpu_instancing") == used.end()) return;
  notes.push_back("EXT_mesh_gpu_instancing is not read: of each instanced node there is one copy.");
}

Scene read_scene(std::span<const unsigned char> file, const std::filesystem::path& base_folder,
                 const ImportOptions& options) {
  const GltfDocument document = read_gltf_document(file, base_folder);
  Scene scene;
  scene.materials = read_materials(document.model, scene.report.notes);
  note_instancing(document.model, scene.report.notes);
  const auto nodes = place_nodes(document.model, scene.report.notes);
  for (const PlacedNode& placed : nodes) {
    add_camera(document.model, placed, scene);
    add_light(document.model, placed, scene);
  }
  GltfMeshes meshes(document, scene);
  const auto plan = plan_meshes(document, nodes, options, meshes, scene);
  TriangleSink sink(scene, options.invalid);
  for (const PlacedMesh& item : plan) add_mesh(document, item, scene, sink);
  require_triangles(scene);
  return scene;
}

}  // namespace

Scene import_gltf_bytes(const unsigned char* bytes, std::size_t size,
                        const std::filesystem::path& base_folder, const ImportOptions& options) {
  return run_import({}, [&] { return read_scene({bytes, size}, base_folder, options); });
}

Scene import_gltf(const std::filesystem::path& file, const ImportOptions& options) {
  const auto bytes = read_file(file);
  return run_import(file, [&] {
    Scene scene = read_scene(bytes, file.parent_path(), options);
    scene.name = file.stem().string();
    return scene;
  });
}

}  // namespace gnomon
