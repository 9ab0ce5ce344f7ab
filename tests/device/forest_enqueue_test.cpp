// A forest's tracer on the caller's buffers: only enqueues, and answers as its blocking calls do.
#include <catch2/catch.hpp>
#include <cstring>
#include <limits>

#include "gnomon/cl/launch.h"
#include "support/forest_rig.h"
#include "support/shapes.h"

namespace cl = gnomon::cl;
using gnomon::ForestTraceOptions;
using gnomon::ForestTracer;
using gnomon::test::context;
using gnomon::test::Rig;

namespace {

struct Batch {
  std::vector<GnRay> rays;
  cl::Buffer ray_buffer;
  cl::Buffer hits;
  cl::Buffer occluded;
  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(rays.size()); }
};

Batch batch_of(std::vector<GnRay> rays) {
  Batch batch{std::move(rays), {}, {}, {}};
  batch.ray_buffer = context().create_buffer("rays", batch.rays.size() * sizeof(GnRay));
  context().upload_values<GnRay>(batch.ray_buffer, batch.rays);
  batch.hits = context().create_buffer("hits", batch.rays.size() * sizeof(GnHit));
  batch.occluded = context().create_buffer("occluded", batch.rays.size() * sizeof(std::uint32_t));
  return batch;
}

struct Trees {
  std::vector<GnTriangle> triangles = gnomon::test::soup(700, 121);
  std::vector<gnomon::InfluenceArea> areas =
      gnomon::test::areas_of(gnomon::test::extent_of(triangles), {0.3, -1.0, 0.2}, 0.6);
  Rig rig{triangles, gnomon::test::local_trees_of(areas)};
};

}  // namespace

TEST_CASE("a forest's enqueued traces answer as its blocking ones, at once and in passes",
          "[serial][portable]") {
  const Trees trees;
  Batch batch = batch_of(gnomon::test::all_rays(trees.areas, 40, 122));
  for (const std::uint32_t step_limit : {0U, 400U}) {
    CAPTURE(step_limit);
    ForestTraceOptions options;
    options.trace.step_limit = step_limit;
    const ForestTracer tracer(context(), trees.rig.forest(), trees.rig.tops().front(), options);
    const auto hits = tracer.closest(batch.rays).hits;
    const auto occluded = tracer.any(batch.rays).occluded;
    context().fill(batch.hits, 0xaa);
    context().fill(batch.occluded, 0xaa);
    cl::wait(tracer.enqueue_closest(batch.ray_buffer.mem.get(), batch.hits.mem.get(), batch.count()));
    cl::wait(tracer.enqueue_any(batch.ray_buffer.mem.get(), batch.occluded.mem.get(), batch.count()));
    const auto got = context().download_values<GnHit>(batch.hits, hits.size());
    REQUIRE(std::memcmp(got.data(), hits.data(), hits.size() * sizeof(GnHit)) == 0);
    REQUIRE(context().download_values<std::uint32_t>(batch.occluded, occluded.size()) == occluded);
    std::size_t met = 0;
    for (const std::uint32_t one : occluded) met += one;
    REQUIRE(met > 20);
    REQUIRE(met + 20 < occluded.size());
  }
}

TEST_CASE("a forest's tracer counts invalid rays over all calls", "[portable]") {
  const Trees trees;
  std::vector<GnRay> rays = gnomon::test::all_rays(trees.areas, 5, 123);
  rays[3].origin[1] = std::numeric_limits<float>::quiet_NaN();
  const Batch batch = batch_of(rays);
  const ForestTracer tracer(context(), trees.rig.forest(), trees.rig.tops().front());
  REQUIRE(tracer.invalid_rays() == 0);
  REQUIRE(tracer.closest(rays).invalid_rays == 1);
  cl::wait(tracer.enqueue_any(batch.ray_buffer.mem.get(), batch.occluded.mem.get(), batch.count()));
  REQUIRE(tracer.invalid_rays() == 2);
  REQUIRE(tracer.any(rays).invalid_rays == 1);
}

TEST_CASE("a forest's enqueued trace waits for the caller's event and nobody waits for it") {
  const Trees trees;
  const Batch batch = batch_of(gnomon::test::all_rays(trees.areas, 5, 124));
  const ForestTracer tracer(context(), trees.rig.forest(), trees.rig.tops().front());
  cl_int status = CL_SUCCESS;
  cl_context owner = nullptr;
  REQUIRE(clGetMemObjectInfo(batch.ray_buffer.mem.get(), CL_MEM_CONTEXT, sizeof owner, &owner, nullptr) ==
          CL_SUCCESS);
  cl_event gate = clCreateUserEvent(owner, &status);
  REQUIRE(status == CL_SUCCESS);
  const auto event = tracer.enqueue_closest(batch.ray_buffer.mem.get(), batch.hits.mem.get(), batch.count(),
                                            std::span(&gate, 1));
  cl_int state = CL_COMPLETE;
  clGetEventInfo(event.get(), CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof state, &state, nullptr);
  CHECK(state > CL_COMPLETE);
  REQUIRE(clSetUserEventStatus(gate, CL_COMPLETE) == CL_SUCCESS);
  cl::wait(event);
  clReleaseEvent(gate);
}

TEST_CASE("a forest's counting tracer refuses to only enqueue") {
  const Trees trees;
  const Batch batch = batch_of(gnomon::test::all_rays(trees.areas, 1, 125));
  ForestTraceOptions counting;
  counting.trace.counters = true;
  const ForestTracer tracer(context(), trees.rig.forest(), trees.rig.tops().front(), counting);
  REQUIRE_THROWS_WITH(tracer.enqueue_closest(batch.ray_buffer.mem.get(), batch.hits.mem.get(), batch.count()),
                      Catch::Contains("counting"));
}
