// gnomon reproduce --on-device: the device's trees are the reference's, so are all figures but times.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "run_program.h"

using nlohmann::json;
using program::Folder;
using program::run;

namespace {

const char* const kTwoSetUps =
    R"({"configs": [{"scene": "Random1000", "area": "plane", "orientation": "15", "kind": "plane",
  "point": [3.5, 5, -4], "normal": [0.259, 0, 0.966], "half_width": 6.5, "half_height": 5, "forward_size": 20,
  "used_by_variants": ["Standard", "Full", "Facing", "Longest"]},
  {"scene": "Random1000", "area": "point", "orientation": "parallel", "kind": "point", "eye": [5, 5, -4],
  "direction": [0, 0, 1], "fov_x_deg": 90, "fov_y_deg": 90, "near": 1, "far": 20,
  "used_by_variants": ["Standard", "Full", "Facing", "Longest"]}]})";

// The rows, without the time that each build took.
std::vector<json> rows_of(const Folder& folder, const std::vector<std::string>& more) {
  const std::string rows = folder.file("rows.jsonl");
  std::vector<std::string> arguments = {
      "reproduce", "--configs", folder.file("configs.json"), "--scenes", folder.path().string(),
      "--rays",    "200",       "--prediction-rays",         "300",      "--rows",
      rows,        "--quiet"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const auto outcome = run(arguments);
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.status == 0);
  std::vector<json> out;
  std::istringstream lines(program::read_text(rows));
  for (std::string line; std::getline(lines, line);) {
    json row = json::parse(line);
    row.erase("build_ms");
    out.push_back(std::move(row));
  }
  return out;
}

}  // namespace

TEST_CASE("a device's rows are the host's") {
  const Folder folder;
  program::write_text(folder.path() / "configs.json", kTwoSetUps);
  const auto host = rows_of(folder, {});
  const auto device = rows_of(folder, {"--on-device"});
  REQUIRE(host.size() == 6 + 2 + 11 + 12);
  REQUIRE(device.size() == host.size());
  for (std::size_t i = 0; i < host.size(); ++i) {
    CAPTURE(i, host[i].dump(), device[i].dump());
    REQUIRE(device[i] == host[i]);
  }
}
