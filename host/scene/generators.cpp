#include "gnomon/scene/generators.h"

#include <array>
#include <string>

#include "gnomon/base/error.h"
#include "gnomon/scene/generator_list.h"

namespace gnomon {
namespace {

constexpr std::array<GeneratorInfo, 10> kGenerators{{
    {"random", "small triangles spread evenly through a cube, exact count", 10'000, 1},
    {"random100", "the thesis' Random100: exactly its 100 triangles, whatever the seed", 100, 100},
    {"random1000", "the thesis' Random1000: exactly its 1000 triangles, whatever the seed", 1000, 1000},
    {"terrain", "hills and crags: a height field of seeded noise", 100'000, 64},
    {"city", "towers with ledges and windows on a rolling ground, long slanted cables between them", 200'000,
     2000},
    {"atrium", "a columned hall with arches, curtains and thin roof beams, lit by the sun and lamps", 250'000,
     16'000},
    {"cottage", "a house of few large triangles with a garden of many small ones", 20'000, 7000},
    {"cottage-walls", "the cottage inside a walled yard", 20'000, 7000},
    {"forest", "trees with branches and leaves on a forest floor", 200'000, 4000},
    {"crowd", "people in many poses in a walled hall", 200'000, 4000},
}};

using Maker = Scene (*)(std::uint64_t, std::uint64_t);
constexpr std::array<Maker, kGenerators.size()> kMakers{
    make_random, make_random100, make_random1000,    make_terrain, make_city,
    make_atrium, make_cottage,   make_cottage_walls, make_forest,  make_crowd};

// Triangle indices are 32 bits wide and two values short of full range are kept for marks.
constexpr std::uint64_t kMaxTriangles = 1ULL << 31;

std::size_t find_generator(std::string_view name) {
  std::string known;
  for (std::size_t i = 0; i < kGenerators.size(); ++i) {
    if (kGenerators[i].name == name) return i;
    known += (i == 0 ? "" : ", ") + std::string(kGenerators[i].name);
  }
  throw Error(ErrorCode::kInvalidArgument,
              "unknown scene \"" + std::string(name) + "\"; known are: " + known);
}

void check_count(const GeneratorInfo& info, std::uint64_t triangles) {
  const std::string name(info.name);
  const bool fixed = name == "random100" || name == "random1000";
  if (fixed && triangles != info.default_triangles) {
    throw Error(ErrorCode::kInvalidArgument, "scene " + name + " has exactly " +
                                                 std::to_string(info.default_triangles) + " triangles; " +
                                                 std::to_string(triangles) + " were asked for");
  }
  if (triangles < info.min_triangles || triangles > kMaxTriangles) {
    throw Error(ErrorCode::kInvalidArgument, "scene " + name + " can be made with " +
                                                 std::to_string(info.min_triangles) + " to " +
                                                 std::to_string(kMaxTriangles) + " triangles; " +
                                                 std::to_string(triangles) + " were asked for");
  }
}

}  // namespace

std::span<const GeneratorInfo> generators() {
  return kGenerators;
}

Scene generate_scene(std::string_view name, std::uint64_t triangles, std::uint64_t seed) {
  const std::size_t index = find_generator(name);
  check_count(kGenerators[index], triangles);
  return kMakers[index](triangles, seed);
}

}  // namespace gnomon
