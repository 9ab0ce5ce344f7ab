#include "gnomon/scene/data_uri.h"

#include <array>
#include <cstdint>

#include "gnomon/scene/import_message.h"

namespace gnomon {
namespace {

constexpr unsigned char kNotBase64 = 255;

constexpr std::array<unsigned char, 256> make_base64_values() {
  std::array<unsigned char, 256> values{};
  for (auto& value : values) value = kNotBase64;
  constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (unsigned char i = 0; i < 64; ++i) values[static_cast<unsigned char>(kAlphabet[i])] = i;
  return values;
}

int hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

bool is_data_uri(std::string_view uri) {
  return uri.substr(0, 5) == "data:";
}

std::vector<unsigned char> decode_data_uri(std::string_view uri, const std::string& place) {
  static constexpr std::array<unsigned char, 256> kValues = make_base64_values();
  constexpr std::string_view kMarker = ";base64,";
  const std::size_t comma = uri.find(',');
  const std::size_t text_at = comma == uri.npos ? 0 : comma + 1;
  if (text_at < kMarker.size() || uri.substr(text_at - kMarker.size(), kMarker.size()) != kMarker) {
    bad_scene(place + " has a data URI that is not base64" + std::string(kExportAgain));
  }
  std::string_view text = uri.substr(text_at);
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::vector<unsigned char> bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  unsigned bit_count = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const unsigned char value = kValues[static_cast<unsigned char>(text[i])];
    if (value == kNotBase64) {
      bad_scene(place + " has a data URI whose character " + std::to_string(i) + " is not base64" +
                std::string(kExportAgain));
    }
    bits = (bits << 6U | value) & 0xFFFFU;
    bit_count += 6;
    if (bit_count >= 8) {
      bit_count -= 8;
      bytes.push_back(static_cast<unsigned char>(bits >> bit_count & 0xFFU));
    }
  }
  return bytes;
}

std::string decode_percent(std::string_view uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const int high = uri[i] == '%' && i + 2 < uri.size() ? hex_value(uri[i + 1]) : -1;
    const int low = high >= 0 ? hex_value(uri[i + 2]) : -1;
    if (low >= 0) {
      text += static_cast<char>(high * 16 + low);
      i += 2;
    } else {
      text += uri[i];
    }
  }
  return text;
}

}  // namespace gnomon
