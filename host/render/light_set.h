// A scene's lights made ready to be sampled. Not for visibility: that is a ray's business. Feeds render.cpp.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gnomon/render/vector_math.h"
#include "gnomon/scene/scene.h"

namespace gnomon {

// Light that would reach a point if nothing were in between.
struct LightSample {
  Point direction;   // unit, towards the light
  double distance;   // infinite for the sun
  Point irradiance;  // on the surface, its slope included
};

// What lights a scene without lights: the sun of ray_set.h's shadow rays, so that pictures and measured rays
// agree.
[[nodiscard]] Light default_sun();

class LightSet {
 public:
  // `bounds` are the scene's. A scene without lights gets a sun.
  LightSet(const Scene& scene, const Bounds& bounds);

  [[nodiscard]] std::size_t size() const { return emitters_.size(); }
  [[nodiscard]] bool is_area(std::size_t light) const {
    return emitters_[light].light.kind == LightKind::kArea;
  }
  // What was assumed, for the user; empty when nothing was.
  [[nodiscard]] const std::string& note() const { return note_; }
  // How bright the sky should be beside these lights: a share of what they give a surface a fair way off.
  [[nodiscard]] double sky_level() const;

  // Light from one of them at a point of a surface with this unit normal: point and spot fall off with the
  // squared distance (and range, cone: KHR_lights_punctual), area lights shine from a point that `sample`
  // picks, to both sides. Nothing if the light is behind the surface or does not reach it.
  [[nodiscard]] std::optional<LightSample> sample(std::size_t light, const Point& position,
                                                  const Point& normal, const Point2& sample) const;

 private:
  struct Emitter {
    Light light;
    std::vector<double> running_areas;  // area: sum of areas up to and with each triangle
  };
  [[nodiscard]] Point point_on(const Emitter& emitter, const Point2& sample, Point& normal) const;
  [[nodiscard]] double level_of(const Emitter& emitter) const;

  std::span<const Triangle> triangles_;  // the scene's, which must outlive this
  double reach_;                         // a fair way off
  std::vector<Emitter> emitters_;
  std::string note_;
};

}  // namespace gnomon
