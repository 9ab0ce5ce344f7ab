// Rays that run together are found among others, and nothing is where nothing is.
#include "gnomon/areas/detect.h"

#include <limits>

#include "area_test_tools.h"
#include "gnomon/areas/detect_lights.h"
#include "gnomon/base/error.h"
#include "gnomon/scene/generators.h"
#include "gnomon/scene/ray_set.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/trace_reference.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

GnRay ray_of(const Vec3d& origin, const Vec3d& direction, double tmax) {
  GnRay ray{};
  for (std::size_t k = 0; k < 3; ++k) {
    ray.origin[k] = static_cast<float>(origin[k]);
    ray.direction[k] = static_cast<float>(direction[k]);
  }
  ray.tmax = static_cast<float>(tmax);
  return ray;
}

using Rays = std::vector<GnRay>;

void add_noise(Rays& rays, Source& source, int count) {
  for (int i = 0; i < count; ++i) {
    const Vec3d origin = source.point(-10.0, 10.0);
    rays.push_back(ray_of(origin, source.direction(), source.between(0.1, 20.0)));
  }
}

// Parallel to `axis` within `radians`, from a square of half side 2 about `middle`, 6 long.
void add_bundle(Rays& rays, Source& source, int count, const Vec3d& middle, const Vec3d& axis,
                double radians) {
  const AreaFrame frame = look_along(middle, axis, kWorldUp);
  for (int i = 0; i < count; ++i) {
    const Vec3d origin =
        to_world(frame, {source.between(-2.0, 2.0), source.between(-2.0, 2.0), source.between(-0.5, 0.5)});
    Vec3d off = source.direction();
    off = off - dot(off, frame.forward) * frame.forward;
    rays.push_back(ray_of(origin, unit_of(frame.forward + radians * source.between(0.0, 1.0) * off), 6.0));
  }
}

// To `apex` from a ball of radius 3 about `middle`; lines miss it by up to `blur`.
void add_pencil(Rays& rays, Source& source, int count, const Vec3d& middle, const Vec3d& apex, double blur,
                bool diverging = false) {
  for (int i = 0; i < count; ++i) {
    const Vec3d from = middle + source.between(0.0, 3.0) * source.direction();
    const Vec3d to = apex + source.between(0.0, blur) * source.direction();
    const double distance = length(to - from);
    if (diverging) {
      // From somewhere on the way, not from the apex itself: mirrors and lenses send such rays.
      const Vec3d start = to + 0.4 * (from - to);
      rays.push_back(ray_of(start, 1.0 / distance * (from - to), 0.6 * distance));
    } else {
      rays.push_back(ray_of(from, 1.0 / distance * (to - from), 0.9999 * distance));
    }
  }
}

double degrees_between(const Vec3d& a, const Vec3d& b) {
  return 2.0 * std::asin(0.5 * length(unit_of(a) - unit_of(b))) / kDegree;
}

const RayGroup& only(const Detection& found, GroupKind kind) {
  REQUIRE(found.groups.size() == 1);
  REQUIRE(found.groups[0].kind == kind);
  return found.groups[0];
}

}  // namespace

TEST_CASE("isotropic rays and diffuse bounces show no group") {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    for (const int count : {16, 100, 2000, 8000}) {
      Source source(seed);
      Rays rays;
      add_noise(rays, source, count);
      CAPTURE(seed, count);
      DetectOptions options;
      options.seed = seed;
      REQUIRE(detect(rays, options).groups.empty());
      // Cosine-weighted about the normals of a floor and a wall.
      Rays bounces;
      for (int i = 0; i < count; ++i) {
        const std::size_t axis = i % 3 == 0 ? 0 : 1;
        Vec3d origin = source.point(-10.0, 10.0);
        origin[axis] = 0.0;
        Vec3d direction = source.direction();
        direction[axis] += 1.0001;
        bounces.push_back(ray_of(origin, unit_of(direction), kInfinity));
      }
      REQUIRE(detect(bounces, options).groups.empty());
    }
  }
}

TEST_CASE("a bundle is found in noise, its box about its rays") {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    for (const double radians : {0.0, 0.002, 0.03}) {
      for (const double share : {0.05, 0.5}) {
        Source source(seed);
        Rays rays;
        const Vec3d axis = source.direction();
        const Vec3d middle = source.point(-3.0, 3.0);
        const int count = static_cast<int>(share * 6000.0);
        add_bundle(rays, source, count, middle, axis, radians);
        add_noise(rays, source, 6000 - count);
        const Detection found = detect(rays, {});
        CAPTURE(seed, radians, share, found.groups.size());
        const RayGroup& group = only(found, GroupKind::kBundle);
        REQUIRE(degrees_between(group.direction, axis) < 0.01 + 10.0 * radians);
        REQUIRE(group.coverage > 0.95 * share);
        REQUIRE(group.coverage < share + 0.01);
        REQUIRE(group.inside > 0.9);
        REQUIRE(group.spread < radians + 1e-3);
        REQUIRE(group.log10_chance <= -6.0);
        REQUIRE(group.area.kind() == AreaKind::kPlane);
        const auto& box = std::get<OrientedBox>(group.area.region());
        // Four by four by seven, and what the angle adds; not the whole of the noise's 20 units.
        if (share == 0.5) {
          REQUIRE(box.half[0] * box.half[1] > 3.6);
          REQUIRE(box.half[0] * box.half[1] < 4.4 + 50.0 * radians);
          REQUIRE(box.half[2] == Approx(3.5).epsilon(0.06));
          REQUIRE(length(box.centre - (middle + 3.0 * axis)) < 0.3);
        }
      }
    }
  }
}

TEST_CASE("pencils are found in noise, towards their apex and away from it") {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    for (const bool diverging : {false, true}) {
      for (const double blur : {0.0, 0.3}) {
        Source source(seed);
        Rays rays;
        const Vec3d apex = source.point(-5.0, 5.0);
        const Vec3d middle = apex + 9.0 * source.direction();
        add_pencil(rays, source, 1200, middle, apex, blur, diverging);
        add_noise(rays, source, 4800);
        const Detection found = detect(rays, {});
        CAPTURE(seed, diverging, blur, found.groups.size());
        const RayGroup& group = only(found, diverging ? GroupKind::kDiverging : GroupKind::kConverging);
        REQUIRE(length(group.apex - apex) < 0.01 + 0.6 * blur);
        REQUIRE(group.coverage > 0.18);
        REQUIRE(group.coverage < 0.22);
        // Lines that miss the apex end beside it, where the frustum is narrower than they miss it by.
        if (blur == 0.0) REQUIRE(group.inside > 0.85);
        REQUIRE(group.miss < 0.1 + blur);
        REQUIRE(group.area.kind() == AreaKind::kPoint);
        REQUIRE(degrees_between(group.direction, middle - apex) < 3.0);
        // Seen from the apex the ball of radius 3 at a distance of 9 is 39 degrees wide.
        const auto& frustum = std::get<Frustum>(group.area.region());
        REQUIRE(std::atan(frustum.tan_x) / kDegree == Approx(18.0).margin(3.0));
        REQUIRE(frustum.far_distance == Approx(11.6).margin(0.8));
      }
    }
  }
}

TEST_CASE("several groups are told apart") {
  Source source(5);
  Rays rays;
  add_bundle(rays, source, 2000, {0, 0, 0}, {0.3, -1.0, 0.2}, 0.0);
  add_bundle(rays, source, 1500, {4, 0, 0}, {-0.3, -1.0, 0.2}, 0.003);
  add_pencil(rays, source, 1000, {0, 0, 0}, {2, 8, 1}, 0.0);
  add_pencil(rays, source, 700, {3, 0, 0}, {-6, 5, 1}, 0.0);
  add_pencil(rays, source, 400, {3, 3, 3}, {-40, 50, 60}, 0.0);  // far: nearly a bundle
  add_noise(rays, source, 2400);
  const Detection found = detect(rays, {});
  REQUIRE(found.groups.size() == 5);
  const std::size_t counts[] = {2000, 1500, 1000, 700, 400};
  for (std::size_t i = 0; i < 5; ++i) {
    CAPTURE(i, found.groups[i].count);
    REQUIRE(found.groups[i].count == Approx(static_cast<double>(counts[i])).epsilon(0.05));
    REQUIRE(found.groups[i].kind == (i < 2 ? GroupKind::kBundle : GroupKind::kConverging));
  }
  REQUIRE(length(found.groups[2].apex - Vec3d{2, 8, 1}) < 0.05);
  REQUIRE(length(found.groups[3].apex - Vec3d{-6, 5, 1}) < 0.05);
  REQUIRE(length(found.groups[4].apex - Vec3d{-40, 50, 60}) < 1.0);
}

TEST_CASE("rays to and from a place far away are a pencil where their lines say so") {
  for (const bool diverging : {false, true}) {
    Source source(6);
    Rays rays;
    const Vec3d apex{0, 0, 600};
    // No two lines meet at a degree or more.
    for (int i = 0; i < 3000; ++i) {
      const Vec3d from{source.between(-2.0, 2.0), source.between(-2.0, 2.0), source.between(-1.0, 1.0)};
      const Vec3d way = unit_of(apex - from);
      rays.push_back(ray_of(from, diverging ? -1.0 * way : way, 5.0));
    }
    add_noise(rays, source, 3000);
    const Detection found = detect(rays, {});
    CAPTURE(diverging, found.groups.size());
    const RayGroup& group = only(found, diverging ? GroupKind::kDiverging : GroupKind::kConverging);
    REQUIRE(length(group.apex - apex) < 20.0);
    REQUIRE(group.coverage == Approx(0.5).margin(0.01));
  }
}

// Surely not isotropic, but nowhere much denser than beside it.
TEST_CASE("a broad lobe is no group") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Source source(seed);
    Rays rays;
    while (rays.size() < 8000) {
      const Vec3d way = source.direction();
      if (way[1] > 0.0 && source.between(0.0, 1.0) < std::pow(way[1], 12.0))
        rays.push_back(ray_of(source.point(-10.0, 10.0), way, kInfinity));
    }
    CAPTURE(seed);
    REQUIRE(detect(rays, {}).groups.empty());
  }
}

TEST_CASE("a lamp's reflection in a mirror is found where the mirror shows it") {
  // The mirror is the plane x = 4. Rays leave a floor for it, so as to reach the lamp.
  Source source(9);
  const Vec3d lamp{-1.0, 5.0, 0.5};
  const Vec3d image{9.0, 5.0, 0.5};
  Rays rays;
  for (int i = 0; i < 1000; ++i) {
    const Vec3d from{source.between(-4.0, 3.0), 0.0, source.between(-4.0, 4.0)};
    const Vec3d way = unit_of(image - from);
    const double to_mirror = (4.0 - from[0]) / way[0];
    rays.push_back(ray_of(from, way, to_mirror));
  }
  // And from the mirror on: towards the lamp itself.
  for (int i = 0; i < 1000; ++i) {
    const Vec3d from{source.between(-4.0, 3.0), 0.0, source.between(-4.0, 4.0)};
    const Vec3d way = unit_of(image - from);
    const Vec3d at = from + (4.0 - from[0]) / way[0] * way;
    rays.push_back(ray_of(at, {-way[0], way[1], way[2]}, 0.9999 * length(lamp - at)));
  }
  add_noise(rays, source, 3000);
  const Detection found = detect(rays, {});
  REQUIRE(found.groups.size() == 2);
  const bool image_first = found.groups[0].apex[0] > 0.0;
  REQUIRE(length(found.groups[image_first ? 0 : 1].apex - image) < 0.02);
  REQUIRE(length(found.groups[image_first ? 1 : 0].apex - lamp) < 0.02);
  for (const RayGroup& group : found.groups) REQUIRE(group.kind == GroupKind::kConverging);
}

TEST_CASE("the order of rays is of no account, and one seed gives one answer") {
  Source source(3);
  Rays rays;
  add_bundle(rays, source, 3000, {0, 0, 0}, {0.3, -1.0, 0.2}, 0.002);
  add_pencil(rays, source, 3000, {0, 0, 0}, {2, 8, 1}, 0.1);
  add_noise(rays, source, 14000);  // more than are looked at
  const Detection first = detect(rays, {});
  std::reverse(rays.begin(), rays.end());
  std::swap(rays[5], rays[9000]);
  const Detection second = detect(rays, {});
  REQUIRE(first.looked_at == 8192);
  REQUIRE(first.groups.size() == 2);
  REQUIRE(second.groups.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    REQUIRE(first.groups[i].count == second.groups[i].count);
    REQUIRE(first.groups[i].direction == second.groups[i].direction);
    REQUIRE(first.groups[i].apex == second.groups[i].apex);
    REQUIRE(first.groups[i].area.half_window() == second.groups[i].area.half_window());
    REQUIRE(first.groups[i].area.frame().origin == second.groups[i].area.frame().origin);
  }
}

TEST_CASE("few, equal and endless rays are answered, broken ones refused") {
  REQUIRE(detect(Rays{}, {}).groups.empty());
  const GnRay one = ray_of({1, 2, 3}, {0, -1, 0}, kInfinity);
  REQUIRE(detect(Rays{one}, {}).groups.empty());
  const Detection equal = detect(Rays(1000, one), {});
  REQUIRE(only(equal, GroupKind::kBundle).coverage == 1.0);
  // Most of the sample stands for most of the rays, however often they repeat.
  Rays repeated(20000, one);
  Source source(4);
  add_noise(repeated, source, 20000);
  REQUIRE(only(detect(repeated, {}), GroupKind::kBundle).coverage == Approx(0.5).margin(0.03));
  // A camera's: all from one point.
  Rays camera;
  for (int i = 0; i < 1000; ++i)
    camera.push_back(
        ray_of({1, 2, 3}, unit_of({source.between(-0.5, 0.5), source.between(-0.5, 0.5), 1.0}), kInfinity));
  DetectOptions bounded;
  bounded.bounds = Box3d{{-10, -10, -10}, {10, 10, 10}};
  const RayGroup group = only(detect(camera, bounded), GroupKind::kDiverging);
  REQUIRE(length(group.apex - Vec3d{1, 2, 3}) < 1e-4);
  REQUIRE(group.area.kind() == AreaKind::kPoint);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (int field = 0; field < 5; ++field) {
    Rays broken(100, one);
    if (field == 0) broken[7].origin[1] = nan;
    if (field == 1) broken[7].direction[2] = nan;
    if (field == 2) broken[7].direction[1] = 0.0F;
    if (field == 3) broken[7].tmax = nan;
    if (field == 4) broken[7].origin[0] = kInfinity;
    CAPTURE(field);
    REQUIRE_THROWS_WITH(detect(broken, {}), Catch::Contains("ray 7 of 100"));
  }
  DetectOptions options;
  options.least_share = 2.0;
  REQUIRE_THROWS_AS(detect(Rays{}, options), Error);
}

TEST_CASE("shadow rays of generated scenes lead to their lights, and shrink the lights' areas") {
  for (const char* name : {"atrium", "city"}) {
    const Scene scene = generate_scene(name, 20000, 1);
    const Bvh bvh = build_reference(scene.triangles);
    const std::vector<Ray> primary = primary_rays(scene, 12000, 7);
    const std::vector<Hit> hits = trace_reference(bvh, scene.triangles, primary, false).hits;
    const std::vector<Ray> shadow = shadow_rays(scene, primary, hits, 12000, 7);
    const auto lights = detect_lights(scene, shadow);
    const Detection found = detect(shadow, {});
    CAPTURE(name, shadow.size(), found.groups.size());
    std::size_t asked = 0;
    for (const LightRegion& light : lights) {
      asked += light.count;
      const Light& own = scene.lights[light.light];
      CAPTURE(light.light, light.count, light.inside);
      if (light.count < 200 || own.kind == LightKind::kArea) continue;
      REQUIRE(light.shrunk);
      REQUIRE(light.inside > 0.9);
      const Vec3d place{own.position[0], own.position[1], own.position[2]};
      const Vec3d way{own.direction[0], own.direction[1], own.direction[2]};
      bool known = false;
      for (const RayGroup& group : found.groups) {
        known |= own.kind == LightKind::kDirectional
                     ? group.kind == GroupKind::kBundle && degrees_between(group.direction, -way) < 0.1
                     : group.kind == GroupKind::kConverging && length(group.apex - place) < 0.05;
      }
      REQUIRE(known);
    }
    REQUIRE(20 * asked > 19 * shadow.size());
  }
}
