// The thesis' set-ups, read from a JSON file: which scene, which influence area. Feeds the reproduction of
// the thesis.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gnomon/areas/influence_area.h"

namespace gnomon {

struct SetUp {
  std::string scene;                  // as the thesis names it
  std::string area_name;              // "plane" or "point"
  std::string orientation;            // "parallel", "15", "45", "oblique"
  std::vector<std::string> variants;  // of the thesis that ran with it; one set-up may have several windows
  InfluenceArea area;

  // "Suzanne plane oblique"
  [[nodiscard]] std::string label() const { return scene + " " + area_name + " " + orientation; }
};

// Reads {"configs": [{scene, area, orientation, used_by_variants, kind: "plane", point, normal, half_width,
// half_height, forward_size} or {..., kind: "point", eye, direction, fov_x_deg, fov_y_deg, near, far}, ...]};
// whatever else is there is left out. Throws Error: kIo (cannot be read), kInvalidArgument (not JSON; a field
// that is missing or of the wrong kind; an area that cannot be), naming file, entry and field.
[[nodiscard]] std::vector<SetUp> read_set_ups(const std::filesystem::path& file);

// Where a thesis scene comes from: "gen:NAME" for a generated one, else a file's name. Throws
// Error{kInvalidArgument} for a name that the thesis has not, listing those it has.
[[nodiscard]] std::string scene_source_of(const std::string& thesis_name);

// Whether the scene's file is not to be had: Crowd and Sponza were never published as the thesis used them.
[[nodiscard]] bool is_lost(const std::string& thesis_name);

}  // namespace gnomon
