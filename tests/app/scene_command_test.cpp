// gnomon scene: files that the other subcommands read as the scenes they were made from.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "run_program.h"

using Catch::Contains;
using nlohmann::json;
using program::Folder;
using program::run;

TEST_CASE("scene --list names every generator with its default and its fewest triangles") {
  const auto text = run({"scene", "--list"});
  CHECK(text.status == 0);
  const json document = json::parse(run({"scene", "--list", "--json"}).out);
  REQUIRE(document.at("generators").size() >= 10);
  for (const json& generator : document.at("generators")) {
    CHECK_THAT(text.out, Contains(generator.at("name").get<std::string>()));
    CHECK(generator.at("min_triangles") <= generator.at("default_triangles"));
  }
}

TEST_CASE("a written scene reads back with the hash that was announced") {
  const Folder folder;
  const std::string file = folder.file("random.glb");
  const auto written = run({"scene", "random", "--triangles", "1k", "--seed", "5", "-o", file, "--json"});
  REQUIRE(written.status == 0);
  const json document = json::parse(written.out);
  CHECK(document.at("triangles") == 1000);
  CHECK(document.at("dropped") == 0);
  CHECK(document.at("options").at("seed") == 5);
  const json info = json::parse(run({"info", file, "--json"}).out);
  CHECK(info.at("scene_hash") == document.at("scene_hash"));
  CHECK(info.at("triangles") == 1000);

  const std::string again = folder.file("again.glb");
  REQUIRE(run({"scene", "random", "--triangles", "1000", "--seed", "5", "-o", again}).status == 0);
  CHECK(program::read_text(file) == program::read_text(again));
  CHECK(folder.names().size() == 2);
}

TEST_CASE("scene without a name or a file is wrong usage, a file that cannot be written a failure") {
  CHECK(run({"scene"}).status == 2);
  CHECK(run({"scene", "random"}).status == 2);
  CHECK(run({"scene", "castle", "-o", "castle.glb"}).status == 2);
  const auto nowhere = run({"scene", "random", "-o", "/nonexistent/random.glb"});
  CHECK(nowhere.status == 1);
  CHECK_THAT(nowhere.err, Contains("/nonexistent/random.glb"));
}
