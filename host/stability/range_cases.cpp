// Rays that are hard for their range or their direction's length, and rays of every kind at random.
#include <algorithm>
#include <cmath>

#include "gnomon/scene/generators.h"
#include "gnomon/scene/ray_set.h"
#include "gnomon/stability/cases.h"
#include "gnomon/stability/lattice_rays.h"

namespace gnomon::stability {

namespace {

// Rays meet the flat field at t = 1, 1/2, 1/4 exactly.
std::vector<Specimen> ranges_of_one_point(const Bench& bench) {
  const Triangles flat = hill(kCells, 0, bench.seed);
  SteadyRandom random(bench.seed);
  Specimen at{flat, {}, Expect::kAllHit};
  Specimen beside{flat, {}, Expect::kNoneHit};
  for (std::uint32_t i = 0; i < bench.rays; ++i) {
    const Point target = inner_lattice_point(random);
    Ray ray = towards(above(random), target);
    const float stretch = std::ldexp(1.0F, static_cast<int>(random.below(3)));
    for (float& d : ray.direction) d *= stretch;
    ray.tmin = ray.tmax = 1.0F / stretch;
    at.rays.push_back(ray);
    ray.tmin = ray.tmax = std::nextafter(ray.tmin, i % 2 == 0 ? 0.0F : 2.0F);
    beside.rays.push_back(ray);
  }
  return {at, beside};
}

std::vector<Specimen> wide_and_tiny_ranges(const Bench& bench) {
  const Triangles mesh = soup(200, 1.0F, 0.0F, 10.0F, bench.seed);
  SteadyRandom random(bench.seed);
  const float ends[] = {-kInfinity, -3.4e38F, -1.0F, -1e-40F, -0.0F,    0.0F,
                        1e-45F,     1e-38F,   1.0F,  3.4e38F, kInfinity};
  constexpr std::uint32_t kEnds = static_cast<std::uint32_t>(std::size(ends));
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < 2 * bench.rays; ++i) {
    const Triangle& t = mesh[random.below(static_cast<unsigned>(mesh.size()))];
    Ray ray = through(place_on(t, i % 3, random), 12.0F, random);
    ray.tmin = ends[i % kEnds];
    ray.tmax = ends[(i / kEnds) % kEnds];
    rays.push_back(ray);
  }
  return {{mesh, rays, Expect::kOracle}};
}

std::vector<Specimen> invalid_rays(const Bench& bench) {
  const float nan = std::nanf("");
  Specimen bad{soup(100, 3.0F, 0.0F, 10.0F, bench.seed), {}, Expect::kNoneHit};
  const Point good_from{5, 5, -3};
  const Point good_along{0.1F, 0.2F, 1};
  for (const float wrong : {nan, kInfinity, -kInfinity}) {
    for (std::size_t k = 0; k < 3; ++k) {
      Point from = good_from;
      from[k] = wrong;
      bad.rays.push_back(ray_of(from, good_along));
      Point along = good_along;
      along[k] = wrong;
      bad.rays.push_back(ray_of(good_from, along));
    }
  }
  bad.rays.push_back(ray_of(good_from, good_along, nan));
  bad.rays.push_back(ray_of(good_from, good_along, 0, nan));
  for (const Point& along :
       {Point{0, 0, 0}, Point{-0.0F, 0, -0.0F}, Point{1e-45F, 0, 0}, Point{0, 2.9e-39F, 1e-40F},
        Point{0, 0, 0x1.fffffep-101F}, Point{0x1.000002p100F, 0, 1}, Point{1, -3.4e38F, 1}})
    bad.rays.push_back(ray_of(good_from, along));
  bad.invalid = bad.rays.size();
  return {bad};
}

std::vector<Specimen> lengths(const Bench& bench) {
  const Triangles mesh = hill(kCells, 3, bench.seed);
  Specimen specimen{mesh, {}, Expect::kAllHit};
  for (int power = -100; power <= 90; power += 10) {  // 1e-30 to 1e30 with directions of up to 2^6
    for (Ray ray : rays_at(mesh, 0, std::max(4U, bench.rays / 16),
                           bench.seed + static_cast<std::uint64_t>(power + 200))) {
      for (float& d : ray.direction) d = std::ldexp(d, power);
      specimen.rays.push_back(ray);
    }
  }
  return {specimen};
}

// A component so small that its reciprocal overflows, or that devices flush.
std::vector<Specimen> denormal_components(const Bench& bench) {
  Specimen specimen{hill(kCells, 0, bench.seed), {}, Expect::kAllHit};
  SteadyRandom random(bench.seed);
  for (std::uint32_t i = 0; i < bench.rays; ++i) {
    const Point target = inner_lattice_point(random);
    const float tiny = std::ldexp(i % 2 == 0 ? 1.0F : -1.0F, -127 - static_cast<int>(random.below(22)));
    const float other = i % 3 == 0 ? 0.0F : tiny;
    specimen.rays.push_back(
        ray_of({target[0], 9, target[2]},
               {tiny, -std::ldexp(1.0F, static_cast<int>(random.below(60)) - 30), other}));
  }
  // Small plates a ray reaches sideways only through such a component: 100 / 2^-90 * 1e-39 is about 1e-10.
  Specimen aside{{}, {}, Expect::kAllHit};
  for (const float sense : {1.0F, -1.0F}) {
    for (std::uint32_t i = 0; i < 20; ++i) {
      const float z = static_cast<float>(i);
      const float far = sense * 1e-9F;
      aside.triangles.push_back(
          triangle_of({sense * 2e-11F, 0, z - 1}, {far, 0, z}, {sense * 2e-11F, 0, z + 1}));
      aside.rays.push_back(ray_of({0, -100, z}, {sense * 1e-39F, 0x1p-90F, 0}));
    }
  }
  return {specimen, aside};
}

std::vector<Specimen> at_random(const Bench& bench) {
  SteadyRandom random(bench.seed);
  Specimen specimen{soup(800, 0.5F, 0.0F, 10.0F, bench.seed), {}, Expect::kOracle};
  for (std::uint32_t i = 0; i < 2 * bench.rays; ++i) {
    Point from{};
    Point along{};
    for (std::size_t k = 0; k < 3; ++k) {
      from[k] = static_cast<float>(random.between(-2, 12));
      along[k] = static_cast<float>(random.between(-1, 1));
    }
    specimen.rays.push_back(ray_of(from, along));
  }
  return {specimen};
}

std::vector<Specimen> given_scenes(const Bench& bench) {
  std::vector<Scene> scenes = bench.scenes;
  if (scenes.empty()) scenes.push_back(generate_scene("cottage", 7000, 1));
  std::vector<Specimen> specimens;
  for (const Scene& scene : scenes) {
    if (scene.triangles.empty()) continue;
    const float size = extent_of(scene.triangles).size();
    SteadyRandom random(bench.seed);
    std::vector<Ray> rays = random_rays(scene, bench.rays, bench.seed);
    const std::vector<Ray> primary = primary_rays(scene, bench.rays, bench.seed);
    rays.insert(rays.end(), primary.begin(), primary.end());
    for (std::uint32_t i = 0; i < 2 * bench.rays; ++i) {
      const Triangle& t = scene.triangles[random.below(static_cast<unsigned>(scene.triangles.size()))];
      rays.push_back(through(place_on(t, i % 2, random), 0.3F * size, random));
    }
    specimens.push_back({scene.triangles, rays, Expect::kOracle});
  }
  return specimens;
}

}  // namespace

void add_range_cases(std::vector<Case>& cases) {
  const auto add = [&](std::uint32_t number, const char* name, const char* expectation,
                       std::function<std::vector<Specimen>(const Bench&)> specimens) {
    cases.push_back({{number, "rays", name, expectation}, std::move(specimens), {}});
  };
  add(12, "tmin = tmax", "all hit at t, none an ulp beside it", ranges_of_one_point);
  add(13, "infinite, denormal and empty ranges", "as the oracle", wide_and_tiny_ranges);
  add(14, "zero, NaN, infinite, too short and too long", "all are refused", invalid_rays);
  add(15, "directions of length 1e-30 to 1e30", "all hit", lengths);
  add(16, "denormal components of directions", "all hit", denormal_components);
  add(17, "at random through a soup", "as the oracle", at_random);
  add(18, "through the scenes given", "as the oracle", given_scenes);
}

}  // namespace gnomon::stability
