// Rays that are hard, on shapes that are not.
#include <algorithm>
#include <cmath>

#include "gnomon/scene/generators.h"
#include "gnomon/scene/ray_set.h"
#include "gnomon/stability/aim.h"
#include "gnomon/stability/cases.h"

namespace gnomon::stability {

namespace {

constexpr std::uint32_t kCells = 12;  // of a hill's side: 288 triangles

float lattice(SteadyRandom& random, std::uint32_t below) {
  return static_cast<float>(random.below(below));
}

// Above a hill over [0, 2 kCells]^2, on the lattice, outside its surface.
Point above(SteadyRandom& random) {
  const float x = lattice(random, 2 * kCells + 8) - 4.0F;
  const float z = lattice(random, 2 * kCells + 8) - 4.0F;
  return {x, 40.0F + lattice(random, 30), z};
}

Point inner_lattice_point(SteadyRandom& random) {
  const float x = 2.0F + 2.0F * lattice(random, kCells - 1);
  return {x, 0.0F, 2.0F + 2.0F * lattice(random, kCells - 1)};
}

// Steep rays from above at places of kind 0, 1 or 2 of place_on, all inside the border.
std::vector<Ray> rays_at(const Triangles& mesh, std::uint32_t kind, std::uint32_t count, std::uint64_t seed) {
  SteadyRandom random(seed);
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const Point target = place_on(mesh[random.below(static_cast<unsigned>(mesh.size()))], kind, random);
    Ray ray = towards(above(random), target);
    const float stretch = 1.0F + lattice(random, 3);  // t = 1, 1/2 or 1/3
    for (float& d : ray.direction) d *= stretch;
    rays.push_back(ray);
  }
  return rays;
}

Specimen aimed(const Bench& bench, std::uint32_t kind) {
  const Triangles mesh = hill(kCells, 3, bench.seed);
  return {mesh, rays_at(mesh, kind, bench.rays, bench.seed + 1), Expect::kAllHit};
}

std::vector<Specimen> at_vertices(const Bench& bench) {
  return {aimed(bench, 0)};
}

std::vector<Specimen> at_edges(const Bench& bench) {
  return {aimed(bench, 1)};
}

std::vector<Specimen> at_t_junctions(const Bench& bench) {
  const Triangles mesh = t_junctions(4);
  SteadyRandom random(bench.seed);
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < bench.rays; ++i) {
    const Point target{4.0F * (1.0F + lattice(random, 3)), 0.0F, 2.0F + 4.0F * lattice(random, 4)};
    rays.push_back(towards({lattice(random, 17), 8.0F + lattice(random, 9), lattice(random, 17)}, target));
  }
  return {{mesh, rays, Expect::kAllHit}};
}

// The two triangles of an edge are not met by a ray along it; what lies before and behind is.
std::vector<Specimen> along_edges(const Bench& bench) {
  const Triangles mesh = hill(kCells, 3, bench.seed);
  SteadyRandom random(bench.seed);
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < bench.rays; ++i) {
    const Triangle& t = mesh[random.below(static_cast<unsigned>(mesh.size()))];
    const Point a = corner(t, i % 3);
    const Point b = corner(t, (i + 1) % 3);
    Ray ray = towards(a, b);
    const float back = 2.0F * lattice(random, 4);
    for (std::size_t k = 0; k < 3; ++k) ray.origin[k] -= back * ray.direction[k];
    rays.push_back(ray);
  }
  return {{mesh, rays, Expect::kOracle}};
}

std::vector<Specimen> in_planes(const Bench& bench) {
  const Triangles flat = hill(kCells, 0, bench.seed);
  SteadyRandom random(bench.seed);
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < bench.rays; ++i) {
    const Point from{lattice(random, 30) - 3.0F, 0.0F, lattice(random, 30) - 3.0F};
    const float zero = i % 2 == 0 ? 0.0F : -0.0F;
    rays.push_back(ray_of(from, {lattice(random, 7) - 3.0F, zero, lattice(random, 7) + 1.0F}));
  }
  Specimen tilted{flat, rays, Expect::kNoneHit};
  for (Triangle& t : tilted.triangles) {
    for (float* v : {t.v0, t.v1, t.v2}) v[1] = v[0] + 2.0F * v[2];
  }
  for (Ray& ray : tilted.rays) {
    ray.origin[1] = ray.origin[0] + 2.0F * ray.origin[2];
    ray.direction[1] = ray.direction[0] + 2.0F * ray.direction[2];
  }
  return {{flat, rays, Expect::kNoneHit}, tilted};
}

std::vector<Specimen> axis_parallel(const Bench& bench) {
  const Triangles mesh = hill(kCells, 3, bench.seed);
  SteadyRandom random(bench.seed);
  Specimen down{mesh, {}, Expect::kAllHit};
  Specimen sideways{mesh, {}, Expect::kOracle};
  for (std::uint32_t i = 0; i < bench.rays; ++i) {
    const float a = (i & 1U) == 0 ? 0.0F : -0.0F;
    const float b = (i & 2U) == 0 ? 0.0F : -0.0F;
    const float x = lattice(random, 2 * kCells + 1);  // corners, edges, diagonals and middles
    const float z = lattice(random, 2 * kCells + 1);
    down.rays.push_back(ray_of({x, 50, z}, {a, -1, b}));
    down.rays.push_back(ray_of({x, -50, z}, {a, 1, b}));
    sideways.rays.push_back(ray_of({-5, lattice(random, 7), z}, {1, a, b}));
    sideways.rays.push_back(ray_of({x, lattice(random, 7), 60}, {a, b, -1}));
  }
  return {down, sideways};
}

// Oblique rays in planes x = 2i and z = 2j, where every box of the tree has faces.
std::vector<Specimen> in_box_faces(const Bench& bench) {
  SteadyRandom random(bench.seed);
  Specimen over{hill(kCells, 3, bench.seed), {}, Expect::kAllHit};
  Specimen shell{cube_shell(8), {}, Expect::kOracle};
  for (std::uint32_t i = 0; i < bench.rays; ++i) {
    const float zero = (i & 1U) == 0 ? 0.0F : -0.0F;
    const Point target = inner_lattice_point(random);
    const float slope = lattice(random, 3) - 1.0F;
    // Down to y = 0 within a step of the target, so it meets the hill inside its border.
    if ((i & 2U) == 0) {
      over.rays.push_back(ray_of({target[0], 64, target[2] - 64 * slope / 64}, {zero, -64, slope}));
    } else {
      over.rays.push_back(ray_of({target[0] - 64 * slope / 64, 64, target[2]}, {slope, -64, zero}));
    }
    Point from{2.0F * lattice(random, 9), lattice(random, 17), -3};
    Point along{zero, lattice(random, 5) - 2.0F, 1};
    std::rotate(from.begin(), from.begin() + i % 3, from.end());
    std::rotate(along.begin(), along.begin() + i % 3, along.end());
    shell.rays.push_back(ray_of(from, along));
  }
  return {over, shell};
}

// Nearly along a flat field, over its corners and just below them.
std::vector<Specimen> grazing(const Bench& bench) {
  Triangles mesh = hill(kCells, 0, bench.seed);
  append(mesh, hill(kCells, 1, bench.seed));
  SteadyRandom random(bench.seed);
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < bench.rays; ++i) {
    const Point target = inner_lattice_point(random);
    const float slope = std::ldexp(1.0F, -static_cast<int>(random.below(40)));
    const float height = 2.0F * lattice(random, 2) + (i % 2 == 0 ? slope : 0.0F);
    Ray ray = ray_of({target[0] - 32, height, target[2] - 32}, {32, -slope, 32});
    if (i % 3 == 0) ray.direction[0] = 31.5F;
    rays.push_back(ray);
  }
  return {{mesh, rays, Expect::kOracle}};
}

// Where the surface is, and a last bit above or below.
std::vector<Specimen> starting_on(const Bench& bench, bool off) {
  const Triangles mesh = hill(kCells, 3, bench.seed);
  SteadyRandom random(bench.seed);
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < bench.rays; ++i) {
    const Triangle& t = mesh[random.below(static_cast<unsigned>(mesh.size()))];
    Point from = place_on(t, i % 3, random);
    if (off) from[1] = std::nextafter(from[1], i % 2 == 0 ? kInfinity : -kInfinity);
    Point along{lattice(random, 9) - 4.0F, lattice(random, 9) - 4.0F, lattice(random, 9) - 4.0F};
    if (along == Point{0, 0, 0}) along[1] = 1.0F;
    rays.push_back(ray_of(from, along));
  }
  return {{mesh, rays, Expect::kOracle}};
}

std::vector<Specimen> starting_inside(const Bench& bench) {
  SteadyRandom random(bench.seed);
  Specimen shell{cube_shell(8), {}, Expect::kAllHit};
  for (std::uint32_t i = 0; i < bench.rays; ++i) {
    const Point from{1.0F + lattice(random, 15), 1.0F + lattice(random, 15), 1.0F + lattice(random, 15)};
    const Triangle& t = shell.triangles[random.below(static_cast<unsigned>(shell.triangles.size()))];
    shell.rays.push_back(towards(from, place_on(t, i % 3, random)));
  }
  return {shell};
}

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
  const float ends[] = {-kInfinity, -3.4e38F, -1.0F, -1e-40F, -0.0F, 0.0F, 1e-45F, 1e-38F, 1.0F, 3.4e38F, kInfinity};
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
  for (const Point& along : {Point{0, 0, 0}, Point{-0.0F, 0, -0.0F}, Point{1e-45F, 0, 0}, Point{0, 2.9e-39F, 1e-40F},
                             Point{0, 0, 0x1.fffffep-101F}, Point{0x1.000002p100F, 0, 1}, Point{1, -3.4e38F, 1}})
    bad.rays.push_back(ray_of(good_from, along));
  bad.invalid = bad.rays.size();
  return {bad};
}

std::vector<Specimen> lengths(const Bench& bench) {
  const Triangles mesh = hill(kCells, 3, bench.seed);
  Specimen specimen{mesh, {}, Expect::kAllHit};
  for (int power = -100; power <= 90; power += 10) {  // 1e-30 to 1e30 with directions of up to 2^6
    for (Ray ray : rays_at(mesh, 0, std::max(4U, bench.rays / 16), bench.seed + static_cast<std::uint64_t>(power + 200))) {
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
    specimen.rays.push_back(ray_of({target[0], 9, target[2]}, {tiny, -std::ldexp(1.0F, static_cast<int>(random.below(60)) - 30), other}));
  }
  // Small plates a ray reaches sideways only through such a component: 100 / 2^-90 * 1e-39 is about 1e-10.
  Specimen aside{{}, {}, Expect::kAllHit};
  for (const float sense : {1.0F, -1.0F}) {
    for (std::uint32_t i = 0; i < 20; ++i) {
      const float z = static_cast<float>(i);
      const float far = sense * 1e-9F;
      aside.triangles.push_back(triangle_of({sense * 2e-11F, 0, z - 1}, {far, 0, z}, {sense * 2e-11F, 0, z + 1}));
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

void add_ray_cases(std::vector<Case>& cases) {
  const auto add = [&](std::uint32_t number, const char* name, const char* expectation,
                       std::function<std::vector<Specimen>(const Bench&)> specimens) {
    cases.push_back({{number, "rays", name, expectation}, std::move(specimens), {}});
  };
  add(1, "at shared corners", "all hit", at_vertices);
  add(2, "at middles of edges", "all hit", at_edges);
  add(3, "at T-junctions", "all hit", at_t_junctions);
  add(4, "along edges", "as the oracle", along_edges);
  add(5, "in the plane of triangles", "none hits", in_planes);
  add(6, "axis-parallel, zeros of both signs", "all from above and below hit", axis_parallel);
  add(7, "in faces of boxes", "all over the field hit", in_box_faces);
  add(8, "grazing", "as the oracle", grazing);
  add(9, "starting on surfaces", "as the oracle", [](const Bench& bench) { return starting_on(bench, false); });
  add(10, "starting a last bit off surfaces", "as the oracle",
      [](const Bench& bench) { return starting_on(bench, true); });
  add(11, "starting inside a closed surface", "all hit", starting_inside);
  add(12, "tmin = tmax", "all hit at t, none an ulp beside it", ranges_of_one_point);
  add(13, "infinite, denormal and empty ranges", "as the oracle", wide_and_tiny_ranges);
  add(14, "zero, NaN, infinite, too short and too long", "all are refused", invalid_rays);
  add(15, "directions of length 1e-30 to 1e30", "all hit", lengths);
  add(16, "denormal components of directions", "all hit", denormal_components);
  add(17, "at random through a soup", "as the oracle", at_random);
  add(18, "through the scenes given", "as the oracle", given_scenes);
}

}  // namespace gnomon::stability
