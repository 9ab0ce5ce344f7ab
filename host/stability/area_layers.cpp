#include "gnomon/stability/area_layers.h"

#include <cmath>

#include "gnomon/stability/aim.h"

namespace gnomon::stability {

namespace {

Vec3d middle_of_region(const InfluenceArea& area) {
  if (const auto* box = std::get_if<OrientedBox>(&area.region())) return box->centre;
  if (const auto* frustum = std::get_if<Frustum>(&area.region())) {
    const double half_way = 0.5 * (frustum->near_distance + frustum->far_distance);
    return frustum->frame.origin + half_way * frustum->frame.forward;
  }
  return std::get<Ball>(area.region()).centre;
}

double size_of(const InfluenceArea& area) {
  const Box3d box = area.enclosing_box();
  double size = 0.0;
  for (std::size_t k = 0; k < 3; ++k) size = std::max({size, std::fabs(box.lo[k]), std::fabs(box.hi[k])});
  return size;
}

std::vector<Plane> faces_of(const InfluenceArea& area, SteadyRandom& random) {
  std::vector<Plane> faces(area.planes().begin(), area.planes().end());
  const auto* const ball = std::get_if<Ball>(&area.region());
  for (int i = 0; ball != nullptr && i < 12; ++i) {
    const Vec3d any{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1) + 1e-3};
    const Vec3d inwards = 1.0 / std::sqrt(dot(any, any)) * any;
    faces.push_back(plane_through(ball->centre - ball->radius * inwards, inwards));
  }
  return faces;
}

}  // namespace

Triangles layers_around(const InfluenceArea& area, std::uint64_t seed) {
  SteadyRandom random(seed);
  const Vec3d inside = middle_of_region(area);
  const double size = size_of(area);
  Triangles layers;
  for (const Plane& face : faces_of(area, random)) {
    const AreaFrame frame = look_along({0, 0, 0}, face.normal, kWorldUp);
    for (int k = 6; k <= 24; ++k) {
      const Vec3d centre = inside - (signed_distance(face, inside) + std::exp2(-k) * size) * face.normal;
      const auto at = [&](double right, double up) {
        const Vec3d p = centre + size * (right * frame.right + up * frame.up);
        return Point{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
      };
      // Turned and moved, so that edges of one layer are not those of the next.
      const double a = random.between(-0.3, 0.3);
      layers.push_back(triangle_of(at(-0.5 + a, -0.4), at(0.8, -0.5 + a), at(a, 0.9)));
    }
  }
  return layers;
}

std::vector<Ray> rays_at_layers(const InfluenceArea& area, const Triangles& layers, std::uint32_t count,
                                std::uint64_t seed) {
  SteadyRandom random(seed);
  const Vec3d inside = middle_of_region(area);
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Triangle& layer = layers[random.below(static_cast<unsigned>(layers.size()))];
    Point from{};
    for (std::size_t k = 0; k < 3; ++k) from[k] = static_cast<float>(inside[k] + random.between(-1e-3, 1e-3));
    rays.push_back(towards(from, place_on(layer, i % 3, random)));
  }
  return rays;
}

}  // namespace gnomon::stability
