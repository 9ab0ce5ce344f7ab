// Material files of an OBJ, found and read. Not for which face has which (obj_reader). Feeds obj_reader.
#pragma once

#include <tiny_obj_loader.h>

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "gnomon/scene/obj_lines.h"
#include "gnomon/scene/scene.h"

namespace gnomon {

// tinyobj calls this for every mtllib line. A file that cannot be read becomes a note, never an error. Unlike
// tinyobj's own reader it finds names with blanks in them, several names on a line and backslashes as
// separators.
class ObjMaterialReader : public tinyobj::MaterialReader {
 public:
  ObjMaterialReader(const ObjLines& lines, std::filesystem::path base_folder, std::vector<std::string>& notes)
      : lines_(lines), base_folder_(std::move(base_folder)), notes_(notes) {}

  bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                  std::map<std::string, int>* material_map, std::string* warnings,
                  std::string* errors) override;

 private:
  [[nodiscard]] bool read(const std::string& name, std::vector<tinyobj::material_t>* materials,
                          std::map<std::string, int>* material_map);

  const ObjLines& lines_;
  std::filesystem::path base_folder_;
  std::vector<std::string>& notes_;
  std::set<std::string> missing_;
};

// Kd, Ke and Pr, clamped to what they may be.
[[nodiscard]] Material to_material(const tinyobj::material_t& source);

}  // namespace gnomon
