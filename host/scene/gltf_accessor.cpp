#include "gnomon/scene/gltf_accessor.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "gnomon/scene/import_message.h"

namespace gnomon {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian and read in place");

constexpr std::uint64_t kLargestElement = 128;  // a 4 x 4 matrix of doubles
constexpr unsigned char kZeros[kLargestElement] = {};

// An accessor without a buffer view claims zeros that no file size bounds. Real files use that for a few
// vertices.
constexpr std::uint64_t kMostImpliedElements = 1U << 22U;

template <typename T>
T load(const unsigned char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

// Integer coordinates are plain or stand for [-1, 1] or [0, 1]; glTF 2.0, section 3.11.
template <typename T>
glm::dvec3 load_vector(const unsigned char* at, double one) {
  glm::dvec3 vector;
  for (int axis = 0; axis < 3; ++axis) {
    const double value = static_cast<double>(load<T>(at + static_cast<std::size_t>(axis) * sizeof(T))) / one;
    vector[axis] = one > 1.0 && value < -1.0 ? -1.0 : value;
  }
  return vector;
}

std::uint32_t load_index(int component_type, const unsigned char* at) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<std::uint8_t>(at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(at);
    default:
      return load<std::uint32_t>(at);
  }
}

bool is_index_type(int component_type) {
  return component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

std::uint64_t component_bytes(int component_type, const std::string& place) {
  const int bytes = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(component_type));
  if (bytes < 0) bad_scene(place + ": component type " + std::to_string(component_type) + " does not exist");
  return static_cast<std::uint64_t>(bytes);
}

std::string range_text(std::uint64_t offset, std::uint64_t count, std::uint64_t stride) {
  return std::to_string(count) + " elements every " + std::to_string(stride) + " bytes from byte " +
         std::to_string(offset);
}

}  // namespace

const unsigned char* AccessorView::element(std::uint64_t index) const {
  if (!sparse_elements.empty()) {
    const auto found = std::lower_bound(sparse_elements.begin(), sparse_elements.end(), index);
    if (found != sparse_elements.end() && *found == index) {
      return sparse_values + static_cast<std::uint64_t>(found - sparse_elements.begin()) * element_bytes;
    }
  }
  return data == nullptr ? kZeros : data + index * stride;
}

glm::dvec3 read_position(const AccessorView& view, std::uint64_t index) {
  const unsigned char* const at = view.element(index);
  switch (view.component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return load_vector<std::int8_t>(at, view.is_normalized ? 127.0 : 1.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load_vector<std::uint8_t>(at, view.is_normalized ? 255.0 : 1.0);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return load_vector<std::int16_t>(at, view.is_normalized ? 32767.0 : 1.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load_vector<std::uint16_t>(at, view.is_normalized ? 65535.0 : 1.0);
    default:
      return load_vector<float>(at, 1.0);
  }
}

std::uint32_t read_index(const AccessorView& view, std::uint64_t index) {
  return load_index(view.component_type, view.element(index));
}

GltfAccessors::GltfAccessors(const GltfDocument& document)
    : document_(document), views_(document.model.accessors.size()) {}

const tinygltf::Accessor& GltfAccessors::find(int accessor, const std::string& place) const {
  const auto& accessors = document_.model.accessors;
  if (accessor < 0 || static_cast<std::size_t>(accessor) >= accessors.size()) {
    bad_scene(place + ": accessor " + std::to_string(accessor) + " does not exist, there are " +
              std::to_string(accessors.size()) + std::string(kExportAgain));
  }
  return accessors[static_cast<std::size_t>(accessor)];
}

const AccessorView& GltfAccessors::positions(int accessor, const std::string& place) {
  const tinygltf::Accessor& source = find(accessor, place);
  const int type = source.componentType;
  const bool is_readable = type == TINYGLTF_COMPONENT_TYPE_FLOAT || type == TINYGLTF_COMPONENT_TYPE_BYTE ||
                           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                           type == TINYGLTF_COMPONENT_TYPE_SHORT ||
                           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
  if (source.type != TINYGLTF_TYPE_VEC3 || !is_readable) {
    bad_scene(place + ": POSITION (accessor " + std::to_string(accessor) +
              ") must be VEC3 of floats or 8 or 16 bit integers; export it again as such");
  }
  return open(accessor, place);
}

const AccessorView& GltfAccessors::indices(int accessor, const std::string& place) {
  const tinygltf::Accessor& source = find(accessor, place);
  if (source.type != TINYGLTF_TYPE_SCALAR || !is_index_type(source.componentType)) {
    bad_scene(place + ": indices (accessor " + std::to_string(accessor) +
              ") must be SCALAR of unsigned 8, 16 or 32 bit integers; export it again as such");
  }
  return open(accessor, place);
}

const AccessorView& GltfAccessors::open(int accessor, const std::string& place) {
  std::optional<AccessorView>& kept = views_[static_cast<std::size_t>(accessor)];
  if (kept) return *kept;
  const tinygltf::Accessor& source = document_.model.accessors[static_cast<std::size_t>(accessor)];
  const std::string name = place + ": accessor " + std::to_string(accessor);
  AccessorView view;
  view.count = source.count;
  view.component_type = source.componentType;
  view.is_normalized = source.normalized;
  view.element_bytes =
      component_bytes(source.componentType, name) *
      static_cast<std::uint64_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(source.type)));
  if (source.bufferView >= 0) {
    const auto& views = document_.model.bufferViews;
    const auto index = static_cast<std::size_t>(source.bufferView);
    const std::uint64_t stated = index < views.size() ? views[index].byteStride : 0;
    view.stride = stated == 0 ? view.element_bytes : stated;
    view.data =
        bytes_of(source.bufferView, source.byteOffset, view.count, view.element_bytes, view.stride, name);
  } else if (view.count > kMostImpliedElements) {
    bad_scene(name + " claims " + std::to_string(view.count) + " elements without any data, at most " +
              std::to_string(kMostImpliedElements) + " are accepted" + std::string(kExportAgain));
  }
  if (source.sparse.isSparse) open_sparse(source, view, name);
  kept = std::move(view);
  return *kept;
}

const unsigned char* GltfAccessors::bytes_of(int buffer_view, std::uint64_t offset, std::uint64_t count,
                                             std::uint64_t element_bytes, std::uint64_t stride,
                                             const std::string& place) const {
  const auto& views = document_.model.bufferViews;
  const std::string name = place + ", buffer view " + std::to_string(buffer_view);
  if (buffer_view < 0 || static_cast<std::size_t>(buffer_view) >= views.size()) {
    bad_scene(name + " does not exist, there are " + std::to_string(views.size()) +
              std::string(kExportAgain));
  }
  const tinygltf::BufferView& view = views[static_cast<std::size_t>(buffer_view)];
  if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= document_.buffers.size()) {
    bad_scene(name + ": buffer " + std::to_string(view.buffer) + " does not exist, there are " +
              std::to_string(document_.buffers.size()) + std::string(kExportAgain));
  }
  const auto buffer = document_.buffers[static_cast<std::size_t>(view.buffer)];
  if (view.byteOffset > buffer.size() || view.byteLength > buffer.size() - view.byteOffset) {
    bad_scene(name + " reaches past buffer " + std::to_string(view.buffer) + ", which has " +
              std::to_string(buffer.size()) + " bytes" + std::string(kExportAgain));
  }
  if (stride < element_bytes) {
    bad_scene(name + ": a stride of " + std::to_string(stride) + " bytes is too small for elements of " +
              std::to_string(element_bytes) + std::string(kExportAgain));
  }
  // Subtractions and a division only: nothing a file can state overflows.
  const std::uint64_t length = view.byteLength;
  const bool fits = count == 0 || (offset <= length && element_bytes <= length - offset &&
                                   count - 1 <= (length - offset - element_bytes) / stride);
  if (!fits) {
    bad_scene(name + " has " + std::to_string(length) + " bytes, too few for " +
              range_text(offset, count, stride) + std::string(kExportAgain));
  }
  return count == 0 ? kZeros : buffer.data() + view.byteOffset + offset;
}

void GltfAccessors::open_sparse(const tinygltf::Accessor& source, AccessorView& view,
                                const std::string& place) const {
  const auto& sparse = source.sparse;
  const auto count = static_cast<std::uint64_t>(sparse.count);
  const std::string name = place + ", sparse indices";
  if (!is_index_type(sparse.indices.componentType)) {
    bad_scene(name + " must be unsigned 8, 16 or 32 bit integers" + std::string(kExportAgain));
  }
  const std::uint64_t index_bytes = component_bytes(sparse.indices.componentType, name);
  const unsigned char* const indices =
      bytes_of(sparse.indices.bufferView, static_cast<std::uint64_t>(sparse.indices.byteOffset), count,
               index_bytes, index_bytes, name);
  view.sparse_values =
      bytes_of(sparse.values.bufferView, static_cast<std::uint64_t>(sparse.values.byteOffset), count,
               view.element_bytes, view.element_bytes, place + ", sparse values");
  view.sparse_elements.reserve(static_cast<std::size_t>(count));
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint32_t element = load_index(sparse.indices.componentType, indices + i * index_bytes);
    if (element >= view.count || (i > 0 && element <= view.sparse_elements.back())) {
      bad_scene(name + ": entry " + std::to_string(i) + " is " + std::to_string(element) +
                ", they must ascend and stay below " + std::to_string(view.count) +
                std::string(kExportAgain));
    }
    view.sparse_elements.push_back(element);
  }
}

}  // namespace gnomon
