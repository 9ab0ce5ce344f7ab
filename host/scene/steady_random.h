// Random numbers and angles whose bits depend neither on the standard library nor on the libm: integer steps
// and the four IEEE operations only. Not cryptographic, not for statistics. Feeds the generators and the ray
// sets.
#pragma once

#include <cmath>
#include <cstdint>

namespace gnomon {

// The finaliser of splitmix64: spreads every input bit over all output bits. (Steele et al., OOPSLA 2014.)
[[nodiscard]] constexpr std::uint64_t mix_bits(std::uint64_t value) {
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31);
}

// A splitmix64 stream. Streams of one seed are independent of each other, so the n-th object or ray draws the
// same numbers whatever was drawn before it.
class SteadyRandom {
 public:
  explicit SteadyRandom(std::uint64_t seed, std::uint64_t stream = 0)
      : state_(mix_bits(seed + kStep) ^ mix_bits(stream * kStep + 1)) {}

  [[nodiscard]] std::uint64_t bits() { return mix_bits(state_ += kStep); }
  // Uniform in [0, 1), 53 bits.
  [[nodiscard]] double unit() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  [[nodiscard]] double between(double lo, double hi) { return lo + (hi - lo) * unit(); }
  // Uniform in [0, count); count must not be 0 and stay below 2^32.
  [[nodiscard]] unsigned below(unsigned count) {
    return static_cast<unsigned>(((bits() >> 32) * static_cast<std::uint64_t>(count)) >> 32);
  }
  [[nodiscard]] bool chance(double probability) { return unit() < probability; }

 private:
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15ULL;
  std::uint64_t state_;
};

inline constexpr double kPi = 3.14159265358979323846;

// Sine of an angle in full turns, by its Taylor series on a quarter turn: within 1e-15, the same bits
// everywhere.
[[nodiscard]] inline double sin_turns(double turns) {
  double t = turns - std::floor(turns + 0.5);
  if (t > 0.25) t = 0.5 - t;
  if (t < -0.25) t = -0.5 - t;
  const double x = t * (2.0 * kPi);
  double term = 1.0;
  for (int k = 20; k >= 2; k -= 2) term = 1.0 - x * x * term / static_cast<double>(k * (k + 1));
  return x * term;
}
[[nodiscard]] inline double cos_turns(double turns) {
  return sin_turns(turns + 0.25);
}

}  // namespace gnomon
