// The device's builders held against their references. Feeds the tests of builders.
#pragma once

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "gnomon/device/build_device.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/bvh_check.h"
#include "support/device.h"

namespace gnomon::test {

// Builds on the device, demands the reference's bytes, returns their hash.
inline std::string require_same(const std::vector<GnTriangle>& triangles, const BuildOptions& options) {
  const DeviceBvh tree = build_device(context(), triangles, options);
  const Bvh device = download_bvh(context(), tree);
  const Bvh reference = build_reference(triangles, options);
  const auto fault = check_bvh(device, triangles, options);
  if (fault) FAIL(fault->what << " at node " << fault->node);
  REQUIRE(device.nodes.size() == reference.nodes.size());
  REQUIRE(device.primitives == reference.primitives);
  REQUIRE(tree_hash(device) == tree_hash(reference));
  REQUIRE(tree.max_depth == stats_of(reference, options).max_depth);
  return tree_hash(device);
}

}  // namespace gnomon::test
