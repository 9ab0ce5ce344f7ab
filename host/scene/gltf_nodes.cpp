#include "gnomon/scene/gltf_nodes.h"

#include <cmath>
#include <cstdint>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "gnomon/scene/import_message.h"

namespace gnomon {
namespace {

constexpr std::size_t kNoParent = std::numeric_limits<std::size_t>::max();
constexpr double kMatrixRounding = 1e-6;

std::string node_name(const tinygltf::Model& model, std::size_t node) {
  return numbered("node", node, model.nodes[node].name);
}

// An index that the file states, as one that exists.
std::size_t require_node(const tinygltf::Model& model, int node, const std::string& place) {
  if (node < 0 || static_cast<std::size_t>(node) >= model.nodes.size()) {
    bad_scene(place + ": node " + std::to_string(node) + " does not exist, there are " +
              std::to_string(model.nodes.size()) + std::string(kExportAgain));
  }
  return static_cast<std::size_t>(node);
}

// The parent of every node. That each has at most one keeps walks linear in the file's size.
std::vector<std::size_t> find_parents(const tinygltf::Model& model) {
  std::vector<std::size_t> parents(model.nodes.size(), kNoParent);
  for (std::size_t node = 0; node < model.nodes.size(); ++node) {
    for (const int child_index : model.nodes[node].children) {
      const std::size_t child = require_node(model, child_index, node_name(model, node));
      if (parents[child] != kNoParent) {
        bad_scene(node_name(model, child) + " is listed as a child twice, by " +
                  node_name(model, parents[child]) + " and " + node_name(model, node) +
                  ": nodes must form a tree; export it again with copies");
      }
      parents[child] = node;
    }
  }
  return parents;
}

// With one parent at most, a node is on or below a cycle exactly when no root leads to it.
void require_no_cycle(const tinygltf::Model& model, const std::vector<std::size_t>& parents) {
  std::vector<bool> is_reached(parents.size(), false);
  std::vector<std::size_t> open;
  for (std::size_t node = 0; node < parents.size(); ++node) {
    if (parents[node] == kNoParent) open.push_back(node);
  }
  std::size_t reached = 0;
  while (!open.empty()) {
    const std::size_t node = open.back();
    open.pop_back();
    is_reached[node] = true;
    ++reached;
    for (const int child : model.nodes[node].children) open.push_back(static_cast<std::size_t>(child));
  }
  if (reached == parents.size()) return;
  std::size_t node = 0;
  while (is_reached[node]) ++node;
  // Climbing as often as there are nodes ends on the cycle itself.
  for (std::size_t step = 0; step < parents.size(); ++step) node = parents[node];
  bad_scene(node_name(model, node) + " is its own ancestor: the nodes form a cycle" +
            std::string(kExportAgain));
}

std::vector<std::size_t> roots_of_scene(const tinygltf::Model& model, std::size_t scene,
                                        const std::vector<std::size_t>& parents) {
  const std::string place = numbered("scene", scene, model.scenes[scene].name);
  std::vector<bool> is_listed(parents.size(), false);
  std::vector<std::size_t> roots;
  for (const int index : model.scenes[scene].nodes) {
    const std::size_t node = require_node(model, index, place);
    if (is_listed[node] || parents[node] != kNoParent) {
      bad_scene(place + " lists " + node_name(model, node) +
                (is_listed[node] ? " twice" : ", which is no root node") + std::string(kExportAgain));
    }
    is_listed[node] = true;
    roots.push_back(node);
  }
  return roots;
}

std::vector<std::size_t> find_roots(const tinygltf::Model& model, const std::vector<std::size_t>& parents,
                                    std::vector<std::string>& notes) {
  if (model.defaultScene >= 0 && static_cast<std::size_t>(model.defaultScene) >= model.scenes.size()) {
    bad_scene("the default scene " + std::to_string(model.defaultScene) + " does not exist, there are " +
              std::to_string(model.scenes.size()) + std::string(kExportAgain));
  }
  if (!model.scenes.empty()) {
    const std::size_t scene = model.defaultScene < 0 ? 0 : static_cast<std::size_t>(model.defaultScene);
    if (model.scenes.size() > 1) {
      notes.push_back("Only " + numbered("scene", scene, model.scenes[scene].name) + " of " +
                      std::to_string(model.scenes.size()) + " was read.");
    }
    return roots_of_scene(model, scene, parents);
  }
  std::vector<std::size_t> roots;
  for (std::size_t node = 0; node < parents.size(); ++node) {
    if (parents[node] == kNoParent) roots.push_back(node);
  }
  return roots;
}

glm::dmat4 matrix_of(const std::vector<double>& stated, const std::string& place) {
  glm::dmat4 matrix;
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row)
      matrix[column][row] = stated[static_cast<std::size_t>(column * 4 + row)];
  }
  for (int column = 0; column < 4; ++column) {
    const double affine = column == 3 ? 1.0 : 0.0;
    // Exporters that invert matrices leave rounding here; a projection is something else.
    if (!(std::abs(matrix[column][3] - affine) <= kMatrixRounding)) {
      bad_scene(place + ": its matrix must end in the row 0 0 0 1" + std::string(kExportAgain));
    }
    matrix[column][3] = affine;
  }
  return matrix;
}

// The node's own transform: its matrix, or translation * rotation * scale.
glm::dmat4 local_transform(const tinygltf::Model& model, std::size_t index) {
  const tinygltf::Node& node = model.nodes[index];
  if (!node.matrix.empty()) return matrix_of(node.matrix, node_name(model, index));
  glm::dmat4 local(1.0);
  if (!node.translation.empty()) {
    local = glm::translate(local, glm::dvec3(node.translation[0], node.translation[1], node.translation[2]));
  }
  if (!node.rotation.empty()) {
    const std::vector<double>& q = node.rotation;
    const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
    if (!(length > 0.0) || !std::isfinite(length)) {
      bad_scene(node_name(model, index) + ": its rotation has no direction" + std::string(kExportAgain));
    }
    local *= glm::mat4_cast(glm::dquat(q[3] / length, q[0] / length, q[1] / length, q[2] / length));
  }
  if (!node.scale.empty()) local = glm::scale(local, glm::dvec3(node.scale[0], node.scale[1], node.scale[2]));
  return local;
}

}  // namespace

std::vector<PlacedNode> place_nodes(const tinygltf::Model& model, std::vector<std::string>& notes) {
  const auto parents = find_parents(model);
  require_no_cycle(model, parents);
  const auto roots = find_roots(model, parents, notes);
  std::vector<PlacedNode> placed;
  // A stack of our own, not the call stack: depth costs only memory.
  std::vector<PlacedNode> open;
  for (auto root = roots.rbegin(); root != roots.rend(); ++root) open.push_back({*root, glm::dmat4(1.0)});
  while (!open.empty()) {
    PlacedNode node = open.back();  // world still is the parent's
    open.pop_back();
    node.world *= local_transform(model, node.node);
    placed.push_back(node);
    const auto& children = model.nodes[node.node].children;
    for (auto child = children.rbegin(); child != children.rend(); ++child) {
      open.push_back({static_cast<std::size_t>(*child), node.world});
    }
  }
  return placed;
}

}  // namespace gnomon
