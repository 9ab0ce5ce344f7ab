// Which shadow rays to send from where to which light, and what each is worth. Not for tracing them. Feeds
// render.cpp.
#pragma once

#include <cstdint>
#include <vector>

#include "gnomon/render/light_set.h"
#include "gnomon/render/place.h"

namespace gnomon {

// Radiance that leaves a place towards the viewer if the ray of the same index is free.
struct Pending {
  std::uint32_t pixel;
  Point radiance;
};
struct ShadowBatch {
  std::vector<Ray> rays;
  std::vector<Pending> pending;
};

class LightRays {
 public:
  LightRays(const LightSet& lights, std::uint64_t seed) : lights_(lights), seed_(seed) {}

  // How many rounds light a place: one for each light, eight at most.
  [[nodiscard]] std::uint32_t rounds() const;
  // One ray a place: to light number `round`, or one drawn from its share of them when there are more than
  // rounds.
  [[nodiscard]] ShadowBatch aim_round(const std::vector<Place>& places, std::uint32_t round) const;
  // One ray a place to a light drawn in proportion to what it would give there if it were free (Talbot et al.
  // 2005).
  [[nodiscard]] ShadowBatch aim_once(const std::vector<Place>& places) const;

 private:
  [[nodiscard]] std::optional<LightSample> sample(const Place& place, std::uint32_t round,
                                                  std::uint32_t purpose) const;
  void aim_at_one_of_all(const Place& place, ShadowBatch& batch) const;

  const LightSet& lights_;
  std::uint64_t seed_;
};

}  // namespace gnomon
