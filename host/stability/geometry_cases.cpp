// Shapes that are hard, under rays at their corners, edges and faces.
#include <algorithm>
#include <cmath>

#include "gnomon/stability/aim.h"
#include "gnomon/stability/cases.h"

namespace gnomon::stability {

namespace {

// Rays through corners, edges and faces of triangles picked at random; `reach`: how far off they start at
// most.
std::vector<Ray> rays_through(const Triangles& mesh, float reach, std::uint32_t count, std::uint64_t seed) {
  SteadyRandom random(seed);
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Triangle& t = mesh[random.below(static_cast<unsigned>(mesh.size()))];
    rays.push_back(through(place_on(t, i % 3, random), reach, random));
    if (i % 4 == 0) rays.back().tmin = -kInfinity;
  }
  return rays;
}

Specimen specimen_of(const Bench& bench, const Triangles& mesh, Expect expect = Expect::kOracle) {
  return {mesh, rays_through(mesh, extent_of(mesh).size(), bench.rays, bench.seed + 1), expect};
}

// The same soup farther and farther from the origin: corners are rounded there, hits must follow them.
std::vector<Specimen> offsets(const Bench& bench) {
  std::vector<Specimen> out;
  for (const float offset : {0.0F, 1e3F, 1e5F, 1e6F}) {
    const Triangles mesh = soup(300, 0.05F, offset, 1.0F, bench.seed);
    out.push_back({mesh, rays_through(mesh, 0.5F, bench.rays, bench.seed + 1), Expect::kOracle});
  }
  return out;
}

// A small thing of many triangles in a large hall of few: 1 to 1e6.
std::vector<Specimen> mixed_scales(const Bench& bench) {
  Triangles mesh = soup(400, 2e-4F, 4.0F, 1e-3F, bench.seed);
  const Triangles hall = scaled(cube_shell(4), 7);  // to 1024
  append(mesh, hall);
  std::vector<Ray> rays = rays_through(mesh, 1e-3F, bench.rays, bench.seed);
  for (const Ray& ray : rays_through(mesh, 500.0F, bench.rays, bench.seed + 2)) rays.push_back(ray);
  SteadyRandom random(bench.seed);
  for (std::uint32_t i = 0; i < bench.rays; ++i) {  // from the hall's walls at the small thing
    const Point target = place_on(mesh[random.below(400)], i % 2, random);
    rays.push_back(
        towards(place_on(hall[random.below(static_cast<unsigned>(hall.size()))], 2, random), target));
  }
  return {{mesh, rays, Expect::kOracle}};
}

std::vector<Specimen> thin_triangles(const Bench& bench) {
  return {specimen_of(bench, slivers(300, 8.0F, 1e-3F, bench.seed)),
          specimen_of(bench, slivers(300, 8.0F, 1e-6F, bench.seed)),
          specimen_of(bench, slivers(300, 1e-3F, 1e-9F, bench.seed))};
}

std::vector<Specimen> needles(const Bench& bench) {
  return {specimen_of(bench, slivers(200, 1e4F, 1e-4F, bench.seed)),
          specimen_of(bench, slivers(200, 1e6F, 1e-7F, bench.seed))};
}

// Nothing meets a triangle without area; the others among them are met.
std::vector<Specimen> without_area(const Bench& bench) {
  const Triangles flat = flat_triangles(300, bench.seed);
  Triangles mixed = flat;
  append(mixed, soup(100, 1.0F, 0.0F, 16.0F, bench.seed));
  return {specimen_of(bench, flat, Expect::kNoneHit), specimen_of(bench, mixed)};
}

// Of triangles that coincide the first is reported.
std::vector<Specimen> coincident(const Bench& bench) {
  Triangles mesh = soup(60, 1.5F, 0.0F, 10.0F, bench.seed);
  const Triangles once = mesh;
  for (int copy = 0; copy < 6; ++copy) append(mesh, once);
  Specimen specimen = specimen_of(bench, mesh);
  specimen.in_order = true;
  return {specimen};
}

// Triangles that differ, in boxes that do not.
std::vector<Specimen> identical_boxes(const Bench& bench) {
  SteadyRandom random(bench.seed);
  Triangles mesh;
  for (int i = 0; i < 10000; ++i) {
    const float x = static_cast<float>(random.below(9));
    mesh.push_back(triangle_of({0, 0, 0}, {8, 8, x}, {x, 8.0F - x, 8}));
  }
  return {specimen_of(bench, mesh)};
}

std::vector<Specimen> one_plane(const Bench& bench) {
  Triangles flat = hill(16, 0, bench.seed);
  Specimen level = specimen_of(bench, flat);
  for (Triangle& t : flat) {
    for (float* v : {t.v0, t.v1, t.v2}) v[1] = 0.3F * v[0] + 0.7F * v[2];
  }
  Specimen tilted = specimen_of(bench, flat);
  for (Specimen* specimen : {&level, &tilted}) {
    SteadyRandom random(bench.seed);
    for (Ray& ray : specimen->rays) {
      if (ray.direction[1] == 0.0F) ray.direction[1] = 1.0F;
    }
  }
  return {level, tilted};
}

// Centres on one line, at ever larger steps; and all triangles cut by one line.
std::vector<Specimen> on_a_line(const Bench& bench) {
  Triangles row;
  for (int i = 0; i < 500; ++i) {
    const float x = static_cast<float>(i * i);
    row.push_back(triangle_of({x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}));
  }
  Triangles doubling;
  for (int i = -60; i < 40; ++i) {
    const float x = std::ldexp(1.0F, i);
    doubling.push_back(triangle_of({x, 0, 0}, {x * 1.5F, 0, 0}, {x, x, 0}));
  }
  Specimen far = specimen_of(bench, doubling);
  for (std::size_t i = 0; i < far.rays.size(); ++i) {  // each from a place as large as its triangle
    const float x = std::ldexp(1.0F, static_cast<int>(i % 100) - 60);
    far.rays[i] = ray_of({1.2F * x, 0.25F * x, x}, {0, 0, -1});
  }
  // Outwards through all boxes, near ones first, each level of the tree waiting: every ray's first hit is
  // another plate.
  SteadyRandom random(bench.seed);
  Specimen outwards;
  for (int i = -60; i < 40; ++i) {
    const float x = std::ldexp(1.0F, i);
    const float low = x * static_cast<float>(random.unit());
    outwards.triangles.push_back(
        triangle_of({x, low, -x}, {x, low + 0.02F * x, -x}, {x, low + 0.01F * x, 2.0F * x}));
  }
  for (std::uint32_t i = 0; i < bench.rays; ++i)
    outwards.rays.push_back(ray_of({0, 0, 0}, {1, static_cast<float>(random.unit()), 0}));
  return {specimen_of(bench, row), far, outwards};
}

// One triangle far off makes bins so wide that all others fall into one.
std::vector<Specimen> one_bin(const Bench& bench) {
  Triangles mesh = soup(500, 0.01F, 1.0F, 0.1F, bench.seed);
  mesh.push_back(triangle_of({1e6F, 1e6F, 1e6F}, {1.1e6F, 1e6F, 1e6F}, {1e6F, 1.1e6F, 1e6F}));
  Triangles same_middle;
  for (int i = 1; i <= 300; ++i) {
    const float r = static_cast<float>(i);
    same_middle.push_back(triangle_of({-r, -r, -r}, {r, r, r}, {r, -r, 0}));
  }
  return {{mesh, rays_through(mesh, 0.2F, bench.rays, bench.seed), Expect::kOracle},
          specimen_of(bench, same_middle)};
}

// Up to the coordinates that builders take, and down to where numbers end.
std::vector<Specimen> extremes(const Bench& bench) {
  std::vector<Specimen> out{specimen_of(bench, scaled(soup(200, 0.2F, -0.75F, 1.5F, bench.seed), 48)),
                            specimen_of(bench, scaled(soup(200, 0.2F, 0.0F, 1.0F, bench.seed), -60))};
  for (Ray& ray : out[1].rays) {
    for (float& d : ray.direction) d = std::ldexp(d, 60);
  }
  return out;
}

}  // namespace

void add_geometry_cases(std::vector<Case>& cases) {
  const auto add = [&](std::uint32_t number, const char* name, const char* expectation,
                       std::function<std::vector<Specimen>(const Bench&)> specimens) {
    cases.push_back({{number, "geometry", name, expectation}, std::move(specimens), {}});
  };
  cases.push_back({{21, "geometry", "scales 2^-40 to 2^40", "the same tree and hits, bit for bit, t scaled"},
                   {},
                   check_scales});
  add(22, "offsets of 0, 1e3, 1e5, 1e6 times the size", "as the oracle", offsets);
  add(23, "a small thing in a hall 1e6 as large", "as the oracle", mixed_scales);
  add(24, "slivers", "as the oracle", thin_triangles);
  add(25, "needles", "as the oracle", needles);
  add(26, "triangles without area", "none is hit", without_area);
  add(27, "coincident triangles", "the first of them is reported", coincident);
  add(28, "1e4 identical boxes", "as the oracle", identical_boxes);
  add(29, "everything in one plane", "as the oracle", one_plane);
  add(30, "everything on one line", "as the oracle", on_a_line);
  add(31, "centres within one bin", "as the oracle", one_bin);
  add(32, "coordinates of 2^48 and of 2^-60", "as the oracle", extremes);
  cases.push_back(
      {{33, "geometry", "numbers next to 2^31 and 2^32, simulated", "no sum wraps"}, {}, check_indices});
}

}  // namespace gnomon::stability
