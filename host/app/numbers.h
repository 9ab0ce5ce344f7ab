// Counts and sizes as people write and read them. Feeds options, scene sources and tables.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon::app {

// "250000", "250k", "1M", "1.5M", "1e6": a whole number below 2^63; k, M and G are powers of ten. Nothing
// else.
[[nodiscard]] std::optional<std::uint64_t> parse_count(std::string_view text);

// "0.3,-1,2e-1": finite numbers with commas between. Nothing else, no spaces.
[[nodiscard]] std::optional<std::vector<double>> parse_numbers(std::string_view text);

// With a fixed number of digits after the point.
[[nodiscard]] std::string fixed(double value, int digits);
// "640 bytes", "12.5 MiB".
[[nodiscard]] std::string format_bytes(std::uint64_t bytes);

}  // namespace gnomon::app
