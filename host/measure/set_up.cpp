#include "gnomon/measure/set_up.h"

#include <array>
#include <nlohmann/json.hpp>
#include <numbers>

#include "gnomon/base/error.h"
#include "gnomon/scene/read_file.h"

namespace gnomon {
namespace {

using nlohmann::json;

struct SceneSource {
  const char* name;
  const char* source;  // empty: lost
};
constexpr std::array<SceneSource, 8> kScenes{{{"Random100", "gen:random100"},
                                              {"Random1000", "gen:random1000"},
                                              {"Suzanne", "suzanne.glb"},
                                              {"Cottage", "cottage.glb"},
                                              {"CottageWalls", "cottage-walls.glb"},
                                              {"Wood", "woods.glb"},
                                              {"Crowd", ""},
                                              {"Sponza", ""}}};

const SceneSource& scene_named(const std::string& name) {
  std::string known;
  for (const SceneSource& scene : kScenes) {
    if (name == scene.name) return scene;
    known += std::string(known.empty() ? "" : ", ") + scene.name;
  }
  throw Error(ErrorCode::kInvalidArgument, "there is no thesis scene \"" + name + "\"; there are " + known);
}

// One entry of the file, and how to say where it stands.
class Entry {
 public:
  Entry(const json& value, std::string place) : value_(value), place_(std::move(place)) {
    if (!value.is_object()) fail("is not an object");
  }

  [[nodiscard]] std::string text(const char* field) const {
    const json& value = at(field);
    if (!value.is_string()) fail(std::string(field) + " is not a text");
    return value.get<std::string>();
  }
  [[nodiscard]] double number(const char* field) const { return number_of(at(field), field); }
  [[nodiscard]] Vec3d vector(const char* field) const {
    const json& value = at(field);
    if (!value.is_array() || value.size() != 3) fail(std::string(field) + " is not a list of three numbers");
    return {number_of(value[0], field), number_of(value[1], field), number_of(value[2], field)};
  }
  [[nodiscard]] std::vector<std::string> texts(const char* field) const {
    const json& value = at(field);
    if (!value.is_array()) fail(std::string(field) + " is not a list of texts");
    std::vector<std::string> out;
    for (const json& item : value) {
      if (!item.is_string()) fail(std::string(field) + " is not a list of texts");
      out.push_back(item.get<std::string>());
    }
    return out;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::kInvalidArgument, place_ + ": " + what);
  }

 private:
  [[nodiscard]] const json& at(const char* field) const {
    const auto found = value_.find(field);
    if (found == value_.end()) fail(std::string(field) + " is missing");
    return *found;
  }
  [[nodiscard]] double number_of(const json& value, const char* field) const {
    if (!value.is_number()) fail(std::string(field) + " is not a number");
    return value.get<double>();
  }

  const json& value_;
  std::string place_;
};

InfluenceArea plane_of(const Entry& entry) {
  PlaneWindow window;
  window.point = entry.vector("point");
  window.direction = entry.vector("normal");
  window.half_width = entry.number("half_width");
  window.half_height = entry.number("half_height");
  window.depth = entry.number("forward_size");
  return InfluenceArea::plane(window);
}

InfluenceArea point_of(const Entry& entry) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  PointView view;
  view.eye = entry.vector("eye");
  view.direction = entry.vector("direction");
  view.fov_x = kDegree * entry.number("fov_x_deg");
  view.fov_y = kDegree * entry.number("fov_y_deg");
  view.near_distance = entry.number("near");
  view.far_distance = entry.number("far");
  return InfluenceArea::point(view);
}

InfluenceArea area_of_kind(const std::string& kind, const Entry& entry) {
  if (kind != "plane" && kind != "point")
    entry.fail("kind is \"" + kind + "\"; write \"plane\" or \"point\"");
  try {
    return kind == "plane" ? plane_of(entry) : point_of(entry);
  } catch (const Error& error) {
    const std::string what = error.what();
    if (what.starts_with("configs")) throw;
    entry.fail(what);
  }
}

SetUp set_up_of(const json& value, std::size_t number) {
  const Entry entry(value, "configs[" + std::to_string(number) + "]");
  SetUp out{entry.text("scene"), entry.text("area"), entry.text("orientation"),
            entry.texts("used_by_variants"), area_of_kind(entry.text("kind"), entry)};
  try {
    static_cast<void>(scene_named(out.scene));
  } catch (const Error& error) {
    entry.fail(error.what());
  }
  return out;
}

json parse(const std::filesystem::path& file) {
  const auto bytes = read_file(file);
  try {
    return json::parse(bytes.begin(), bytes.end());
  } catch (const json::exception& error) {
    throw Error(ErrorCode::kInvalidArgument, file.string() + " is not JSON: " + error.what());
  }
}

}  // namespace

std::vector<SetUp> read_set_ups(const std::filesystem::path& file) {
  const json document = parse(file);
  const auto configs = document.is_object() ? document.find("configs") : document.end();
  if (configs == document.end() || !configs->is_array() || configs->empty())
    throw Error(ErrorCode::kInvalidArgument,
                file.string() + " has no list \"configs\" of set-ups; give the thesis' configs.json");
  std::vector<SetUp> out;
  for (std::size_t i = 0; i < configs->size(); ++i) {
    try {
      out.push_back(set_up_of((*configs)[i], i));
    } catch (const Error& error) {
      throw Error(error.code(), file.string() + ", " + error.what());
    }
  }
  return out;
}

std::string scene_source_of(const std::string& thesis_name) {
  return scene_named(thesis_name).source;
}

bool is_lost(const std::string& thesis_name) {
  return *scene_named(thesis_name).source == '\0';
}

}  // namespace gnomon
