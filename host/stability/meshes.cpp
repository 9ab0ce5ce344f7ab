#include "gnomon/stability/meshes.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace gnomon::stability {

namespace {

float between(SteadyRandom& random, double low, double high) {
  return static_cast<float>(random.between(low, high));
}

// n x n cells of two triangles each; at(i, j) is the corner of cell (i, j).
void add_cells(std::uint32_t n, const std::function<Point(std::uint32_t, std::uint32_t)>& at,
               Triangles& out) {
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      out.push_back(triangle_of(at(i, j), at(i, j + 1), at(i + 1, j + 1)));
      out.push_back(triangle_of(at(i, j), at(i + 1, j + 1), at(i + 1, j)));
    }
  }
}

}  // namespace

Triangle triangle_of(const Point& a, const Point& b, const Point& c) {
  Triangle t{};
  std::copy(a.begin(), a.end(), t.v0);
  std::copy(b.begin(), b.end(), t.v1);
  std::copy(c.begin(), c.end(), t.v2);
  return t;
}

Point corner(const Triangle& t, std::uint32_t which) {
  const float* const v = which == 0 ? t.v0 : which == 1 ? t.v1 : t.v2;
  return {v[0], v[1], v[2]};
}

Triangles hill(std::uint32_t n, std::uint32_t relief, std::uint64_t seed) {
  SteadyRandom random(seed);
  std::vector<float> heights((n + 1) * (n + 1));
  for (float& h : heights) h = 2.0F * static_cast<float>(random.below(relief + 1));
  Triangles out;
  add_cells(
      n,
      [&](std::uint32_t i, std::uint32_t j) {
        return Point{2.0F * static_cast<float>(i), heights[i * (n + 1) + j], 2.0F * static_cast<float>(j)};
      },
      out);
  return out;
}

Triangles cube_shell(std::uint32_t n) {
  Triangles out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const std::uint32_t side : {0U, n}) {
      add_cells(
          n,
          [&](std::uint32_t i, std::uint32_t j) {
            Point p{};
            p[axis] = 2.0F * static_cast<float>(side);
            p[(axis + 1) % 3] = 2.0F * static_cast<float>(i);
            p[(axis + 2) % 3] = 2.0F * static_cast<float>(j);
            return p;
          },
          out);
    }
  }
  return out;
}

Triangles t_junctions(std::uint32_t n) {
  Triangles out;
  const auto at = [](std::uint32_t x, std::uint32_t z) {
    return Point{static_cast<float>(x), 0.0F, static_cast<float>(z)};
  };
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t x = 4 * i;
      const std::uint32_t z = 4 * j;
      const std::uint32_t size = i % 2 == 0 ? 4 : 2;
      for (std::uint32_t a = 0; a < 4; a += size) {
        for (std::uint32_t b = 0; b < 4; b += size) {
          out.push_back(
              triangle_of(at(x + a, z + b), at(x + a, z + b + size), at(x + a + size, z + b + size)));
          out.push_back(
              triangle_of(at(x + a, z + b), at(x + a + size, z + b + size), at(x + a + size, z + b)));
        }
      }
    }
  }
  return out;
}

Triangles soup(std::uint32_t count, float size, float low, float side, std::uint64_t seed) {
  SteadyRandom random(seed);
  Triangles out(count);
  for (Triangle& t : out) {
    Point centre{};
    for (float& x : centre) x = low + between(random, 0.0, side);
    for (float* v : {t.v0, t.v1, t.v2}) {
      for (std::size_t k = 0; k < 3; ++k) v[k] = centre[k] + between(random, -size, size);
    }
  }
  return out;
}

Triangles slivers(std::uint32_t count, float length, float width, std::uint64_t seed) {
  SteadyRandom random(seed);
  Triangles out(count);
  for (Triangle& t : out) {
    Point along{};
    Point across{};
    for (std::size_t k = 0; k < 3; ++k) {
      t.v0[k] = between(random, 0.0, 10.0);
      along[k] = between(random, -1.0, 1.0);
      across[k] = between(random, -1.0, 1.0);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      t.v1[k] = t.v0[k] + length * along[k];
      t.v2[k] = t.v0[k] + 0.5F * length * along[k] + width * across[k];
    }
  }
  return out;
}

Triangles flat_triangles(std::uint32_t count, std::uint64_t seed) {
  SteadyRandom random(seed);
  Triangles out;
  for (std::uint32_t i = 0; i < count; ++i) {
    Point a{};
    Point step{};
    for (std::size_t k = 0; k < 3; ++k) {
      a[k] = static_cast<float>(random.below(16));
      step[k] = i % 3 == 0 ? 0.0F : static_cast<float>(random.below(5)) - 2.0F;
    }
    const Point b{a[0] + step[0], a[1] + step[1], a[2] + step[2]};
    const Point c{a[0] + 3 * step[0], a[1] + 3 * step[1], a[2] + 3 * step[2]};
    out.push_back(triangle_of(a, b, c));
  }
  return out;
}

Triangles scaled(Triangles triangles, int power_of_two) {
  for (Triangle& t : triangles) {
    for (float* v : {t.v0, t.v1, t.v2}) {
      for (std::size_t k = 0; k < 3; ++k) v[k] = std::ldexp(v[k], power_of_two);
    }
  }
  return triangles;
}

void append(Triangles& to, const Triangles& more) {
  to.insert(to.end(), more.begin(), more.end());
}

}  // namespace gnomon::stability
