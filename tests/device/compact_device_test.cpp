// The compact form on the device has the reference's bytes. Its traversal: trace_compact_test.cpp.
#include <catch2/catch.hpp>

#include "gnomon/base/error.h"
#include "gnomon/device/compact_device.h"
#include "support/device.h"
#include "support/wide_shapes.h"

using gnomon::test::context;
using gnomon::test::scaled;

using Triangles = std::vector<GnTriangle>;

namespace {

// The device's bytes are the reference's, and nothing is wrong with them.
void require_reference_bytes(const Triangles& triangles, const gnomon::BuildOptions& build) {
  const auto tree = gnomon::build_device(context(), triangles, build);
  const auto wide = collapse_device(context(), tree);
  const auto compact = compact_device(context(), wide);
  const auto made = download_compact(context(), compact);
  const auto expected = gnomon::compact_reference(download_wide(context(), wide));
  REQUIRE(tree_hash(made) == tree_hash(expected));
  REQUIRE(made.nodes.size() == expected.nodes.size());
  REQUIRE(made.leaves.size() == expected.leaves.size());
  REQUIRE(made.depth == expected.depth);
  REQUIRE(compact.bytes() == made.bytes());
  const auto fault = gnomon::check_compact(made, triangles);
  CAPTURE(fault ? fault->what : "none");
  REQUIRE(!fault);
}

}  // namespace

TEST_CASE("the device's compact tree has the reference's bytes, whatever the shape",
          "[portable][unlimited]") {
  for (const auto& shape : gnomon::test::wide_shapes()) {
    CAPTURE(shape.name);
    require_reference_bytes(shape.triangles, shape.options);
  }
}

TEST_CASE("small compact trees have the reference's bytes, with corners shared and apart",
          "[portable][memcheck]") {
  require_reference_bytes(gnomon::test::soup(60, 631), gnomon::test::leaves_of(2));
  require_reference_bytes(gnomon::test::grid(5, 1.0F), gnomon::test::leaves_of(2));
  require_reference_bytes(gnomon::test::grid(4, 1.0F), gnomon::test::lazy_leaves_of(20));
  require_reference_bytes({}, {});
}

TEST_CASE("compact trees of models of any size have the reference's bytes", "[unlimited]") {
  for (const float scale : {1e-44F, 1e-40F, 1e-37F, 1e-31F, 1e-12F, 1e12F}) {
    for (const float offset : {0.0F, -1e-30F, 3e6F}) {
      CAPTURE(scale, offset);
      require_reference_bytes(scaled(gnomon::test::grid(15, 3.0F), scale, offset), {});
      require_reference_bytes(scaled(gnomon::test::soup(300, 632), scale, offset), {});
    }
  }
}

TEST_CASE("a leaf of 256 triangles cannot be made compact on the device", "[unlimited]") {
  const auto triangles = gnomon::test::repeated(gnomon::test::triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 256);
  const auto tree = gnomon::build_device(context(), triangles, gnomon::test::leaves_too_large());
  const auto wide = collapse_device(context(), tree);
  REQUIRE_THROWS_WITH(compact_device(context(), wide), Catch::Contains("leaf of 256 triangles"));
}
