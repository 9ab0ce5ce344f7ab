// tinygltf and tinyobj compiled into the fuzz test from their headers: the libraries of the system have no
// sanitizers, so faults that our input provokes in them would go unseen.
#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>
