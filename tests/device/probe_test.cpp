// What the host assumes of the device's compiler: struct layout, unfused arithmetic, the shared hit
// functions.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "gnomon/cl/launch.h"
#include "gnomon/cl/program.h"
#include "gnomon/shared/area_math.h"
#include "gnomon/shared/box_frame.h"
#include "gnomon/shared/compact_layout.h"
#include "gnomon/shared/cost_math.h"
#include "gnomon/shared/hit_math.h"
#include "gnomon/shared/wide_layout.h"
#include "support/device.h"
#include "support/shapes.h"

namespace cl = gnomon::cl;
using gnomon::test::context;
using gnomon::test::Random;

namespace {

template <typename... Arguments>
void run(const char* kernel_name, std::size_t items, const Arguments&... arguments) {
  const auto kernel = context().programs().kernel({"probe.cl"}, "", kernel_name);
  cl::set_arguments(kernel.get(), arguments...);
  cl::wait(cl::enqueue(context().queue(), kernel.get(), items, 0));
}

template <typename T>
cl::Buffer buffer_of(const char* name, const std::vector<T>& values) {
  cl::Buffer buffer = context().create_buffer(name, values.size() * sizeof(T));
  context().upload_values<T>(buffer, values);
  return buffer;
}

}  // namespace

TEST_CASE("the device lays out every shared struct as the host does", "[portable][memcheck]") {
  const cl::Buffer out = context().create_buffer("layout", 41 * sizeof(std::uint32_t));
  run("probe_layout", 1, out);
  const std::vector<std::uint32_t> expected = {sizeof(GnTriangle),
                                               sizeof(GnLeafTriangle),
                                               sizeof(GnPrimitive),
                                               sizeof(GnNode),
                                               sizeof(GnRay),
                                               sizeof(GnHit),
                                               sizeof(GnRayCounters),
                                               sizeof(GnBin),
                                               sizeof(GnSplit),
                                               sizeof(GnTask),
                                               sizeof(GnChunk),
                                               sizeof(GnChildren),
                                               offsetof(GnLeafTriangle, primitive),
                                               offsetof(GnNode, hi),
                                               offsetof(GnRay, direction),
                                               offsetof(GnTask, buffer),
                                               context().device().fp64 ? 1U : 0U,
                                               sizeof(GnWalk),
                                               sizeof(GnArea),
                                               sizeof(GnAreaBox),
                                               sizeof(GnAreaCell),
                                               sizeof(GnAreaCounters),
                                               sizeof(GnAreaWalk),
                                               offsetof(GnArea, kind),
                                               offsetof(GnArea, root),
                                               offsetof(GnAreaWalk, exit),
                                               sizeof(GnWideNode),
                                               sizeof(GnLeaf),
                                               sizeof(GnForest),
                                               sizeof(GnCollapseTask),
                                               offsetof(GnWideNode, links),
                                               offsetof(GnLeaf, count),
                                               offsetof(GnForest, triangles),
                                               offsetof(GnCollapseTask, largest_leaf),
                                               sizeof(GnCompactNode),
                                               sizeof(GnPackHead),
                                               offsetof(GnPackHead, least),
                                               sizeof(GnPlainTriangle),
                                               offsetof(GnCompactNode, planes),
                                               sizeof(GnBoxFrame),
                                               offsetof(GnBoxFrame, size)};
  REQUIRE(context().download_values<std::uint32_t>(out, 41) == expected);
}

TEST_CASE("arithmetic that decides trees has the same bits on the device", "[portable][memcheck]") {
  constexpr std::size_t kCount = 4096;
  Random random(41);
  std::vector<float> x, y, z;
  for (std::size_t i = 0; i < kCount; ++i) {
    x.push_back(random.between(-1e3F, 1e3F));
    y.push_back(random.between(-1.0F, 1.0F));
    z.push_back(-x.back() * y.back() *
                random.between(0.999F, 1.001F));  // cancellation shows fused operations
  }
  const cl::Buffer fused = context().create_buffer("fused", kCount * 4);
  const cl::Buffer reciprocal = context().create_buffer("reciprocal", kCount * 4);
  const cl::Buffer bin = context().create_buffer("bin", kCount * 4);
  run("probe_arithmetic", kCount, buffer_of("x", x), buffer_of("y", y), buffer_of("z", z), fused, reciprocal,
      bin);
  const auto got_fused = context().download_values<float>(fused, kCount);
  const auto got_reciprocal = context().download_values<float>(reciprocal, kCount);
  const auto got_bin = context().download_values<std::uint32_t>(bin, kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    CAPTURE(i, x[i], y[i], z[i]);
    REQUIRE(gn_bits_of(got_fused[i]) == gn_bits_of(x[i] * y[i] + z[i]));
    REQUIRE(gn_bits_of(got_reciprocal[i]) == gn_bits_of(gn_reciprocal(gn_abs(x[i]) + 1e-20F)));
    const float scale = gn_bin_scale(0.0F, gn_abs(y[i]) + gn_abs(z[i]) + 1e-20F, 16);
    REQUIRE(got_bin[i] == gn_bin_of(gn_abs(y[i]), 0.0F, scale, 16));
  }
}

namespace {

void require_host_hits(const std::uint32_t count) {
  Random random(42);
  std::vector<GnTriangle> triangles = gnomon::test::soup(count, 43, 1.0F, -5.0F);
  std::vector<GnRay> rays;
  for (std::uint32_t i = 0; i < count; ++i) {
    // Every third ray is aimed at a corner: the rare exact path must run too.
    rays.push_back(i % 3 == 0 ? gnomon::test::aimed({random.between(-9, 9), random.between(-9, 9), 9.0F},
                                                    gnomon::test::corner(triangles[i], i % 2))
                              : gnomon::test::random_ray(random, -1.0F, 1.0F));
  }
  const cl::Buffer hits = context().create_buffer("hits", count * sizeof(GnHit));
  const cl::Buffer entries = context().create_buffer("entries", count * sizeof(float));
  run("probe_hits", count, buffer_of("rays", rays), buffer_of("triangles", triangles), hits, entries);
  const auto got_hits = context().download_values<GnHit>(hits, count);
  const auto got_entries = context().download_values<float>(entries, count);
  std::uint32_t met = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    CAPTURE(i);
    const GnRayFrame frame = gn_ray_frame(&rays[i]);
    GnHit hit{};
    const GnTriangle& t = triangles[i];
    const bool expected = gn_triangle_hit(&frame, t.v0, t.v1, t.v2, &hit) != 0;
    const bool undecided =
        !context().device().fp64 && i % 3 == 0;  // pairs of floats may call a corner inside
    if (!undecided || expected) REQUIRE((got_hits[i].primitive != GN_NONE) == expected);
    if (!expected) continue;
    met += 1;
    REQUIRE(std::fabs(got_hits[i].t - hit.t) <= 1.2e-7F * std::fabs(hit.t));
    float lo[3], hi[3];
    for (std::size_t k = 0; k < 3; ++k) {
      lo[k] = std::min({t.v0[k], t.v1[k], t.v2[k]});
      hi[k] = std::max({t.v0[k], t.v1[k], t.v2[k]});
    }
    const float entry = gn_box_entry(&frame, lo, hi, 0.0F, gn_slab_limit(rays[i].tmax));
    // Division may differ by 2.5 ulp on a device; the verdict may not, inside the slack.
    if (hit.t >= 0.0F) REQUIRE(got_entries[i] < INFINITY);
    if (entry < INFINITY && got_entries[i] < INFINITY) REQUIRE(got_entries[i] == Approx(entry).epsilon(1e-6));
  }
  REQUIRE(met > count / 20);
}

}  // namespace

TEST_CASE("hits and box entries on the device are the host's", "[portable]") {
  require_host_hits(2000);
}

TEST_CASE("a few hits and box entries keep to their buffers", "[memcheck]") {
  require_host_hits(200);
}

TEST_CASE("loops make all their turns, or the device is known to end them", "[portable]") {
  constexpr std::uint32_t kAsked = 200'000;
  const cl::Buffer turns = context().create_buffer("turns", sizeof(std::uint32_t));
  const cl::Buffer value = context().create_buffer("value", sizeof(std::uint32_t));
  const auto kernel = context().programs().kernel({"loop_limit.cl"}, "", "count_turns");
  for (const std::uint32_t asked : {1000U, kAsked}) {
    cl::set_arguments(kernel.get(), turns, value, asked);
    cl::wait(cl::enqueue(context().queue(), kernel.get(), 1, 1));
    const std::uint32_t made = context().download_values<std::uint32_t>(turns, 1).front();
    const std::uint32_t limit = context().device().loop_limit;
    REQUIRE(made == (limit == 0 ? asked : std::min(asked, limit)));
  }
}

// Once per compiler: the default device and Mesa's.
TEST_CASE("every kernel file compiles by itself") {
  for (const auto& file : cl::embedded_kernels()) {
    if (!file.path.ends_with(".cl")) continue;
    CAPTURE(file.path);
    REQUIRE_NOTHROW(static_cast<void>(context().programs().get({std::string(file.path)}, "")));
  }
}
