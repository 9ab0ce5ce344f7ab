#include "gnomon/render/camera_view.h"

#include <limits>

#include "gnomon/scene/steady_random.h"

namespace gnomon {

CameraView::CameraView(const Camera& camera, std::uint32_t width, std::uint32_t height)
    : position_(to_point(camera.position)) {
  const Point forward = to_point(camera.forward);
  const Point up = to_point(camera.up);
  const double half_turns = static_cast<double>(camera.fov_y) / (4.0 * kPi);
  const double pixel = 2.0 * sin_turns(half_turns) / cos_turns(half_turns) / height;
  right_ = pixel * glm::cross(forward, up);
  down_ = -pixel * up;
  corner_ = forward - 0.5 * width * right_ - 0.5 * height * down_;
}

Ray CameraView::ray(double x, double y) const {
  const Point direction = glm::normalize(corner_ + x * right_ + y * down_);
  Ray ray{};
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis] = static_cast<float>(position_[axis]);
    ray.direction[axis] = static_cast<float>(direction[axis]);
  }
  ray.tmax = std::numeric_limits<float>::infinity();
  return ray;
}

}  // namespace gnomon
