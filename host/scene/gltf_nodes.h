// Where the nodes of a glTF scene stand. Not for what hangs on them (gltf_mesh, gltf_lights). Feeds
// gltf_import.
#pragma once

#include <tiny_gltf.h>

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

namespace gnomon {

struct PlacedNode {
  std::size_t node = 0;
  glm::dmat4 world{1.0};  // node to world
};

// The nodes of the default scene, else of the first, else of the whole file: parents before children, in the
// file's order, transforms composed in double precision. Adds a note when other scenes are left out. Throws
// Error{kBadScene} for indices that do not exist, a node with two parents, a cycle, or a matrix or rotation
// that is none. Deep hierarchies are fine.
[[nodiscard]] std::vector<PlacedNode> place_nodes(const tinygltf::Model& model,
                                                  std::vector<std::string>& notes);

}  // namespace gnomon
