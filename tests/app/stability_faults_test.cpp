// Faults planted in the kernels, one at a time: each is caught by the case named, through the flavour that
// has the fault.
#include <catch2/catch.hpp>

#include "broken_kernels.h"

using program::BrokenKernels;
using program::Edit;
using program::run;

namespace {

struct Plant {
  const char* what;
  const char* cases;
  const char* flavour;
  std::vector<Edit> edits;
};

const char* const kRay = "shared/ray_math.h";
const char* const kHit = "shared/hit_math.h";
const char* const kLeaf = "wide_leaf.h";
const char* const kWide = "wide_walk.h";
const char* const kCompact = "trace_compact.cl";

const std::vector<Plant>& plants() {
  static const std::vector<Plant> all{
      {"a box test that loses to NaN",
       "7",
       "thread",
       {{kRay, "near = gn_max(a, near);", "near = gn_max(near, a);"}}},
      {"a wide box test that loses to NaN",
       "7",
       "wide",
       {{kWide, "far = GN_MIN8(far_y, far);", "far = GN_MIN8(far, far_y);"},
        {kWide, "near = GN_MAX8(near_y, near);", "near = GN_MAX8(near, near_y);"}}},
      {"an edge test that trusts floats",
       "22",
       "thread",
       {{kHit, "#define GN_EDGE_ERROR_8 2.9802322e-07f", "#define GN_EDGE_ERROR_8 0.0f"},
        {kHit, "#define GN_EDGE_UNDERFLOW 1e-36f", "#define GN_EDGE_UNDERFLOW 0.0f"}}},
      {"an edge test that trusts doubles",
       "22",
       "thread",
       {{kHit, "return gn_exact_edge_sign(ray->direction, ray->origin, a, b);",
         "return gn_wide_sign(value);"}}},
      {"an edge test whose products and differences are contracted",  // the split of a product is none then
       "22,24",
       "thread",
       {{"shared/exact_math.h", "high = c - (c - products[i]);",
         "high = fma(products[i], 134217729.0, -fma(products[i], 134217729.0, -products[i]));"},
        {"shared/exact_math.h", "    const double c = products[i] * 134217729.0;", "    "}}},
      {"a distance that trusts doubles",
       "25",
       "thread",
       {{kHit, "return doubtful ||", "return doubtful &&"}}},
      {"boxes without slack",
       "22",
       "thread",
       {{kRay, "#define GN_SLAB_SLACK 1.9073486e-06f", "#define GN_SLAB_SLACK 0.0f"}}},
      {"boxes behind a negative tmin without their margin",
       "22,24,30",
       "wide",
       {{kLeaf, "ray->tmin < 0.0f ? -4.0f * GN_SLAB_SLACK * ray->tmin : 0.0f", "0.0f"}}},
      {"an end of the range that does not count",
       "12",
       "thread",
       {{"walk.h", "hit.t <= ray->tmax", "hit.t < ray->tmax"}}},
      {"a start of the range that does not count",
       "12",
       "wide",
       {{kLeaf, "hit.t >= ray->tmin && ", "hit.t > ray->tmin && "}}},
      {"the last of equally near triangles",
       "27",
       "thread",
       {{kHit, "hit->primitive < best->primitive", "hit->primitive > best->primitive"}}},
      {"directions whose reciprocals overflow",
       "14",
       "thread",
       {{kRay, "longest >= GN_SHORTEST_DIRECTION", "longest > 0.0f"}}},
      {"reciprocals of denormal components",
       "16",
       "thread",
       {{kRay, "magnitude != 0u && magnitude < 0x00800000u", "0"}}},
      {"distances that overflow",
       "32",
       "wide",
       {{kLeaf, "const int known = farthest - nearest < INFINITY;", "const int known = 1;"},
        {kLeaf, "(u * share * az + v * share * bz + w * share * cz)",
         "((u * az + v * bz + w * cz) * share)"}}},
      {"a stack of eight nodes, what is above lost",
       "30",
       "thread",
       {{"walk.h", "if (far_entry < INFINITY) {", "if (far_entry < INFINITY && height < 8u) {"}}},
      {"a stack of 32 nodes where 33 wait",
       "30",
       "thread",
       {{"walk.h", "if (far_entry < INFINITY) {", "if (far_entry < INFINITY && height < 32u) {"}}},
      {"bounds that small work-groups leave unset",
       "61",
       "thread",
       {{"group.h", "k < 6u; k += GN_WGS) keys[k]", "k < 6u; k += 64u) keys[k]"}}},
      {"a wide stack of six nodes, what is above lost",
       "28,30",
       "wide",
       {{kWide, "take_next(walker, batch, height + count);",
         "take_next(walker, batch, min(height + count, 6u));"}}},
      {"a wide node's last child forgotten",
       "17",
       "wide",
       {{kWide, "take_next(walker, batch, height + count);",
         "take_next(walker, batch, height + (count > 1u ? count - 1u : count));"}}},
      {"boxes taken for beyond a hit that they begin before",
       "21",
       "wide",
       {{"eight.h", "as_int(limit) : 0)", "as_int(0.5f * limit) : 0)"}}},
      {"lanes behind a block's last triangle", "1", "wide", {{kLeaf, " & (255u >> (8u - count));", ";"}}},
      {"a compact node's group that forgets its last node",
       "17",
       "compact",
       {{kCompact, "if (visits != 0u) {", "if ((visits & (visits - 1u)) != 0u) {"}}},
      {"a compact box rounded inwards",
       "22",
       "compact",
       {{"shared/compact_math.h", "while (step < 255u &&", "while (step < 0u &&"}}},
      {"an area's exit that is too far",
       "49",
       "thread",
       {{"shared/area_math.h", "#define GN_AREA_SHORTER 9.9999905e-01f", "#define GN_AREA_SHORTER 1.001f"}}},
      {"a measure that is a last bit off",
       "41",
       "thread",
       {{"shared/elementary_math.h", "r = r * (1.5f - half_x * r * r);",
         "r = r * (1.5f - half_x * (r * r));"}}},
  };
  return all;
}

}  // namespace

TEST_CASE("every planted fault is caught") {
  for (const Plant& plant : plants()) {
    const BrokenKernels broken(plant.edits);
    const auto outcome = run({"stability", "--only", plant.cases, "--rays-per-case", "256", "--builder",
                              "balanced", "--flavour", plant.flavour, "-q"},
                             broken.setup());
    CAPTURE(plant.what, plant.cases, plant.flavour, outcome.out, outcome.err);
    // 1000 and more: a signal, which a stack that is too small may end in.
    CHECK((outcome.status == 6 || outcome.status > 1000));
  }
}
