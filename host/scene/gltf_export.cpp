#include "gnomon/scene/gltf_export.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <utility>

#include "gnomon/base/error.h"
#include "gnomon/scene/corner_index.h"
#include "gnomon/scene/glb_container.h"
#include "gnomon/scene/write_file.h"

namespace gnomon {
namespace {

using Json = nlohmann::ordered_json;

enum : int {
  kUnsignedShort = 5123,
  kUnsignedInt = 5125,
  kFloat = 5126,
  kArrayBuffer = 34962,
  kElementBuffer = 34963
};

Json to_json(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

// The unit quaternion (x, y, z, w) that turns -z to `forward` and y to `up`: from the rotation matrix with
// columns right, up, -forward, by its largest component (Shepperd 1978).
Json rotation_json(const Vec3& forward, const Vec3& up) {
  const double u[3] = {up[0], up[1], up[2]};
  const double b[3] = {-static_cast<double>(forward[0]), -static_cast<double>(forward[1]),
                       -static_cast<double>(forward[2])};
  const double r[3] = {u[1] * b[2] - u[2] * b[1], u[2] * b[0] - u[0] * b[2], u[0] * b[1] - u[1] * b[0]};
  const double squares[4] = {1.0 + r[0] - u[1] - b[2], 1.0 - r[0] + u[1] - b[2], 1.0 - r[0] - u[1] + b[2],
                             1.0 + r[0] + u[1] + b[2]};
  const double products[4][4] = {{squares[0], r[1] + u[0], b[0] + r[2], u[2] - b[1]},
                                 {r[1] + u[0], squares[1], u[2] + b[1], b[0] - r[2]},
                                 {b[0] + r[2], u[2] + b[1], squares[2], r[1] - u[0]},
                                 {u[2] - b[1], b[0] - r[2], r[1] - u[0], squares[3]}};
  const auto& row = products[std::max_element(squares, squares + 4) - squares];
  const double length = std::sqrt(row[0] * row[0] + row[1] * row[1] + row[2] * row[2] + row[3] * row[3]);
  return {row[0] / length, row[1] / length, row[2] / length, row[3] / length};
}

// Any unit vector at right angles to a direction: a light has no up of its own.
Vec3 some_up(const Vec3& direction) {
  const double d[3] = {direction[0], direction[1], direction[2]};
  const bool steep = std::abs(d[1]) > 0.9;
  const double dot = steep ? d[2] : d[1];
  const double up[3] = {-dot * d[0], (steep ? 0.0 : 1.0) - dot * d[1], (steep ? 1.0 : 0.0) - dot * d[2]};
  const double length = std::sqrt(up[0] * up[0] + up[1] * up[1] + up[2] * up[2]);
  return {static_cast<float>(up[0] / length), static_cast<float>(up[1] / length),
          static_cast<float>(up[2] / length)};
}

class Exporter {
 public:
  explicit Exporter(const Scene& scene) : scene_(scene) {}

  std::vector<unsigned char> run() {
    json_["asset"] = {{"version", "2.0"}, {"generator", "gnomon"}};
    json_["scene"] = 0;
    json_["scenes"] = Json::array({Json{{"name", scene_.name}}});
    add_materials();
    add_meshes();
    add_cameras();
    add_lights();
    if (!nodes_.empty()) {
      for (std::size_t i = 0; i < nodes_.size(); ++i) json_["scenes"][0]["nodes"].push_back(i);
      json_["nodes"] = std::move(nodes_);
    }
    if (!extensions_.empty()) json_["extensionsUsed"] = extensions_;
    if (!bytes_.empty()) json_["buffers"] = Json::array({Json{{"byteLength", bytes_.size()}}});
    return pack_glb(json_.dump(-1, ' ', false, Json::error_handler_t::replace), bytes_);
  }

 private:
  void add_materials() {
    for (const Material& material : scene_.materials) {
      const Vec3& color = material.base_color;
      Json entry{{"name", material.name},
                 {"pbrMetallicRoughness",
                  {{"baseColorFactor", {color[0], color[1], color[2], 1.0}},
                   {"metallicFactor", material.metallic},
                   {"roughnessFactor", material.roughness}}},
                 {"doubleSided", true}};
      add_emission(entry, material.emission);
      json_["materials"].push_back(std::move(entry));
    }
  }

  // emissiveFactor may not pass 1: what is above goes into the strength.
  void add_emission(Json& entry, const Vec3& emission) {
    const float strongest = std::max({emission[0], emission[1], emission[2]});
    if (!(strongest > 0.0F)) return;
    const double strength = strongest > 1.0F ? strongest : 1.0;
    entry["emissiveFactor"] = {emission[0] / strength, emission[1] / strength, emission[2] / strength};
    if (strongest <= 1.0F) return;
    entry["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
    use_extension("KHR_materials_emissive_strength");
  }

  void add_meshes() {
    std::vector<std::vector<std::uint32_t>> members(scene_.materials.size());
    for (std::size_t i = 0; i < scene_.triangles.size(); ++i) {
      members[scene_.material_ids[i]].push_back(static_cast<std::uint32_t>(i));
    }
    for (std::size_t id = 0; id < members.size(); ++id) {
      if (members[id].empty()) continue;
      const CornerIndex corners = index_corners(scene_.triangles, members[id]);
      require_glb_room(bytes_.size() + corners.positions.size() * sizeof(Vec3) +
                       corners.indices.size() * sizeof(std::uint32_t));
      const std::string& name = scene_.materials[id].name;
      const std::size_t positions = add_positions(corners.positions);
      const std::size_t indices = add_indices(corners);
      const Json primitive{{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"material", id}};
      nodes_.push_back({{"name", name}, {"mesh", json_.contains("meshes") ? json_["meshes"].size() : 0}});
      json_["meshes"].push_back({{"name", name}, {"primitives", Json::array({primitive})}});
    }
  }

  std::size_t add_view(const void* data, std::size_t size, int target) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    const std::size_t offset = bytes_.size();
    bytes_.resize(offset + size);
    std::memcpy(bytes_.data() + offset, data, size);
    json_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}, {"target", target}});
    return json_["bufferViews"].size() - 1;
  }

  std::size_t add_accessor(Json accessor) {
    json_["accessors"].push_back(std::move(accessor));
    return json_["accessors"].size() - 1;
  }

  std::size_t add_positions(const std::vector<Vec3>& positions) {
    Vec3 lo = positions.front();
    Vec3 hi = positions.front();
    for (const Vec3& p : positions) {
      for (unsigned axis = 0; axis < 3; ++axis) {
        lo[axis] = std::min(lo[axis], p[axis]);
        hi[axis] = std::max(hi[axis], p[axis]);
      }
    }
    const std::size_t view = add_view(positions.data(), positions.size() * sizeof(Vec3), kArrayBuffer);
    return add_accessor({{"bufferView", view},
                         {"componentType", kFloat},
                         {"count", positions.size()},
                         {"type", "VEC3"},
                         {"min", to_json(lo)},
                         {"max", to_json(hi)}});
  }

  // The highest 16-bit value is reserved (primitive restart), so 65535 corners are the most that fit.
  std::size_t add_indices(const CornerIndex& corners) {
    const bool narrow = corners.positions.size() <= 65535;
    std::size_t view = 0;
    if (narrow) {
      const std::vector<std::uint16_t> shorts(corners.indices.begin(), corners.indices.end());
      view = add_view(shorts.data(), shorts.size() * sizeof(std::uint16_t), kElementBuffer);
    } else {
      view = add_view(corners.indices.data(), corners.indices.size() * sizeof(std::uint32_t), kElementBuffer);
    }
    return add_accessor({{"bufferView", view},
                         {"componentType", narrow ? kUnsignedShort : kUnsignedInt},
                         {"count", corners.indices.size()},
                         {"type", "SCALAR"}});
  }

  void add_cameras() {
    for (std::size_t i = 0; i < scene_.cameras.size(); ++i) {
      const Camera& camera = scene_.cameras[i];
      Json perspective{{"yfov", camera.fov_y}, {"znear", 0.01}};
      if (camera.aspect > 0.0F) perspective["aspectRatio"] = camera.aspect;
      json_["cameras"].push_back(
          {{"name", camera.name}, {"type", "perspective"}, {"perspective", perspective}});
      nodes_.push_back({{"name", camera.name},
                        {"camera", i},
                        {"translation", to_json(camera.position)},
                        {"rotation", rotation_json(camera.forward, camera.up)}});
    }
  }

  // Area lights are not repeated here: their materials carry them.
  void add_lights() {
    Json lights = Json::array();
    for (const Light& light : scene_.lights) {
      if (light.kind == LightKind::kArea) continue;
      Json node{{"name", light.name}, {"extensions", {{"KHR_lights_punctual", {{"light", lights.size()}}}}}};
      if (light.kind != LightKind::kDirectional) node["translation"] = to_json(light.position);
      if (light.kind != LightKind::kPoint)
        node["rotation"] = rotation_json(light.direction, some_up(light.direction));
      nodes_.push_back(std::move(node));
      lights.push_back(light_json(light));
    }
    if (lights.empty()) return;
    use_extension("KHR_lights_punctual");
    json_["extensions"]["KHR_lights_punctual"]["lights"] = std::move(lights);
  }

  // Colour has its largest part at 1; the intensity carries the rest.
  static Json light_json(const Light& light) {
    const double intensity = std::max({light.color[0], light.color[1], light.color[2], 0.0F});
    const double scale = intensity > 0.0 ? intensity : 1.0;
    const char* const type = light.kind == LightKind::kDirectional ? "directional"
                             : light.kind == LightKind::kSpot      ? "spot"
                                                                   : "point";
    Json entry{{"name", light.name},
               {"type", type},
               {"color", {light.color[0] / scale, light.color[1] / scale, light.color[2] / scale}},
               {"intensity", intensity}};
    if (light.range > 0.0F && light.kind != LightKind::kDirectional) entry["range"] = light.range;
    if (light.kind == LightKind::kSpot) {
      entry["spot"] = {{"innerConeAngle", light.inner_cone}, {"outerConeAngle", light.outer_cone}};
    }
    return entry;
  }

  void use_extension(const char* name) {
    if (std::find(extensions_.begin(), extensions_.end(), name) == extensions_.end())
      extensions_.emplace_back(name);
  }

  const Scene& scene_;
  Json json_;
  Json nodes_ = Json::array();
  std::vector<std::string> extensions_;
  std::vector<unsigned char> bytes_;
};

}  // namespace

std::vector<unsigned char> export_glb(const Scene& scene) {
  return Exporter(scene).run();
}

void write_glb(const Scene& scene, const std::filesystem::path& file) {
  const std::vector<unsigned char> bytes = export_glb(scene);
  write_file(file, std::as_bytes(std::span(bytes)));
}

}  // namespace gnomon
