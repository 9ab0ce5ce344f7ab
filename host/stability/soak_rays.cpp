#include "gnomon/stability/soak_rays.h"

#include <algorithm>
#include <cmath>

namespace gnomon::stability {

namespace {

Point direction(SteadyRandom& random) {
  Point d{};
  for (float& x : d) x = static_cast<float>(random.between(-1, 1));
  return d;
}

// A place may be the ray's own start.
Ray valid(Ray ray) {
  const float* const d = ray.direction;
  if (std::max({std::fabs(d[0]), std::fabs(d[1]), std::fabs(d[2])}) < GN_SHORTEST_DIRECTION)
    ray.direction[1] = 1.0F;
  return ray;
}

}  // namespace

Ray RaySource::draw(std::uint64_t number, SoakPart& part) const {
  SteadyRandom random(seed_, number);
  const std::uint64_t bundle = number / kBundle;
  if (bundle % 4 == 3) return in_bundle(bundle / 4, random, part);
  switch (number % 8) {
    case 0:
    case 1:
      return at_place(0, number % 16 < 8, random, part);
    case 2:
    case 3:
      return at_place(1, number % 16 < 8, random, part);
    case 4:
      return along_axes(random);
    case 5:
      return from_surface(random);
    default:
      return anywhere(random);
  }
}

Point RaySource::target(std::uint32_t kind, SteadyRandom& random) const {
  return place_on(triangles_[random.below(static_cast<unsigned>(triangles_.size()))], kind, random);
}

Point RaySource::in_bounds(SteadyRandom& random) const {
  Point p{};
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = static_cast<float>(random.between(extent_.lo[k] - 0.2 * size_, extent_.hi[k] + 0.2 * size_));
  }
  return p;
}

// Half of them start so that the direction is exact, the others anywhere.
Ray RaySource::at_place(std::uint32_t kind, bool exactly, SteadyRandom& random, SoakPart& part) const {
  const Point place = target(kind, random);
  Ray ray = exactly ? through(place, 0.5F * size_, random) : towards(in_bounds(random), place);
  (kind == 0 ? part.at_corners : part.at_edges) += 1;
  if (passes_exactly(ray, place)) part.exactly += 1;
  return valid(ray);
}

// Rays that run together: from a point to corners and edges of triangles side by side, from these to a point,
// or parallel. All of a bundle draw its course from the bundle's number.
Ray RaySource::in_bundle(std::uint64_t bundle, SteadyRandom& random, SoakPart& part) const {
  SteadyRandom course(~seed_, bundle);
  const std::size_t first = course.below(static_cast<unsigned>(triangles_.size()));
  const Point focus = corner(triangles_[first], 0);
  const Point eye = in_bounds(course);
  const std::uint32_t kind = random.below(2);
  const Point place = place_on(triangles_[(first + random.below(6)) % triangles_.size()], kind, random);
  if (bundle % 3 == 1) {  // shadow rays
    Ray ray = towards(place, eye);
    ray.tmin = 0x1p-12F;
    ray.tmax = 1.0F;
    return valid(ray);
  }
  Ray ray = towards(eye, place);
  if (bundle % 3 == 2) {
    ray = towards(eye, focus);
    for (std::size_t k = 0; k < 3; ++k) ray.origin[k] = place[k] - ray.direction[k];
  }
  (kind == 0 ? part.at_corners : part.at_edges) += 1;
  if (passes_exactly(ray, place)) part.exactly += 1;
  return valid(ray);
}

// Along an axis, or in the plane of two, through a corner: in faces of boxes.
Ray RaySource::along_axes(SteadyRandom& random) const {
  const Point place = target(0, random);
  const std::size_t axis = random.below(3);
  const float zero = random.chance(0.5) ? 0.0F : -0.0F;
  Point along{zero, zero, zero};
  along[axis] = random.chance(0.5) ? 1.0F : -1.0F;
  if (random.chance(0.5)) along[(axis + 1) % 3] = static_cast<float>(random.between(-1, 1));
  Point from = place;
  for (std::size_t k = 0; k < 3; ++k) from[k] -= along[k] == 0.0F ? 0.0F : size_ * along[k];
  return ray_of(from, along);
}

Ray RaySource::from_surface(SteadyRandom& random) const {
  const Point from = target(random.below(3), random);
  return valid(ray_of(from, direction(random)));
}

Ray RaySource::anywhere(SteadyRandom& random) const {
  Ray ray = ray_of(in_bounds(random), direction(random));
  if (random.chance(0.25)) ray.tmax = static_cast<float>(random.between(0, 0.5)) * size_;
  return valid(ray);
}

}  // namespace gnomon::stability
