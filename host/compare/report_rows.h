// Rows of a device, one by one. Not public. Feeds report_json.cpp.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "gnomon/compare/report.h"

namespace gnomon::compare {

using Json = nlohmann::ordered_json;

// As report_json.h describes them.
[[nodiscard]] Json rows_of(const Report& report, const DeviceReport& device);
// Puts it where it belongs; a task that is not known is passed over. Throws nlohmann's exceptions.
void read_row(const Json& row, DeviceReport& device);

[[nodiscard]] Json text_or_null(const std::string& text);
[[nodiscard]] std::string text_of(const Json& value);

}  // namespace gnomon::compare
