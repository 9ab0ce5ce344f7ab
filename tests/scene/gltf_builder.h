// Small glTF documents for tests, made in memory: JSON to change at will and a binary part that grows by
// arrays. Not for anything a real exporter should do. Feeds the importer's tests and its fuzz test.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gnomon/base/error.h"
#include "gnomon/scene/import.h"

namespace gnomon_test {

using Json = nlohmann::json;
using Bytes = std::vector<unsigned char>;

inline constexpr int kByte = 5120;
inline constexpr int kUnsignedByte = 5121;
inline constexpr int kShort = 5122;
inline constexpr int kUnsignedShort = 5123;
inline constexpr int kUnsignedInt = 5125;
inline constexpr int kFloat = 5126;

inline std::string base64(const Bytes& bytes) {
  constexpr const char* kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8U | (i + k < bytes.size() ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k > bytes.size() ? '=' : kAlphabet[bits >> (18U - 6U * k) & 63U];
    }
  }
  return text;
}

// Without its buffer a document starts as {"asset": {"version": "2.0"}}; buffer 0 is added when it is
// written.
struct GltfBuilder {
  Json json = {{"asset", {{"version", "2.0"}}}};
  Bytes binary;

  template <typename T>
  int add_view(const std::vector<T>& values, int stride = 0) {
    while (binary.size() % 4 != 0) binary.push_back(0);
    const std::size_t at = binary.size();
    binary.resize(at + values.size() * sizeof(T));
    std::memcpy(binary.data() + at, values.data(), values.size() * sizeof(T));
    Json view = {{"buffer", 0}, {"byteOffset", at}, {"byteLength", values.size() * sizeof(T)}};
    if (stride != 0) view["byteStride"] = stride;
    json["bufferViews"].push_back(view);
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }

  int add_accessor(const Json& accessor) {
    json["accessors"].push_back(accessor);
    return static_cast<int>(json["accessors"].size()) - 1;
  }

  int add_positions(const std::vector<float>& xyz) {
    return add_accessor({{"bufferView", add_view(xyz)},
                         {"componentType", kFloat},
                         {"count", xyz.size() / 3},
                         {"type", "VEC3"}});
  }

  template <typename T>
  int add_indices(const std::vector<T>& indices) {
    constexpr int kType = sizeof(T) == 1 ? kUnsignedByte : sizeof(T) == 2 ? kUnsignedShort : kUnsignedInt;
    return add_accessor({{"bufferView", add_view(indices)},
                         {"componentType", kType},
                         {"count", indices.size()},
                         {"type", "SCALAR"}});
  }

  // A mesh of one primitive, and a node that shows it.
  Json& add_mesh(const Json& primitive) {
    json["meshes"].push_back({{"name", "Body"}, {"primitives", Json::array({primitive})}});
    json["nodes"].push_back({{"mesh", json["meshes"].size() - 1}});
    return json["meshes"].back()["primitives"][0];
  }

  // The primitive of mesh 0.
  Json& primitive() { return json["meshes"][0]["primitives"][0]; }

  [[nodiscard]] std::string text() const {
    Json whole = json;
    if (!binary.empty() && !whole.contains("buffers")) {
      whole["buffers"] = {
          {{"byteLength", binary.size()}, {"uri", "data:application/octet-stream;base64," + base64(binary)}}};
    }
    return whole.dump();
  }

  [[nodiscard]] Bytes glb() const {
    Json whole = json;
    if (!binary.empty()) whole["buffers"] = {{{"byteLength", binary.size()}}};
    std::string chunk = whole.dump();
    while (chunk.size() % 4 != 0) chunk += ' ';
    Bytes padded = binary;
    while (padded.size() % 4 != 0) padded.push_back(0);
    Bytes file;
    const auto put = [&file](std::size_t value) {
      for (unsigned shift = 0; shift < 32; shift += 8)
        file.push_back(static_cast<unsigned char>(value >> shift));
    };
    put(0x46546C67);
    put(2);
    put(12 + 8 + chunk.size() + (padded.empty() ? 0 : 8 + padded.size()));
    put(chunk.size());
    put(0x4E4F534A);
    file.insert(file.end(), chunk.begin(), chunk.end());
    if (!padded.empty()) {
      put(padded.size());
      put(0x004E4942);
      file.insert(file.end(), padded.begin(), padded.end());
    }
    return file;
  }
};

// One triangle in the xy plane, its front towards +z: mesh 0 "Body", node 0.
inline GltfBuilder one_triangle() {
  GltfBuilder builder;
  builder.add_mesh({{"attributes", {{"POSITION", builder.add_positions({0, 0, 0, 1, 0, 0, 0, 1, 0})}}}});
  return builder;
}

inline gnomon::Scene load(const std::string& text, const gnomon::ImportOptions& options = {}) {
  return gnomon::import_gltf_bytes(reinterpret_cast<const unsigned char*>(text.data()), text.size(), {},
                                   options);
}
inline gnomon::Scene load(const Bytes& glb, const gnomon::ImportOptions& options = {}) {
  return gnomon::import_gltf_bytes(glb.data(), glb.size(), {}, options);
}
inline gnomon::Scene load(const GltfBuilder& builder, const gnomon::ImportOptions& options = {}) {
  return load(builder.text(), options);
}

// "kIo: message" or "kBadScene: message" of the Error that an action throws, or "no error".
template <typename Action>
std::string error_of(const Action& action) {
  try {
    action();
  } catch (const gnomon::Error& error) {
    const bool is_known =
        error.code() == gnomon::ErrorCode::kIo || error.code() == gnomon::ErrorCode::kBadScene;
    const char* const code = !is_known                                ? "other: "
                             : error.code() == gnomon::ErrorCode::kIo ? "kIo: "
                                                                      : "kBadScene: ";
    return std::string(code) + error.what();
  }
  return "no error";
}
inline std::string load_error(const GltfBuilder& builder, const gnomon::ImportOptions& options = {}) {
  return error_of([&] { return load(builder, options); });
}

inline constexpr gnomon::ImportOptions kReject{gnomon::InvalidPolicy::kReject};

// A folder of its own that disappears afterwards.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "gnomon-import-XXXXXX").string();
    path_ = mkdtemp(pattern.data());
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  template <typename Content>
  std::filesystem::path write(const std::string& name, const Content& content) const {
    const auto file = path_ / name;
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(content.data()), static_cast<std::streamsize>(content.size()));
    return file;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace gnomon_test
