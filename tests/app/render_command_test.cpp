// gnomon render: pictures that are pictures, and none at all after Ctrl-C.
#include <stb_image.h>

#include <catch2/catch.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "run_program.h"

using Catch::Contains;
using nlohmann::json;
using program::Folder;
using program::run;

namespace {

struct Decoded {
  int width = 0;
  int height = 0;
  std::vector<unsigned char> bytes;
  [[nodiscard]] std::size_t colors() const {
    std::set<std::uint32_t> seen;
    for (std::size_t i = 0; i + 2 < bytes.size(); i += 3)
      seen.insert(bytes[i] << 16U | bytes[i + 1] << 8U | bytes[i + 2]);
    return seen.size();
  }
};

Decoded decode(const std::string& file) {
  Decoded picture;
  int channels = 0;
  const std::unique_ptr<unsigned char, decltype(&stbi_image_free)> bytes(
      stbi_load(file.c_str(), &picture.width, &picture.height, &channels, 0), stbi_image_free);
  REQUIRE(bytes != nullptr);
  REQUIRE(channels == 3);
  picture.bytes.assign(bytes.get(), bytes.get() + std::size_t{3} * picture.width * picture.height);
  return picture;
}

}  // namespace

TEST_CASE("a picture and its heat map have the size asked for and something on them") {
  const Folder folder;
  const auto outcome = run({"render", "gen:cottage:8k", "-o", folder.file("a.png"), "--heat-map",
                            folder.file("heat.png"), "--width", "120", "--height", "70", "--json"});
  CAPTURE(outcome.err);
  REQUIRE(outcome.status == 0);
  for (const char* name : {"a.png", "heat.png"}) {
    CAPTURE(name);
    const Decoded picture = decode(folder.file(name));
    CHECK(picture.width == 120);
    CHECK(picture.height == 70);
    CHECK(picture.colors() > 100);
  }
  const json document = json::parse(outcome.out);
  CHECK(document.at("picture") == folder.file("a.png"));
  CHECK(document.at("camera_rays") == 4 * 120 * 70);
  CHECK(document.at("rays").get<int>() > 4 * 120 * 70);
  CHECK(document.at("heat_map").at("scale_max").get<double>() > 1.0);
  CHECK(document.at("heat_map").at("max_boxes") >= document.at("heat_map").at("scale_max"));
  for (const char* key :
       {"device", "driver", "commit", "scene_hash", "triangles", "dropped", "options", "build", "tree"}) {
    CHECK(document.contains(key));
  }
  CHECK(folder.names().size() == 2);
}

TEST_CASE("the same seed gives the same picture, another seed another") {
  const Folder folder;
  const auto picture = [&](const std::string& name, const std::string& seed) {
    REQUIRE(run({"render", "gen:random:1k", "-o", folder.file(name), "--width", "64", "--height", "48",
                 "--seed", seed, "--quiet"})
                .status == 0);
    return program::read_text(folder.file(name));
  };
  const std::string first = picture("a.png", "1");
  CHECK(picture("b.png", "1") == first);
  CHECK(picture("c.png", "2") != first);
}

TEST_CASE("what a scene lacks is made up and said, unless --quiet") {
  const Folder folder;
  program::write_text(folder.file("one.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::vector<std::string> arguments{
      "render", folder.file("one.obj"), "-o", folder.file("one.png"), "--width", "32", "--height", "32"};
  const auto loud = run(arguments);
  CHECK(loud.status == 0);
  CHECK_THAT(loud.err, Contains("no lights") && Contains("no camera"));
  auto hushed = arguments;
  hushed.emplace_back("--quiet");
  const auto quiet = run(hushed);
  CHECK(quiet.status == 0);
  CHECK(quiet.err.empty());
  CHECK_FALSE(quiet.out.empty());
}

TEST_CASE("a scene without triangles is none, and no picture is made of it") {
  const Folder folder;
  program::write_text(folder.file("none.obj"), "v 0 0 0\n");
  const auto outcome = run({"render", folder.file("none.obj"), "-o", folder.file("none.png")});
  CHECK(outcome.status == 4);
  CHECK_THAT(outcome.err, Contains("no triangles"));
  CHECK(folder.names().size() == 1);
}

TEST_CASE("Ctrl-C stops a long render, exits 130 and leaves no file") {
  const Folder folder;
  program::Setup setup;
  setup.terminal = true;
  setup.interrupt_at = "render";
  const auto outcome = run({"render", "gen:random:1k", "-o", folder.file("never.png"), "--samples", "4096",
                            "--width", "1000", "--height", "1000"},
                           setup);
  CAPTURE(outcome.err);
  CHECK(outcome.status == 130);
  CHECK(outcome.out.empty());
  CHECK_THAT(outcome.err, Contains(" %") && Contains("cancelled"));
  CHECK(folder.names().empty());
}

TEST_CASE("progress is drawn on terminals only, and not when --quiet") {
  const Folder folder;
  const std::vector<std::string> arguments{
      "render", "gen:random:1k", "-o", folder.file("a.png"), "--width", "16", "--height", "16", "--quiet"};
  program::Setup terminal;
  terminal.terminal = true;
  CHECK(run(arguments, terminal).err.empty());
}

TEST_CASE("a picture that cannot be written is a failure") {
  const auto outcome =
      run({"render", "gen:random:100", "-o", "/nonexistent/a.png", "--width", "8", "--height", "8"});
  CHECK(outcome.status == 1);
  CHECK_THAT(outcome.err, Contains("/nonexistent/a.png"));
}
