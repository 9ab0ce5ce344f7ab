// Reading accessors element by element, every range checked once when one is opened: buffer views, strides,
// sparse overrides, and zeros where there is no data. Not for copying them out: a file may share one huge
// accessor between thousands of small primitives. Feeds gltf_mesh.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gnomon/scene/gltf_document.h"

namespace gnomon {

// An accessor whose reads are safe for every element below count. Elements it overrides come from
// sparse_values.
struct AccessorView {
  const unsigned char* data = nullptr;  // null: zeros
  std::uint64_t stride = 0;
  std::uint64_t count = 0;
  std::uint64_t element_bytes = 0;
  int component_type = 0;
  bool is_normalized = false;
  std::vector<std::uint32_t> sparse_elements;  // ascending
  const unsigned char* sparse_values = nullptr;

  [[nodiscard]] const unsigned char* element(std::uint64_t index) const;
};

// An element of a position accessor: float, or an integer type decoded as KHR_mesh_quantization says.
[[nodiscard]] glm::dvec3 read_position(const AccessorView& view, std::uint64_t index);
// An element of an index accessor.
[[nodiscard]] std::uint32_t read_index(const AccessorView& view, std::uint64_t index);

// The accessors of one document, opened at first use and kept. The document must outlive this.
class GltfAccessors {
 public:
  explicit GltfAccessors(const GltfDocument& document);

  // `place` names the user in messages, like `mesh 2 "Body", primitive 0`. All throw Error{kBadScene} for an
  // accessor that does not exist, has the wrong type, or reaches outside its buffer view or buffer.
  [[nodiscard]] const AccessorView& positions(int accessor, const std::string& place);
  [[nodiscard]] const AccessorView& indices(int accessor, const std::string& place);

 private:
  [[nodiscard]] const tinygltf::Accessor& find(int accessor, const std::string& place) const;
  [[nodiscard]] const AccessorView& open(int accessor, const std::string& place);
  [[nodiscard]] const unsigned char* bytes_of(int buffer_view, std::uint64_t offset, std::uint64_t count,
                                              std::uint64_t element_bytes, std::uint64_t stride,
                                              const std::string& place) const;
  void open_sparse(const tinygltf::Accessor& source, AccessorView& view, const std::string& place) const;

  const GltfDocument& document_;
  std::vector<std::optional<AccessorView>> views_;
};

}  // namespace gnomon
