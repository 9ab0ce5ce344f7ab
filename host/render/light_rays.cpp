#include "gnomon/render/light_rays.h"

#include <algorithm>
#include <array>

#include "gnomon/scene/steady_random.h"

namespace gnomon {
namespace {

constexpr std::uint32_t kMostRounds = 8;
constexpr double kShadowReach = 0.9999;  // of the distance to a light: its own surface does not hide it

void queue(const Place& place, const LightSample& lit, double factor, ShadowBatch& batch) {
  batch.rays.push_back(make_ray(place.position, lit.direction, kShadowReach * lit.distance));
  batch.pending.push_back({place.pixel, factor / kPi * place.albedo * lit.irradiance});
}

}  // namespace

std::uint32_t LightRays::rounds() const {
  return static_cast<std::uint32_t>(std::min<std::size_t>(kMostRounds, lights_.size()));
}

std::optional<LightSample> LightRays::sample(const Place& place, std::uint32_t round,
                                             std::uint32_t purpose) const {
  std::size_t light = round;
  if (rounds() < lights_.size()) {
    const double choice =
        (place.random(seed_, purpose).x + round) / rounds() * static_cast<double>(lights_.size());
    light = std::min(static_cast<std::size_t>(choice), lights_.size() - 1);
  }
  const Point2 point = lights_.is_area(light) ? place.random(seed_, purpose + 1) : Point2{0.0};
  return lights_.sample(light, place.position, place.normal, point);
}

ShadowBatch LightRays::aim_round(const std::vector<Place>& places, std::uint32_t round) const {
  ShadowBatch batch;
  const double share = static_cast<double>(lights_.size()) / rounds();
  for (const Place& place : places) {
    const auto lit = sample(place, round, kLightPoints + 2 * round);
    if (lit) queue(place, *lit, share, batch);
  }
  return batch;
}

void LightRays::aim_at_one_of_all(const Place& place, ShadowBatch& batch) const {
  std::array<std::optional<LightSample>, kMostRounds> lit;
  std::array<double, kMostRounds> running{};
  double sum = 0.0;
  for (std::uint32_t i = 0; i < rounds(); ++i) {
    lit[i] = sample(place, i, kLightPoints + 2 * (kMostRounds + i));
    if (lit[i]) sum += luminance(lit[i]->irradiance);
    running[i] = sum;
  }
  const double draw = sum * place.random(seed_, kLightChoice).x;
  const double share = static_cast<double>(lights_.size()) / rounds();
  for (std::uint32_t i = 0; i < rounds(); ++i) {
    if (!lit[i] || draw >= running[i]) continue;
    const double own = luminance(lit[i]->irradiance);
    if (own > 0.0) queue(place, *lit[i], share * sum / own, batch);
    return;
  }
}

ShadowBatch LightRays::aim_once(const std::vector<Place>& places) const {
  ShadowBatch batch;
  for (const Place& place : places) aim_at_one_of_all(place, batch);
  return batch;
}

}  // namespace gnomon
