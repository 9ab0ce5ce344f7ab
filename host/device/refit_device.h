// Refitting a tree on the device to triangles that have moved. Not for changing its shape: a tree refitted to
// quite another scene is right but slow; build a new one. Feeds animation.
#pragma once

#include <span>

#include "gnomon/device/build_device.h"
#include "gnomon/device/collapse_device.h"

namespace gnomon {

// Gives the tree the triangles' new corners, and every node the box that a builder would give it; nodes,
// links and leaf order stay. `triangles` are those the tree was built of, in the same order. Unmoved ones
// leave every byte as it was. Throws Error: kInvalidArgument (another number of triangles, or a tree of
// parts: Builder::kBest), kBadScene (as build_device; the tree is then as it was), kInvalidArgument also
// where the device ends the loops this takes, kOutOfMemory, kDevice. A Tracer made of the tree before is not
// to be used again.
void refit_device(const cl::Context& context, DeviceBvh& tree, std::span<const Triangle> triangles);

// The same for a wide tree: its slots stay where they are, learnt orders with them.
void refit_device(const cl::Context& context, DeviceWideBvh& tree, std::span<const Triangle> triangles);

}  // namespace gnomon
