// Answers are judged once where their bits are the same, and anew where anything differs.
#include "gnomon/compare/judging.h"

#include <catch2/catch.hpp>

#include "gnomon/scene/generators.h"
#include "gnomon/scene/ray_set.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/trace_reference.h"

using namespace gnomon;
using namespace gnomon::compare;

TEST_CASE("the same answers are judged once, and others by themselves, occlusion too") {
  const Scene scene = generate_scene("random", 500, 1);
  const Bvh bvh = build_reference(scene.triangles);
  Batch batch;
  batch.kind = "random";
  batch.rays = random_rays(scene, 400, 3);
  Answers right;
  right.hits = trace_reference(bvh, scene.triangles, batch.rays, false).hits;
  for (const Hit& hit : right.hits) right.occluded.push_back(hit.primitive == GN_NONE ? 0 : 1);
  Judge judge(scene, false);
  const auto row_of = [&](const char* method, const Answers& answers) {
    return judge.row(method, batch, answers, 1000, 60.0);
  };
  const AccuracyRow first = row_of("first", right);
  REQUIRE(first.judged == batch.rays.size());
  REQUIRE(first.hits > 50);
  REQUIRE(first.any_closest_disagree == 0);
  REQUIRE(first.same_as.empty());
  REQUIRE(row_of("twin", right).same_as == "first");
  // One ray's occlusion alone.
  Answers other = right;
  other.occluded[7] = other.occluded[7] != 0 ? 0 : 1;
  const AccuracyRow differs = row_of("other", other);
  REQUIRE(differs.same_as.empty());
  REQUIRE(differs.any_closest_disagree == 1);
  // One hit's last bit alone.
  Answers moved = right;
  for (Hit& hit : moved.hits) {
    if (hit.primitive == GN_NONE) continue;
    hit.u = -hit.u;
    break;
  }
  REQUIRE(row_of("moved", moved).same_as.empty());
  judge.forget();
  REQUIRE(row_of("again", right).same_as.empty());
}
