// Shapes on which tracers and builders go wrong. Corners are on lattices of small whole numbers where rays
// must be aimed exactly: differences of such numbers are exact in float. Seeded. Feeds the cases.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "gnomon/scene/steady_random.h"
#include "gnomon/tree/oracle.h"

namespace gnomon::stability {

using Point = std::array<float, 3>;
using Triangles = std::vector<Triangle>;

[[nodiscard]] Triangle triangle_of(const Point& a, const Point& b, const Point& c);
[[nodiscard]] Point corner(const Triangle& triangle, std::uint32_t which);

// A field of n x n cells of two triangles over x and z from 0 to 2n, heights whole even numbers from 0 to 2 *
// relief: corners and middles of edges are on the lattice.
[[nodiscard]] Triangles hill(std::uint32_t n, std::uint32_t relief, std::uint64_t seed);

// The surface of the cube from 0 to 2n, each face of n x n cells.
[[nodiscard]] Triangles cube_shell(std::uint32_t n);

// Strips of large triangles beside strips of small ones in the plane y = 0: a corner of the small ones lies
// in the middle of each large one's edge. x and z from 0 to 4n.
[[nodiscard]] Triangles t_junctions(std::uint32_t n);

// Triangles of edges about `size` in the cube from `low` to `low + side` on every axis.
[[nodiscard]] Triangles soup(std::uint32_t count, float size, float low, float side, std::uint64_t seed);

// Triangles `length` long and `width` wide, turned all ways, in the cube from 0 to 10.
[[nodiscard]] Triangles slivers(std::uint32_t count, float length, float width, std::uint64_t seed);

// Corners in one line or in one place.
[[nodiscard]] Triangles flat_triangles(std::uint32_t count, std::uint64_t seed);

[[nodiscard]] Triangles scaled(Triangles triangles, int power_of_two);
void append(Triangles& to, const Triangles& more);

}  // namespace gnomon::stability
