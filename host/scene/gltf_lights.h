// Cameras and KHR_lights_punctual lights of glTF nodes. Not for emissive surfaces (area_light). Feeds
// gltf_import.
#pragma once

#include "gnomon/scene/gltf_nodes.h"
#include "gnomon/scene/scene.h"

namespace gnomon {

// Appends the node's camera and light to the scene, if it has any; both look along the node's -z, scale
// ignored. Orthographic cameras, and what has no usable place or angle, are left out with a note. Throws
// Error{kBadScene} for a camera or light that does not exist, and for a light of unknown type.
void add_camera(const tinygltf::Model& model, const PlacedNode& placed, Scene& scene);
void add_light(const tinygltf::Model& model, const PlacedNode& placed, Scene& scene);

}  // namespace gnomon
