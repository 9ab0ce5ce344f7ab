#include "gnomon/tree/depth_map.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "gnomon/base/error.h"

namespace gnomon {

namespace {

bool is_window(const GnMeasure& measure) {
  return measure.kind == GN_MEASURE_WINDOW;
}

void require(const GnMeasure& measure, float near_depth, float far_depth) {
  const bool point = measure.kind == GN_MEASURE_SOLID_ANGLE || measure.kind == GN_MEASURE_NEAR_PLANE;
  if (!(is_window(measure) || (point && measure.culled != 0)))
    throw Error(ErrorCode::kInvalidArgument,
                "a depth map needs parallel rays or rays from a point, through a window");
  if (!(near_depth >= 0.0F && near_depth < far_depth))
    throw Error(ErrorCode::kInvalidArgument, "a depth map from " + std::to_string(near_depth) + " to " +
                                                 std::to_string(far_depth) +
                                                 ": near must be 0 or more, and below far");
  if (!is_window(measure) && !(near_depth > 0.0F))
    throw Error(ErrorCode::kInvalidArgument, "a depth map of rays from a point must not begin there");
}

// Of a cell's middle, from -1 to 1 across the window.
float middle_of(std::uint32_t cell) {
  return (2.0F * static_cast<float>(cell) + 1.0F) / static_cast<float>(GN_MAP_CELLS) - 1.0F;
}

// The deepest slice in which something as deep as this is seen. The last one is behind all that rays meet.
std::uint32_t slice_of(const GnDepthMap& shape, const Hit& hit) {
  if (hit.primitive == GN_NONE) return GN_MAP_SLICES - 1;
  const float slice = (hit.t - shape.near_depth) * shape.to_slices;
  return static_cast<std::uint32_t>(std::clamp(slice, 0.0F, static_cast<float>(GN_MAP_SLICES - 2)));
}

}  // namespace

std::vector<Ray> depth_rays(const GnMeasure& measure, float near_depth, float far_depth) {
  require(measure, near_depth, far_depth);
  std::vector<Ray> rays;
  rays.reserve(std::size_t{GN_MAP_CELLS} * GN_MAP_CELLS);
  for (std::uint32_t row = 0; row < GN_MAP_CELLS; ++row) {
    for (std::uint32_t column = 0; column < GN_MAP_CELLS; ++column) {
      const float x = middle_of(column) * measure.half_width;
      const float y = middle_of(row) * measure.half_height;
      Ray ray{};
      for (int k = 0; k < 3; ++k) {
        const float aside = x * measure.right[k] + y * measure.up[k];
        ray.origin[k] = measure.origin[k] + (is_window(measure) ? aside : 0.0F);
        ray.direction[k] = measure.forward[k] + (is_window(measure) ? 0.0F : aside);
      }
      ray.tmin = near_depth;
      ray.tmax = far_depth;
      rays.push_back(ray);
    }
  }
  return rays;
}

DepthMap depth_map_of(const GnMeasure& measure, float near_depth, float far_depth,
                      std::span<const Hit> hits) {
  require(measure, near_depth, far_depth);
  if (hits.size() != std::size_t{GN_MAP_CELLS} * GN_MAP_CELLS)
    throw Error(ErrorCode::kInvalidArgument, "a depth map of " + std::to_string(hits.size()) +
                                                 " hits: there must be one for each of depth_rays");
  // Without an end, slices go as far as anything was met.
  float end = near_depth;
  for (const Hit& hit : hits) {
    if (hit.primitive != GN_NONE) end = std::max(end, hit.t);
  }
  if (std::isfinite(far_depth)) end = std::min(end, far_depth);
  DepthMap map;
  map.shape.near_depth = near_depth;
  map.shape.to_slices = end > near_depth ? static_cast<float>(GN_MAP_SLICES - 2) / (end - near_depth) : 0.0F;
  map.shape.to_cells[0] = 0.5F * static_cast<float>(GN_MAP_CELLS) / measure.half_width;
  map.shape.to_cells[1] = 0.5F * static_cast<float>(GN_MAP_CELLS) / measure.half_height;
  map.shape.is_there = 1;
  map.sums.assign(GN_MAP_SUMS, 0);
  for (std::uint32_t slice = 0; slice < GN_MAP_SLICES; ++slice) {
    std::uint16_t* sums = map.sums.data() + std::size_t{slice} * GN_MAP_ROW * GN_MAP_ROW;
    for (std::uint32_t row = 0; row < GN_MAP_CELLS; ++row) {
      std::uint32_t before = 0;  // in this row
      for (std::uint32_t column = 0; column < GN_MAP_CELLS; ++column) {
        before += slice_of(map.shape, hits[row * GN_MAP_CELLS + column]) >= slice ? 1U : 0U;
        const std::uint32_t at = (row + 1) * GN_MAP_ROW + column + 1;
        sums[at] = static_cast<std::uint16_t>(sums[at - GN_MAP_ROW] + before);
      }
    }
  }
  return map;
}

AreaCosts area_costs(std::span<const AreaCost> areas, float root_faces, const float* root_lo,
                     const float* root_hi) {
  AreaCosts out;
  for (const AreaCost& area : areas) {
    GnAreaCost cost{};
    cost.measure = area.measure;
    cost.map = area.map.shape;
    cost.map.is_there = area.map.sums.empty() ? 0 : 1;
    cost.map.first = static_cast<std::uint32_t>(out.maps.size());
    out.maps.insert(out.maps.end(), area.map.sums.begin(), area.map.sums.end());
    const int how = gn_measure_how(&cost.measure, root_lo, root_hi);
    const float root = gn_box_measure(&cost.measure, how, root_lo, root_hi);
    cost.scale = root > 0.0F ? area.share * root_faces / root : 0.0F;
    out.areas.push_back(cost);
  }
  return out;
}

}  // namespace gnomon
