// Which tree a scene's rays need, and no more than that: candidates fitted to sampled rays beside the best
// surface-area tree, judged by other rays, kept only where they pay (host/notes/ray-aware.md). Not for making
// rays. Feeds `gnomon plan`, benches.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gnomon/areas/influence_area.h"
#include "gnomon/base/progress.h"
#include "gnomon/plan/optimise_for_rays.h"
#include "gnomon/plan/race.h"
#include "gnomon/plan/ray_sample.h"
#include "gnomon/tree/build_options.h"
#include "gnomon/tree/optimise.h"

namespace gnomon {

// Rays of one kind that a scene will see.
struct PlanRays {
  std::string name;
  Query query = Query::kClosest;
  std::vector<Ray> fit;    // trees are fitted to these
  std::vector<Ray> probe;  // and judged by these: drawn apart, with another seed
  double expected = 0.0;   // rays of this kind that will be traced; >= 0
  // Neighbours in a batch run through one point or one way, as in a picture: tracers may take them together.
  bool together = false;
  // Where they may run together, if that is known: lights' influence areas, say. For local trees.
  std::vector<InfluenceArea> regions{};
};

// What work costs beside a box test of a device's tracer, in whose units plans reckon. Defaults are rounded
// down from the clock of this library (bench/plan_price_bench): such a unit takes 6 ns on one thread.
struct PlanPrices {
  double build_start = 50'000.0;  // of the balanced builder, whatever the scene
  double build = 38.0;            // and a triangle
  double move_start = 120'000.0;  // of reinsertion by areas, until passes end
  double move = 40.0;
  double move_seen = 3'000.0;  // of reinsertion by what areas see, a triangle: measures of points are long
  double move_segments = 3'000.0;  // of reinsertion by all sampled segments, a triangle
  double finish = 5.0;             // of joining leaves, a triangle
  double divide = 10.0;            // of triangles into parts, a part
  double turn = 9.0;   // of putting triangles in a frame, three of which are looked at, a triangle
  double learn = 9.0;  // of learning an order of children, a triangle, beside its rays
  double trace = 3.0;  // of a box test of a plan's own: probes and samples are traced by the reference
  double byte = 0.05;  // of a tree that is held beside the baseline
  // What a unit less is worth where rays to come are traced: a device takes 2 to 3 ns for one by now, and
  // what counts save is not all saved in time (bench/results/ray-aware-time.md).
  double saved = 0.2;
};

// More than the best builder takes: what stands last should be hard to beat.
[[nodiscard]] OptimiseOptions thorough();

struct PlanOptions {
  std::string choice = "auto";   // or the name of one of candidate_names(), which is then kept without a test
  std::uint32_t fit_rays = 512;  // 1..kMostSegments
  std::uint32_t probe_rays = 1024;        // at most; 1..65536
  float mixture_share = 0.9F;             // of the rays' own measure beside surface area; [0, 1]
  float every_share = 0.99F;              // the same for Query::kEvery, whose cost that measure is
  float prior_share = 0.25F;              // SampleMeasure's
  OptimiseOptions optimise = thorough();  // passes by areas, the baseline's too; the plan sets face_weights
  SampledOptions sampled;                 // moves by sampled rays; most_work is cut to sample_share
  // Of the baseline's build, at most: moves by sampled rays; probes, beyond the least there must be. >= 0.
  double sample_share = 0.4;
  double probe_share = 0.2;
  RaceOptions race;
  PlanPrices prices;
  std::uint64_t seed = 1;  // of the order in which probes run
  // Trees whose boxes stand along the rays may be kept (gnomon/tree/box_frame.h): only for callers whose
  // tracer is wide, packet or trace_reference, and who keep trees in no file.
  bool light_space = false;
  // Such a tree is made where rays are at least so oblique to the world's axes (light_space.h), and where
  // they see no more than so much of the baseline's boxes, put in the frame, beside these boxes as they are.
  double least_oblique = 1.3;
  double most_framed = 0.95;
  double most_framed_every = 1.1;  // the same for Query::kEvery, whose cost that is
  // For others a few probes are traced through the baseline put in the frame, too: they may cost at most so
  // much of what they cost in it as it is.
  double most_framed_cost = 0.9;
  // What a ray's work in such a tree is worth, in work of other trees, where time is saved by it and not by
  // counts alone (Query::kEvery): rays in packets part sooner there. 1.1 to 1.6 measured
  // (host/notes/light-space.md).
  double framed_work = 1.4;
  // The tracer takes rays that run together in packets, which meet what any of their rays meets: of what a
  // fitted tree saves each ray little is left. So much their work in such a tree is worth, in work of the
  // baseline: 1.1 to 1.4 measured (host/notes/ray-aware.md).
  bool packets = false;
  double packet_work = 1.3;
  // Trees of part of the triangles beside one of all may be kept (OrderedTree::local): only for callers whose
  // tracer is wide, packet or trace_ordered, and who keep trees in no file. A region may hold so much of the
  // triangles.
  bool local_trees = false;
  double most_local = 0.5;
  bool keep_tried = false;  // Plan::trees has every candidate that was made, not only what is kept

  // Throws Error{kInvalidArgument} naming the option, its value and its range.
  void check() const;
};

// "sah": three axes, by surface area, reinsertion by surface area, near child first: the baseline.
// "best": the same over parts of those triangles that waste much (build_options.h, kBest), where any do: the
// baseline of "auto" there. "best-order", "best-rays": of that, as follows.
// "sah-order": the same tree, any-hit children in the order learnt from the rays.
// "sah-rays": reinsertion goes on by sampled rays.
// "sah-segments": the same, many moves at once, where trees are built: by a device, if that is one.
// "sah-mix": reinsertion goes on by the mixture of surface area and the rays' own measure.
// "sah-seen": reinsertion goes on by what the bundles and pencils that detect finds in the rays see of boxes,
// less what stands behind the first thing they meet (a depth map of each); surface area for all other rays.
// "mix", "mix-rays": built by the mixture from the start, and then by sampled rays.
// "light-mix", "light-rays": as "mix" and "mix-rays", their boxes in a frame along the rays; made for
// PlanOptions::light_space alone.
// "local-rays": a tree of its own, made as "sah-rays", for rays that are whole within a region which leaves
// most triangles out; made for PlanOptions::local_trees alone. Others go through "sah-rays" (of "auto":
// through what it keeps without).
// All but "sah" and "best" have the learnt order where any hit is asked for; "sah-order" is for any hit only.
// "auto" tries "sah-rays" ("best-rays"), and for any hit "sah-order" ("best-order") where that is not kept;
// for oblique rays "light-rays" before them, and where that saves much nothing else; and "local-rays" at last
// where PlanRays::regions, or the region of rays that are all of one pencil or bundle, hold few triangles.
[[nodiscard]] const std::vector<std::string>& candidate_names();

// A tree of the plan.
struct PlanTree {
  std::string name;
  OrderedTree tree;
  double build_units = 0.0;  // more than the baseline's: what making it took
  std::uint64_t bytes = 0;   // nodes and leaf order
};

// How a candidate did.
struct Trial {
  std::string name;
  std::size_t tree = 0;  // place in Plan::trees; 0: not among them
  Standing standing;
  double fit_gain = 0.0;  // share of the inner nodes' weight on the fitted rays that is saved: optimistic
  double price = 0.0;     // units it costs beside the baseline: building, memory
  double saving = 0.0;    // units it saves over the expected rays
};

// A local tree that is kept.
struct LocalUse {
  std::size_t triangles = 0;
  double share = 0.0;  // of the rays it was fitted to, that are within its region
};

// What was decided for one kind of rays.
struct Decision {
  std::string rays;
  Query query = Query::kClosest;
  double expected = 0.0;
  std::string kept;      // a candidate's name
  std::size_t tree = 0;  // place in Plan::trees
  std::string reason;    // in words
  std::uint64_t probes = 0;
  double probe_units = 0.0;
  double baseline_cost = 0.0;  // a probe ray, units
  double cost = 0.0;           // of what is kept
  double obliquity = 1.0;      // of the rays (light_space.h)
  // What they see of the baseline's boxes in a frame along them, beside those as they are; 0: not reckoned.
  double framed_share = 0.0;
  // Regions that a tenth of the rays or more are within whole; the least share of the triangles that one
  // holds, 1 where all hold more than may be; and the local trees that are kept.
  std::size_t regions = 0;
  double least_members = 1.0;
  std::vector<LocalUse> local;
  std::vector<Trial> trials;
};

struct Plan {
  std::vector<PlanTree> trees;      // the baseline first, then those that are kept
  std::vector<Decision> decisions;  // one for each kind of rays given
  double baseline_units = 0.0;      // building the baseline
  double planning_units = 0.0;      // everything beyond that: building and probing candidates
  double kept_units = 0.0;          // of those, making the trees that are kept
};

// How the plan has trees built and reinsertion by areas done: in plain C++, or by a device, the same bytes.
struct PlanBuilder {
  std::function<Bvh(std::span<const Triangle>, const BuildOptions&)> build;
  std::function<Bvh(const Bvh&, const OptimiseOptions&)> optimise;
};
[[nodiscard]] PlanBuilder reference_builder();

// Deterministic: counts decide, not clocks. Throws Error: kInvalidArgument (options, a choice that is not
// known, no traceable ray to fit to), kBadScene, kCancelled.
[[nodiscard]] Plan make_plan(std::span<const Triangle> triangles, std::span<const PlanRays> rays,
                             const PlanOptions& options = {},
                             const PlanBuilder& builder = reference_builder(), const Progress& progress = {});

// One JSON object with every decision and its figures, as text.
[[nodiscard]] std::string to_json(const Plan& plan);

}  // namespace gnomon
