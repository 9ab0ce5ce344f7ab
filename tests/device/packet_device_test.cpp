// Packets: rays that run together, in every way a packet may be made of and on triangles that test its error
// bounds, against the other flavours and the oracle. Also that packets are what is tested.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "support/flavours.h"

using gnomon::TraceFlavour;
using gnomon::test::context;
using gnomon::test::ray;
using gnomon::test::Rays;
using gnomon::test::require_equal_flavours;
using gnomon::test::require_faultless;
using gnomon::test::Triangles;
using Point = std::array<float, 3>;

namespace {

// In tiles of 8 x 8, so that 64 in a row see a small part.
template <typename Make>
Rays tiled(std::uint32_t tiles, const Make& make) {
  Rays rays;
  const float side = 8.0F * static_cast<float>(tiles);
  for (std::uint32_t i = 0; i < 64 * tiles * tiles; ++i) {
    const std::uint32_t tile = i / 64;
    const auto x = static_cast<float>(8 * (tile % tiles) + i % 8);
    const auto y = static_cast<float>(8 * (tile / tiles) + i / 8 % 8);
    rays.push_back(make((x + 0.5F) / side - 0.5F, (y + 0.5F) / side - 0.5F));
  }
  return rays;
}

Rays camera_rays(std::uint32_t tiles, const Point& eye, const Point& forward, float width) {
  return tiled(tiles, [&](float x, float y) {
    return ray(eye, {forward[0] + width * x, forward[1] + width * y, forward[2] - 0.3F * width * x});
  });
}

Rays sun_rays(std::uint32_t tiles, const Point& direction, float width) {
  return tiled(tiles, [&](float x, float y) {
    return ray({5 + width * x + 3 * y * y, 12 + x, 5 + width * y}, direction);
  });
}

// From a wavy floor to a point, with lengths that vary: the apex has to be found, and is off by rounding.
Rays shadow_rays(std::uint32_t tiles, const Point& light, float width) {
  return tiled(tiles, [&](float x, float y) {
    const Point from{5 + width * x, std::sin(9 * x * y), 5 + width * y};
    const Point way{light[0] - from[0], light[1] - from[1], light[2] - from[2]};
    const float length = std::sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
    return ray(from, {way[0] / length, way[1] / length, way[2] / length}, 0.0F, 0.999F * length);
  });
}

std::vector<std::pair<std::string, Rays>> bundles(std::uint32_t tiles) {
  return {{"camera", camera_rays(tiles, {5, 4, 30}, {-0.1F, 0.05F, -1}, 0.5F)},
          {"camera along x, inside", camera_rays(tiles, {5, 5, 5}, {1, 0.6F, 0.7F}, 0.4F)},
          {"camera, wide", camera_rays(tiles, {5, 5, 12}, {0.2F, -0.3F, -1}, 2.0F)},
          {"sun along y", sun_rays(tiles, {0, -1, 0}, 6.0F)},
          {"sun along -0", sun_rays(tiles, {-0.0F, -1, -0.0F}, 3.0F)},
          {"sun, oblique", sun_rays(tiles, {0.4F, -0.8F, 0.45F}, 6.0F)},
          {"sun, one component zero", sun_rays(tiles, {0.3F, -0.9F, 0}, 2.0F)},
          {"light", shadow_rays(tiles, {3.3F, 11.7F, 6.1F}, 4.0F)},
          {"light, near", shadow_rays(tiles, {5.1F, 1.5F, 5.2F}, 1.0F)}};
}

// The largest share of rays that have the counts of the fifteen beside them: those of a packet do.
double share_in_packets(const Triangles& triangles, const Rays& rays, bool any_hit) {
  gnomon::TraceOptions options;
  options.counters = true;
  options.flavour = TraceFlavour::kPacket;
  const auto tree = gnomon::build_device(context(), triangles);
  const gnomon::Tracer tracer(context(), tree, options);
  const auto counters = (any_hit ? tracer.any(rays) : tracer.closest(rays)).counters;
  std::size_t alike = 0;
  for (std::size_t i = 0; i + 16 <= counters.size(); i += 16) {
    // The first ray counts what all share.
    bool same = true;
    for (std::size_t k = 2; k < 16; ++k)
      same &= counters[i + k].boxes == counters[i + 1].boxes &&
              counters[i + k].triangles == counters[i + 1].triangles;
    alike += same ? 16 : 0;
  }
  return static_cast<double>(alike) / static_cast<double>(counters.size());
}

}  // namespace

TEST_CASE("packets give the other flavours' bits and the oracle's answers on bundles of every kind",
          "[unlimited]") {
  for (const auto& [name, rays] : bundles(6)) {
    for (const float size : {0.1F, 1.0F, 6.0F}) {
      CAPTURE(name, size);
      const auto triangles = gnomon::test::soup(1500, 201, size);
      require_equal_flavours(triangles, rays);
      require_faultless(triangles, rays, false);
    }
  }
}

TEST_CASE("packets give the other flavours' bits on a small soup", "[memcheck][unlimited]") {
  const auto triangles = gnomon::test::soup(60, 202, 1.5F);
  for (const auto& [name, rays] : bundles(1)) {
    CAPTURE(name);
    require_equal_flavours(triangles, Rays(rays.begin(), rays.begin() + 24));
  }
}

TEST_CASE("rays that run together are traced as packets", "[unlimited]") {
  if (!context().device().is_cpu) return;
  const auto triangles = gnomon::test::soup(2000, 203, 1.0F);
  for (const auto& [name, rays] : bundles(12)) {
    CAPTURE(name);
    REQUIRE(share_in_packets(triangles, rays, false) > 0.8);
    REQUIRE(share_in_packets(triangles, rays, true) > 0.8);
  }
  // And others are not.
  REQUIRE(share_in_packets(triangles, gnomon::test::random_rays(4096, 204), false) < 0.1);
}

TEST_CASE("a batch that packets do not divide, or with rays that do not belong, has the same answers",
          "[unlimited]") {
  const auto triangles = gnomon::test::soup(1000, 205, 1.0F);
  for (auto& [name, rays] : bundles(4)) {
    CAPTURE(name);
    rays.resize(rays.size() - 41);
    rays[70].direction[1] = NAN;
    rays[200].tmin = -3.0F;
    rays[300].tmax = 0.5F * rays[300].tmin - 1.0F;
    for (float& x : rays[400].direction) x = -x;
    rays[500].tmin = 2.0F;
    rays[501].tmax = 2.0F;
    std::rotate(rays.begin(), rays.begin() + 7, rays.end());
    require_equal_flavours(triangles, rays);
  }
}

// Camera rays through corners, edges' middles and points of triangles, in order of direction; far from the
// origin and at scales whose numbers are as small and as large as coordinates may be.
TEST_CASE("packets lose no ray aimed at corners and edges, at any scale and distance", "[unlimited]") {
  gnomon::test::Random random(206);
  for (const float scale : {1.0F, std::ldexp(1.0F, -40), std::ldexp(1.0F, 30)}) {
    for (const float offset : {0.0F, 1.0e3F, 1.0e5F}) {
      CAPTURE(scale, offset);
      Triangles triangles = gnomon::test::grid(12, 0.8F);
      for (GnTriangle& t : triangles)
        for (float* v : {t.v0, t.v1, t.v2})
          for (int k = 0; k < 3; ++k) v[k] = scale * (v[k] + offset);
      const Point eye{scale * (offset + 5.2F), scale * (offset + 9.1F), scale * (offset + 4.7F)};
      Rays rays;
      for (int i = 0; i < 1500; ++i) {
        const auto& t = triangles[random.below(static_cast<std::uint32_t>(triangles.size()))];
        const float* a = gnomon::test::corner(t, random.below(3));
        const float* b = gnomon::test::corner(t, random.below(3));
        const float target[3] = {0.5F * (a[0] + b[0]), 0.5F * (a[1] + b[1]), 0.5F * (a[2] + b[2])};
        rays.push_back(gnomon::test::aimed(eye, target));
      }
      const auto cell = [](const GnRay& r) {
        return std::pair(std::floor(8 * r.direction[0] / r.direction[1]), r.direction[2] / r.direction[1]);
      };
      std::sort(rays.begin(), rays.end(), [&](const GnRay& a, const GnRay& b) { return cell(a) < cell(b); });
      require_equal_flavours(triangles, rays);
      require_faultless(triangles, rays, true);
    }
  }
}

// Large triangles seen nearly edge-on, slivers, and stacks of sheets as near as floats can be told apart.
TEST_CASE("packets rank sheets that nearly touch and slivers as the other flavours do", "[unlimited]") {
  gnomon::test::Random random(207);
  Triangles triangles;
  for (int i = 0; i < 200; ++i) {
    float y = 2.0F;
    for (int step = 0; step < i % 7; ++step) y = std::nextafter(y, i % 2 == 0 ? 0.0F : 4.0F);
    const float turn = random.between(-0.001F, 0.001F);
    triangles.push_back(gnomon::test::triangle({-50, y, -50}, {60, y + turn, -40}, {5, y, 70}));
    triangles.push_back(gnomon::test::triangle({random.between(0, 10), random.between(0, 10), -50},
                                               {random.between(0, 10), random.between(0, 10), 60},
                                               {5, random.between(0, 10), random.between(-1e-3F, 1e-3F)}));
  }
  for (const auto& [name, rays] : bundles(4)) {
    CAPTURE(name);
    require_equal_flavours(triangles, rays);
  }
  require_equal_flavours(triangles, camera_rays(4, {5, 2.01F, 30}, {0.05F, -0.001F, -1}, 0.05F));
}

// Numbers so small or so large that products of them underflow or overflow.
TEST_CASE("packets agree where products underflow and overflow", "[unlimited]") {
  gnomon::test::Random random(208);
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
      triangles.push_back(gnomon::test::triangle(at(), at(), at()));
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
  const auto triangles = gnomon::test::soup(1000, 209, 1.0F);
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
