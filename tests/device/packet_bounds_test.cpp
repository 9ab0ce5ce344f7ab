// What packets know of their own errors: triangles and ranges on which floats are wrong unless the bounds of
// packet_leaf.h hold, against the other flavours and the oracle.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "support/bundles.h"

using namespace gnomon::test;

// Large triangles seen nearly edge-on, slivers, and stacks of sheets as near as floats can be told apart.
TEST_CASE("packets rank sheets that nearly touch and slivers as the other flavours do", "[unlimited]") {
  Random random(207);
  Triangles triangles;
  for (int i = 0; i < 200; ++i) {
    float y = 2.0F;
    for (int step = 0; step < i % 7; ++step) y = std::nextafter(y, i % 2 == 0 ? 0.0F : 4.0F);
    const float turn = random.between(-0.001F, 0.001F);
    triangles.push_back(triangle({-50, y, -50}, {60, y + turn, -40}, {5, y, 70}));
    triangles.push_back(triangle({random.between(0, 10), random.between(0, 10), -50},
                                 {random.between(0, 10), random.between(0, 10), 60},
                                 {5, random.between(0, 10), random.between(-1e-3F, 1e-3F)}));
  }
  for (const auto& [name, rays] : bundles(4)) {
    CAPTURE(name);
    require_equal_flavours(triangles, rays);
  }
  require_equal_flavours(triangles, camera_rays(4, {5, 2.01F, 30}, {0.05F, -0.001F, -1}, 0.05F));
}

TEST_CASE("packets report the first of faces in one plane", "[unlimited]") {
  gnomon::test::Random random(109);
  gnomon::test::Triangles triangles;
  for (int i = 0; i < 80; ++i) {
    const float y = static_cast<float>(random.below(3));
    const float x = random.between(-20, 10);
    const float end = i % 4 == 0 ? std::nextafter(y, 9.0F) : y;
    triangles.push_back(gnomon::test::triangle({x, y, -20}, {x + 20, y, -20}, {x + 8, end, 40}));
  }
  for (const std::uint32_t leaf : {1U, 8U}) {
    const auto options = gnomon::test::lazy_leaves_of(leaf);
    require_equal_flavours(triangles, gnomon::test::camera_rays(3, {5, 9, 5}, {0.1F, -1, 0.2F}, 0.5F),
                           options);
    require_equal_flavours(triangles, gnomon::test::sun_rays(3, {0.3F, -0.9F, 0.1F}, 4.0F), options);
  }
}

// Numbers so small or so large that products of them underflow or overflow.
TEST_CASE("packets agree where products underflow and overflow", "[unlimited]") {
  Random random(208);
  for (const auto& [size, depth, far] : {std::tuple(1e-15F, 1e-30F, 1.0F),
                                         {1e-20F, 1e-20F, 1e-18F},
                                         {2e14F, 2e14F, 1e17F},
                                         {2e14F, 1e-3F, 9e17F}}) {
    CAPTURE(size, depth, far);
    Triangles triangles;
    for (int i = 0; i < 120; ++i) {
      const auto at = [&] {
        return Point{random.between(-size, size), random.between(-size, size), depth * random.between(-1, 0)};
      };
      triangles.push_back(triangle(at(), at(), at()));
    }
    const float spread = size / far;
    require_equal_flavours(triangles, tiled(3, [&](float x, float y) {
                             return ray({0, 0, far}, {spread * x, spread * y, -1});
                           }));
    require_equal_flavours(triangles, tiled(3, [&](float x, float y) {
                             return ray({size * x, size * y, far}, {1e-39F, -1e-42F, -1});
                           }));
  }
}

TEST_CASE("packets agree on ranges that end or begin next to a hit", "[unlimited]") {
  const auto triangles = soup(1000, 209, 1.0F);
  for (auto& [name, rays] : bundles(3)) {
    CAPTURE(name);
    const auto hits = require_equal_flavours(triangles, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (hits[i].primitive == GN_NONE) continue;
      if (i % 3 == 0) rays[i].tmax = std::nextafter(hits[i].t, 0.0F);
      if (i % 3 == 1) rays[i].tmin = rays[i].tmax = hits[i].t;
      if (i % 3 == 2) rays[i].tmin = std::nextafter(hits[i].t, INFINITY);
    }
    require_equal_flavours(triangles, rays);
  }
}

// Sheets in one tilted plane but for last bits, seen so nearly edge-on that floats are further off than the
// slack of distances: they rank them wrongly unless they know how far off a plane may be.
TEST_CASE("packets know how far off the distance to a sheet seen edge-on may be", "[unlimited]") {
  Random random(210);
  // Two directions in the plane and one off it.
  const Point along{0.8F, -0.36F, 0.48F};
  const Point across{-0.6F, -0.48F, 0.64F};
  const Point off{0, -0.8F, -0.6F};
  const auto at = [&](float a, float b, float c) {
    Point p{5, 5, 5};
    for (int k = 0; k < 3; ++k) p[k] += a * along[k] + b * across[k] + c * off[k];
    return p;
  };
  Triangles triangles;
  for (int i = 0; i < 60; ++i) {
    GnTriangle t = triangle(at(random.between(-60, -40), random.between(-40, -20), 0),
                            at(random.between(40, 60), random.between(-40, -20), 0),
                            at(random.between(-10, 10), random.between(40, 60), 0));
    for (float* v : {t.v0, t.v1, t.v2})
      for (int k = 0; k < 3; ++k)
        if (random.below(2) == 0) v[k] = std::nextafter(v[k], random.below(2) == 0 ? -100.0F : 100.0F);
    triangles.push_back(t);
  }
  for (const float height : {0.3F, 0.03F, 0.003F}) {
    CAPTURE(height);
    const Point eye = at(-45, 0, height);
    require_equal_flavours(triangles, tiled(6, [&](float x, float y) {
                             const Point to = at(8 * x, 8 * y, 0);
                             return ray(eye, {to[0] - eye[0], to[1] - eye[1], to[2] - eye[2]});
                           }));
    const Point way{along[0] - 0.02F * height * off[0], along[1] - 0.02F * height * off[1],
                    along[2] - 0.02F * height * off[2]};
    require_equal_flavours(
        triangles, tiled(6, [&](float x, float y) { return ray(at(-45 + 2 * x, 8 * y, height), way); }));
  }
}

// Distances are counted from the apex, which the nearest ray passes: others add as much as they start before
// it.
TEST_CASE("packets keep to the ranges of parallel rays that start far apart", "[unlimited]") {
  Random random(211);
  Triangles triangles;
  for (int i = 0; i < 40; ++i) {
    const float z = random.between(-1, 1);
    triangles.push_back(triangle({-30, -30, z}, {40, -30, z}, {0, 60, z}));
  }
  Rays rays = tiled(4, [&](float x, float y) {
    const float back = random.between(2, 3.0e4F) * (x + 0.5F) + 3.0F;
    return ray({10 * x - 0.1F * back, 10 * y - 0.2F * back, 0.7F * back}, {0.1F, 0.2F, -0.7F});
  });
  const auto hits = require_equal_flavours(triangles, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    REQUIRE(hits[i].primitive != GN_NONE);
    if (i % 3 == 0) rays[i].tmax = std::nextafter(hits[i].t, 0.0F);
    if (i % 3 == 1) rays[i].tmin = rays[i].tmax = hits[i].t;
    if (i % 3 == 2) rays[i].tmin = std::nextafter(hits[i].t, INFINITY);
  }
  require_equal_flavours(triangles, rays);
}

// The light is where the rays end, as well as their roundings let it be: that may be more than a small
// triangle beside it allows.
TEST_CASE("packets know how vague a light is that rays reach from far away", "[unlimited]") {
  Random random(212);
  const Point light{5, 5, 5};
  const Triangles triangles = soup(300, 213, 0.2F, 0.0F);
  Triangles near;
  for (GnTriangle t : triangles) {
    for (float* v : {t.v0, t.v1, t.v2})
      for (int k = 0; k < 3; ++k) v[k] = light[k] + 0.05F * (v[k] - 5.0F) - (k == 2 ? 0.6F : 0.0F);
    near.push_back(t);
  }
  for (const float distance : {30.0F, 3.0e3F}) {
    CAPTURE(distance);
    Rays rays;
    for (int i = 0; i < 2048; ++i) {
      const auto& t = near[random.below(static_cast<std::uint32_t>(near.size()))];
      const float* a = corner(t, random.below(3));
      const float* b = corner(t, random.below(3));
      Point from{};
      Point way{};
      float length = 0.0F;
      for (int k = 0; k < 3; ++k) from[k] = light[k] + distance * (0.5F * (a[k] + b[k]) - light[k]);
      for (int k = 0; k < 3; ++k) length += (light[k] - from[k]) * (light[k] - from[k]);
      for (int k = 0; k < 3; ++k) way[k] = (light[k] - from[k]) / std::sqrt(length);
      rays.push_back(ray(from, way));
    }
    std::sort(rays.begin(), rays.end(), [](const GnRay& a, const GnRay& b) {
      return std::pair(std::floor(16 * a.direction[0] / a.direction[2]), a.direction[1] / a.direction[2]) <
             std::pair(std::floor(16 * b.direction[0] / b.direction[2]), b.direction[1] / b.direction[2]);
    });
    require_equal_flavours(near, rays);
    require_faultless(near, rays, true);
  }
}

TEST_CASE("rays that may hit behind their origin are not lost in packets", "[unlimited]") {
  const auto triangles = soup(1500, 214, 0.6F);
  for (auto& [name, rays] : bundles(4)) {
    CAPTURE(name);
    for (GnRay& r : rays) {
      r.tmin = -100.0F;
      r.tmax = -0.25F;
    }
    const auto hits = require_equal_flavours(triangles, rays);
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (hits[i].primitive != GN_NONE) rays[i].tmax = hits[i].t;
    require_equal_flavours(triangles, rays);
  }
  // Boxes without thickness, met at the range's end.
  const auto hits =
      require_equal_flavours(grid(8, 2.0F), tiled(2, [](float x, float y) {
                               return ray({4 + 0.9F * x, -3, 4 + 0.9F * y}, {0, -1, 0}, -9.0F, -5.0F);
                             }));
  REQUIRE(std::all_of(hits.begin(), hits.end(), [](const GnHit& hit) { return hit.t == -5.0F; }));
}
