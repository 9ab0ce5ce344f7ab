// Copying the wanted members of a JSON object while checking type and range. Not for anything that glTF alone
// knows. Feeds gltf_json.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "gnomon/scene/import_message.h"

namespace gnomon {

using Json = nlohmann::json;

enum class JsonKind {
  kIndex,    // integer in [0, 2^31)
  kSize,     // integer in [0, 2^53]
  kNumber,   // finite
  kNumbers,  // array of finite numbers
  kIndices,  // array of integers in [0, 2^31)
  kText,
  kFlag,
};

struct JsonRule {
  const char* key;
  JsonKind kind;
  bool required = false;
  std::size_t length = 0;  // of an array; 0: any
};

// The members the rules name, moved out of `source`. `place` names the object in messages, like `nodes[3]`.
// Throws Error{kBadScene} for one that is missing though required, or is not what its rule says.
[[nodiscard]] Json pick(Json& source, const std::string& place, std::initializer_list<JsonRule> rules);

// The member `key` of an object, when it is there; it must then be an object (array) itself.
[[nodiscard]] Json* find_object(Json& source, const char* key, const std::string& place);
[[nodiscard]] Json* find_array(Json& source, const char* key, const std::string& place);

// Applies `pick_one(element, place)` to each object in the array `source[key]`; an array of the results,
// empty when there is no such member.
template <typename PickOne>
[[nodiscard]] Json pick_all(Json& source, const char* key, const std::string& place,
                            const PickOne& pick_one) {
  Json out = Json::array();
  const std::string path = place.empty() ? std::string(key) : place + '.' + key;
  if (Json* const elements = find_array(source, key, place)) {
    for (Json& element : *elements) {
      const std::string name = path + '[' + std::to_string(out.size()) + ']';
      if (!element.is_object()) bad_scene(name + " must be a JSON object" + std::string(kExportAgain));
      out.push_back(pick_one(element, name));
    }
  }
  return out;
}

}  // namespace gnomon
