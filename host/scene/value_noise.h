// Seeded value noise over the ground plane, for height fields and scattered colours. Lattice values come from
// integer hashes, so the bits are the same everywhere. Feeds the outdoor generators.
#pragma once

#include <cmath>
#include <cstdint>

#include "gnomon/scene/steady_random.h"

namespace gnomon {

class ValueNoise {
 public:
  explicit ValueNoise(std::uint64_t seed) : seed_(mix_bits(seed + 1)) {}

  // Smooth in x and z, lattice of width 1, in [0, 1].
  [[nodiscard]] double at(double x, double z) const {
    const double cell_x = std::floor(x);
    const double cell_z = std::floor(z);
    const auto ix = static_cast<std::int64_t>(cell_x);
    const auto iz = static_cast<std::int64_t>(cell_z);
    const double u = ease(x - cell_x);
    const double v = ease(z - cell_z);
    const double near = corner(ix, iz) + u * (corner(ix + 1, iz) - corner(ix, iz));
    const double far = corner(ix, iz + 1) + u * (corner(ix + 1, iz + 1) - corner(ix, iz + 1));
    return near + v * (far - near);
  }

  // Octaves of halving width and height, in [0, 1].
  [[nodiscard]] double octaves(double x, double z, unsigned count) const {
    double sum = 0.0;
    double weight = 0.5;
    double total = 0.0;
    for (unsigned i = 0; i < count; ++i) {
      sum += weight * at(x, z);
      total += weight;
      weight *= 0.5;
      const double turned = 1.6 * x - 1.2 * z + 17.3;  // doubles and turns, so that lattices do not line up
      z = 1.2 * x + 1.6 * z + 9.1;
      x = turned;
    }
    return sum / total;
  }

 private:
  [[nodiscard]] static double ease(double t) { return t * t * t * (t * (6.0 * t - 15.0) + 10.0); }
  [[nodiscard]] double corner(std::int64_t ix, std::int64_t iz) const {
    const auto a = static_cast<std::uint64_t>(ix) * 0x9e3779b97f4a7c15ULL;
    const auto b = static_cast<std::uint64_t>(iz) * 0xc2b2ae3d27d4eb4fULL;
    return static_cast<double>(mix_bits(seed_ ^ mix_bits(a + mix_bits(b))) >> 11) * 0x1.0p-53;
  }
  std::uint64_t seed_;
};

}  // namespace gnomon
