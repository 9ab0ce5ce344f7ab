#include "gnomon/tree/parts.h"

#include <algorithm>
#include <utility>

#include "gnomon/tree/build_reference.h"

namespace gnomon {

namespace {

GnCut cut_of(const GnTriangle& triangle) {
  GnCut cut{};
  const float* const corners[] = {triangle.v0, triangle.v1, triangle.v2};
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) cut.corner[i][k] = gn_without_negative_zero(corners[i][k]);
  }
  return cut;
}

GnPlaneGrid grid_of(const std::vector<GnPrimitive>& boxes) {
  float lo[3];
  float hi[3];
  gn_empty_box(lo, hi);
  for (const GnPrimitive& box : boxes) {
    for (int k = 0; k < 3; ++k) {
      lo[k] = gn_min(box.lo[k], lo[k]);
      hi[k] = gn_max(box.hi[k], hi[k]);
    }
  }
  return gn_plane_grid(lo, hi);
}

// Triangles' boxes, and by what they waste which are to be divided.
struct Weighed {
  std::vector<GnPrimitive> boxes;
  std::vector<std::uint32_t> bin_of;
  GnPlaneGrid grid{};  // its floor is GN_NONE where none is
};

Weighed weigh(std::span<const GnTriangle> triangles, float budget) {
  Weighed out;
  out.boxes.reserve(triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) out.boxes.push_back(primitive_of(triangles[i], i));
  out.grid.floor = GN_NONE;
  if (triangles.empty()) return out;
  out.grid = grid_of(out.boxes);
  std::vector<std::uint32_t> bins(GN_WASTE_BINS);
  out.bin_of.reserve(triangles.size());
  for (std::uint32_t i = 0; i < out.boxes.size(); ++i) {
    const GnCut cut = cut_of(triangles[i]);
    out.bin_of.push_back(gn_waste_bin(gn_wasted_area(&cut, out.boxes[i].lo, out.boxes[i].hi)));
    bins[out.bin_of.back()] += 1;
  }
  out.grid.floor = waste_floor(bins, out.grid.units, budget);
  return out;
}

// A triangle is divided only where its box wastes so many times the scene's box over n^(2/3), about the side
// of a cell when n of them fill the scene, and triangles only where the mean one does. Below that parts cost
// what they save: a block tests eight triangles at once, however large they are.
constexpr double kLeastWaste = 0.64;

// As many primitives as builders index.
constexpr std::uint64_t kMostIndices = 0x7fffffff;

}  // namespace

std::uint64_t most_parts(std::uint64_t triangles, float budget) {
  const auto most =
      triangles + static_cast<std::uint64_t>(static_cast<double>(budget) * static_cast<double>(triangles));
  return std::max(triangles, std::min(most, kMostIndices));
}

std::uint32_t waste_floor(std::span<const std::uint32_t> bins, float units, float budget) {
  std::uint64_t triangles = 0;
  for (const std::uint32_t count : bins) triangles += count;
  const std::uint64_t most = most_parts(triangles, budget) - triangles;
  if (most == 0 || !(units > 0.0F)) return GN_NONE;
  const auto splits_from = [&](std::uint32_t floor) {
    std::uint64_t splits = 0;
    for (std::uint32_t bin = floor; bin < bins.size(); ++bin)
      splits += std::uint64_t{bins[bin]} * gn_splits_of(bin, floor);
    return splits;
  };
  const auto n = static_cast<double>(triangles);
  const auto share_of = [&](std::uint32_t bin) {
    return static_cast<double>(gn_float_of(bin << GN_WASTE_SHIFT)) * static_cast<double>(units);
  };
  const auto too_little = [&](double share) {
    return share * share * share * n * n < kLeastWaste * kLeastWaste * kLeastWaste;
  };
  double all = 0.0;
  for (std::uint32_t bin = 0; bin < bins.size(); ++bin) {
    if (bins[bin] > 0) all += bins[bin] * share_of(bin);
  }
  if (too_little(all / n)) return GN_NONE;
  // More are divided, and more often, the lower the floor is.
  std::uint32_t low = 1;
  auto high = static_cast<std::uint32_t>(bins.size());
  while (low < high) {
    const std::uint32_t middle = (low + high) / 2;
    if (too_little(share_of(middle)) || splits_from(middle) > most)
      low = middle + 1;
    else
      high = middle;
  }
  return splits_from(high) == 0 ? GN_NONE : high;
}

std::vector<GnPrimitive> parts_of(std::span<const GnTriangle> triangles, float budget) {
  Weighed weighed = weigh(triangles, budget);
  const auto& [boxes, bin_of, grid] = weighed;
  if (grid.floor == GN_NONE) return std::move(weighed.boxes);
  std::vector<GnPrimitive> out;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    const GnCut cut = cut_of(triangles[i]);
    GnPart parts[GN_MOST_PARTS];
    std::copy_n(boxes[i].lo, 3, parts[0].lo);
    std::copy_n(boxes[i].hi, 3, parts[0].hi);
    parts[0].splits = gn_splits_of(bin_of[i], grid.floor);
    std::uint32_t height = 1;
    GnPart one;
    while (gn_next_part(&grid, &cut, parts, &height, &one) != 0) {
      GnPrimitive primitive{};
      std::copy_n(one.lo, 3, primitive.lo);
      std::copy_n(one.hi, 3, primitive.hi);
      primitive.index = i;
      out.push_back(primitive);
    }
  }
  return out;
}

bool divides_any(std::span<const GnTriangle> triangles, float budget) {
  return weigh(triangles, budget).grid.floor != GN_NONE;
}

}  // namespace gnomon
