// Which gnomon this is. Feeds --version and every JSON document.
#pragma once

#include <string>

namespace gnomon::app {

[[nodiscard]] std::string version();  // "0.1.0"
[[nodiscard]] std::string commit();  // short hash, perhaps "-dirty"; "unknown" when not built from a checkout

}  // namespace gnomon::app
