// The section on what trace --accuracy fast gains and costs, from rows of accuracy_bench.
#pragma once

#include <string>

#include "rows.h"

namespace stability_page {

[[nodiscard]] std::string fast_accuracy(const Rows& all);

}  // namespace stability_page
