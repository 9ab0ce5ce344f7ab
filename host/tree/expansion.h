// Sums of doubles kept without any rounding, after Shewchuk 1997 ("Adaptive Precision Floating-Point
// Arithmetic and Fast Robust Geometric Predicates", sections 2.3 to 2.7). Not for speed: only where a plain
// double leaves a sign or a digit in doubt. Needs round-to-nearest-even, no contraction and no excess
// precision. Feeds exact_hit.
#pragma once

#include <cfloat>
#include <vector>

namespace gnomon {

static_assert(FLT_EVAL_METHOD == 0, "exact sums need doubles that are rounded to double");

// A number as an unevaluated sum of nonadjacent doubles of increasing magnitude, none of them zero.
// Exact while every product added is a multiple of 2^-1074 and below 2^996: true of six floats multiplied
// together.
class Expansion {
 public:
  // Adds a value (Grow-Expansion, Theorem 10, with zeros left out).
  void add(double value);
  // Adds a * b (Two-Product, Theorem 18: halves by Veltkamp's split, so no FMA is assumed).
  void add_product(double a, double b);
  // Adds factor times another expansion, or the product of two.
  void add_product(const Expansion& a, double factor);
  void add_product(const Expansion& a, const Expansion& b, double sign);

  // -1, 0 or +1: the largest part outweighs all others together.
  [[nodiscard]] int sign() const;
  // The value as a double, relative error below 2^-45 for up to 48 parts: nonadjacent parts add up, in
  // magnitude, to at most 5/3 of the largest and the value is at least 1/3 of it, so summing loses less than
  // 47 * 5 * 2^-53 of the value.
  [[nodiscard]] double estimate() const;

 private:
  std::vector<double> parts_;
};

}  // namespace gnomon
