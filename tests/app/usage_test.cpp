// What the program says and how it exits where no device is needed: help, wrong usage, bad scenes, no device
// at all.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "run_program.h"

using Catch::Contains;
using program::Folder;
using program::run;

namespace {

const program::Setup kNoDevice{
    {{"OCL_ICD_VENDORS", "/nonexistent"}, {"GNOMON_DEVICE", std::nullopt}}, false, {}, {}};

}  // namespace

TEST_CASE("help and version are data, not errors") {
  const auto help = run({"--help"});
  CHECK(help.status == 0);
  CHECK(help.err.empty());
  for (const char* command : {"devices", "scene", "info", "build", "trace", "validate", "render"}) {
    CAPTURE(command);
    CHECK_THAT(help.out, Contains(command));
    const auto own = run({command, "--help"});
    CHECK(own.status == 0);
    CHECK(own.err.empty());
    CHECK_THAT(own.out, Contains("Examples:") && Contains("--json") && Contains("--quiet"));
  }
  CHECK_THAT(
      help.out,
      Contains(
          "Exit status: 0 ok, 1 failure, 2 wrong usage, 3 no device, 4 bad scene, tree, ray or rows file"));
  CHECK_THAT(run({"trace", "--help"}).out, Contains("bounce") && Contains("parallel") && Contains("float32"));
  CHECK_THAT(run({"build", "--help"}).out, Contains("even over a picture's plane") && Contains("--light 0"));
  CHECK_THAT(run({"scene", "--help"}).out, Contains("atrium") && Contains("cottage-walls"));
  const auto version = run({"--version"});
  CHECK(version.status == 0);
  CHECK_THAT(version.out, Catch::StartsWith("gnomon 0."));
}

TEST_CASE("wrong usage exits 2, says what is wrong and where help is") {
  const std::vector<std::vector<std::string>> wrong{
      {},
      {"--nope"},
      {"nope"},
      {"build"},
      {"build", "gen:random", "--nope"},
      {"build", "gen:random", "gen:random"},
      {"build", "gen:random", "--bins"},
      {"build", "gen:random", "--bins", "many"},
      {"build", "gen:random", "--bins", "1", "--bins", "2"},
      {"build", "gen:random", "--repeat", "0"},
      {"build", "gen:random", "--invalid", "keep"},
      {"trace", "gen:random", "--rays", "sideways"},
      {"trace", "gen:random", "--count", "-1"},
      {"trace", "gen:random", "--rays", "bounce", "--rays-in", "rays"},
      {"render", "gen:random"},
      {"devices", "--color", "pink"},
  };
  for (const auto& arguments : wrong) {
    CAPTURE(arguments);
    const auto outcome = run(arguments, kNoDevice);
    CHECK(outcome.status == 2);
    CHECK(outcome.out.empty());
    CHECK_THAT(outcome.err, Contains("gnomon: error: ") && Contains("--help"));
  }
  CHECK_THAT(run({"biuld", "gen:random"}, kNoDevice).err,
             Contains("no subcommand \"biuld\"") && Contains("there are devices, ") && Contains(" build, "));
  // Not that a scene is missing: what is not known may be meant to be one.
  CHECK_THAT(run({"trace", "--nope"}).err, Contains("--nope") && Contains("gnomon trace --help"));
  CHECK_THAT(run({"trace"}).err, Contains("required"));
}

TEST_CASE("options are checked before anything is loaded or opened") {
  CHECK(run({"build", "gen:random", "--bins", "1"}, kNoDevice).status == 2);
  CHECK(run({"validate", "gen:random", "--max-leaf", "0"}, kNoDevice).status == 2);
  for (const char* command : {"build", "trace", "validate"}) {
    CHECK(run({command, "gen:random", "--heuristic", "window"}, kNoDevice).status == 2);
    CHECK(run({command, "gen:random", "--heuristic", "plane", "--direction", "down"}, kNoDevice).status == 2);
    CHECK_THAT(run({command, "--help"}, kNoDevice).out, Contains("--heuristic") && Contains("solid-angle"));
  }
  CHECK(run({"trace", "gen:random", "--query", "any", "--hits-out", "hits"}, kNoDevice).status == 2);
  const auto size = run({"render", "gen:random", "-o", "x.png", "--width", "20000"}, kNoDevice);
  CHECK(size.status == 2);
  CHECK_THAT(size.err, Contains("width is 20000"));
}

TEST_CASE("generated scenes that make no sense exit 2 and say why") {
  const auto unknown = run({"info", "gen:castle"}, kNoDevice);
  CHECK(unknown.status == 2);
  CHECK_THAT(unknown.err, Contains("castle") && Contains("atrium"));
  for (const char* source : {"gen:", "gen:city:12x", "gen:city:50k:1:2", "gen:city:50k:-1", "gen:city:0"}) {
    CAPTURE(source);
    CHECK(run({"info", source}, kNoDevice).status == 2);
  }
}

TEST_CASE("a scene that cannot be used exits 4") {
  const Folder folder;
  const auto missing = run({"info", folder.file("missing.glb")}, kNoDevice);
  CHECK(missing.status == 4);
  CHECK_THAT(missing.err, Contains("missing.glb") && Contains("no such file"));
  program::write_text(folder.file("text.glb"), "not a scene");
  CHECK(run({"info", folder.file("text.glb")}, kNoDevice).status == 4);
  CHECK(run({"info", folder.path().string()}, kNoDevice).status == 4);

  program::write_text(folder.file("flat.obj"), "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 4\n");
  const auto dropped = run({"info", folder.file("flat.obj")}, kNoDevice);
  CHECK(dropped.status == 0);
  CHECK_THAT(dropped.err, Contains("dropped 1 triangles") && Contains("1 without area"));
  CHECK(run({"info", folder.file("flat.obj"), "--invalid", "reject"}, kNoDevice).status == 4);
  const auto document =
      nlohmann::json::parse(run({"info", folder.file("flat.obj"), "--json", "-q"}, kNoDevice).out);
  CHECK(document.at("dropped") == 1);
  CHECK(document.at("triangles") == 1);
}

TEST_CASE("without any device those who need one exit 3 and name the remedy") {
  const std::vector<std::vector<std::string>> needing{{"devices"},
                                                      {"build", "gen:random"},
                                                      {"trace", "gen:random"},
                                                      {"validate", "gen:random"},
                                                      {"render", "gen:random", "-o", "never.png"}};
  for (const auto& arguments : needing) {
    CAPTURE(arguments);
    const auto outcome = run(arguments, kNoDevice);
    CHECK(outcome.status == 3);
    CHECK(outcome.out.empty());
    CHECK_THAT(outcome.err, Contains("no OpenCL device") && Contains("apt install pocl-opencl-icd"));
  }
}

TEST_CASE("info needs no device") {
  const auto text = run({"info", "gen:cottage"}, kNoDevice);
  CHECK(text.status == 0);
  CHECK_THAT(text.out, Contains("0 directional, 1 point, 2 area") && Contains("no OpenCL device here"));
  const auto document = nlohmann::json::parse(run({"info", "gen:cottage", "--json"}, kNoDevice).out);
  CHECK(document.at("device").is_null());
  CHECK(document.at("build_memory").is_null());
  CHECK(document.at("triangles").get<int>() > 15'000);
  CHECK(document.at("scene_hash").get<std::string>().size() == 16);
  CHECK(document.at("lights").at("point") == 1);
  CHECK(document.at("bounds").at("hi").size() == 3);
  CHECK(document.at("cameras").size() == 2);
}

TEST_CASE("colour appears only where it is wanted") {
  const std::string escape = "\033[";
  const auto plain = run({"nope"});
  CHECK_THAT(plain.err, !Contains(escape));  // a pipe is no terminal
  program::Setup terminal;
  terminal.terminal = true;
  terminal.environment = kNoDevice.environment;
  CHECK_THAT(run({"devices"}, terminal).err, Contains(escape));
  CHECK_THAT(run({"devices", "--color", "never"}, terminal).err, !Contains(escape));
  terminal.environment["NO_COLOR"] = "1";
  CHECK_THAT(run({"devices"}, terminal).err, !Contains(escape));
  CHECK_THAT(run({"devices", "--color", "always"}, terminal).err, Contains(escape));
  terminal.environment["NO_COLOR"] = "";  // set but empty means nothing
  CHECK_THAT(run({"devices"}, terminal).err, Contains(escape));
}
