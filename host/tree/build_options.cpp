#include "gnomon/tree/build_options.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "gnomon/shared/axis_policy.h"

namespace gnomon {

namespace {

void require(bool ok, const char* option, const std::string& value, const char* range) {
  if (!ok) {
    throw Error(ErrorCode::kInvalidArgument,
                std::string("build option ") + option + " = " + value + " is outside its range " + range);
  }
}

// 0 means "the device decides" for the options that only say how to work.
void require_or_zero(std::uint32_t value, std::uint32_t low, std::uint32_t high, const char* option,
                     const char* range) {
  require(value == 0 || (value >= low && value <= high), option, std::to_string(value), range);
}

bool is_finite(const float* values, std::size_t count) {
  return std::all_of(values, values + count, [](float x) { return std::isfinite(x); });
}

void check_measure(const GnMeasure& m) {
  require(m.kind <= GN_MEASURE_CUSTOM, "measure.kind", std::to_string(m.kind), "0..5");
  require(m.area_share >= 0.0F && m.area_share <= 1.0F, "measure.area_share", std::to_string(m.area_share),
          "[0, 1]");
  const bool finite = is_finite(m.weights, 3) && is_finite(m.origin, 3) && is_finite(m.right, 3) &&
                      is_finite(m.up, 3) && is_finite(m.forward, 3) && std::isfinite(m.half_width) &&
                      std::isfinite(m.half_height) && std::isfinite(m.near_distance) &&
                      std::isfinite(m.area_scale);
  require(finite, "measure", "not finite", "of finite numbers");
  require(m.weights[0] >= 0.0F && m.weights[1] >= 0.0F && m.weights[2] >= 0.0F && m.area_scale >= 0.0F,
          "measure.weights", "negative", ">= 0");
}

void check_policy(const PublishedRules& p) {
  require(p.quality_threshold >= 0.0F && p.quality_threshold <= 1.0F, "policy.quality_threshold",
          std::to_string(p.quality_threshold), "[0, 1]");
  require(p.acceptable > 0.0F && p.acceptable <= 1e6F, "policy.acceptable", std::to_string(p.acceptable),
          "(0, 1e6]");
  require(p.excellent > 0.0F && p.excellent <= 1e6F, "policy.excellent", std::to_string(p.excellent),
          "(0, 1e6]");
  require(p.max_metric_depth <= 1000, "policy.max_metric_depth", std::to_string(p.max_metric_depth),
          "0..1000");
}

void check_leaves(const PublishedLeaves& l) {
  require(l.min_split >= 1 && l.min_split <= 255, "published_leaves.min_split", std::to_string(l.min_split),
          "1..255");
  require(l.max_depth >= 1 && l.max_depth <= 1000, "published_leaves.max_depth", std::to_string(l.max_depth),
          "1..1000");
  require(l.max_cost >= 0.0F && std::isfinite(l.max_cost), "published_leaves.max_cost",
          std::to_string(l.max_cost), ">= 0");
  require(l.max_probability >= 0.0F && l.max_probability <= 1.0F, "published_leaves.max_probability",
          std::to_string(l.max_probability), "[0, 1]");
  require(l.max_area >= 0.0F && std::isfinite(l.max_area), "published_leaves.max_area",
          std::to_string(l.max_area), ">= 0");
}

// What the fast builder cannot do is refused, not ignored.
void check_fast(const BuildOptions& options) {
  const auto refuse = [](const std::string& what) {
    throw Error(ErrorCode::kInvalidArgument,
                "builder fast divides by surface area along the Morton curve alone: it cannot heed " + what +
                    "; use builder balanced");
  };
  if (heuristic_name(options) != "sah") refuse("heuristic " + heuristic_name(options));
  if (options.published_leaves.on) refuse("published_leaves");
  if (options.median_depth != BuildOptions{}.median_depth)
    refuse("median_depth = " + std::to_string(options.median_depth));
}

// Nor here: reinsertion weighs boxes by three face weights, and divides triangles by no policy.
void check_best(const BuildOptions& options) {
  const auto refuse = [](const std::string& what) {
    throw Error(ErrorCode::kInvalidArgument,
                "builder best optimises measures of three face weights on all axes: it cannot heed " + what +
                    "; use builder balanced");
  };
  if (options.measure.kind != GN_MEASURE_LINEAR) refuse("heuristic " + heuristic_name(options));
  if (options.axes != AxisPolicy::kAll) refuse("heuristic " + heuristic_name(options));
  if (options.published_leaves.on) refuse("published_leaves");
}

}  // namespace

const char* to_string(Builder builder) {
  switch (builder) {
    case Builder::kBalanced:
      return "balanced";
    case Builder::kFast:
      return "fast";
    case Builder::kBest:
      return "best";
  }
  return "unknown";
}

const char* to_string(AxisPolicy policy) {
  switch (policy) {
    case AxisPolicy::kAll:
      return "all";
    case AxisPolicy::kSpfh:
      return "spfh";
    case AxisPolicy::kLsph:
      return "lsph";
  }
  return "unknown";
}

std::string heuristic_name(const BuildOptions& options) {
  static constexpr const char* kKinds[] = {"pah",           "pah-window", "pah-solid-angle", "pah-near-plane",
                                           "pah-yaw-pitch", "custom"};
  const GnMeasure& m = options.measure;
  const bool even = m.weights[0] == m.weights[1] && m.weights[1] == m.weights[2];
  const bool surface = (m.kind == GN_MEASURE_LINEAR && even) || m.area_share == 0.0F;
  std::string name = surface ? "sah" : kKinds[m.kind];
  if (!surface && m.area_share < 1.0F) name += "-mixed";
  if (options.axes != AxisPolicy::kAll) name += std::string("+") + to_string(options.axes);
  return name;
}

GnMeasure surface_area_measure() {
  GnMeasure measure{};
  std::fill_n(measure.weights, 3, 1.0F);
  measure.kind = GN_MEASURE_LINEAR;
  measure.area_scale = 1.0F;
  measure.area_share = 1.0F;
  return measure;
}

GnHeuristic heuristic_of(const BuildOptions& options, const float lo[3], const float hi[3]) {
  GnHeuristic h{};
  h.measure = options.measure;
  GnRules& rules = h.rules;
  rules.axes = static_cast<std::uint32_t>(options.axes);
  rules.repaired = options.policy.repaired ? 1 : 0;
  rules.from_point = options.measure.kind >= GN_MEASURE_SOLID_ANGLE || options.policy.rays_from_point ? 1 : 0;
  rules.max_metric_depth = options.policy.max_metric_depth;
  rules.quality_threshold = options.policy.quality_threshold;
  rules.acceptable = options.policy.acceptable;
  rules.excellent = options.policy.excellent;
  rules.cost_traversal = options.cost_traversal;
  rules.cost_triangle = options.cost_triangle;
  if (options.published_leaves.on) {
    rules.leaf_rule = GN_LEAF_PUBLISHED;
    rules.max_leaf_size = options.published_leaves.min_split;
    rules.median_depth = GN_NONE;
    rules.max_depth = options.published_leaves.max_depth;
    rules.max_leaf_cost = options.published_leaves.max_cost;
    rules.max_leaf_probability = options.published_leaves.max_probability;
    rules.max_leaf_area = options.published_leaves.max_area;
  } else {
    rules.leaf_rule = GN_LEAF_BY_COST;
    rules.max_leaf_size = options.max_leaf_size;
    rules.median_depth = options.median_depth;
  }
  gn_settle_heuristic(&h, lo, hi);
  return h;
}

void BuildOptions::check() const {
  require(builder == Builder::kBalanced || builder == Builder::kFast || builder == Builder::kBest, "builder",
          std::to_string(static_cast<unsigned>(builder)), "{balanced, fast, best}");
  check_measure(measure);
  require(static_cast<std::uint32_t>(axes) <= GN_AXES_LSPH, "axes",
          std::to_string(static_cast<unsigned>(axes)), "{all, spfh, lsph}");
  check_policy(policy);
  check_leaves(published_leaves);
  require(bins >= 2 && bins <= 64, "bins", std::to_string(bins), "2..64");
  require(max_leaf_size >= 1 && max_leaf_size <= 255, "max_leaf_size", std::to_string(max_leaf_size),
          "1..255");
  require(cost_traversal > 0.0F && cost_traversal <= 1000.0F, "cost_traversal",
          std::to_string(cost_traversal), "(0, 1000]");
  require(cost_triangle > 0.0F && cost_triangle <= 1000.0F, "cost_triangle", std::to_string(cost_triangle),
          "(0, 1000]");
  require(median_depth >= 1 && median_depth <= 64, "median_depth", std::to_string(median_depth), "1..64");
  require_or_zero(work_group_size, 1, 256, "work_group_size", "{0, powers of two up to 256}");
  require(work_group_size == 0 || std::has_single_bit(work_group_size), "work_group_size",
          std::to_string(work_group_size), "{0, powers of two up to 256}");
  require_or_zero(subtree_size, 32, 1048576, "subtree_size", "{0, 32..1048576}");
  require_or_zero(chunk_size, 64, 1048576, "chunk_size", "{0, 64..1048576}");
  if (builder == Builder::kFast) check_fast(*this);
  if (builder == Builder::kBest) check_best(*this);
}

}  // namespace gnomon
