#include "gnomon/scene/gltf_json.h"

#include <utility>

#include "gnomon/scene/gltf_extensions.h"
#include "gnomon/scene/import_message.h"
#include "gnomon/scene/json_pick.h"

namespace gnomon {
namespace {

using Kind = JsonKind;

constexpr const char* kLights = "KHR_lights_punctual";
constexpr const char* kEmissiveStrength = "KHR_materials_emissive_strength";
constexpr const char* kDraco = "KHR_draco_mesh_compression";

// The object source.extensions[name], when there is one.
Json* find_extension(Json& source, const char* name, const std::string& place) {
  Json* const extensions = find_object(source, "extensions", place);
  return extensions == nullptr ? nullptr : find_object(*extensions, name, place + ".extensions");
}

void check_asset(Json& root, Json& out) {
  Json* const asset = find_object(root, "asset", "");
  if (asset == nullptr) bad_scene("is JSON but not glTF: it has no \"asset\" object");
  out["asset"] = pick(*asset, "asset", {{"version", Kind::kText, true}});
  const auto version = out["asset"]["version"].get<std::string>();
  if (version.substr(0, 2) != "2.") {
    bad_scene("is of glTF version " + in_quotes(version) + "; export it as glTF 2.0");
  }
}

void check_required_extensions(Json& root) {
  Json* const required = find_array(root, "extensionsRequired", "");
  if (required == nullptr) return;
  for (const Json& name : *required) {
    if (!name.is_string()) bad_scene("extensionsRequired must hold texts only" + std::string(kExportAgain));
    require_known_extension(name.get_ref<const std::string&>());
  }
}

std::vector<GltfBufferSource> take_buffers(Json& root) {
  std::vector<GltfBufferSource> buffers;
  Json picked = pick_all(root, "buffers", "", [](Json& buffer, const std::string& place) {
    return pick(buffer, place, {{"uri", Kind::kText}, {"byteLength", Kind::kSize, true}});
  });
  for (Json& buffer : picked) {
    GltfBufferSource source;
    source.byte_length = buffer["byteLength"].get<std::uint64_t>();
    // Moved, not copied: an embedded buffer may be most of the file.
    if (buffer.contains("uri")) source.uri = std::move(buffer["uri"].get_ref<std::string&>());
    buffers.push_back(std::move(source));
  }
  return buffers;
}

Json pick_view(Json& view, const std::string& place) {
  Json out = pick(view, place,
                  {{"buffer", Kind::kIndex, true},
                   {"byteOffset", Kind::kSize},
                   {"byteLength", Kind::kSize, true},
                   {"byteStride", Kind::kSize}});
  const std::uint64_t stride = out.value("byteStride", std::uint64_t{0});
  if (stride % 4 != 0 || stride > 252) {
    bad_scene(place + ".byteStride must be a multiple of 4 up to 252" + std::string(kExportAgain));
  }
  return out;
}

Json pick_sparse(Json& sparse, const std::string& place) {
  Json out = pick(sparse, place, {{"count", Kind::kIndex, true}});
  Json* const indices = find_object(sparse, "indices", place);
  Json* const values = find_object(sparse, "values", place);
  if (indices == nullptr || values == nullptr) {
    bad_scene(place + " needs both \"indices\" and \"values\"" + std::string(kExportAgain));
  }
  // Offsets are ints in tinygltf, so they must fit one.
  out["indices"] = pick(*indices, place + ".indices",
                        {{"bufferView", Kind::kIndex, true},
                         {"byteOffset", Kind::kIndex},
                         {"componentType", Kind::kIndex, true}});
  out["values"] =
      pick(*values, place + ".values", {{"bufferView", Kind::kIndex, true}, {"byteOffset", Kind::kIndex}});
  return out;
}

Json pick_accessor(Json& accessor, const std::string& place) {
  Json out = pick(accessor, place,
                  {{"bufferView", Kind::kIndex},
                   {"byteOffset", Kind::kSize},
                   {"componentType", Kind::kIndex, true},
                   {"normalized", Kind::kFlag},
                   {"count", Kind::kSize, true},
                   {"type", Kind::kText, true}});
  if (Json* const sparse = find_object(accessor, "sparse", place)) {
    out["sparse"] = pick_sparse(*sparse, place + ".sparse");
  }
  return out;
}

// tinygltf refuses indices without a buffer view, in words that name no mesh.
void check_index_accessor(const Json& primitive, const Json& checked, const std::string& place) {
  const auto indices = primitive.find("indices");
  if (indices == primitive.end()) return;
  const auto accessor = indices->get<std::uint64_t>();
  const Json& accessors = checked["accessors"];
  const std::string name = place + ".indices names accessor " + std::to_string(accessor);
  if (accessor >= accessors.size()) {
    bad_scene(name + " and there are " + std::to_string(accessors.size()) + std::string(kExportAgain));
  }
  const std::uint64_t view = accessors[accessor].value("bufferView", std::uint64_t{0xFFFFFFFF});
  if (view >= checked["bufferViews"].size()) {
    bad_scene(name + ", which has no bufferView that exists" + std::string(kExportAgain));
  }
}

Json pick_primitive(Json& primitive, const Json& checked, const std::string& place) {
  Json out =
      pick(primitive, place, {{"indices", Kind::kIndex}, {"material", Kind::kIndex}, {"mode", Kind::kIndex}});
  Json* const attributes = find_object(primitive, "attributes", place);
  if (attributes == nullptr) bad_scene(place + ".attributes is missing" + std::string(kExportAgain));
  out["attributes"] = pick(*attributes, place + ".attributes", {{"POSITION", Kind::kIndex}});
  // Only that it is there matters; see gltf_mesh.
  if (find_extension(primitive, kDraco, place) != nullptr) out["extensions"][kDraco] = Json::object();
  check_index_accessor(out, checked, place);
  return out;
}

Json pick_mesh(Json& mesh, const Json& checked, const std::string& place) {
  Json out = pick(mesh, place, {{"name", Kind::kText}, {"weights", Kind::kNumbers}});
  out["primitives"] =
      pick_all(mesh, "primitives", place, [&checked](Json& primitive, const std::string& path) {
        return pick_primitive(primitive, checked, path);
      });
  return out;
}

Json pick_node(Json& node, const std::string& place) {
  Json out = pick(node, place,
                  {{"name", Kind::kText},
                   {"children", Kind::kIndices},
                   {"mesh", Kind::kIndex},
                   {"camera", Kind::kIndex},
                   {"skin", Kind::kIndex},
                   {"matrix", Kind::kNumbers, false, 16},
                   {"translation", Kind::kNumbers, false, 3},
                   {"rotation", Kind::kNumbers, false, 4},
                   {"scale", Kind::kNumbers, false, 3}});
  if (Json* const light = find_extension(node, kLights, place)) {
    out["extensions"][kLights] =
        pick(*light, place + ".extensions." + kLights, {{"light", Kind::kIndex, true}});
  }
  return out;
}

Json pick_scene(Json& scene, const std::string& place) {
  return pick(scene, place, {{"name", Kind::kText}, {"nodes", Kind::kIndices}});
}

Json pick_material(Json& material, const std::string& place) {
  Json out = pick(material, place, {{"name", Kind::kText}, {"emissiveFactor", Kind::kNumbers, false, 3}});
  // Textures are not read; that one is there becomes a note.
  const Json some_texture{{"index", 0}};
  if (find_object(material, "emissiveTexture", place) != nullptr) out["emissiveTexture"] = some_texture;
  if (Json* const pbr = find_object(material, "pbrMetallicRoughness", place)) {
    const std::string path = place + ".pbrMetallicRoughness";
    Json& picked = out["pbrMetallicRoughness"];
    picked = pick(*pbr, path,
                  {{"baseColorFactor", Kind::kNumbers, false, 4},
                   {"metallicFactor", Kind::kNumber},
                   {"roughnessFactor", Kind::kNumber}});
    if (find_object(*pbr, "baseColorTexture", path) != nullptr) picked["baseColorTexture"] = some_texture;
  }
  if (Json* const strength = find_extension(material, kEmissiveStrength, place)) {
    out["extensions"][kEmissiveStrength] =
        pick(*strength, place + ".extensions." + kEmissiveStrength, {{"emissiveStrength", Kind::kNumber}});
  }
  return out;
}

Json pick_camera(Json& camera, const std::string& place) {
  Json out = pick(camera, place, {{"type", Kind::kText, true}, {"name", Kind::kText}});
  const std::string& type = out["type"].get_ref<const std::string&>();
  if (type == "orthographic") {
    // Skipped later; tinygltf wants these all the same.
    out["orthographic"] = {{"xmag", 1.0}, {"ymag", 1.0}, {"zfar", 1.0}, {"znear", 0.0}};
    return out;
  }
  Json* const perspective = find_object(camera, "perspective", place);
  if (type != "perspective" || perspective == nullptr) {
    bad_scene(place + " must be \"perspective\" or \"orthographic\" and have a member of that name" +
              std::string(kExportAgain));
  }
  out["perspective"] = pick(*perspective, place + ".perspective",
                            {{"yfov", Kind::kNumber, true}, {"aspectRatio", Kind::kNumber}});
  out["perspective"]["znear"] = 0.01;  // never read here, but tinygltf insists on one
  return out;
}

Json pick_light(Json& light, const std::string& place) {
  Json out = pick(light, place,
                  {{"type", Kind::kText, true},
                   {"name", Kind::kText},
                   {"color", Kind::kNumbers, false, 3},
                   {"intensity", Kind::kNumber},
                   {"range", Kind::kNumber}});
  Json* const spot = find_object(light, "spot", place);
  if (spot != nullptr) {
    out["spot"] =
        pick(*spot, place + ".spot", {{"innerConeAngle", Kind::kNumber}, {"outerConeAngle", Kind::kNumber}});
  } else {
    out["spot"] = Json::object();  // tinygltf refuses a spot light without one; ours has default angles
  }
  return out;
}

Json parse(std::string_view json) {
  try {
    Json root = Json::parse(json.begin(), json.end());
    if (!root.is_object()) bad_scene("is JSON but not glTF: it is no JSON object");
    return root;
  } catch (const Json::exception& error) {
    // nlohmann's text has line and column after its own tag in brackets.
    const std::string_view what = error.what();
    const std::size_t tag_end = what.find("] ");
    bad_scene("is neither glTF nor GLB: " + std::string(what.substr(tag_end == what.npos ? 0 : tag_end + 2)));
  }
}

}  // namespace

CheckedGltf check_gltf_json(std::string_view json) {
  Json root = parse(json);
  Json out = Json::object();
  CheckedGltf checked;
  check_asset(root, out);
  check_required_extensions(root);
  checked.buffers = take_buffers(root);
  out["bufferViews"] = pick_all(root, "bufferViews", "", pick_view);
  out["accessors"] = pick_all(root, "accessors", "", pick_accessor);
  out["meshes"] = pick_all(root, "meshes", "", [&out](Json& mesh, const std::string& place) {
    return pick_mesh(mesh, out, place);
  });
  out["nodes"] = pick_all(root, "nodes", "", pick_node);
  out["scenes"] = pick_all(root, "scenes", "", pick_scene);
  out["materials"] = pick_all(root, "materials", "", pick_material);
  out["cameras"] = pick_all(root, "cameras", "", pick_camera);
  if (Json* const lights = find_extension(root, kLights, "")) {
    out["extensions"][kLights]["lights"] = pick_all(*lights, "lights", "", pick_light);
  }
  out.update(pick(root, "", {{"scene", Kind::kIndex}}));
  if (Json* const used = find_array(root, "extensionsUsed", "")) out["extensionsUsed"] = std::move(*used);
  checked.text = out.dump();
  return checked;
}

}  // namespace gnomon
