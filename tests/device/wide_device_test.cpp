// The wide form on the device: the collapse against the reference's bytes, its traversal against the binary
// tree's bits, the reference's visits and the oracle.
#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/base/error.h"
#include "support/flavours.h"

using gnomon::TraceFlavour;
using gnomon::test::aimed_rays;
using gnomon::test::awkward_rays;
using gnomon::test::context;
using gnomon::test::ray;
using gnomon::test::Rays;
using gnomon::test::require_equal_flavours;
using gnomon::test::require_faultless;
using gnomon::test::Triangles;

TEST_CASE("the device's collapse has the reference's bytes, whatever the shape and the tasks",
          "[portable][unlimited]") {
  for (const auto& shape : gnomon::test::wide_shapes()) {
    const auto tree = gnomon::build_device(context(), shape.triangles, shape.options);
    const auto expected = gnomon::collapse_reference(download_bvh(context(), tree), shape.triangles);
    for (const std::uint32_t task : {0U, 1U, 5U, 64U, 1U << 20U}) {
      CAPTURE(shape.name, task);
      gnomon::CollapseOptions options;
      options.triangles_per_task = task;
      const auto wide = download_wide(context(), collapse_device(context(), tree, options));
      REQUIRE(tree_hash(wide) == tree_hash(expected));
      REQUIRE(wide.depth == expected.depth);
      REQUIRE(wide.nodes.size() == expected.nodes.size());
    }
  }
}

TEST_CASE("a small collapse in many tasks keeps to its buffers", "[portable][memcheck]") {
  const auto triangles = gnomon::test::soup(120, 91);
  const auto tree = gnomon::build_device(context(), triangles, gnomon::test::leaves_of(2));
  gnomon::CollapseOptions options;
  options.triangles_per_task = 10;
  options.cost_node = 0.5F;
  const auto wide = download_wide(context(), collapse_device(context(), tree, options));
  REQUIRE(tree_hash(wide) ==
          tree_hash(gnomon::collapse_reference(download_bvh(context(), tree), triangles, options)));
}

TEST_CASE("the flavours give equal bits on a small soup", "[portable][memcheck]") {
  const auto triangles = gnomon::test::soup(120, 92, 1.0F);
  require_equal_flavours(triangles, gnomon::test::random_rays(40, 93), gnomon::test::lazy_leaves_of(20));
  require_faultless(triangles, gnomon::test::random_rays(40, 93), false);
}

TEST_CASE("the flavours give equal bits, and the reference's visits, on soups", "[unlimited]") {
  for (const float size : {0.05F, 0.5F, 4.0F}) {
    for (const std::uint32_t leaf : {1U, 8U, 40U}) {
      CAPTURE(size, leaf);
      const auto triangles = gnomon::test::soup(2000, 94, size);
      require_equal_flavours(triangles, gnomon::test::random_rays(1500, 95),
                             gnomon::test::lazy_leaves_of(leaf));
      require_equal_flavours(triangles, awkward_rays(1500, 96), gnomon::test::leaves_of(leaf));
    }
  }
}

TEST_CASE("the flavours agree, and with the oracle, on rays aimed at corners and edges far from the origin",
          "[unlimited]") {
  for (const float offset : {0.0F, 1.0e3F, 1.0e5F}) {
    CAPTURE(offset);
    const auto triangles = gnomon::test::soup(300, 97, 0.5F, offset);
    const Rays rays = aimed_rays(triangles, 600, 98, offset);
    require_equal_flavours(triangles, rays);
    require_faultless(triangles, rays, true);
  }
}

TEST_CASE("the flavours agree on every shape", "[unlimited]") {
  for (const auto& shape : gnomon::test::wide_shapes()) {
    CAPTURE(shape.name);
    Rays rays = awkward_rays(100, 99);
    if (!shape.triangles.empty()) {
      const Rays aimed = aimed_rays(shape.triangles, 100, 100);
      rays.insert(rays.end(), aimed.begin(), aimed.end());
    }
    require_equal_flavours(shape.triangles, rays, shape.options);
  }
}

TEST_CASE("the flavours agree on rays through lattice points and in the plane of a grid",
          "[portable][unlimited]") {
  const auto triangles = gnomon::test::grid(8, 2.0F);
  Rays rays;
  for (int i = 0; i <= 16; ++i) {
    for (int j = 0; j <= 16; ++j) {
      const float x = 0.5F * static_cast<float>(i);
      const float z = 0.5F * static_cast<float>(j);
      for (const float zero : {0.0F, -0.0F}) rays.push_back(ray({x, 7, z}, {zero, -1, zero}));
      rays.push_back(ray({x, 2, z}, {0.3F, 1, 0.1F}));         // starts on the surface
      rays.push_back(ray({x, 2, z}, {0.3F, 1, 0.1F}, 1e-6F));  // just behind it
      rays.push_back(ray({x, 2, -1}, {0.1F, 0, 1}));           // in the plane
      rays.push_back(ray({x, 7, z}, {0, -1, 0}, 5.0F, 5.0F));  // both ends of the range inclusive
      rays.push_back(ray({x, 7, z}, {0, 1, 0}, -5.0F, -5.0F));
      rays.push_back(ray({x, 7, z}, {0, 1, 0}, -6.0F, std::nextafter(-5.0F, -6.0F)));
    }
  }
  const auto hits = require_equal_flavours(triangles, rays);
  for (std::size_t i = 0; i < rays.size(); i += 8) {
    CAPTURE(i);
    REQUIRE(hits[i].t == 5.0F);
    REQUIRE(hits[i + 2].t == 0.0F);
    REQUIRE(hits[i + 3].primitive == GN_NONE);
    REQUIRE(hits[i + 4].primitive == GN_NONE);
    REQUIRE(hits[i + 5].t == 5.0F);
    REQUIRE(hits[i + 6].t == -5.0F);
    REQUIRE(hits[i + 7].primitive == GN_NONE);
  }
}

TEST_CASE("of equally near triangles in one block, and of nearly as near ones, flavours report the same",
          "[unlimited]") {
  Triangles triangles;
  for (int i = 0; i < 300; ++i) {
    float z = 20.0F;
    for (int step = 0; step < (i * 7) % 5; ++step) z = std::nextafter(z, i % 2 == 0 ? 0.0F : 40.0F);
    triangles.push_back(gnomon::test::triangle({-5, -5, z}, {25, -5, z}, {5, 30, z}));
  }
  Rays rays;
  gnomon::test::Random random(101);
  for (int i = 0; i < 200; ++i)
    rays.push_back(ray({random.between(0, 10), random.between(0, 10), i % 2 == 0 ? 30.0F : -30.0F},
                       {random.between(-0.1F, 0.1F), 0, i % 2 == 0 ? -1.0F : 1.0F}));
  for (const std::uint32_t leaf : {1U, 8U, 255U})
    require_equal_flavours(triangles, rays, gnomon::test::lazy_leaves_of(leaf));
}

TEST_CASE("faces in one plane are told apart whatever is met before, between and after them", "[unlimited]") {
  Triangles triangles;
  gnomon::test::Random random(103);
  for (int i = 0; i < 240; ++i) {
    // Two to four faces in each of some planes, a few units in the last place off at times, numbers at
    // random.
    float z = static_cast<float>(random.below(80));
    if (random.below(4) == 0) z = std::nextafter(z, 100.0F);
    const float x = random.between(-9, 3);
    triangles.push_back(gnomon::test::triangle({x, -5, z}, {x + 20, -5, z}, {x + 8, 20, z}));
  }
  Rays rays;
  for (int i = 0; i < 400; ++i) {
    const bool up = i % 2 == 0;
    const float slant = i % 4 < 2 ? 0.0F : random.between(-0.05F, 0.05F);
    rays.push_back(ray({random.between(-2, 10), random.between(-2, 8), up ? -3.0F : random.between(0, 90)},
                       {slant, 0, up ? 1.0F : -1.0F}));
  }
  for (const std::uint32_t leaf : {1U, 3U, 8U, 255U})
    require_equal_flavours(triangles, rays, gnomon::test::lazy_leaves_of(leaf));
}

// Where the nearer of two is told without working both out: but for the middle between two floats, and but
// for faces that only begin in the plane.
TEST_CASE("faces in one plane seen edge-on, and faces next to it, are told apart", "[unlimited]") {
  gnomon::test::Random random(108);
  for (const bool tilted : {false, true}) {
    CAPTURE(tilted);
    Triangles triangles;
    for (int i = 0; i < 60; ++i) {
      const float y = tilted ? static_cast<float>(random.below(3)) / 3.0F : 0.3F;
      const float z = random.between(-0.02F, 0.02F);
      const float end = tilted && i % 2 == 0 ? y + 3e-6F * static_cast<float>(1 + i % 8) : y;
      const float width = tilted ? 40.0F : std::exp2(random.between(-10, 3));
      const float length = random.between(500, 900);
      // The corner out of the plane is each of three in turn.
      const std::array<std::array<float, 3>, 3> corners{
          {{-400, y, z - width}, {-400, y, z + width}, {length, end, z}}};
      const auto first = static_cast<std::size_t>(i / 2 % 3);
      triangles.push_back(
          gnomon::test::triangle(corners[first], corners[(first + 1) % 3], corners[(first + 2) % 3]));
    }
    Rays rays;
    for (int i = 0; i < 3000; ++i) {
      if (tilted) {
        rays.push_back(ray({random.between(-3, 3), 1.5F, random.between(-0.01F, 0.01F)},
                           {random.between(5, 90), -1.0F, random.between(-0.001F, 0.001F)}));
        continue;
      }
      const float above = 0.3F * std::exp2(random.between(-12, 0));
      rays.push_back(ray({random.between(-3, 3), 0.3F + above, random.between(-0.01F, 0.01F)},
                         {random.between(0.5F, 20), -above, random.between(-0.01F, 0.01F)}));
    }
    for (const std::uint32_t leaf : {1U, 8U})
      require_equal_flavours(triangles, rays, gnomon::test::lazy_leaves_of(leaf));
  }
}

TEST_CASE("of two faces one may leave the other's plane by any corner", "[unlimited]") {
  gnomon::test::Random random(110);
  Rays rays;
  for (int i = 0; i < 400; ++i)
    rays.push_back(ray({random.between(-3, 3), 1.5F, random.between(-0.01F, 0.01F)},
                       {random.between(5, 90), -1.0F, random.between(-0.001F, 0.001F)}));
  const auto face = [](std::size_t first, float end) {
    const std::array<std::array<float, 3>, 3> corners{{{-400, 0.5F, -40}, {-400, 0.5F, 40}, {700, end, 0}}};
    return gnomon::test::triangle(corners[first], corners[(first + 1) % 3], corners[(first + 2) % 3]);
  };
  for (std::size_t corner = 0; corner < 3; ++corner) {
    for (const float rise : {-3e-6F, -3e-7F, 3e-7F, 3e-6F}) {
      for (const bool flat_first : {false, true}) {
        CAPTURE(corner, rise, flat_first);
        Triangles pair{face(0, 0.5F), face(corner, 0.5F + rise)};
        if (!flat_first) std::swap(pair[0], pair[1]);
        require_equal_flavours(pair, rays);
      }
    }
  }
}

TEST_CASE("the flavours agree on ranges that end or begin next to a hit", "[unlimited]") {
  const auto triangles = gnomon::test::soup(1000, 106, 1.0F);
  const Rays rays = gnomon::test::random_rays(300, 107);
  const auto hits = require_equal_flavours(triangles, rays);
  Rays beside;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].primitive == GN_NONE) continue;
    GnRay r = rays[i];
    r.tmax = std::nextafter(hits[i].t, 0.0F);
    beside.push_back(r);
    r.tmin = r.tmax = hits[i].t;
    beside.push_back(r);
    r.tmin = std::nextafter(hits[i].t, INFINITY);
    r.tmax = INFINITY;
    beside.push_back(r);
  }
  REQUIRE(beside.size() > 100);
  require_equal_flavours(triangles, beside);
}

// Sheared coordinates whose products straddle the largest float: an edge function may then be NaN.
TEST_CASE("the flavours agree on rays whose edge functions overflow", "[unlimited]") {
  gnomon::test::Random random(102);
  Triangles triangles;
  for (int i = 0; i < 200; ++i) {
    GnTriangle t{};
    for (float* v : {t.v0, t.v1, t.v2})
      for (std::size_t k = 0; k < 3; ++k) v[k] = random.between(-2.8e14F, 2.8e14F);
    triangles.push_back(t);
  }
  Rays rays;
  for (int i = 0; i < 2000; ++i) {
    const float x = 1.8446743e19F * random.between(0.9999F, 1.0001F);
    const float y = 1.8446743e19F * random.between(0.9999F, 1.0001F);
    rays.push_back(ray({i % 2 == 0 ? x : -x, y, random.between(-1e15F, 1e15F)},
                       {random.between(-1e-3F, 1e-3F), random.between(-1e-3F, 1e-3F), 1}, -INFINITY));
    // Towards the scene from as far.
    rays.push_back(ray({x, y, 0}, {-x, -y, random.between(-1e15F, 1e15F)}));
  }
  require_equal_flavours(triangles, rays);
}

// Results that lie among the smallest floats, where rounding is no longer relative.
TEST_CASE("the flavours agree on triangles and distances among the smallest floats", "[unlimited]") {
  gnomon::test::Random random(103);
  for (const float size : {1e-15F, 1e-3F}) {
    for (const float depth : {1e-44F, 1e-40F, 1e-37F}) {
      CAPTURE(size, depth);
      Triangles triangles;
      for (int i = 0; i < 40; ++i) {
        const auto at = [&] {
          return std::array<float, 3>{random.between(-size, size), random.between(-size, size),
                                      depth * random.between(0.0F, 4.0F)};
        };
        triangles.push_back(gnomon::test::triangle(at(), at(), at()));
      }
      Rays rays;
      for (int i = 0; i < 200; ++i) {
        const float stretch = i % 2 == 0 ? 1.0F : 1e30F;
        rays.push_back(ray({random.between(-size, size), random.between(-size, size), 0}, {0, 0, stretch}));
      }
      require_equal_flavours(triangles, rays);
    }
  }
}

TEST_CASE("the flavours agree on directions as short and as long as rays may have, and on others",
          "[unlimited]") {
  const auto triangles = gnomon::test::soup(500, 104, 1.0F);
  Rays rays = gnomon::test::random_rays(600, 105);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const float stretches[] = {1e-29F, 1e30F, 1e-36F, 3e38F, 1e-40F};
    for (float& x : rays[i].direction) x *= stretches[i % 5];
    if (i % 4 == 0) rays[i].tmin = -INFINITY;
  }
  require_equal_flavours(triangles, rays);
}

TEST_CASE("leaves too large for the wide form are traced by the thread flavour unless wide is demanded",
          "[unlimited]") {
  const auto triangles = gnomon::test::repeated(gnomon::test::triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 500);
  const auto tree = gnomon::build_device(context(), triangles, gnomon::test::leaves_too_large());
  const gnomon::Tracer tracer(context(), tree);
  REQUIRE(tracer.flavour() == TraceFlavour::kThread);
  REQUIRE(tracer.closest(Rays{ray({0.2F, 0.2F, 1}, {0, 0, -1})}).hits[0].primitive == 0);
  gnomon::TraceOptions options;
  options.flavour = TraceFlavour::kWide;
  REQUIRE_THROWS_WITH(gnomon::Tracer(context(), tree, options), Catch::Contains("leaf of 500 triangles"));
}

TEST_CASE("a wide tree is not traced by the thread flavour, nor in passes", "[portable]") {
  const auto tree = gnomon::build_device(context(), gnomon::test::soup(20, 1));
  const auto wide = collapse_device(context(), tree);
  gnomon::TraceOptions options;
  options.step_limit = 10;
  REQUIRE_THROWS_AS(gnomon::Tracer(context(), wide, options), gnomon::Error);
  options.step_limit = 0;
  options.flavour = TraceFlavour::kThread;
  REQUIRE_THROWS_AS(gnomon::Tracer(context(), wide, options), gnomon::Error);
  options.flavour = TraceFlavour::kAuto;
  REQUIRE(gnomon::Tracer(context(), wide, options).flavour() == TraceFlavour::kPacket);
}

TEST_CASE("a device that ends loops is not asked for large wide trees", "[portable]") {
  const auto tree = gnomon::build_device(context(), gnomon::test::soup(600, 1));
  const bool ends_loops = context().device().loop_limit != 0;
  const gnomon::Tracer tracer(context(), tree);
  REQUIRE((tracer.flavour() == TraceFlavour::kThread) == (ends_loops || !context().device().is_cpu));
  if (ends_loops) {
    REQUIRE_THROWS_WITH(collapse_device(context(), tree), Catch::Contains("ends loops"));
  } else {
    REQUIRE(collapse_device(context(), tree).triangle_count == 600);
  }
}
