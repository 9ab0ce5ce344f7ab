// How far off t may be on a device without double, which works on pairs of floats. Feeds the judge of such
// devices and the test of their arithmetic.
#pragma once

#include "gnomon/tree/oracle.h"

namespace gnomon {

// Bound on |device's t - exact t| for a triangle that the device says is met, beside the half ulp by which t
// itself is rounded: 2^-40 kappa s + 2^-43 z over |d|, where d is the direction's longest component, s and z
// are the spread and the largest magnitude of the corners' distances along that axis, and kappa is the sum of
// the edges' permanents over that of the edges' determinants, at least 1. Never more than s / |d|.
// Derived in host/notes/exact-hits.md.
[[nodiscard]] double pair_error_bound(const Ray& ray, const Triangle& triangle);

}  // namespace gnomon
