#include "gnomon/scene/json_pick.h"

#include <cstdint>
#include <utility>

namespace gnomon {
namespace {

constexpr std::uint64_t kMaxIndex = 0x7FFFFFFF;
constexpr std::uint64_t kMaxSize = 1ULL << 53U;  // above it JSON numbers are not exact everywhere

bool is_whole(const Json& value, std::uint64_t limit) {
  // number_unsigned is nlohmann's type for every non-negative integer.
  return value.is_number_unsigned() && value.get<std::uint64_t>() <= limit;
}

template <typename Accepts>
bool is_array_of(const Json& value, std::size_t length, const Accepts& accepts) {
  if (!value.is_array() || (length != 0 && value.size() != length)) return false;
  for (const Json& element : value) {
    if (!accepts(element)) return false;
  }
  return true;
}

bool obeys(const Json& value, const JsonRule& rule) {
  switch (rule.kind) {
    case JsonKind::kIndex:
      return is_whole(value, kMaxIndex);
    case JsonKind::kSize:
      return is_whole(value, kMaxSize);
    case JsonKind::kNumber:
      return value.is_number();
    case JsonKind::kNumbers:
      return is_array_of(value, rule.length, [](const Json& v) { return v.is_number(); });
    case JsonKind::kIndices:
      return is_array_of(value, rule.length, [](const Json& v) { return is_whole(v, kMaxIndex); });
    case JsonKind::kText:
      return value.is_string();
    case JsonKind::kFlag:
      return value.is_boolean();
  }
  return false;
}

std::string wanted(const JsonRule& rule) {
  const std::string many = rule.length == 0 ? std::string() : std::to_string(rule.length) + ' ';
  switch (rule.kind) {
    case JsonKind::kIndex:
      return "a whole number from 0 to 2147483647";
    case JsonKind::kSize:
      return "a whole number from 0 to 2^53";
    case JsonKind::kNumber:
      return "a number";
    case JsonKind::kNumbers:
      return "an array of " + many + "numbers";
    case JsonKind::kIndices:
      return "an array of whole numbers from 0 to 2147483647";
    case JsonKind::kText:
      return "a text";
    case JsonKind::kFlag:
      return "true or false";
  }
  return {};
}

std::string member(const std::string& place, const char* key) {
  return place.empty() ? std::string(key) : place + '.' + key;
}

Json* find_typed(Json& source, const char* key, const std::string& place, Json::value_t type,
                 const char* name) {
  const auto found = source.find(key);
  if (found == source.end()) return nullptr;
  if (found->type() != type) {
    bad_scene(member(place, key) + " must be " + name + std::string(kExportAgain));
  }
  return &*found;
}

}  // namespace

Json pick(Json& source, const std::string& place, std::initializer_list<JsonRule> rules) {
  Json out = Json::object();
  for (const JsonRule& rule : rules) {
    const auto found = source.find(rule.key);
    if (found == source.end()) {
      if (rule.required) bad_scene(member(place, rule.key) + " is missing" + std::string(kExportAgain));
      continue;
    }
    if (!obeys(*found, rule)) {
      bad_scene(member(place, rule.key) + " must be " + wanted(rule) + std::string(kExportAgain));
    }
    out[rule.key] = std::move(*found);
  }
  return out;
}

Json* find_object(Json& source, const char* key, const std::string& place) {
  return find_typed(source, key, place, Json::value_t::object, "a JSON object");
}

Json* find_array(Json& source, const char* key, const std::string& place) {
  return find_typed(source, key, place, Json::value_t::array, "a JSON array");
}

}  // namespace gnomon
