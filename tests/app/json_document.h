// What the program printed, as JSON. Feeds the tests of host/app.
#pragma once

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "run_program.h"

namespace program {

// Requires that it ended well. The arguments must ask for --json.
inline nlohmann::json document_of(const std::vector<std::string>& arguments) {
  const auto outcome = run(arguments);
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.status == 0);
  return nlohmann::json::parse(outcome.out);
}

}  // namespace program
