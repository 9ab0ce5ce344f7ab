// gnomon render: pictures that are pictures, and none at all after Ctrl-C.
#include <stb_image.h>

#include <catch2/catch.hpp>
#include <map>
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

TEST_CASE("shadow rays in the order of their lights make the same picture") {
  const Folder folder;
  const auto picture = [&](const std::string& name, const std::string& order) {
    REQUIRE(run({"render", "gen:cottage:8k", "-o", folder.file(name), "--width", "64", "--height", "48",
                 "--samples", "2", "--order", order, "--quiet"})
                .status == 0);
    return program::read_text(folder.file(name));
  };
  CHECK(picture("light.png", "light") == picture("given.png", "given"));
  CHECK(run({"render", "gen:random:100", "-o", folder.file("a.png"), "--order", "origin"}).status == 2);
}

TEST_CASE("paths make a picture that has no guesses in it, the same for the same seed") {
  const Folder folder;
  const auto picture = [&](const std::string& name, const std::string& seed) {
    const auto outcome =
        run({"render", "gen:cottage:8k", "-o", folder.file(name), "--heat-map", folder.file("heat.png"),
             "--width", "40", "--height", "30", "--samples", "3", "--seed", seed, "--json"});
    CAPTURE(outcome.err);
    REQUIRE(outcome.status == 0);
    const json document = json::parse(outcome.out);
    CHECK(document.at("options").at("method") == "paths");
    CHECK(document.at("options").at("samples") == 3);
    CHECK(document.at("camera_rays") == 3 * 40 * 30);
    CHECK(document.at("rays").get<int>() > 2 * 3 * 40 * 30);
    CHECK(document.at("record").is_null());
    CHECK(document.at("heat_map").at("mean_boxes").get<double>() > 1.0);
    CHECK(decode(folder.file(name)).colors() > 100);
    return program::read_text(folder.file(name));
  };
  const std::string first = picture("a.png", "1");
  CHECK(picture("b.png", "1") == first);
  CHECK(picture("c.png", "2") != first);
}

TEST_CASE("a record holds what it says, and trace and validate take it") {
  const Folder folder;
  const auto render = [&](const std::string& name) {
    return run({"render", "gen:cottage:8k", "-o", folder.file("a.png"), "--width", "40", "--height", "30",
                "--samples", "3", "--record", folder.file(name), "--record-rays", "2000", "--json"});
  };
  const auto outcome = render("rays.gnr");
  CAPTURE(outcome.err);
  REQUIRE(outcome.status == 0);
  const json document = json::parse(outcome.out);
  const json record = document.at("record");
  // Strata share the bound in whole rays.
  const auto rays = record.at("rays").get<std::size_t>();
  CHECK(rays <= 2000);
  CHECK(rays > 2000 - record.at("strata").size());
  std::uint64_t traced = 0;
  std::map<std::string, std::uint64_t> stored;
  for (const json& stratum : record.at("strata")) {
    traced += stratum.at("traced").get<std::uint64_t>();
    stored[stratum.at("kind")] += stratum.at("stored").get<std::uint64_t>();
    CHECK(stratum.at("light").is_null() == (stratum.at("kind") != "shadow"));
  }
  CHECK(traced == document.at("rays"));
  REQUIRE(stored.size() == 3);
  CHECK(program::read_text(folder.file("rays.gnr")).size() ==
        64 + 32 * record.at("strata").size() + 32 * rays);
  REQUIRE(render("again.gnr").status == 0);
  CHECK(program::read_text(folder.file("again.gnr")) == program::read_text(folder.file("rays.gnr")));

  const auto trace = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{
        "trace", "gen:cottage:8k", "--rays-in", folder.file("rays.gnr"), "--repeat", "1", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto traced_rays = run(arguments);
    CAPTURE(traced_rays.err);
    REQUIRE(traced_rays.status == 0);
    return json::parse(traced_rays.out);
  };
  CHECK(trace({}).at("rays") == rays);
  CHECK(trace({}).at("options").at("query") == "closest");
  const json shadow = trace({"--kinds", "shadow"});
  CHECK(shadow.at("rays") == stored["shadow"]);
  CHECK(shadow.at("options").at("query") == "any");
  CHECK(shadow.at("invalid_rays") == 0);
  CHECK(trace({"--kinds", "camera,bounce"}).at("rays") == stored["camera"] + stored["bounce"]);
  const auto judged = run({"validate", "gen:cottage:8k", "--rays-in", folder.file("rays.gnr"), "--kinds",
                           "shadow,bounce", "--max-rays", "200", "--json"});
  CAPTURE(judged.err);
  REQUIRE(judged.status == 0);
  const json kinds = json::parse(judged.out).at("kinds");
  REQUIRE(kinds.size() == 2);
  CHECK(kinds[0].at("kind") == "bounce");
  CHECK(kinds[1].at("rays") == stored["shadow"]);
}

TEST_CASE("records that cannot be had or used are refused") {
  const Folder folder;
  const std::string record = folder.file("rays.gnr");
  CHECK(run({"render", "gen:random:100", "-o", folder.file("a.png"), "--record", record}).status == 2);
  CHECK(run({"render", "gen:random:100", "-o", folder.file("a.png"), "--samples", "1", "--preview", "1"})
            .status == 2);
  CHECK(run({"trace", "gen:random:100", "--kinds", "shadow"}).status == 2);
  program::write_text(folder.file("raw"), std::string(64, '\0'));
  CHECK(run({"trace", "gen:random:100", "--rays-in", folder.file("raw"), "--kinds", "shadow"}).status == 2);
  REQUIRE(run({"render", "gen:random:100", "-o", folder.file("a.png"), "--samples", "1", "--width", "8",
               "--height", "8", "--record", record})
              .status == 0);
  const auto none = run({"trace", "gen:random:100", "--rays-in", record, "--kinds", "other"});
  CHECK(none.status == 4);
  CHECK_THAT(none.err, Contains("holds no other rays"));
  std::string bytes = program::read_text(record);
  bytes[100] = static_cast<char>(bytes[100] ^ 1);
  program::write_text(record, bytes);
  const auto damaged = run({"validate", "gen:random:100", "--rays-in", record});
  CHECK(damaged.status == 4);
  CHECK_THAT(damaged.err, Contains("checksum"));
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
  for (const std::vector<std::string>& how :
       {std::vector<std::string>{"--preview", "4096"},
        std::vector<std::string>{"--samples", "4096", "--record", folder.file("never.gnr")}}) {
    std::vector<std::string> arguments{"render",  "gen:random:1k", "-o",       folder.file("never.png"),
                                       "--width", "1000",          "--height", "1000"};
    arguments.insert(arguments.end(), how.begin(), how.end());
    const auto outcome = run(arguments, setup);
    CAPTURE(outcome.err);
    CHECK(outcome.status == 130);
    CHECK(outcome.out.empty());
    CHECK_THAT(outcome.err, Contains(" %") && Contains("cancelled"));
    CHECK(folder.names().empty());
  }
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
