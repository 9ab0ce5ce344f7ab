// The JSON documents: one each, on stdout, with every key that other programs may count on.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "json_document.h"

using nlohmann::json;
using program::document_of;
using program::run;

namespace {

void require_keys(const json& document, const std::vector<const char*>& pointers) {
  for (const char* pointer : pointers) {
    CAPTURE(pointer, document.dump());
    REQUIRE(document.contains(json::json_pointer(pointer)));
    CHECK_FALSE(document.at(json::json_pointer(pointer)).is_null());
  }
}

// Parses what must be one document and nothing else.
const std::vector<const char*> kBuildKeys{"/version",
                                          "/commit",
                                          "/command",
                                          "/device",
                                          "/driver",
                                          "/scene",
                                          "/scene_hash",
                                          "/triangles",
                                          "/dropped",
                                          "/options/heuristic",
                                          "/options/axes",
                                          "/options/bins",
                                          "/options/max_leaf",
                                          "/options/cost_traversal",
                                          "/options/cost_triangle",
                                          "/options/invalid",
                                          "/options/work_group_size",
                                          "/build/total_ms",
                                          "/build/stages",
                                          "/tree/hash",
                                          "/tree/sah_cost",
                                          "/tree/nodes",
                                          "/tree/leaves",
                                          "/tree/max_depth"};

}  // namespace

TEST_CASE("devices, as a document") {
  const json document = document_of({"devices", "--json"});
  require_keys(document, {"/version", "/commit", "/device", "/driver", "/devices/0/address",
                          "/devices/0/max_allocation", "/devices/0/max_work_group", "/devices/0/local_memory",
                          "/devices/0/unified_memory", "/devices/0/fp64", "/devices/0/int64_atomics"});
  CHECK(document.at("devices").at(document.at("default_index").get<std::size_t>()).at("name") ==
        document.at("device"));
}

TEST_CASE("info with a device says what a build needs") {
  const json document = document_of({"info", "gen:random:1k", "--json"});
  require_keys(document,
               {"/device", "/driver", "/scene_hash", "/triangles", "/dropped", "/materials", "/cameras",
                "/lights/point", "/bounds/lo", "/build_memory/tree_bytes", "/build_memory/scratch_bytes"});
  CHECK(document.at("build_memory").at("fits") == true);
}

TEST_CASE("build, as a document") {
  const json document = document_of({"build", "gen:cottage:8k", "--max-leaf", "4", "--json"});
  require_keys(document, kBuildKeys);
  CHECK(document.at("options").at("max_leaf") == 4);
  CHECK(document.at("build").at("runs") == 3);
  CHECK(document.at("build").at("total_ms").get<double>() > 0.0);
  CHECK(document.at("build").at("total_ms_min") <= document.at("build").at("total_ms"));
  CHECK(document.at("tree").at("nodes").get<int>() == 2 * document.at("tree").at("leaves").get<int>() - 1);
  CHECK(document.at("tree").at("hash").get<std::string>().size() == 16);
}

TEST_CASE("trace, as a document") {
  const json document = document_of(
      {"trace", "gen:cottage:8k", "--rays", "bounce", "--count", "5k", "--repeat", "3", "--json"});
  require_keys(document, kBuildKeys);
  require_keys(document, {"/rays", "/hits", "/invalid_rays", "/mrays_per_s/median", "/mrays_per_s/min",
                          "/mrays_per_s/max", "/mrays_per_s/n", "/clock", "/seconds", "/boxes_per_ray",
                          "/triangles_per_ray", "/options/rays", "/options/count", "/options/seed"});
  CHECK(document.at("rays").get<int>() > 1000);
  CHECK(document.at("hits").get<int>() > 0);
  CHECK(document.at("mrays_per_s").at("n") == 3);
  CHECK(document.at("mrays_per_s").at("min").get<double>() > 0.0);
  CHECK(document.at("seconds").size() == 3);
  CHECK((document.at("clock") == "device" || document.at("clock") == "wall"));
  CHECK(document.at("boxes_per_ray").get<double>() > 1.0);
  CHECK(document.at("triangles_per_ray").get<double>() > 0.0);
}

TEST_CASE("trace names the flavour that traced, and takes one") {
  const auto traced = [](const std::string& flavour) {
    return document_of({"trace", "gen:cottage:8k", "--count", "2k", "--flavour", flavour, "--json"});
  };
  const json thread = traced("thread");
  const json wide = traced("wide");
  CHECK(thread.at("flavour") == "thread");
  CHECK(wide.at("flavour") == "wide");
  CHECK(thread.at("hits") == wide.at("hits"));
  CHECK(thread.at("boxes_per_ray") != wide.at("boxes_per_ray"));
  const json packet = traced("packet");
  CHECK(packet.at("flavour") == "packet");
  CHECK(packet.at("hits") == thread.at("hits"));
  const json compact = traced("compact");
  CHECK(compact.at("flavour") == "compact");
  CHECK(compact.at("hits") == thread.at("hits"));
  const json left_to_us = traced("auto");
  CHECK(left_to_us.at("options").at("flavour") == "auto");
  CHECK((left_to_us.at("flavour") == "thread" || left_to_us.at("flavour") == "packet"));
  const auto refused = run({"trace", "gen:cottage:8k", "--flavour", "narrow"});
  CHECK(refused.status == 2);
  CHECK_THAT(refused.err, Catch::Contains("--flavour") && Catch::Contains("wide"));
}

TEST_CASE("the text of the same commands goes to stdout too, and --quiet leaves stderr empty") {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"devices", "--quiet"},
                                             {"info", "gen:random:1k", "-q"},
                                             {"build", "gen:cottage:8k", "-q"},
                                             {"trace", "gen:cottage:8k", "--count", "2k", "--quiet"}}) {
    CAPTURE(arguments);
    const auto outcome = run(arguments);
    CHECK(outcome.status == 0);
    CHECK_FALSE(outcome.out.empty());
    CHECK(outcome.err.empty());
    CHECK(outcome.out.find('{') == std::string::npos);
  }
}

TEST_CASE("a result that cannot be written is a failure") {
  program::Setup full;
  full.stdout_file = "/dev/full";
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"devices"}, {"devices", "--json"}}) {
    CAPTURE(arguments);
    const auto outcome = run(arguments, full);
    CHECK(outcome.status == 1);
    CHECK(outcome.err.find("standard output") != std::string::npos);
  }
}
