// Which light a path asks, on the host, against what each brings by formulas written down here in double
// precision.
#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/render/path_scene.h"
#include "gnomon/scene/steady_random.h"
#include "gnomon/shared/path_math.h"
#include "render/path_rig.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

constexpr Vec3 kPosition{0.5F, 0.25F, -0.75F};
constexpr Vec3 kNormal{0.6F, 0.8F, 0.0F};

double dot(const float* a, const Vec3& b) {
  return double{a[0]} * double{b[0]} + double{a[1]} * double{b[1]} + double{a[2]} * double{b[2]};
}

// What a light would bring kPosition if nothing were in between.
double brought(const GnPathLight& light, gn_u32 strategy) {
  Vec3 way{};
  double square = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    way[k] = light.position[k] - kPosition[k];
    square += std::pow(double{light.position[k]} - double{kPosition[k]}, 2.0);
  }
  const double facing = dot(way.data(), kNormal);
  const double strength = light.strength;
  switch (light.kind) {
    case GN_LIGHT_SUN:
      return std::max(0.0, -dot(light.direction, kNormal)) * strength;
    case GN_LIGHT_SKY:
      return strategy == GN_STRATEGY_LIGHTS ? strength : 0.0;
    case GN_LIGHT_AREA:
      if (strategy == GN_STRATEGY_SURFACES || facing < -double{light.range}) return 0.0;
      return strength / std::max(square, std::pow(double{light.range}, 2.0));
    default: {
      const double distance = std::sqrt(square);
      const double along = -dot(light.direction, way) / distance;
      const double cone = std::clamp((along - double{light.cos_outer}) * double{light.cone_scale}, 0.0, 1.0);
      const double reach = light.range > 0.0F ? std::pow(distance / double{light.range}, 4.0) : 0.0;
      const double window = std::max(0.0, 1.0 - reach);
      return std::max(0.0, facing / distance) * strength * window * cone * cone / square;
    }
  }
}

// `count` lights of all kinds, and the sky behind them.
Scene lit_by(std::uint32_t count) {
  PathSceneBuilder b;
  const auto matt = b.material({0.5F, 0.5F, 0.5F});
  b.quad(matt, {-9, -9, -9}, {9, -9, -9}, {9, -9, 9}, {-9, -9, 9});
  SteadyRandom random(count);
  const auto any = [&](float from, float to) {
    return from + (to - from) * static_cast<float>(random.unit());
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3 at{any(-4, 4) + 1.0F, any(0, 4), any(-4, 4)};  // most of them in front
    const Vec3 color{any(1, 9), any(1, 9), any(1, 9)};
    if (i % 4 == 0) b.light(point_light(i == 0 ? Vec3{3, 3, 1} : at, color));
    if (i % 4 == 1) b.light(spot_light(at, {-0.6F, -0.8F, 0.0F}, color, 0.3F, 1.5F));
    if (i % 4 == 2) b.light(sun_light({0.48F, any(0, 1) < 0.5F ? -0.8F : 0.8F, 0.36F}, color));
    if (i % 4 == 3) {
      b.lamp(color, at, {at[0] + 1, at[1], at[2]}, {at[0] + 1, at[1], at[2] + 1}, {at[0], at[1], at[2] + 1});
    }
  }
  Scene scene = b.scene();
  for (std::size_t i = 0; i < scene.lights.size(); i += 8) scene.lights[i].range = 7.0F;
  return scene;
}

PathOptions with_sky(PathStrategy strategy) {
  PathOptions options;
  options.width = options.height = 1;
  options.strategy = strategy;
  options.sky = Vec3{0.2F, 0.2F, 0.2F};
  return options;
}

struct Asked {
  GnPath path{};
  GnLit lit{};
};

// With `choice` for which light.
Asked ask(const Scene& scene, const PathScene& paths, float choice) {
  const GnPathTables tables{&paths.frame,          scene.triangles.data(), scene.material_ids.data(),
                            paths.surfaces.data(), paths.lights.data(),    paths.light_rows.data(),
                            paths.emitters.data(), paths.links.data()};
  GnPlace place{};
  for (std::size_t k = 0; k < 3; ++k) {
    place.position[k] = kPosition[k];
    place.normal[k] = kNormal[k];
  }
  GnBasis basis{};
  gn_basis_about(place.normal, &basis);
  GnSurface matt{{0.5F, 0.5F, 0.5F}, 1.0F, {0, 0, 0}, 0.0F};
  const float view[3] = {0.0F, 0.0F, 1.0F};
  GnScatter scatter{};
  gn_scatter_of(&matt, view, &scatter);
  Asked out;
  GnRay ray{};
  const float middle[2] = {0.5F, 0.5F};
  gn_ask_light(&tables, &place, &basis, &scatter, choice, middle, &out.path, &ray, &out.lit);
  return out;
}

}  // namespace

// Fewer lights than lanes, as many, more, as many as are held at once, and more than that.
TEST_CASE("a light is asked as often as the root of what it brings says, whatever its kind") {
  for (const std::uint32_t count : {1U, 3U, 4U, 5U, 31U, 32U, 33U, 70U}) {
    const Scene scene = lit_by(count);
    for (const PathStrategy strategy :
         {PathStrategy::kBoth, PathStrategy::kLights, PathStrategy::kSurfaces}) {
      const PathScene paths = make_path_scene(scene, with_sky(strategy));
      REQUIRE(paths.lights.size() == count + 1);
      std::vector<double> shares;
      double sum = 0.0;
      for (const GnPathLight& light : paths.lights) {
        shares.push_back(std::sqrt(brought(light, paths.frame.strategy)));
        sum += shares.back();
      }
      REQUIRE(sum > 0.0);
      CAPTURE(count, static_cast<int>(strategy), sum);
      CHECK(ask(scene, paths, 0.5F).path.light_sum == Approx(sum).epsilon(1e-5));
      double before = 0.0;
      for (std::uint32_t i = 0; i < shares.size(); ++i) {
        const double middle = (before + 0.5 * shares[i]) / sum;
        before += shares[i];
        if (!(shares[i] > 1e-3 * sum)) continue;
        CAPTURE(i, paths.lights[i].kind, shares[i]);
        CHECK(ask(scene, paths, static_cast<float>(middle)).lit.light == i);
      }
    }
  }
}

TEST_CASE("nothing is asked where no light brings anything") {
  PathSceneBuilder b;
  b.light(sun_light({0.6F, 0.8F, 0.0F}, {9.0F, 9.0F, 9.0F}));  // from behind
  const PathScene paths = make_path_scene(b.scene(), with_sky(PathStrategy::kBoth));
  const Asked asked = ask(b.scene(), paths, 0.5F);
  CHECK(asked.path.light_sum == 0.0F);
  CHECK(asked.lit.radiance[0] == 0.0F);
}
