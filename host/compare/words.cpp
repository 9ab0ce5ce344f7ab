#include "gnomon/compare/words.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace gnomon::compare {

std::string fixed(double value, int digits) {
  std::array<char, 400> text{};
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, digits);
  return {text.data(), end};
}

std::string significant(double value, int digits) {
  if (value == 0.0 || !std::isfinite(value)) return value == 0.0 ? "0" : "–";
  const double magnitude = std::fabs(value);
  if (magnitude < 1e-3 || magnitude >= 1e6) {
    std::array<char, 64> text{};
    const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value,
                                            std::chars_format::scientific, std::max(0, digits - 1));
    return {text.data(), end};
  }
  // Of the number as rounded: 0.9999 has one digit before the point when three are kept.
  const double rounded = magnitude * (1.0 + 0.5 * std::pow(10.0, -digits));
  const int before = static_cast<int>(std::floor(std::log10(rounded))) + 1;
  return fixed(value, std::max(0, digits - before));
}

std::string time_text(double seconds) {
  if (seconds >= 1.0) return significant(seconds) + " s";
  if (seconds >= 1e-3) return significant(1e3 * seconds) + " ms";
  if (seconds >= 1e-6) return significant(1e6 * seconds) + " µs";
  return significant(1e9 * seconds) + " ns";
}

std::string count_text(double count) {
  if (count >= 0.9995e12) return significant(1e-12 * count, 2) + " trillion";
  if (count >= 0.9995e9) return significant(1e-9 * count, 2) + " billion";
  if (count >= 0.9995e6) return significant(1e-6 * count, 2) + " million";
  if (count >= 9.995e3) return significant(1e-3 * count, 2) + " thousand";
  return fixed(std::round(count), 0);
}

std::string bytes_text(double bytes) {
  if (bytes < 1024.0) return fixed(bytes, 0) + " bytes";
  if (bytes < 1024.0 * 1024.0) return significant(bytes / 1024.0) + " KiB";
  if (bytes < 1024.0 * 1024.0 * 1024.0) return significant(bytes / (1024.0 * 1024.0)) + " MiB";
  return significant(bytes / (1024.0 * 1024.0 * 1024.0)) + " GiB";
}

std::string list_text(const std::vector<std::string>& items) {
  std::string out;
  for (std::size_t i = 0; i < items.size(); ++i)
    out += (i == 0 ? "" : i + 1 == items.size() ? " and " : ", ") + items[i];
  return out;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

}  // namespace gnomon::compare
