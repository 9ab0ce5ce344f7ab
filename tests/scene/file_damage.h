// Damage to scene files, the same for the same seed: to their bytes, and to the JSON of glTF documents so
// that it still parses. Not for judging the outcome. Feeds the importers' fuzz test.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "gltf_builder.h"

namespace gnomon_test {

// mt19937_64 gives the same numbers everywhere; the standard distributions need not.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  std::size_t below(std::size_t limit) {
    return limit == 0 ? 0 : static_cast<std::size_t>(engine_() % limit);
  }
  template <typename T>
  const T& one_of(const std::vector<T>& choices) {
    return choices[below(choices.size())];
  }

 private:
  std::mt19937_64 engine_;
};

inline const std::vector<std::string>& nasty_numbers() {
  static const std::vector<std::string> numbers{"0",
                                                "-1",
                                                "1",
                                                "2",
                                                "3",
                                                "4",
                                                "7",
                                                "255",
                                                "256",
                                                "65535",
                                                "2147483647",
                                                "2147483648",
                                                "4294967295",
                                                "4294967296",
                                                "9007199254740992",
                                                "9007199254740993",
                                                "18446744073709551615",
                                                "-9223372036854775808",
                                                "1e30",
                                                "1e308",
                                                "1e-400",
                                                "0.5",
                                                "null",
                                                "\"x\"",
                                                "[]",
                                                "{}",
                                                "true",
                                                "nan",
                                                "-inf",
                                                "5126",
                                                "5121",
                                                "12345678901234567890"};
  return numbers;
}

inline bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// Replaces one run of digits in a text.
inline void replace_number(std::string& text, Dice& dice) {
  std::size_t at = dice.below(text.size());
  while (at < text.size() && !is_digit(text[at])) ++at;
  std::size_t end = at;
  while (end < text.size() && is_digit(text[end])) ++end;
  if (at < end) text.replace(at, end - at, dice.one_of(nasty_numbers()));
}

// One step of damage to a file of any kind; `other` is where splices come from.
inline void damage(std::string& file, const std::string& other, Dice& dice) {
  if (file.empty()) return;
  switch (dice.below(6)) {
    case 0:
      file[dice.below(file.size())] ^= static_cast<char>(1U << dice.below(8));
      break;
    case 1:
      file[dice.below(file.size())] = static_cast<char>(dice.below(256));
      break;
    case 2:
      file.resize(dice.below(file.size()));
      break;
    case 3:
      replace_number(file, dice);
      break;
    case 4: {  // a piece of another file
      const std::size_t from = dice.below(other.size());
      const std::size_t length = dice.below(std::min<std::size_t>(other.size() - from, 64) + 1);
      file.replace(dice.below(file.size()), dice.below(length + 1), other, from, length);
      break;
    }
    default: {  // a piece of itself, gone
      const std::size_t from = dice.below(file.size());
      file.erase(from, dice.below(32));
      break;
    }
  }
}

// One value somewhere in a JSON document, reached by one random step or more from its root.
inline Json& some_value(Json& root, Dice& dice) {
  Json* at = &root;
  do {
    auto next = at->begin();
    std::advance(next, static_cast<std::ptrdiff_t>(dice.below(at->size())));
    at = &*next;
  } while (at->is_structured() && !at->empty() && dice.below(8) != 0);
  return *at;
}

inline void collect_numbers(Json& value, std::vector<Json*>& numbers) {
  if (value.is_number()) numbers.push_back(&value);
  if (!value.is_structured()) return;
  for (Json& element : value) collect_numbers(element, numbers);
}

// Any number of the document, each as likely as the others.
inline Json& some_number(Json& root, Dice& dice) {
  std::vector<Json*> numbers;
  collect_numbers(root, numbers);
  return numbers.empty() ? some_value(root, dice) : *dice.one_of(numbers);
}

// Moves one buffer view's bytes to the end of the buffer: reading past that view then is reading past
// everything, which the sanitizer sees. In the middle of a buffer it would not.
inline void expose_view(GltfBuilder& builder, Dice& dice) {
  Json& view = builder.json["bufferViews"][dice.below(builder.json["bufferViews"].size())];
  const auto from = view["byteOffset"].get<std::size_t>();
  const auto length = view["byteLength"].get<std::size_t>();
  const Bytes bytes(builder.binary.begin() + static_cast<std::ptrdiff_t>(from),
                    builder.binary.begin() + static_cast<std::ptrdiff_t>(from + length));
  view["byteOffset"] = builder.binary.size();
  builder.binary.insert(builder.binary.end(), bytes.begin(), bytes.end());
}

// Damage that stays JSON and so gets past the parser.
inline void damage_document(GltfBuilder& builder, Dice& dice) {
  switch (dice.below(5)) {
    case 0: {
      const Json nasty = Json::parse(dice.one_of(nasty_numbers()), nullptr, false);
      (dice.below(2) == 0 ? some_value(builder.json, dice) : some_number(builder.json, dice)) =
          nasty.is_discarded() ? Json(-1) : nasty;
      break;
    }
    case 1:
      some_value(builder.json, dice) = Json(some_value(builder.json, dice));
      break;
    case 2:
      some_number(builder.json, dice) = dice.below(16);
      break;
    case 3:
      some_number(builder.json, dice) = dice.below(1024);
      break;
    default:
      builder.binary[dice.below(builder.binary.size())] ^= static_cast<unsigned char>(1U << dice.below(8));
      break;
  }
}

}  // namespace gnomon_test
