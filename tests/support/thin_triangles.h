// Triangles down to needles and rays that start in their plane, a last bit off it and elsewhere, up to 1e6
// from the origin: where the distance to a hit is hardest to tell. Feeds the tests of hits, with and without
// double.
#pragma once

#include <algorithm>
#include <cmath>

#include "support/shapes.h"

namespace gnomon::test {

struct ThinCase {
  GnTriangle triangle;
  GnRay ray;  // through a place within the triangle, but for rounding
};

inline ThinCase thin_case(Random& random, int number) {
  const float offset = number % 3 == 0 ? 0.0F : number % 3 == 1 ? 1e3F : 1e6F;
  const float width = std::ldexp(1.0F, -static_cast<int>(random.below(30)));
  std::array<float, 3> a{}, b{}, c{}, inside{}, d{};
  for (std::size_t k = 0; k < 3; ++k) {
    a[k] = offset + random.between(-10, 10);
    b[k] = a[k] + random.between(-10, 10);
    c[k] = 0.5F * (a[k] + b[k]) + width * random.between(-1, 1);
    inside[k] = 0.25F * a[k] + 0.25F * b[k] + 0.5F * c[k];
    d[k] = random.between(-1, 1);
  }
  const float back = number % 4 == 0   ? 0.0F
                     : number % 4 == 1 ? random.between(-1e-5F, 1e-5F)
                                       : random.between(-20, 20);
  for (std::size_t k = 0; k < 3; ++k) inside[k] -= back * d[k];
  return {triangle(a, b, c), ray(inside, d)};
}

// Spacing of floats at t, that of the smallest normal one below it.
inline double ulp_at(double t) {
  return std::ldexp(1.0, std::max(std::ilogb(std::max(std::fabs(t), 0x1p-126)), -126) - 23);
}

}  // namespace gnomon::test
