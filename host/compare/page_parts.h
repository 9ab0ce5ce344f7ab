// What page.cpp puts together. Feeds page.cpp alone.
#pragma once

#include <string>
#include <string_view>

namespace gnomon::compare {

// host/compare/page/, embedded at build time.
[[nodiscard]] std::string_view page_style();
[[nodiscard]] std::string_view page_script();

}  // namespace gnomon::compare
