// The path tracer on the device: the reference's bits, however the work is cut and whatever traces the rays.
#include <catch2/catch.hpp>
#include <cstring>

#include "gnomon/render/path_reference.h"
#include "gnomon/render/picture_tracing.h"
#include "gnomon/tree/build_reference.h"
#include "render/path_checks.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

using Film = std::vector<std::array<float, 4>>;

// Everything a path can meet, in few triangles.
Scene furnished() {
  PathSceneBuilder b;
  const auto matt = b.material({0.8F, 0.6F, 0.4F});
  const auto metal = b.material({0.9F, 0.9F, 0.7F}, 0.2F, 1.0F);
  const auto glossy = b.material({0.1F, 0.5F, 0.3F}, 0.5F);
  const auto lost = b.material({0.0F, 0.0F, 0.0F}, 1.0F, 0.0F, {0.5F, 0.0F, 0.0F});  // shines, is no light
  std::uint32_t i = 0;
  for (const GnTriangle& t : soup(60, 5, 2.0F)) {
    b.triangle(std::array{matt, metal, glossy, lost}[i++ % 4], {t.v0[0], t.v0[1], t.v0[2]},
               {t.v1[0], t.v1[1], t.v1[2]}, {t.v2[0], t.v2[1], t.v2[2]});
  }
  b.quad(matt, {-5, -1, -5}, {-5, -1, 15}, {15, -1, 15}, {15, -1, -5});
  b.lamp({5.0F, 6.0F, 7.0F}, {2, 12, 2}, {6, 12, 2}, {6, 12, 6}, {2, 12, 6});
  b.light(point_light({1.0F, 9.0F, 12.0F}, {40.0F, 30.0F, 20.0F}));
  b.light(spot_light({9.0F, 11.0F, 9.0F}, {-0.6F, -0.8F, 0.0F}, {60.0F, 60.0F, 60.0F}, 0.2F, 0.6F));
  b.light(sun_light({0.48F, -0.8F, 0.36F}, {2.0F, 2.0F, 1.5F}));
  b.look({4.0F, 6.0F, 22.0F}, {5.0F, 4.0F, 5.0F}, 0.8F);
  return b.scene();
}

PathOptions odd_picture() {
  PathOptions options;
  options.width = 21;
  options.height = 13;
  options.seed = 77;
  return options;
}

void require_same(const Film& a, const Film& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CAPTURE(i, a[i][0], b[i][0], a[i][1], b[i][1], a[i][2], b[i][2], a[i][3], b[i][3]);
    REQUIRE(std::memcmp(&a[i], &b[i], sizeof a[i]) == 0);
  }
}

Film film_of(const TracedScene& traced, const PathOptions& options, std::uint32_t samples) {
  PathTracer paths(context(), traced.tracer, traced.scene, options);
  paths.add_samples(samples);
  return paths.film();
}

// Devices without double round t otherwise now and then, after which a path is another.
void require_alike(const Film& a, const Film& b) {
  if (context().device().fp64) return require_same(a, b);
  std::size_t apart = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < 4; ++k)
      if (std::abs(a[i][k] - b[i][k]) > 1e-3F * (1.0F + std::abs(b[i][k]))) apart += 1;
  }
  CAPTURE(apart);
  REQUIRE(apart < a.size() / 10);
}

}  // namespace

TEST_CASE("paths on the device bring what the reference's do, to the last bit", "[portable]") {
  const Scene scene = furnished();
  const Bvh tree = build_reference(scene.triangles);
  const TracedScene traced(scene);
  for (const PathStrategy strategy : {PathStrategy::kBoth, PathStrategy::kLights, PathStrategy::kSurfaces}) {
    CAPTURE(static_cast<int>(strategy));
    PathOptions options = odd_picture();
    options.strategy = strategy;
    const Film expected = path_reference(scene, tree, options, 3);
    float sum = 0.0F;
    for (const auto& pixel : expected) sum += pixel[0];
    REQUIRE(sum > 10.0F);
    require_alike(film_of(traced, options, 3), expected);
  }
}

TEST_CASE("more lights than are held at once change nothing in that", "[portable]") {
  Scene scene = furnished();
  for (int i = 0; i < 37; ++i) {
    const float x = static_cast<float>(i);
    scene.lights.push_back(point_light({x - 15.0F, 3.0F + static_cast<float>(i % 5), 9.0F}, {3.0F, 2.0F, x}));
  }
  PathOptions options = odd_picture();
  options.width = 12;
  const TracedScene traced(scene);
  require_alike(film_of(traced, options, 1),
                path_reference(scene, build_reference(scene.triangles), options, 1));
}

// oclgrind watches the path kernels alone: the tree comes from the host.
TEST_CASE("a few paths on a tree from the host bring what the reference's do", "[portable][memcheck]") {
  const Scene scene = furnished();
  const Bvh tree = build_reference(scene.triangles);
  const DeviceBvh on_device = upload_bvh(context(), tree, scene.triangles);
  TraceOptions thread;
  thread.flavour = TraceFlavour::kThread;
  const Tracer tracer(context(), on_device, thread);
  PathOptions options = odd_picture();
  options.width = 9;
  options.height = 3;
  PathTracer paths(context(), tracer, scene, options);
  paths.add_samples(1);
  require_alike(paths.film(), path_reference(scene, tree, options, 1));
}

TEST_CASE("a picture depends neither on batches, work-groups and calls nor on the flavour of traversal") {
  const Scene scene = furnished();
  const TracedScene traced(scene);
  const Film expected = film_of(traced, odd_picture(), 5);
  for (const std::uint32_t at_once : {1U, 64U, 100U, 1000U, 4096U}) {
    CAPTURE(at_once);
    PathOptions options = odd_picture();
    options.paths_at_once = at_once;
    require_same(film_of(traced, options, at_once == 1 ? 1 : 5),
                 at_once == 1 ? film_of(traced, odd_picture(), 1) : expected);
  }
  for (const std::uint32_t group : {1U, 4U, 128U}) {
    CAPTURE(group);
    PathOptions options = odd_picture();
    options.work_group_size = group;
    require_same(film_of(traced, options, 5), expected);
  }
  PathTracer in_parts(context(), traced.tracer, scene, odd_picture());
  for (const std::uint32_t samples : {1U, 0U, 3U, 1U}) in_parts.add_samples(samples);
  REQUIRE(in_parts.samples() == 5);
  require_same(in_parts.film(), expected);
  for (const TraceFlavour flavour :
       {TraceFlavour::kThread, TraceFlavour::kWide, TraceFlavour::kCompact, TraceFlavour::kPacket}) {
    for (const bool sorted : {false, true}) {
      CAPTURE(to_string(flavour), sorted);
      TraceOptions options;
      options.flavour = flavour;
      options.sort_rays = sorted;
      if (sorted || flavour == TraceFlavour::kPacket) options.lights = ray_lights_of(scene);
      require_same(film_of(TracedScene(scene, options), odd_picture(), 5), expected);
    }
  }
  PathOptions other = odd_picture();
  other.seed = 78;
  REQUIRE(film_of(traced, other, 5) != expected);
}

TEST_CASE("rays are sorted by points, spots and suns, and by the sun of a scene without lights") {
  Scene scene = furnished();
  std::size_t wanted = 0;
  for (const Light& light : scene.lights) wanted += light.kind == LightKind::kArea ? 0 : 1;
  REQUIRE(wanted < scene.lights.size());
  const std::vector<RayLight> lights = ray_lights_of(scene);
  REQUIRE(lights.size() == wanted);
  std::size_t next = 0;
  for (const Light& light : scene.lights) {
    if (light.kind == LightKind::kArea) continue;
    CAPTURE(light.name);
    REQUIRE(lights[next].is_sun == (light.kind == LightKind::kDirectional));
    REQUIRE(lights[next].place == (lights[next].is_sun ? light.direction : light.position));
    ++next;
  }
  const cl::DeviceInfo& device = context().device();
  REQUIRE(picture_tracing(device, scene, false).lights.empty());
  REQUIRE(picture_tracing(device, scene, true).lights.size() ==
          (device.is_cpu && device.loop_limit == 0 ? wanted : 0));
  scene.lights = std::vector<Light>(100);
  REQUIRE(ray_lights_of(scene).size() == 31);
  scene.lights.clear();
  REQUIRE(ray_lights_of(scene).size() == 1);
  REQUIRE(ray_lights_of(scene).front().is_sun);
}

TEST_CASE("observers see every ray once, with the path it belongs to and the light it asks", "[portable]") {
  const TracedScene traced(furnished());
  PathTracer paths(context(), traced.tracer, traced.scene, odd_picture());
  std::uint64_t camera = 0;
  std::uint64_t bounce = 0;
  std::uint64_t shadow = 0;
  std::vector<int> per_pixel(std::size_t{21} * 13);
  std::vector<std::uint64_t> per_light(paths.light_names().size());
  paths.add_samples(2, {}, [&](const TracedRays& traced_rays) {
    REQUIRE(traced_rays.paths.size() == traced_rays.rays.size());
    const bool asks = traced_rays.use == RayUse::kShadow;
    REQUIRE(traced_rays.lights.size() == (asks ? traced_rays.rays.size() : 0));
    (asks ? shadow : traced_rays.use == RayUse::kCamera ? camera : bounce) += traced_rays.rays.size();
    for (const std::uint32_t light : traced_rays.lights) per_light.at(light) += 1;
    for (std::size_t i = 0; i < traced_rays.rays.size(); ++i) {
      REQUIRE(traced_rays.rays[i].tmin <= traced_rays.rays[i].tmax);
      REQUIRE(traced_rays.paths[i].sample < 2);
      if (traced_rays.use == RayUse::kCamera) per_pixel.at(paths.pixel_of(traced_rays.paths[i].cell)) += 1;
    }
  });
  REQUIRE(camera == paths.counts().camera_rays);
  REQUIRE(bounce == paths.counts().bounce_rays);
  REQUIRE(shadow == paths.counts().shadow_rays);
  REQUIRE(camera == 2 * per_pixel.size());
  REQUIRE(per_pixel == std::vector<int>(per_pixel.size(), 2));
  REQUIRE(paths.light_names().size() == 5);  // lamp, point, spot, sun, sky
  // The sky is left to scattered rays.
  for (std::size_t light = 0; light < 5; ++light) REQUIRE((per_light[light] > 0) == (light < 4));
  REQUIRE(traced.tracer.invalid_rays() == 0);
}

TEST_CASE("cancelling stops between bounces; odd options are refused") {
  const TracedScene traced(furnished());
  PathTracer paths(context(), traced.tracer, traced.scene, odd_picture());
  int calls = 0;
  REQUIRE_THROWS_AS(paths.add_samples(100, [&](std::string_view, double) { return ++calls < 3; }), Error);
  REQUIRE(calls == 3);
  PathOptions options;
  options.max_bounces = 0;
  REQUIRE_THROWS_AS(options.check(), Error);
  options.max_bounces = 1;
  options.width = 0;
  REQUIRE_THROWS_AS(options.check(), Error);
}

TEST_CASE("an empty scene is all sky, a picture of no samples black") {
  Scene empty;
  const TracedScene traced(empty);
  PathOptions options = small_picture(4, PathStrategy::kBoth);
  options.sky = Vec3{0.5F, 0.25F, 2.0F};
  PathTracer paths(context(), traced.tracer, traced.scene, options);
  REQUIRE(paths.picture().pixels.front() == Vec3{0.0F, 0.0F, 0.0F});
  paths.add_samples(4);
  for (const Vec3& pixel : paths.picture().pixels) REQUIRE(pixel == *options.sky);
  REQUIRE(paths.coverage() == std::vector<float>(16, 0.0F));
}
