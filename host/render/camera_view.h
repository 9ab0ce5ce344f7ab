// A camera looking through a picture of a given size. Feeds render.cpp.
#pragma once

#include <cstdint>

#include "gnomon/render/vector_math.h"
#include "gnomon/scene/ray_set.h"

namespace gnomon {

class CameraView {
 public:
  // The camera's vertical angle is kept; the picture's own proportions decide how far it sees sideways.
  CameraView(const Camera& camera, std::uint32_t width, std::uint32_t height);

  // Through the picture at (x, y) in pixels from the top left; unit direction, tmin 0, no end.
  [[nodiscard]] Ray ray(double x, double y) const;

  // Directions through the picture are corner() + x right() + y down(), not unit.
  [[nodiscard]] const Point& corner() const { return corner_; }
  [[nodiscard]] const Point& right() const { return right_; }
  [[nodiscard]] const Point& down() const { return down_; }

 private:
  Point position_;
  Point corner_;  // direction through the top left
  Point right_;   // one pixel to the right
  Point down_;    // one pixel down
};

}  // namespace gnomon
