#include "gnomon/scene/obj_reader.h"

#include <tiny_obj_loader.h>

#include <array>
#include <charconv>
#include <istream>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "gnomon/scene/area_light.h"
#include "gnomon/scene/import_message.h"
#include "gnomon/scene/obj_lines.h"
#include "gnomon/scene/obj_material.h"
#include "gnomon/scene/polygon.h"
#include "gnomon/scene/triangle_check.h"

namespace gnomon {
namespace {

constexpr std::uint32_t kNoMaterial = std::numeric_limits<std::uint32_t>::max();

// A face as the file has it. Kept until all vertices are known: some writers put faces first.
struct ObjFace {
  std::size_t first_corner;
  std::uint32_t corner_count;
  std::uint32_t material_id;
  std::uint32_t shape_id;
  std::uint64_t line;
};

std::string trimmed(const char* text) {
  const auto words = words_of(text);
  if (words.empty()) return {};
  return {words.front().data(), words.back().data() + words.back().size()};
}

// A number, or NaN for the ways programs write NaN and infinity; nothing for other words. tinyobj would take
// all of these for 0. A value too large or small for a float is what tinyobj made of it: infinity or 0.
std::optional<float> read_number(std::string_view word, float from_tinyobj) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  float value = 0.0F;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (stop == word.data() + word.size()) {
    if (error == std::errc()) return value;
    if (error == std::errc::result_out_of_range) return from_tinyobj;
  }
  const bool is_printed_nan = word.find('#') != word.npos || word.find("nan") != word.npos;
  return is_printed_nan ? std::optional(std::numeric_limits<float>::quiet_NaN()) : std::nullopt;
}

// Collects what tinyobj reports, then makes the scene of it.
class ObjReader {
 public:
  ObjReader(ObjLines& lines, const ImportOptions& options) : lines_(lines), options_(options) {}

  [[nodiscard]] Scene read(const std::filesystem::path& base_folder);

 private:
  void add_vertex(float x, float y, float z);
  void add_face(const tinyobj::index_t* indices, int count);
  void use_material(const char* name);
  void add_materials(const tinyobj::material_t* materials, int count);
  void start_shape(std::string name);

  [[nodiscard]] std::string here() const { return "line " + std::to_string(lines_.number()); }
  [[nodiscard]] std::uint32_t resolve(int index) const;
  [[nodiscard]] std::vector<Vec3> corners_of(const ObjFace& face) const;
  void emit(const ObjFace& face, TriangleSink& sink);
  void emit_all();
  std::uint32_t id_of(std::uint32_t material);

  ObjLines& lines_;
  const ImportOptions& options_;
  Scene scene_;
  std::vector<Vec3> vertices_;
  std::vector<std::uint32_t> corners_;
  std::vector<ObjFace> faces_;
  std::uint64_t triangle_count_ = 0;
  std::vector<std::string> shape_names_{std::string()};
  std::map<std::string, std::uint32_t> material_ids_;
  std::size_t materials_seen_ = 0;
  std::uint32_t material_ = kNoMaterial;
  std::uint32_t default_material_ = kNoMaterial;
  // Emissive triangles by shape and material: one light each.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> glowing_;
};

void ObjReader::add_vertex(float x, float y, float z) {
  const auto words = words_of(lines_.line());
  const std::array<float, 3> from_tinyobj{x, y, z};
  Vec3 vertex{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto number =
        axis + 1 < words.size() ? read_number(words[axis + 1], from_tinyobj[axis]) : std::nullopt;
    if (!number)
      bad_scene(here() + ": a vertex needs three numbers, and this says " + in_quotes(lines_.line()));
    vertex[axis] = to_coordinate(static_cast<double>(*number));
  }
  vertices_.push_back(vertex);
}

std::uint32_t ObjReader::resolve(int index) const {
  // Negative ones count back from the last vertex so far.
  const auto known = static_cast<std::int64_t>(vertices_.size());
  const std::int64_t vertex = index > 0 ? std::int64_t{index} - 1 : known + index;
  if (index == 0 || vertex < 0) {
    bad_scene(here() + ": a face needs vertex numbers from 1 or back from -1 (there are " +
              std::to_string(known) + " vertices so far), and this says " + in_quotes(lines_.line()));
  }
  return static_cast<std::uint32_t>(vertex);
}

void ObjReader::add_face(const tinyobj::index_t* indices, int count) {
  if (count < 3) {
    ++scene_.report.primitives_skipped;
    return;
  }
  const auto corner_count = static_cast<std::uint32_t>(count);
  require_room(triangle_count_, corner_count - 2, options_);
  triangle_count_ += corner_count - 2;
  faces_.push_back({corners_.size(), corner_count, material_,
                    static_cast<std::uint32_t>(shape_names_.size() - 1), lines_.number()});
  for (int i = 0; i < count; ++i) corners_.push_back(resolve(indices[i].vertex_index));
}

void ObjReader::use_material(const char* name) {
  const std::string wanted = trimmed(name);
  auto found = material_ids_.find(wanted);
  if (found == material_ids_.end()) {
    scene_.report.notes.push_back("Material " + in_quotes(wanted) + " (" + here() + ") is not defined.");
    found = material_ids_.emplace(wanted, kNoMaterial).first;  // one note each
  }
  material_ = found->second;
}

void ObjReader::add_materials(const tinyobj::material_t* materials, int count) {
  // tinyobj passes all it has so far, every time.
  for (; materials_seen_ < static_cast<std::size_t>(count); ++materials_seen_) {
    const tinyobj::material_t& source = materials[materials_seen_];
    const std::string name = trimmed(source.name.c_str());
    if (name.empty()) continue;
    const auto [entry, is_new] = material_ids_.emplace(name, kNoMaterial);
    if (!is_new && entry->second != kNoMaterial) continue;
    entry->second = static_cast<std::uint32_t>(scene_.materials.size());
    scene_.materials.push_back(to_material(source));
    scene_.materials.back().name = name;
  }
}

void ObjReader::start_shape(std::string name) {
  // Both "o" and "g" start one; often they come together and the first stays empty.
  const bool is_used = !faces_.empty() && faces_.back().shape_id + 1 == shape_names_.size();
  if (is_used) {
    shape_names_.push_back(std::move(name));
  } else {
    shape_names_.back() = std::move(name);
  }
}

std::uint32_t ObjReader::id_of(std::uint32_t material) {
  if (material != kNoMaterial) return material;
  if (default_material_ == kNoMaterial) {
    default_material_ = static_cast<std::uint32_t>(scene_.materials.size());
    scene_.materials.emplace_back().name = "default";
  }
  return default_material_;
}

std::vector<Vec3> ObjReader::corners_of(const ObjFace& face) const {
  std::vector<Vec3> corners;
  corners.reserve(face.corner_count);
  for (std::size_t i = 0; i < face.corner_count; ++i) {
    const std::uint32_t vertex = corners_[face.first_corner + i];
    if (vertex >= vertices_.size()) {
      bad_scene("line " + std::to_string(face.line) + ": a face uses vertex " + std::to_string(vertex + 1) +
                ", and there are " + std::to_string(vertices_.size()) + std::string(kExportAgain));
    }
    corners.push_back(vertices_[vertex]);
  }
  return corners;
}

void ObjReader::emit(const ObjFace& face, TriangleSink& sink) {
  const auto corners = corners_of(face);
  const std::uint32_t material_id = id_of(face.material_id);
  const bool glows = emits(scene_.materials[material_id]);
  const auto place = [&] {
    return "line " + std::to_string(face.line) + ": a triangle of shape " +
           in_quotes(shape_names_[face.shape_id]);
  };
  const PolygonTriangles triangles =
      corners.size() == 3 ? PolygonTriangles{{0, 1, 2}} : split_polygon(corners);
  for (const auto& [a, b, c] : triangles) {
    const Triangle triangle{{corners[a][0], corners[a][1], corners[a][2]},
                            {corners[b][0], corners[b][1], corners[b][2]},
                            {corners[c][0], corners[c][1], corners[c][2]}};
    if (!sink.add(triangle, material_id, place) || !glows) continue;
    glowing_[{face.shape_id, material_id}].push_back(static_cast<std::uint32_t>(scene_.triangles.size() - 1));
  }
}

void ObjReader::emit_all() {
  scene_.triangles.reserve(static_cast<std::size_t>(triangle_count_));
  scene_.material_ids.reserve(static_cast<std::size_t>(triangle_count_));
  TriangleSink sink(scene_, options_.invalid);
  for (const ObjFace& face : faces_) emit(face, sink);
  for (auto& [key, triangles] : glowing_) {
    const Material& material = scene_.materials[key.second];
    scene_.lights.push_back(make_area_light(scene_, material.name, material, std::move(triangles)));
  }
}

Scene ObjReader::read(const std::filesystem::path& base_folder) {
  tinyobj::callback_t callbacks;
  callbacks.vertex_cb = [](void* self, float x, float y, float z, float) {
    static_cast<ObjReader*>(self)->add_vertex(x, y, z);
  };
  callbacks.index_cb = [](void* self, tinyobj::index_t* indices, int count) {
    static_cast<ObjReader*>(self)->add_face(indices, count);
  };
  callbacks.usemtl_cb = [](void* self, const char* name, int) {
    static_cast<ObjReader*>(self)->use_material(name);
  };
  callbacks.mtllib_cb = [](void* self, const tinyobj::material_t* materials, int count) {
    static_cast<ObjReader*>(self)->add_materials(materials, count);
  };
  callbacks.group_cb = [](void* self, const char** names, int count) {
    static_cast<ObjReader*>(self)->start_shape(count > 0 ? trimmed(names[0]) : std::string());
  };
  callbacks.object_cb = [](void* self, const char* name) {
    static_cast<ObjReader*>(self)->start_shape(trimmed(name));
  };
  std::istream stream(&lines_);
  ObjMaterialReader materials(lines_, base_folder, scene_.report.notes);
  tinyobj::LoadObjWithCallback(stream, callbacks, this, &materials);
  scene_.report.primitives_skipped += lines_.skipped();
  emit_all();
  require_triangles(scene_);
  return std::move(scene_);
}

}  // namespace

Scene import_obj_bytes(std::vector<unsigned char> text, const std::filesystem::path& base_folder,
                       const ImportOptions& options) {
  return run_import({}, [&] {
    ObjLines lines(std::move(text));
    return ObjReader(lines, options).read(base_folder);
  });
}

}  // namespace gnomon
