#include "gnomon/scene/obj_material.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "gnomon/base/error.h"
#include "gnomon/scene/import_message.h"
#include "gnomon/scene/read_file.h"

namespace gnomon {
namespace {

// What follows the first word of a line, without blanks around it.
std::string rest_of(std::string_view line) {
  const auto words = words_of(line);
  if (words.size() < 2) return {};
  const std::string_view& last = words.back();
  return {words[1].data(), last.data() + last.size()};
}

float clamped(float value, float most) {
  return std::isfinite(value) ? std::clamp(value, 0.0F, most) : 0.0F;
}

}  // namespace

bool ObjMaterialReader::read(const std::string& name, std::vector<tinyobj::material_t>* materials,
                             std::map<std::string, int>* material_map) {
  std::string portable = name;
  std::replace(portable.begin(), portable.end(), '\\', '/');
  try {
    const auto bytes = read_file(base_folder_ / portable);
    std::istringstream stream(std::string(bytes.begin(), bytes.end()));
    std::string warnings;
    std::string errors;
    tinyobj::LoadMtl(material_map, materials, &stream, &warnings, &errors);
    return true;
  } catch (const Error&) {
    return false;
  }
}

bool ObjMaterialReader::operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                                   std::map<std::string, int>* material_map, std::string* /*warnings*/,
                                   std::string* /*errors*/) {
  // The name tinyobj passes is only its first guess at where names end.
  const std::string whole = rest_of(lines_.line());
  const std::string& shown = whole.empty() ? name : whole;
  if (missing_.count(shown) > 0) return false;
  if (read(shown, materials, material_map)) return true;
  bool is_found = false;
  const auto words = words_of(whole);
  for (std::size_t i = 0; words.size() > 1 && i < words.size(); ++i) {
    if (read(std::string(words[i]), materials, material_map)) is_found = true;
  }
  if (!is_found) {
    missing_.insert(shown);
    notes_.push_back("Material file " + in_quotes(shown) + " (line " + std::to_string(lines_.number()) +
                     ") cannot be read.");
  }
  return is_found;
}

Material to_material(const tinyobj::material_t& source) {
  Material material;
  material.name = source.name;
  for (unsigned channel = 0; channel < 3; ++channel) {
    material.base_color[channel] = clamped(source.diffuse[channel], 1.0F);
    material.emission[channel] = clamped(source.emission[channel], std::numeric_limits<float>::max());
  }
  // tinyobj does not tell "Pr 0" from none, and files without Pr are the usual ones.
  if (source.roughness > 0.0F) material.roughness = clamped(source.roughness, 1.0F);
  return material;
}

}  // namespace gnomon
