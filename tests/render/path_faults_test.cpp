// Faults planted in the path tracer's kernels change the light it finds, and the checks of that see them.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "render/path_checks.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

// From here on, while it lives, kernels are read from a copy of which one text is replaced.
class BrokenKernels {
 public:
  BrokenKernels(const std::string& file, const std::string& right, const std::string& wrong)
      : folder_(std::filesystem::temp_directory_path() /
                ("gnomon-path-faults-" + std::to_string(std::rand()))) {
    std::filesystem::copy(GNOMON_KERNEL_FOLDER, folder_, std::filesystem::copy_options::recursive);
    std::ifstream in(folder_ / file);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    const auto at = text.find(right);
    CAPTURE(file, right);
    REQUIRE(at != std::string::npos);
    REQUIRE(text.find(right, at + 1) == std::string::npos);
    std::ofstream(folder_ / file) << text.replace(at, right.size(), wrong);
    setenv("GNOMON_KERNELS", folder_.c_str(), 1);
  }
  BrokenKernels(const BrokenKernels&) = delete;
  BrokenKernels& operator=(const BrokenKernels&) = delete;
  ~BrokenKernels() {
    unsetenv("GNOMON_KERNELS");
    std::filesystem::remove_all(folder_);
  }

 private:
  std::filesystem::path folder_;
};

// Bars by which the lamp's light on the floor is off where it is looked for in both ways.
double lamp_off() {
  return lamp_over_floor(PathStrategy::kBoth).bars;
}
double box_off() {
  return glowing_box(PathStrategy::kSurfaces).bars;
}

}  // namespace

TEST_CASE("without faults the checks are content") {
  CHECK(lamp_off() < 4.0);
  CHECK(box_off() < 4.0);
}

TEST_CASE("faults that change how much light there is are seen where it is known") {
  struct Plant {
    const char* what;
    const char* file;
    const char* right;
    const char* wrong;
    double (*off)();
  };
  const std::vector<Plant> plants{
      {"a cosine that is missing", "shared/bsdf_math.h", "reflected[k] = scatter->diffuse[k] * *density;",
       "reflected[k] = scatter->diffuse[k] * GN_ONE_OVER_PI;", lamp_off},
      {"a wrong density of lights", "shared/light_math.h", "return light->area * gn_abs(cosine) *",
       "return light->area *", lamp_off},
      {"a wrong density of directions", "shared/path_math.h", "factor = gn_reciprocal(path->density);",
       "factor = GN_PI;", box_off},
      {"roulette whose survivors do not stand for the dead", "shared/path_math.h",
       "path->throughput[k] = path->throughput[k] * factor;", "(void)factor;", box_off},
      {"shares that do not add up to one", "shared/path_math.h",
       "return gn_reciprocal(1.0f + ratio * ratio);", "return gn_reciprocal(1.0f + 0.5f * ratio);",
       lamp_off}};
  for (const Plant& plant : plants) {
    const BrokenKernels broken(plant.file, plant.right, plant.wrong);
    CAPTURE(plant.what);
    CHECK(plant.off() > 8.0);
  }
}

TEST_CASE("densities of one way alone that are wrong are seen by its disagreement with the other") {
  struct Plant {
    const char* what;
    const char* file;
    const char* right;
    const char* wrong;
  };
  const std::vector<Plant> plants{
      {"light that is drawn with the wrong chance", "shared/path_math.h",
       "angle = angle * sum * gn_reciprocal(importance);", "angle = angle * (gn_f32)frame->light_count;"},
      {"gloss with a wrong density", "shared/bsdf_math.h", "scatter->gloss * 0.5f * bell *",
       "scatter->gloss * bell *"}};
  for (const Plant& plant : plants) {
    const BrokenKernels broken(plant.file, plant.right, plant.wrong);
    const Disagreement found = strategies_disagree(PathStrategy::kLights, PathStrategy::kSurfaces, 16);
    CAPTURE(plant.what, found.mean_square, found.largest);
    CHECK(found.largest > 8.0);
  }
}
