// Numbers as people read them, the same for the same value. Feeds advice, charts and the page.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace gnomon::compare {

[[nodiscard]] std::string fixed(double value, int digits);
// So many significant digits, without an exponent between 1e-3 and 1e6: "0.0123", "1.23", "123", "1.2e7".
[[nodiscard]] std::string significant(double value, int digits = 3);
// "12.3 ms", "4.56 µs".
[[nodiscard]] std::string time_text(double seconds);
// "450", "12 thousand", "3.1 million", "1.2 billion".
[[nodiscard]] std::string count_text(double count);
// "12.3 MiB".
[[nodiscard]] std::string bytes_text(double bytes);
// "a", "a and b", "a, b and c".
[[nodiscard]] std::string list_text(const std::vector<std::string>& items);
// For text and attribute values of HTML and SVG.
[[nodiscard]] std::string escaped(const std::string& text);

}  // namespace gnomon::compare
