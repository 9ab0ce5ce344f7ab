// Whether planning can pay, before anything is built for it: what the rays to come will cost in the tree at
// hand against what planning will. Not for choosing among trees (choose.h). Feeds the subcommands that trace.
#pragma once

#include <cstdint>
#include <span>

#include "gnomon/plan/ray_sample.h"

namespace gnomon {

// Rays to come, all of one query.
struct RaysToCome {
  Query query = Query::kClosest;
  std::span<const Ray> some;  // that stand for all
  double expected = 0.0;      // how many there will be; >= 0
};

struct OutlookOptions {
  // Of planning, whatever the scene and a triangle: for the baseline, and for each kind of rays with drawing
  // them, uploading what is kept and weighing it against the tree at hand. In box tests as devices take them,
  // 3 ns: half a unit of PlanPrices. Rounded up from clocks of whole plans (host/notes/ray-aware.md).
  double baseline_start = 1'000'000.0;
  double baseline_price = 500.0;
  double kind_start = 4'000'000.0;
  double kind_price = 400.0;
  // What planning may take of the work to come. Where it finds nothing, a run is longer by that at most.
  double most_share = 0.05;

  // Throws Error{kInvalidArgument} naming the option, its value and its range.
  void check() const;
};

struct Outlook {
  double work = 0.0;   // of the rays to come in the tree at hand, units
  double price = 0.0;  // of planning, units
  bool pays = false;   // the price is within its share of the work
};

// Counts a few of each kind's rays in `tree`. Deterministic. Throws Error{kInvalidArgument} (options,
// expected numbers).
[[nodiscard]] Outlook outlook_of(const Bvh& tree, std::span<const Triangle> triangles,
                                 std::span<const RaysToCome> rays, const OutlookOptions& options = {});

}  // namespace gnomon
