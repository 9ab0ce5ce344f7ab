#include "gnomon/scene/generators.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <set>

#include "gnomon/base/error.h"
#include "gnomon/scene/gltf_export.h"
#include "scene_test_tools.h"

using namespace gnomon_test;
using gnomon::generate_scene;
using gnomon::GeneratorInfo;
using gnomon::Scene;
using gnomon::Triangle;

namespace {

bool is_thesis(const GeneratorInfo& info) {
  return info.min_triangles == info.default_triangles;
}
std::uint64_t small_count(const GeneratorInfo& info) {
  return is_thesis(info) ? info.min_triangles : std::max<std::uint64_t>(info.min_triangles, 20'000);
}
bool same_triangles(const Scene& a, const Scene& b) {
  return a.triangles.size() == b.triangles.size() && a.material_ids == b.material_ids &&
         std::memcmp(a.triangles.data(), b.triangles.data(), a.triangles.size() * sizeof(Triangle)) == 0;
}

}  // namespace

TEST_CASE("the same name, count and seed give the same bytes") {
  for (const GeneratorInfo& info : gnomon::generators()) {
    CAPTURE(info.name);
    const auto first = gnomon::export_glb(generate_scene(info.name, small_count(info), 5));
    const auto second = gnomon::export_glb(generate_scene(info.name, small_count(info), 5));
    REQUIRE(first == second);
  }
}

TEST_CASE("another seed gives another scene, except where the thesis fixes it") {
  for (const GeneratorInfo& info : gnomon::generators()) {
    CAPTURE(info.name);
    const Scene first = generate_scene(info.name, small_count(info), 1);
    const Scene second = generate_scene(info.name, small_count(info), 2);
    REQUIRE(same_triangles(first, second) == is_thesis(info));
  }
}

TEST_CASE("no generator makes a zero-area triangle or a coordinate that is not finite") {
  for (const GeneratorInfo& info : gnomon::generators()) {
    const Scene scene = generate_scene(info.name, small_count(info), 3);
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
      CAPTURE(info.name, i);
      const Point area = area_vector(scene.triangles[i]);
      REQUIRE(std::isfinite(area.x + area.y + area.z));
      REQUIRE((area.x != 0.0 || area.y != 0.0 || area.z != 0.0));
    }
  }
}

TEST_CASE("counts are within ten percent from the minimum to 100000, and exact where promised") {
  for (const GeneratorInfo& info : gnomon::generators()) {
    for (const double factor : {1.0, 1.03, 1.4, 2.3, 5.0, 11.0, 31.0, 100.0}) {
      const auto wanted = static_cast<std::uint64_t>(static_cast<double>(info.min_triangles) * factor);
      if (wanted > 100'000 || (is_thesis(info) && factor != 1.0)) continue;
      const std::uint64_t seed = wanted % 7;
      const double made = static_cast<double>(generate_scene(info.name, wanted, seed).triangles.size());
      CAPTURE(info.name, wanted, seed, made);
      const bool exact = info.name.substr(0, 6) == "random";
      REQUIRE(std::abs(made - static_cast<double>(wanted)) <=
              (exact ? 0.0 : 0.1 * static_cast<double>(wanted)));
    }
  }
}

TEST_CASE("a million triangles keep the promise too") {
  for (const char* const name : {"city", "atrium", "forest", "crowd"}) {
    const double made = static_cast<double>(generate_scene(name, 1'000'000, 1).triangles.size());
    CAPTURE(name, made);
    REQUIRE(std::abs(made - 1e6) < 1e5);
  }
}

TEST_CASE("every scene has a camera and a light, and every triangle a material") {
  for (const GeneratorInfo& info : gnomon::generators()) {
    CAPTURE(info.name);
    const Scene scene = generate_scene(info.name, small_count(info), 1);
    REQUIRE(scene.name == info.name);
    REQUIRE_FALSE(scene.cameras.empty());
    REQUIRE_FALSE(scene.lights.empty());
    REQUIRE(scene.material_ids.size() == scene.triangles.size());
    REQUIRE(*std::max_element(scene.material_ids.begin(), scene.material_ids.end()) < scene.materials.size());
    for (const gnomon::Camera& camera : scene.cameras) {
      REQUIRE(glm::length(to_point(camera.forward)) == Approx(1.0));
      REQUIRE(glm::length(to_point(camera.up)) == Approx(1.0));
      REQUIRE(std::abs(glm::dot(to_point(camera.forward), to_point(camera.up))) < 1e-6);
    }
  }
}

TEST_CASE("area lights hold exactly the emissive triangles") {
  for (const GeneratorInfo& info : gnomon::generators()) {
    CAPTURE(info.name);
    const Scene scene = generate_scene(info.name, small_count(info), 1);
    std::set<std::uint32_t> emissive;
    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
      const gnomon::Vec3& emission = scene.materials[scene.material_ids[i]].emission;
      if (emission[0] > 0.0F || emission[1] > 0.0F || emission[2] > 0.0F) emissive.insert(i);
    }
    std::set<std::uint32_t> held;
    for (const gnomon::Light& light : scene.lights)
      held.insert(light.triangles.begin(), light.triangles.end());
    REQUIRE(held == emissive);
  }
}

TEST_CASE("lights and cameras stand free") {
  for (const GeneratorInfo& info : gnomon::generators()) {
    const Scene scene = generate_scene(info.name, small_count(info), 1);
    for (const gnomon::Light& light : scene.lights) {
      if (light.kind != gnomon::LightKind::kPoint && light.kind != gnomon::LightKind::kSpot) continue;
      CAPTURE(info.name, light.name);
      REQUIRE(clearance(scene, to_point(light.position)) > 0.05);
    }
    for (const gnomon::Camera& camera : scene.cameras) {
      CAPTURE(info.name, camera.name);
      REQUIRE(clearance(scene, to_point(camera.position)) > 0.15);
    }
  }
}

TEST_CASE("every camera sees the scene and not a wall before its lens") {
  for (const GeneratorInfo& info : gnomon::generators()) {
    const Scene scene = generate_scene(info.name, small_count(info), 1);
    for (const gnomon::Camera& camera : scene.cameras) {
      CAPTURE(info.name, camera.name);
      Scene view = scene;
      view.cameras = {camera};
      std::vector<float> seen;
      for (const gnomon::Hit& hit : nearest_hits(view, gnomon::primary_rays(view, 100, 1))) {
        if (hit.primitive != GN_NONE) seen.push_back(hit.t);
      }
      REQUIRE(seen.size() >= (is_thesis(info) ? 8U : 40U));
      std::nth_element(seen.begin(), seen.begin() + static_cast<std::ptrdiff_t>(seen.size() / 2), seen.end());
      REQUIRE(seen[seen.size() / 2] > 1.2F);
    }
  }
}

#ifdef __GLIBCXX__
TEST_CASE("random100 and random1000 are what libstdc++'s distributions draw from one mt19937(1)") {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> first(0.0, 10.0);
  std::uniform_real_distribution<double> others(-1.0, 1.0);
  for (const std::uint64_t count : {std::uint64_t{100}, std::uint64_t{1000}}) {
    const Scene scene = generate_scene(count == 100 ? "random100" : "random1000", count, 9);
    REQUIRE(scene.triangles.size() == count);
    for (std::size_t i = 0; i < count; ++i) {
      Triangle wanted{};
      for (float& c : wanted.v0) c = static_cast<float>(first(engine));
      for (unsigned k = 0; k < 3; ++k) wanted.v1[k] = wanted.v0[k] + static_cast<float>(others(engine));
      for (unsigned k = 0; k < 3; ++k) wanted.v2[k] = wanted.v1[k] + static_cast<float>(others(engine));
      CAPTURE(count, i);
      REQUIRE(std::memcmp(&wanted, &scene.triangles[i], sizeof wanted) == 0);
    }
  }
}
#endif

TEST_CASE("an unknown name is answered with the known ones") {
  try {
    static_cast<void>(generate_scene("castle", 1000, 1));
    FAIL("no error");
  } catch (const gnomon::Error& error) {
    CHECK(error.code() == gnomon::ErrorCode::kInvalidArgument);
    CHECK_THAT(error.what(), Catch::Contains("\"castle\""));
    for (const GeneratorInfo& info : gnomon::generators())
      CHECK_THAT(error.what(), Catch::Contains(std::string(info.name)));
  }
}

TEST_CASE("a count a generator cannot make is refused before anything is made") {
  for (const GeneratorInfo& info : gnomon::generators()) {
    CAPTURE(info.name);
    REQUIRE_THROWS_AS(generate_scene(info.name, info.min_triangles - 1, 1), gnomon::Error);
    REQUIRE_THROWS_AS(generate_scene(info.name, (1ULL << 31) + 1, 1), gnomon::Error);
  }
  REQUIRE_THROWS_WITH(generate_scene("random100", 101, 1), Catch::Contains("exactly 100"));
}

TEST_CASE("the shipped scenes are what their generators make, byte for byte") {
  struct Shipped {
    const char* name;
    std::uint64_t triangles;
  };
  // The same figures stand in scenes/SOURCES.md.
  for (const Shipped& shipped : {Shipped{"atrium", 60'000},
                                 {"city", 40'000},
                                 {"cottage", 12'000},
                                 {"cottage-walls", 12'000},
                                 {"terrain", 20'000},
                                 {"forest", 40'000},
                                 {"crowd", 40'000},
                                 {"random100", 100},
                                 {"random1000", 1000}}) {
    CAPTURE(shipped.name);
    std::ifstream file(std::string(GNOMON_SCENES_FOLDER "/") + shipped.name + ".glb", std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    const auto made = gnomon::export_glb(generate_scene(shipped.name, shipped.triangles, 1));
    REQUIRE(bytes.size() == made.size());
    REQUIRE(std::memcmp(bytes.data(), made.data(), made.size()) == 0);
  }
}
