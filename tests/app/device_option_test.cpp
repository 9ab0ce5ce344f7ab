// Which device is taken: --device beats GNOMON_DEVICE beats the default; and what fits on it.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "run_program.h"

using Catch::Contains;
using nlohmann::json;
using program::Folder;
using program::run;

TEST_CASE("an unknown device exits 3 with the list of those there are") {
  const json devices = json::parse(run({"devices", "--json"}).out);
  const auto name = devices.at("devices").at(0).at("name").get<std::string>();
  const auto outcome = run({"build", "gen:random:100", "--device", "nonsense"});
  CHECK(outcome.status == 3);
  CHECK(outcome.out.empty());
  CHECK_THAT(outcome.err, Contains("nonsense") && Contains("[0]") && Contains(name));
}

TEST_CASE("GNOMON_DEVICE chooses, and --device beats it") {
  const program::Setup nonsense{{{"GNOMON_DEVICE", "nonsense"}}, false, {}, {}};
  CHECK(run({"build", "gen:random:100"}, nonsense).status == 3);
  CHECK(run({"info", "gen:random:100"}, nonsense).status == 3);
  const auto given = run({"build", "gen:random:100", "--device", "0", "--json"}, nonsense);
  CHECK(given.status == 0);
  CHECK(json::parse(given.out).at("device_index") == 0);
  const auto list = run({"devices"}, nonsense);  // the place to look up what would have fitted
  CHECK(list.status == 0);
  CHECK_THAT(list.err, Contains("nonsense"));
  const program::Setup first{{{"GNOMON_DEVICE", "0"}}, false, {}, {}};
  CHECK(run({"build", "gen:random:100", "--json"}, first).status == 0);
  CHECK(run({"build", "gen:random:100", "--device", "nonsense"}, first).status == 3);
}

TEST_CASE("two devices of one platform are told apart") {
  // PoCL can pretend to have several; elsewhere its variables do nothing, so ask for its devices by platform.
  program::Setup two{{{"POCL_DEVICES", "pthread pthread"}, {"GNOMON_DEVICE", std::nullopt}}, false, {}, {}};
  const json devices = json::parse(run({"devices", "--json"}, two).out).at("devices");
  REQUIRE(devices.size() >= 2);
  const auto last = devices.back().at("index").get<unsigned>();
  two.environment["GNOMON_DEVICE"] = std::to_string(last);
  CHECK(json::parse(run({"info", "gen:random:100", "--json"}, two).out).at("device_index") == last);
  const auto address = devices.front().at("address").get<std::string>();
  CHECK(json::parse(run({"info", "gen:random:100", "--device", address, "--json"}, two).out)
            .at("device_index") == 0);
}

TEST_CASE("what does not fit exits 5 and names the buffer") {
  // PoCL with its least memory: 256 MiB in one buffer.
  const program::Setup small{{{"POCL_MEMORY_LIMIT", "1"}, {"GNOMON_DEVICE", "Portable"}}, false, {}, {}};
  const auto refused = run({"build", "gen:random:5M"}, small);
  CHECK(refused.status == 5);
  CHECK_THAT(refused.err, Contains("buffer") && Contains("bytes"));
  const json info = json::parse(run({"info", "gen:random:5M", "--json"}, small).out);
  CHECK(info.at("build_memory").at("fits") == false);
  const auto host = run({"trace", "gen:random:100", "--count", "1e15"});
  CHECK(host.status == 5);
  CHECK_THAT(host.err, Contains("out of memory"));
}

TEST_CASE(
    "--no-cache leaves no compiled program behind, its absence does where the driver keeps none itself") {
  const Folder folder;
  program::Setup fresh{
      {{"XDG_CACHE_HOME", folder.path().string()}, {"RUSTICL_ENABLE", "llvmpipe"}}, false, {}, {}};
  const auto kept = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"build", "gen:random:100"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto outcome = run(arguments, fresh);
    CAPTURE(outcome.err);
    REQUIRE(outcome.status == 0);
    const auto programs = folder.path() / "gnomon";
    return std::filesystem::exists(programs) && !std::filesystem::is_empty(programs);
  };
  CHECK_FALSE(kept({"--device", "Portable"}));  // PoCL keeps its own
  CHECK_FALSE(kept({"--device", "rusticl", "--no-cache"}));
  CHECK(kept({"--device", "rusticl"}));
}
