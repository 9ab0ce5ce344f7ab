// A grid of pixels walked along the Morton curve: rays next to each other in a batch are near each other in
// the picture. Feeds ray_set.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "gnomon/scene/steady_random.h"

namespace gnomon {

struct GridSize {
  std::uint64_t width;
  std::uint64_t height;
};

// The smallest grid of nearly square cells that has at least `count` cells in a picture of this aspect.
[[nodiscard]] inline GridSize grid_for(std::uint64_t count, double aspect) {
  const auto most = static_cast<double>(std::max<std::uint64_t>(count, 1));
  const double wanted = std::clamp(std::sqrt(most * aspect), 1.0, most);
  const auto width = static_cast<std::uint64_t>(wanted + 0.5);
  return {width, (count + width - 1) / width};
}

// Calls visit(x, y) for the cells of a square of side `size` (a power of two) that lie in the grid, Morton
// order.
template <class Visit>
void walk_morton(const GridSize& grid, std::uint64_t x, std::uint64_t y, std::uint64_t size, Visit& visit) {
  if (x >= grid.width || y >= grid.height) return;
  if (size == 1) return visit(x, y);
  const std::uint64_t half = size / 2;
  walk_morton(grid, x, y, half, visit);
  walk_morton(grid, x + half, y, half, visit);
  walk_morton(grid, x, y + half, half, visit);
  walk_morton(grid, x + half, y + half, half, visit);
}

// Calls visit(u, v) exactly `count` times, in Morton order over distinct cells, with a seeded point in each
// cell as shares of the picture: u to the right, v downwards, both in [0, 1). Where the grid has a few cells
// more than asked for, those left out are spread evenly.
template <class Visit>
void for_each_cell(std::uint64_t count, double aspect, std::uint64_t seed, const Visit& visit) {
  if (count == 0) return;
  const GridSize grid = grid_for(count, aspect);
  const std::uint64_t cells = grid.width * grid.height;
  std::uint64_t size = 1;
  while (size < std::max(grid.width, grid.height)) size *= 2;
  std::uint64_t excess = 0;
  const auto visit_cell = [&](std::uint64_t x, std::uint64_t y) {
    excess += count;  // Bresenham's count: a cell is taken each time the sum passes the number of cells
    if (excess < cells) return;
    excess -= cells;
    SteadyRandom random(seed, y * grid.width + x);
    const double u = (static_cast<double>(x) + random.unit()) / static_cast<double>(grid.width);
    visit(u, (static_cast<double>(y) + random.unit()) / static_cast<double>(grid.height));
  };
  walk_morton(grid, 0, 0, size, visit_cell);
}

}  // namespace gnomon
