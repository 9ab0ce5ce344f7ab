// The methods that a comparison enters, and what one must be able to do. A new way to build trees or to trace
// them is added in own_methods.cpp, in one place: charts, rows and words then show it by themselves. Another
// library's come from the caller as more Methods. Feeds run_device.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gnomon/areas/influence_area.h"
#include "gnomon/areas/ray_measure.h"
#include "gnomon/compare/batch.h"
#include "gnomon/compare/report.h"
#include "gnomon/plan/choose.h"
#include "gnomon/tree/bvh.h"

namespace gnomon::compare {

// Closest and any hits of a batch, in its order.
struct Answers {
  std::vector<Hit> hits;
  std::vector<std::uint32_t> occluded;
};

// Means over a batch, each ray traced by itself.
struct Work {
  double boxes_per_ray = 0.0;
  double triangles_per_ray = 0.0;
};

// One method at work on one device and scene. Calls throw Error as builders and tracers do.
class Entrant {
 public:
  virtual ~Entrant() = default;
  // Timed. From triangles in host memory until trace() may be called; in place of what was built before.
  virtual void build(const Progress& progress) = 0;
  // Timed. Answers stay where the method leaves them.
  virtual void trace(const Batch& batch) = 0;
  [[nodiscard]] virtual Answers answers(const Batch& batch) = 0;
  [[nodiscard]] virtual std::vector<Hit> closest(std::span<const Ray> rays) = 0;
  // All but the method's name and the rounds. After build().
  [[nodiscard]] virtual BuildRow facts() = 0;
  // Nothing from methods that do not count.
  [[nodiscard]] virtual std::optional<Work> work(const Batch&) { return std::nullopt; }
  // Boxes that each ray tests, in order; empty from methods that do not count.
  [[nodiscard]] virtual std::vector<float> boxes(std::span<const Ray>) { return {}; }
  // The binary tree as last built, until forget_tree(); nothing from methods without one.
  [[nodiscard]] virtual const Bvh* tree() { return nullptr; }
  [[nodiscard]] virtual const DeviceBvh* device_tree() { return nullptr; }
  virtual void forget_tree() {}
  // What the last build chose, kind by kind; empty for methods that choose nothing.
  [[nodiscard]] virtual std::vector<DecisionRow> decisions() { return {}; }
  // What the method's heuristic expects a ray to cost in that tree; nothing where it expects nothing.
  [[nodiscard]] virtual std::optional<double> predicted_cost(const Bvh&) { return std::nullopt; }
};

struct Method {
  MethodFacts facts;
  std::function<std::unique_ptr<Entrant>()> enter;
  double builds =
      1.0;  // of kBaseline that its build may take as long as: where time is short it is left out for that
};

// The name of the method that others are set beside.
inline constexpr const char* kBaseline = "sah-balanced";

// Rays that a tree may be for.
struct RaysOf {
  std::string name;     // "light 0", "the camera"
  std::string options;  // that say so to `gnomon build`
  InfluenceArea area;
  RayMeasure measure;
};
// Of the lights of the scene that have an area; rays are even over its window or its directions.
[[nodiscard]] std::vector<RaysOf> rays_of_lights(const Scene& scene);
[[nodiscard]] std::optional<RaysOf> first_light(const Scene& scene);
// Of the scene's first camera; nothing for a scene without a triangle.
[[nodiscard]] std::optional<RaysOf> first_camera(const Scene& scene);

// What makes plans (gnomon/plan/choose.h): for which kinds of rays, and how trees are built.
struct PlanSource {
  std::vector<std::string> kinds;
  std::uint64_t seed = 1;  // plans are fitted to rays of seed + 1 and judged by those of seed + 2
  PlanBuilder builder = reference_builder();
};
// Rays that a tree must repay itself over: 64 a pixel of 512 x 512.
inline constexpr double kPlannedRays = 16'777'216.0;

// Ours, kBaseline first; the first kFirstMethods are those that matter most, and the last those that take
// longest to enter. Context and scene must outlive them.
inline constexpr int kFirstMethods = 3;
[[nodiscard]] std::vector<Method> own_methods(const cl::Context& context, const Scene& scene,
                                              const PlanSource& plan);

// For the rays of one light or camera: "pah", by their projected areas; "pah+sah", half and half with surface
// area; "auto", what a plan for them keeps. Context and scene must outlive them.
[[nodiscard]] std::vector<Method> methods_for(const cl::Context& context, const Scene& scene,
                                              const RaysOf& rays, const PlanBuilder& builder);

}  // namespace gnomon::compare
