// PAH's estimate of the all-pierced cost: within 1.5 % in the mean and 3 % at worst on rays of its own
// measure, for windows and points and for a field of view of 130 by 45 degrees (the thesis: 2 % and 12 %, 56
// % there).
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <numbers>

#include "gnomon/measure/prediction.h"
#include "gnomon/measure/reproduce.h"
#include "gnomon/scene/generators.h"
#include "gnomon/scene/import.h"
#include "gnomon/tree/build_reference.h"

using gnomon::InfluenceArea;
using gnomon::RayMeasure;
using gnomon::Vec3d;

namespace {

InfluenceArea plane(const Vec3d& point, const Vec3d& normal, double half_width, double half_height,
                    double depth) {
  gnomon::PlaneWindow window;
  window.point = point;
  window.direction = normal;
  window.half_width = half_width;
  window.half_height = half_height;
  window.depth = depth;
  return InfluenceArea::plane(window);
}

InfluenceArea point(const Vec3d& eye, const Vec3d& direction, double fov_x, double fov_y, double far) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  gnomon::PointView view;
  view.eye = eye;
  view.direction = direction;
  view.fov_x = fov_x * kDegree;
  view.fov_y = fov_y * kDegree;
  view.near_distance = 1;
  view.far_distance = far;
  return InfluenceArea::point(view);
}

struct Case {
  std::string scene;
  std::vector<InfluenceArea> areas;
};

// The thesis' areas of its random scenes and its cottage, and the wide field of view of its crowd.
std::vector<Case> cases() {
  const std::vector<InfluenceArea> random = {
      plane({5, 5, -4}, {0, 0, 1}, 5, 5, 20), plane({10, 12, -3}, {-0.55, -0.9, 1}, 6.5, 6.5, 20),
      point({5, 5, -4}, {0, 0, 1}, 90, 90, 20), point({10, 12, -3}, {-0.55, -0.9, 1}, 60, 60, 20),
      point({5, 5, -4}, {0, 0, 1}, 130, 45, 20)};
  const std::vector<InfluenceArea> cottage = {
      plane({10, 2.8, 0}, {-1, 0, 0}, 6, 2.6, 35), plane({10, 5, -8}, {-1, -0.3, 0.9}, 7, 3.3, 35),
      point({15, 2.7, 0}, {-1, 0, 0}, 70, 35, 35), point({15, 2.7, 0}, {-1, 0, 0}, 130, 45, 35)};
  return {{"random100", random}, {"random1000", random}, {"cottage.glb", cottage}};
}

gnomon::Scene scene_of(const std::string& name) {
  if (name.ends_with(".glb")) return gnomon::import_scene(std::filesystem::path(GNOMON_SCENES_FOLDER) / name);
  return gnomon::generate_scene(name, name == "random100" ? 100 : 1000, 1);
}

}  // namespace

TEST_CASE("PAH predicts the cost of its own rays within 1.5 % in the mean and 3 % at worst") {
  const auto build = [](std::span<const GnTriangle> triangles, const gnomon::BuildOptions& options) {
    return gnomon::build_reference(triangles, options);
  };
  gnomon::ReproduceOptions options;
  options.prediction_rays = 100000;  // of 0.5 % noise at worst
  options.seed = 301;
  std::map<RayMeasure, std::vector<double>> errors;
  double worst_of_others = 0.0;
  for (const Case& c : cases()) {
    const gnomon::ReproduceScene scene = gnomon::prepare_scene(scene_of(c.scene), build);
    for (std::size_t i = 0; i < c.areas.size(); ++i) {
      for (const auto& run : gnomon::check_predictions(c.areas[i], scene, options, build)) {
        const double error = gnomon::prediction_error(run.real.mean, run.predicted);
        if (run.surface || run.measure != run.rays) {
          worst_of_others = std::max(worst_of_others, error);
          continue;
        }
        CAPTURE(c.scene, i, gnomon::to_string(run.rays), run.real.mean, run.predicted);
        REQUIRE(run.real.mean > 3.0);
        REQUIRE(error <= 0.03);
        REQUIRE(std::abs(run.real.mean - run.predicted) <= 4.0 * run.real.standard_error);
        errors[run.rays].push_back(error);
      }
    }
  }
  REQUIRE(errors.size() == 4);
  for (const auto& [rays, of_rays] : errors) {
    CAPTURE(gnomon::to_string(rays));
    REQUIRE(of_rays.size() >= 6);
    REQUIRE(gnomon::mean_of(of_rays).mean <= 0.015);
  }
  REQUIRE(worst_of_others > 0.3);  // measures that are not the rays' own are off by as much
}
