// With A, B, C the corners seen from the ray's origin, the line meets the triangle at weights det(d,B,C) :
// det(d,C,A) : det(d,A,B), whose sum is W = d . N for the triangle's normal N, and t = det(A,B,C) / W
// (Cramer's rule on t d = wA A + wB B + wC C). Inside, the three weights agree in sign, so their sum loses
// nothing.
#include "gnomon/tree/exact_hit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gnomon/tree/expansion.h"

namespace gnomon {

namespace {

constexpr double kHalfUlp = std::numeric_limits<double>::epsilon() / 2;  // 2^-53

struct Vector {
  double x;
  double y;
  double z;
};

Vector widen(const float p[3]) {
  return {p[0], p[1], p[2]};
}

Vector from_origin(const float p[3], const float o[3]) {
  return {static_cast<double>(p[0]) - o[0], static_cast<double>(p[1]) - o[1],
          static_cast<double>(p[2]) - o[2]};
}

// A double and a bound on its distance from the exact value.
struct Bounded {
  double value;
  double bound;
};

// det(a, b, c) of vectors whose components are floats or rounded differences of two floats. Nothing over- or
// underflows (2^-447 .. 2^390). Every one of the six terms passes at most 8 roundings: three differences, two
// products, one subtraction, two sums. So the error is below 8u/(1-8u) of the sum P of the terms' magnitudes
// (u = 2^-53), the computed P is above (1-8u) P, and 16u times the computed P bounds the error with room to
// spare.
Bounded determinant(const Vector& a, const Vector& b, const Vector& c) {
  const double yz = b.y * c.z;
  const double zy = b.z * c.y;
  const double zx = b.z * c.x;
  const double xz = b.x * c.z;
  const double xy = b.x * c.y;
  const double yx = b.y * c.x;
  const double value = a.x * (yz - zy) + a.y * (zx - xz) + a.z * (xy - yx);
  const double magnitude = std::fabs(a.x) * (std::fabs(yz) + std::fabs(zy)) +
                           std::fabs(a.y) * (std::fabs(zx) + std::fabs(xz)) +
                           std::fabs(a.z) * (std::fabs(xy) + std::fabs(yx));
  return {value, 16.0 * kHalfUlp * magnitude};
}

// Adds sign * det(a, b, c). The inner product of two floats is exact in double (48 bits).
void add_determinant(Expansion& sum, double sign, const float a[3], const float b[3], const float c[3]) {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    sum.add_product(static_cast<double>(b[j]) * c[k], sign * a[i]);
    sum.add_product(static_cast<double>(b[k]) * c[j], -sign * a[i]);
  }
}

// det(d, a - o, b - o) = det(d, a, b) + det(d, b, o) + det(d, o, a): 36 parts, never a rounded difference.
Expansion exact_edge(const float d[3], const float o[3], const float a[3], const float b[3]) {
  Expansion sum;
  add_determinant(sum, 1.0, d, a, b);
  add_determinant(sum, 1.0, d, b, o);
  add_determinant(sum, 1.0, d, o, a);
  return sum;
}

// W = d . N, the denominator of t: an edge value seen from the third corner.
Expansion exact_denominator(const Ray& ray, const Triangle& triangle) {
  return exact_edge(ray.direction, triangle.v2, triangle.v0, triangle.v1);
}

// det(v0 - o, v1 - o, v2 - o), the numerator of t, multiplied out: 48 parts.
Expansion exact_numerator(const Ray& ray, const Triangle& triangle) {
  Expansion sum;
  add_determinant(sum, 1.0, triangle.v0, triangle.v1, triangle.v2);
  add_determinant(sum, -1.0, ray.origin, triangle.v1, triangle.v2);
  add_determinant(sum, -1.0, triangle.v0, ray.origin, triangle.v2);
  add_determinant(sum, -1.0, triangle.v0, triangle.v1, ray.origin);
  return sum;
}

bool all_finite(const float p[3]) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

// Sign of an edge value: from the double where its bound allows, else from the exact sum.
int sign_of(const Bounded& edge, const float d[3], const float o[3], const float a[3], const float b[3]) {
  // A bound of zero means that all six terms are zero, hence the value too.
  if (std::fabs(edge.value) > edge.bound || edge.bound == 0.0) return (edge.value > 0.0) - (edge.value < 0.0);
  return exact_edge(d, o, a, b).sign();
}

// Weights of the three corners, of like sign or zero, and the bounds of their doubles.
struct Weights {
  Bounded of_v0;
  Bounded of_v1;
  Bounded of_v2;
};

// t, u and v from doubles. False where the bounds promise less than 2^-40, relative for t and absolute for u
// and v.
bool place_in_double(const Weights& w, const Bounded& numerator, ExactHit& hit) {
  const double sum = w.of_v0.value + w.of_v1.value + w.of_v2.value;
  const double sum_bound = w.of_v0.bound + w.of_v1.bound + w.of_v2.bound + 4.0 * kHalfUlp * std::fabs(sum);
  if (!(sum_bound <= 0x1p-42 * std::fabs(sum))) return false;
  // n'/W' - n/W = (n' - n)/W + (n'/W') (W - W')/W. The 2 covers |W| >= (1 - 2^-42)|W'| and, with the 4u
  // above, the roundings of the division and of this line.
  const double t = numerator.value / sum;
  const double t_error = 2.0 * (numerator.bound + std::fabs(t) * sum_bound) / std::fabs(sum);
  if (!(t_error <= 0x1p-40 * std::fabs(t))) return false;
  hit = {true, t, t_error, w.of_v1.value / sum, w.of_v2.value / sum};
  return true;
}

// The same from exact sums: numerator and denominator are each good to 2^-45, their quotient to 2^-43.
ExactHit place_exactly(const Ray& ray, const Triangle& triangle) {
  const double sum = exact_denominator(ray, triangle).estimate();
  const double t = exact_numerator(ray, triangle).estimate() / sum;
  const double of_v1 = exact_edge(ray.direction, ray.origin, triangle.v2, triangle.v0).estimate();
  const double of_v2 = exact_edge(ray.direction, ray.origin, triangle.v0, triangle.v1).estimate();
  return {true, t, 0x1p-43 * std::fabs(t), of_v1 / sum, of_v2 / sum};
}

// Sign of (exact t) - bound, for a triangle that the line meets. An infinite bound is never in doubt.
int compare(const Ray& ray, const FoundHit& found, float bound) {
  const double difference = found.hit.t - static_cast<double>(bound);
  if (std::fabs(difference) > found.hit.t_error) return difference > 0.0 ? 1 : -1;
  const Expansion denominator = exact_denominator(ray, *found.triangle);
  Expansion rest = exact_numerator(ray, *found.triangle);
  rest.add_product(denominator, -static_cast<double>(bound));
  return rest.sign() * denominator.sign();
}

bool same_corners(const Triangle& a, const Triangle& b) {
  return std::equal(a.v0, a.v0 + 3, b.v0) && std::equal(a.v1, a.v1 + 3, b.v1) &&
         std::equal(a.v2, a.v2 + 3, b.v2);
}

}  // namespace

int exact_edge_sign(const float d[3], const float o[3], const float a[3], const float b[3]) {
  return sign_of(determinant(widen(d), from_origin(a, o), from_origin(b, o)), d, o, a, b);
}

ExactHit exact_intersect(const Ray& ray, const Triangle& triangle) {
  const float* const o = ray.origin;
  const float* const d = ray.direction;
  if (!all_finite(o) || !all_finite(d)) return {};
  if (!all_finite(triangle.v0) || !all_finite(triangle.v1) || !all_finite(triangle.v2)) return {};
  const Vector direction = widen(d);
  const Vector a = from_origin(triangle.v0, o);
  const Vector b = from_origin(triangle.v1, o);
  const Vector c = from_origin(triangle.v2, o);
  Weights w{determinant(direction, b, c), determinant(direction, c, a), determinant(direction, a, b)};
  const int sign0 = sign_of(w.of_v0, d, o, triangle.v1, triangle.v2);
  const int sign1 = sign_of(w.of_v1, d, o, triangle.v2, triangle.v0);
  if (sign0 * sign1 < 0) return {};
  const int sign2 = sign_of(w.of_v2, d, o, triangle.v0, triangle.v1);
  if (sign0 * sign2 < 0 || sign1 * sign2 < 0) return {};
  if (sign0 == 0 && sign1 == 0 && sign2 == 0) return {};
  // A double on the wrong side of a boundary the exact sign has settled is rounding: zero is nearer and
  // within bound.
  if (w.of_v0.value * sign0 <= 0.0) w.of_v0.value = 0.0;
  if (w.of_v1.value * sign1 <= 0.0) w.of_v1.value = 0.0;
  if (w.of_v2.value * sign2 <= 0.0) w.of_v2.value = 0.0;
  ExactHit hit;
  if (place_in_double(w, determinant(a, b, c), hit)) return hit;
  return place_exactly(ray, triangle);
}

bool is_traceable(const Ray& ray) {
  if (!all_finite(ray.origin) || !all_finite(ray.direction)) return false;
  if (std::isnan(ray.tmin) || std::isnan(ray.tmax)) return false;
  const float longest =
      std::max({std::fabs(ray.direction[0]), std::fabs(ray.direction[1]), std::fabs(ray.direction[2])});
  return longest >= 0x1p-100F && longest <= 0x1p100F;
}

// Not std::clamp: a tmin of +inf and a tmax of -inf leave nothing, and must go on doing so.
FiniteRange::FiniteRange(const Ray& ray)
    : tmin(std::max(ray.tmin, -std::numeric_limits<float>::max())),
      tmax(std::min(ray.tmax, std::numeric_limits<float>::max())) {}

bool in_range(const Ray& ray, const FoundHit& found) {
  const FiniteRange range(ray);
  return compare(ray, found, range.tmin) >= 0 && compare(ray, found, range.tmax) <= 0;
}

bool nearer(const Ray& ray, const FoundHit& a, const FoundHit& b) {
  const double difference = a.hit.t - b.hit.t;
  if (std::fabs(difference) > a.hit.t_error + b.hit.t_error) return difference < 0.0;
  if (same_corners(*a.triangle, *b.triangle)) return false;  // scenes do repeat triangles
  const Expansion denominator_a = exact_denominator(ray, *a.triangle);
  const Expansion denominator_b = exact_denominator(ray, *b.triangle);
  Expansion rest;  // sign(n_a / W_a - n_b / W_b) = sign(n_a W_b - n_b W_a) sign(W_a) sign(W_b)
  rest.add_product(exact_numerator(ray, *a.triangle), denominator_b, 1.0);
  rest.add_product(exact_numerator(ray, *b.triangle), denominator_a, -1.0);
  return rest.sign() * denominator_a.sign() * denominator_b.sign() < 0;
}

}  // namespace gnomon
