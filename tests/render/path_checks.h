// What must be true of the light that path tracing finds, as figures: so that the tests can ask for them, and
// ask whether planted faults change them. Feeds path_light_test.cpp and path_faults_test.cpp.
#pragma once

#include "render/path_rig.h"

namespace gnomon::test {

// How far an estimate is from what it must be, in error bars; a thousandth of the value is added to those for
// what floats and the patch seen (not a point) do.
struct Judged {
  double mean;
  double expected;
  double bars;
  double relative_error;  // the error bar's
};

inline Judged judge_mean(const Estimate& estimate, double expected) {
  const double error = std::hypot(estimate.error, 1e-3 * expected);
  return {estimate.mean, expected, std::abs(estimate.mean - expected) / error, estimate.error / expected};
}

inline PathOptions small_picture(std::uint32_t side, PathStrategy strategy, std::uint64_t seed = 1) {
  PathOptions options;
  options.width = side;
  options.height = side;
  options.seed = seed;
  options.strategy = strategy;
  options.sky = Vec3{0.0F, 0.0F, 0.0F};
  return options;
}

// A matt floor of reflectance 1/2, seen from the side in one narrow spot at the origin.
inline PathSceneBuilder spot_on_floor() {
  PathSceneBuilder builder;
  builder.quad(builder.material({0.5F, 0.5F, 0.5F}), {-4, 0, -4}, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4});
  builder.look({5.0F, 2.5F, 0.0F}, {0.0F, 0.0F, 0.0F}, 0.002F);
  return builder;
}

// A square lamp of side 2 and radiance 8, four above the spot. Its form factor: a square above its centre,
// four corners of side a = 1: 2 / pi a / s atan(a / s), s = sqrt(17).
inline Judged lamp_over_floor(PathStrategy strategy) {
  PathSceneBuilder builder = spot_on_floor();
  builder.lamp({8.0F, 8.0F, 8.0F}, {-1, 4, -1}, {1, 4, -1}, {1, 4, 1}, {-1, 4, 1});
  const double s = std::sqrt(17.0);
  const double irradiance = 8.0 * 4.0 / s * std::atan(1.0 / s);
  const Picture picture = TracedScene(builder.scene()).picture(small_picture(16, strategy), 64);
  return judge_mean(mean_of(picture), 0.5 / M_PI * irradiance);
}

// The walls of a closed box shine with radiance 1 and reflect 0.6: everything in it has 1 / (1 - 0.6).
inline Judged glowing_box(PathStrategy strategy) {
  PathSceneBuilder builder;
  const auto wall = builder.material({0.6F, 0.6F, 0.6F}, 1.0F, 0.0F, {1.0F, 1.0F, 1.0F});
  const auto at = [](int i) {
    return Corner{(i & 1) != 0 ? 2.0F : -2.0F, (i & 2) != 0 ? 1.0F : -1.0F, (i & 4) != 0 ? 3.0F : -3.0F};
  };
  for (const auto& face :
       {std::array{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}})
    builder.quad(wall, at(face[0]), at(face[1]), at(face[2]), at(face[3]));
  Light light;
  light.kind = LightKind::kArea;
  light.color = {1.0F, 1.0F, 1.0F};
  for (std::uint32_t i = 0; i < 12; ++i) light.triangles.push_back(i);
  builder.light(light);
  builder.look({0.3F, 0.2F, 1.0F}, {0.0F, 0.0F, -1.0F}, 1.2F);
  const Picture picture = TracedScene(builder.scene()).picture(small_picture(24, strategy), 64);
  return judge_mean(mean_of(picture), 2.5);
}

// What a point light, a spot or a sun brings the spot on the floor: no chance is in it.
inline double irradiance_of(const Light& light) {
  PathSceneBuilder builder = spot_on_floor();
  builder.light(light);
  const Picture picture = TracedScene(builder.scene()).picture(small_picture(4, PathStrategy::kBoth), 4);
  return mean_of(picture).mean / (0.5 / M_PI);
}

// A room open to the front with everything in it: matt and glossy walls, metal, a lamp, a point light, a sky.
inline Scene open_room() {
  PathSceneBuilder b;
  const auto white = b.material({0.7F, 0.7F, 0.7F});
  const auto red = b.material({0.6F, 0.15F, 0.1F});
  const auto gold = b.material({0.9F, 0.7F, 0.4F}, 0.4F, 1.0F);
  const auto lacquer = b.material({0.2F, 0.3F, 0.6F}, 0.3F);
  b.quad(white, {-3, 0, -3}, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3});
  b.quad(gold, {-3, 0, -3}, {3, 0, -3}, {3, 4, -3}, {-3, 4, -3});
  b.quad(red, {-3, 0, 3}, {-3, 0, -3}, {-3, 4, -3}, {-3, 4, 3});
  b.quad(white, {-3, 4, -3}, {3, 4, -3}, {3, 4, 3}, {-3, 4, 3});
  b.quad(lacquer, {-1, 1, -1}, {-1, 1, 1}, {1, 1, 1}, {1, 1, -1});
  b.quad(lacquer, {-1, 0, 1}, {1, 0, 1}, {1, 1, 1}, {-1, 1, 1});
  b.lamp({6.0F, 5.0F, 4.0F}, {0.5F, 3.5F, -1}, {2.5F, 3.5F, -1}, {2.5F, 3.5F, 1}, {0.5F, 3.5F, 1});
  b.light(point_light({-2.0F, 2.5F, 1.0F}, {2.0F, 2.0F, 3.0F}));
  b.look({0.5F, 2.0F, 8.0F}, {0.0F, 1.6F, 0.0F}, 0.7F);
  return b.scene();
}

// Two pictures' blocks of pixels, each with error bars over seeds: the mean square and the largest of their
// differences in bars. Around 1 (10/8 for 16 seeds in all), and seldom above 4, when both have the same mean.
struct Disagreement {
  double mean_square = 0.0;
  double largest = 0.0;
};

inline std::vector<std::vector<double>> block_means(const TracedScene& traced, PathOptions options,
                                                    std::uint32_t seeds, std::uint32_t samples) {
  constexpr std::uint32_t kBlock = 6;
  std::vector<std::vector<double>> blocks;
  for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
    options.seed = 1000 * seed + static_cast<std::uint64_t>(options.strategy);
    const Picture picture = traced.picture(options, samples);
    const std::uint32_t across = options.width / kBlock;
    std::vector<double> sums(std::size_t{3} * across * (options.height / kBlock));
    for (std::uint32_t y = 0; y < options.height; ++y) {
      for (std::uint32_t x = 0; x < options.width; ++x) {
        for (std::size_t k = 0; k < 3; ++k) {
          const Vec3& pixel = picture.pixels[y * options.width + x];
          sums[3 * (y / kBlock * across + x / kBlock) + k] += pixel[k] / double{kBlock * kBlock};
        }
      }
    }
    blocks.resize(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i) blocks[i].push_back(sums[i]);
  }
  return blocks;
}

inline Disagreement compare(const std::vector<std::vector<double>>& a,
                            const std::vector<std::vector<double>>& b) {
  Disagreement out;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Estimate x = estimate_of(a[i]);
    const Estimate y = estimate_of(b[i]);
    const double bars = std::abs(x.mean - y.mean) / std::hypot(x.error, y.error, 1e-4 * x.mean);
    out.mean_square += bars * bars / static_cast<double>(a.size());
    out.largest = std::max(out.largest, bars);
  }
  return out;
}

// How far two ways of finding light disagree about the open room.
inline Disagreement strategies_disagree(PathStrategy first, PathStrategy second, std::uint32_t samples) {
  const TracedScene traced(open_room());
  PathOptions options = small_picture(24, first);
  options.sky = Vec3{0.4F, 0.5F, 0.6F};
  const auto a = block_means(traced, options, 8, samples);
  options.strategy = second;
  return compare(a, block_means(traced, options, 8, samples));
}

}  // namespace gnomon::test
