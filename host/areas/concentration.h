// How much denser rays lie about a direction than around it: a scan over radii. Feeds detect.
#pragma once

#include <cstddef>
#include <span>

namespace gnomon {

// How far a unit vector is from another, as the share of the sphere that is as near or nearer: |u - v|^2 / 4.
// Vectors that favour no direction give numbers uniform in 0 to 1, so a share is its own chance. A cap of
// three times the chord has nine times the share.
inline constexpr double kWidestShare = 0.00486596561;    // 8 degrees
inline constexpr double kNarrowestShare = 3.0461742e-8;  // 0.02 degrees

struct Concentration {
  double share = 0.0;     // the radius, as above
  std::size_t count = 0;  // within it
  double expected = 0.0;  // there: the more of what isotropic rays and what the ring up to three radii gives
  double contrast = 0.0;  // count over expected, less what the model's own rays take up
  double nats = 0.0;      // Chernoff's bound: `expected` gives so many with a chance of at most e^-nats
};

// The radius, of 36 between the narrowest and the widest, that is least likely by chance. `used` rays of the
// count are bound to be there, since the centre was put through them.
[[nodiscard]] Concentration most_concentrated(std::span<const double> shares, std::size_t used);

}  // namespace gnomon
