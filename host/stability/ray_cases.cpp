// Rays that are hard for where they go, on shapes that are not.
#include <algorithm>
#include <cmath>

#include "gnomon/stability/cases.h"
#include "gnomon/stability/lattice_rays.h"

namespace gnomon::stability {

namespace {

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
  add(9, "starting on surfaces", "as the oracle",
      [](const Bench& bench) { return starting_on(bench, false); });
  add(10, "starting a last bit off surfaces", "as the oracle",
      [](const Bench& bench) { return starting_on(bench, true); });
  add(11, "starting inside a closed surface", "all hit", starting_inside);
}

}  // namespace gnomon::stability
