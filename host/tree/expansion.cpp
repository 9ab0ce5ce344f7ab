#include "gnomon/tree/expansion.h"

#include <cstddef>

namespace gnomon {

namespace {

struct Pair {
  double high;
  double low;
};

// high + low == a + b (Two-Sum, Knuth; Shewchuk's Theorem 7): no order of magnitudes is assumed.
Pair two_sum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  const double a_part = sum - b_part;
  return {sum, (a - a_part) + (b - b_part)};
}

// high + low == value, each of at most 26 significant bits (Veltkamp; Shewchuk's Theorem 17).
Pair halves(double value) {
  constexpr double kSplitter = 134217729.0;  // 2^27 + 1
  const double spread = kSplitter * value;
  const double high = spread - (spread - value);
  return {high, value - high};
}

// high + low == a * b.
Pair two_product(double a, double b) {
  const double product = a * b;
  const Pair x = halves(a);
  const Pair y = halves(b);
  const double rest = ((product - x.high * y.high) - x.low * y.high) - x.high * y.low;
  return {product, x.low * y.low - rest};
}

}  // namespace

void Expansion::add(double value) {
  std::size_t kept = 0;
  double carry = value;
  for (const double part : parts_) {
    const Pair sum = two_sum(carry, part);
    carry = sum.high;
    if (sum.low != 0.0) parts_[kept++] = sum.low;  // never ahead of the part being read
  }
  parts_.resize(kept);
  if (carry != 0.0) parts_.push_back(carry);
}

void Expansion::add_product(double a, double b) {
  const Pair product = two_product(a, b);
  add(product.low);
  add(product.high);
}

void Expansion::add_product(const Expansion& a, double factor) {
  for (const double part : a.parts_) add_product(part, factor);
}

void Expansion::add_product(const Expansion& a, const Expansion& b, double sign) {
  for (const double part : b.parts_) add_product(a, sign * part);
}

int Expansion::sign() const {
  if (parts_.empty()) return 0;
  return parts_.back() > 0.0 ? 1 : -1;
}

double Expansion::estimate() const {
  double sum = 0.0;
  for (const double part : parts_) sum += part;
  return sum;
}

}  // namespace gnomon
