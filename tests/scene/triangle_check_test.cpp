// What importers do with triangles that cannot be traced: the policy itself, through glTF documents.
#include "gnomon/scene/triangle_check.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "gltf_builder.h"

using namespace gnomon_test;
using Catch::Contains;
using Catch::StartsWith;
using gnomon::fault_of;
using gnomon::Scene;
using gnomon::Triangle;
using gnomon::TriangleFault;

TEST_CASE("zero area is told from a sliver at every scale") {
  for (const float scale : {1e-30F, 1e-6F, 1.0F, 1e6F, 1e13F}) {
    INFO("scale " << scale);
    const float x = 3 * scale;
    const Triangle line{{0, 0, 0}, {x, x, x}, {2 * x, 2 * x, 2 * x}};
    CHECK(fault_of(line) == TriangleFault::kZeroArea);
    Triangle sliver = line;
    sliver.v2[1] = std::nextafter(sliver.v2[1], 2 * sliver.v2[1]);
    CHECK(fault_of(sliver) == TriangleFault::kNone);
    const Triangle point{{x, x, x}, {x, x, x}, {0, 0, 0}};
    CHECK(fault_of(point) == TriangleFault::kZeroArea);
  }
}

TEST_CASE("coordinates up to 2^48 are fine, beyond are not") {
  Triangle t{{0, 0, 0}, {1, 0, 0}, {0, gnomon::kMaxCoordinate, 0}};
  CHECK(fault_of(t) == TriangleFault::kNone);
  t.v2[1] = -std::nextafter(gnomon::kMaxCoordinate, std::numeric_limits<float>::infinity());
  CHECK(fault_of(t) == TriangleFault::kNotFinite);
}

TEST_CASE("vertices that are no usable numbers are dropped and counted, or rejected by name") {
  const float bad =
      GENERATE(std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 3e14F);
  GltfBuilder builder;
  const int positions = builder.add_positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, bad, 0, 0, 1, 0});
  builder.add_mesh({{"attributes", {{"POSITION", positions}}}});
  const Scene scene = load(builder);
  CHECK(scene.triangles.size() == 1);
  CHECK(scene.report.non_finite_dropped == 1);
  CHECK(scene.report.zero_area_dropped == 0);
  CHECK_THAT(load_error(builder, kReject),
             StartsWith("kBadScene: mesh 0 \"Body\", primitive 0, triangle 1") &&
                 Contains("not a number, infinite or beyond 2^48"));
}

TEST_CASE("triangles without area are dropped and counted, or rejected by name; slivers stay") {
  GltfBuilder builder;
  // Equal corners; corners on one line; and a sliver one rounding step away from that line.
  const int positions = builder.add_positions({1, 2, 3, 1,    2,    3,    4,    5,    6,     //
                                               0, 0, 0, 0.1F, 0.2F, 0.3F, 0.2F, 0.4F, 0.6F,  //
                                               0, 0, 0, 1,    1,    1,    2,    2,    2.0000002F});
  builder.add_mesh({{"attributes", {{"POSITION", positions}}}});
  const Scene scene = load(builder);
  CHECK(scene.triangles.size() == 1);
  CHECK(scene.report.zero_area_dropped == 2);
  CHECK_THAT(load_error(builder, kReject), Contains(", triangle 0 has no area"));
}

TEST_CASE("triangles without area stay for whoever asks, those of no numbers do not") {
  Scene scene;
  gnomon::TriangleSink sink(scene, gnomon::InvalidPolicy::kKeepFlat);
  const auto place = [] { return std::string("here"); };
  CHECK(sink.add({{1, 2, 3}, {1, 2, 3}, {4, 5, 6}}, 7, place));
  CHECK_FALSE(sink.add({{std::numeric_limits<float>::quiet_NaN(), 0, 0}, {1, 0, 0}, {0, 1, 0}}, 7, place));
  CHECK(scene.triangles.size() == 1);
  CHECK(scene.material_ids == std::vector<std::uint32_t>{7});
  CHECK(scene.report.zero_area_dropped == 0);
  CHECK(scene.report.non_finite_dropped == 1);
}

TEST_CASE("a transform that pushes vertices out of range makes them invalid") {
  GltfBuilder builder = one_triangle();
  builder.json["nodes"][0]["scale"] = {1e300, 1e300, 1};
  CHECK_THAT(load_error(builder), Contains("1 triangles with coordinates that are no usable numbers"));
}
