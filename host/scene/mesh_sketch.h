// A pencil for procedural scenes: materials, simple shapes, cameras and lights collected into a Scene. Works
// in double precision and rounds once, per corner. Not for reading or editing scenes. Feeds the generators.
#pragma once

#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gnomon/scene/scene.h"
#include "gnomon/scene/steady_random.h"

namespace gnomon {

using Point = glm::dvec3;
using MaterialId = std::uint32_t;

[[nodiscard]] Vec3 to_vec3(const Point& point);

// A right-handed orthonormal frame; y is "up" for every shape below.
struct Frame {
  Point origin{0.0};
  Point x{1.0, 0.0, 0.0};
  Point y{0.0, 1.0, 0.0};
  Point z{0.0, 0.0, 1.0};
  [[nodiscard]] Point at(double a, double b, double c) const { return origin + a * x + b * y + c * z; }
  [[nodiscard]] Frame moved(double a, double b, double c) const { return {at(a, b, c), x, y, z}; }
};
// Standing at `origin`, turned about the vertical (full turns, counter-clockwise from above).
[[nodiscard]] Frame upright(const Point& origin, double turns = 0.0);
// Origin at `from`, y towards `to`. The points must differ.
[[nodiscard]] Frame aimed(const Point& from, const Point& to);

enum class Rim { kOpen, kClosed };

class MeshSketch {
 public:
  MeshSketch(std::string_view name, std::uint64_t expected_triangles);

  [[nodiscard]] MaterialId material(std::string name, const Vec3& color, float roughness = 1.0F,
                                    const Vec3& emission = {0.0F, 0.0F, 0.0F});
  // The material of everything drawn from here on.
  void use(MaterialId id) { current_ = id; }
  [[nodiscard]] std::uint64_t count() const { return scene_.triangles.size(); }

  // Corners counter-clockwise seen from the front. Triangles that rounding makes flat are left out.
  void triangle(const Vec3& a, const Vec3& b, const Vec3& c);
  void triangle(const Point& a, const Point& b, const Point& c) {
    triangle(to_vec3(a), to_vec3(b), to_vec3(c));
  }
  void quad(const Point& a, const Point& b, const Point& c, const Point& d);

  // A grid of nu x nv quads over at(i, j); the front faces di x dj. A closed rim joins i = nu to i = 0.
  template <class At>
  void sheet(unsigned nu, unsigned nv, At&& at, Rim rim = Rim::kOpen);

  // Solids, faces outwards. Box: 12 triangles between two opposite corners given in the frame.
  void box(const Frame& frame, const Point& lo, const Point& hi);
  // Turned about the frame's y: (radius, height) from bottom to top.
  void lathe(const Frame& frame, std::span<const glm::dvec2> profile, unsigned sides);
  void ellipsoid(const Frame& frame, const Point& radii, unsigned sides, unsigned rings);
  // A round bar along a path, open at both ends unless its radius is 0 there.
  void tube(std::span<const Point> path, std::span<const double> radii, unsigned sides);
  void bar(const Point& from, const Point& to, double radius, unsigned sides);
  // A cone with round ends; about as many triangles as an ellipsoid of these sides and rings.
  void limb(const Point& from, const Point& to, double radius_from, double radius_to, unsigned sides,
            unsigned rings);

  void camera(std::string name, const Point& eye, const Point& target, double fov_y,
              double aspect = 16.0 / 9.0);
  void sun(const Point& travels, const Vec3& irradiance);
  void point_light(std::string name, const Point& position, const Vec3& intensity);
  void spot_light(std::string name, const Point& position, const Point& target, const Vec3& intensity,
                  double outer_cone);

  // The scene, with one area light per emissive material that has triangles. The sketch is empty afterwards.
  [[nodiscard]] Scene finish();

 private:
  Scene scene_;
  MaterialId current_ = 0;
};

// An even share of what is left of a budget: `goal` triangles in all, `objects` still to be drawn.
[[nodiscard]] double share_of(const MeshSketch& sketch, std::uint64_t goal, std::uint64_t objects);
// The nearest whole number, at least `least`.
[[nodiscard]] unsigned at_least(unsigned least, double wanted);

template <class At>
void MeshSketch::sheet(unsigned nu, unsigned nv, At&& at, Rim rim) {
  const unsigned columns = rim == Rim::kClosed ? nu : nu + 1;
  std::vector<Vec3> below(columns);
  std::vector<Vec3> above(columns);
  for (unsigned j = 0; j <= nv; ++j) {
    std::swap(below, above);
    for (unsigned i = 0; i < columns; ++i) above[i] = to_vec3(at(i, j));
    if (j == 0) continue;
    for (unsigned i = 0; i < nu; ++i) {
      const unsigned next = i + 1 < columns ? i + 1 : 0;
      triangle(below[i], below[next], above[next]);
      triangle(below[i], above[next], above[i]);
    }
  }
}

}  // namespace gnomon
