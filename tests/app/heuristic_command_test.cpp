// gnomon build, trace, validate and render for rays in particular: each heuristic, and each way to ask for
// what makes no sense.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <set>

#include "run_program.h"

using Catch::Contains;
using nlohmann::json;
using program::run;

namespace {

json options_of(const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"build", "gen:cottage:8k", "--repeat", "1", "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const auto outcome = run(arguments);
  CAPTURE(outcome.err, more);
  REQUIRE(outcome.status == 0);
  json document = json::parse(outcome.out);
  json options = document.at("options");
  options["hash"] = document.at("tree").at("hash");
  return options;
}

void require_refused(const std::vector<std::string>& more, const std::vector<std::string>& words) {
  std::vector<std::string> arguments{"build", "gen:cottage:8k"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const auto outcome = run(arguments);
  CAPTURE(outcome.err, more);
  REQUIRE(outcome.status == 2);
  REQUIRE(outcome.out.empty());
  for (const std::string& word : words) REQUIRE_THAT(outcome.err, Contains(word));
}

}  // namespace

TEST_CASE("every heuristic builds a tree of its own and is named") {
  const std::vector<std::string> view{"--point", "1,2,8", "--direction", "0.1,-0.1,-1", "--fov", "90,60"};
  const std::vector<std::string> sun{"--direction", "-0.3,-1,0.2"};
  const std::vector<std::tuple<std::string, std::vector<std::string>, std::string>> cases{
      {"plane", sun, "pah"},
      {"window", {"--light", "0"}, "pah-window"},
      {"solid-angle", {"--point", "0.5,1,0.5"}, "pah-solid-angle"},
      {"near-plane", view, "pah-near-plane"},
      {"yaw-pitch", view, "pah-yaw-pitch"}};
  std::set<std::string> hashes{options_of({}).at("hash")};
  for (const auto& [name, rays, expected] : cases) {
    CAPTURE(name);
    std::vector<std::string> more{"--heuristic", name};
    more.insert(more.end(), rays.begin(), rays.end());
    const json options = options_of(more);
    REQUIRE(options.at("heuristic") == expected);
    REQUIRE_FALSE(options.at("rays_of").is_null());
    REQUIRE(hashes.insert(options.at("hash").get<std::string>()).second);
  }
}

TEST_CASE("every number that says where rays are makes another tree") {
  const auto hash = [](const std::vector<std::string>& more) {
    return options_of(more).at("hash").get<std::string>();
  };
  const auto view = [&](const std::string& heuristic, const std::string& point, const std::string& direction,
                        const std::string& fov) {
    return hash({"--heuristic", heuristic, "--point", point, "--direction", direction, "--fov", fov});
  };
  for (const std::string heuristic : {"solid-angle", "near-plane", "yaw-pitch"}) {
    CAPTURE(heuristic);
    std::set<std::string> hashes;
    CHECK(hashes.insert(view(heuristic, "1,2,8", "0.1,-0.1,-1", "60,40")).second);
    CHECK(hashes.insert(view(heuristic, "1,2,8", "0.1,-0.1,-1", "60,20")).second);
    CHECK(hashes.insert(view(heuristic, "1,2,8", "0.1,-0.1,-1", "30,40")).second);
    CHECK(hashes.insert(view(heuristic, "1,2,8", "0.4,-0.1,-1", "60,40")).second);
    CHECK(hashes.insert(view(heuristic, "1,3,8", "0.1,-0.1,-1", "60,40")).second);
  }
  CHECK(view("yaw-pitch", "1,2,8", "0.1,-0.1,-1", "60,60") ==
        hash({"--heuristic", "yaw-pitch", "--point", "1,2,8", "--direction", "0.1,-0.1,-1"}));
  CHECK(hash({"--heuristic", "plane", "--direction", "0.3,-1,0"}) !=
        hash({"--heuristic", "plane", "--direction", "0,-1,0.3"}));
  // Rays from a point, for SPFH to go by, are not parallel ones.
  CHECK(hash({"--axes", "spfh", "--point", "1,2,8"}) != hash({"--axes", "spfh", "--point", "-20,2,0"}));
}

TEST_CASE("the light asked for is the one whose rays count") {
  const auto outcome = run({"info", "gen:atrium:16k", "--json"});
  CAPTURE(outcome.err);
  REQUIRE(outcome.status == 0);
  const std::size_t lights = json::parse(outcome.out).at("lights").size();
  REQUIRE(lights >= 2);
  std::set<std::string> hashes;
  for (std::size_t i = 0; i < lights; ++i) {
    const auto built = run({"build", "gen:atrium:16k", "--repeat", "1", "--json", "--axes", "spfh", "--light",
                            std::to_string(i)});
    CAPTURE(i, built.err);
    REQUIRE(built.status == 0);
    const json document = json::parse(built.out);
    const std::string name = document.at("options").at("rays_of");
    CHECK_THAT(name, Catch::StartsWith("light " + std::to_string(i) + " ("));
    hashes.insert(document.at("tree").at("hash").get<std::string>());
  }
  CHECK(hashes.size() > 1);
}

TEST_CASE("without rays the tree is the one for rays from everywhere") {
  const json options = options_of({"--heuristic", "sah"});
  CHECK(options.at("heuristic") == "sah");
  CHECK(options.at("rays_of").is_null());
  CHECK(options.at("share").is_null());
  CHECK(options.at("hash") == options_of({}).at("hash"));
}

TEST_CASE("axis policies and shares are heeded and named") {
  const std::vector<std::string> sun{"--direction", "-0.3,-1,0.2"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), sun.begin(), sun.end());
    return options_of(more);
  };
  const json plane = with({"--heuristic", "plane"});
  const json mixed = with({"--heuristic", "plane", "--share", "0.5"});
  CHECK(mixed.at("heuristic") == "pah-mixed");
  CHECK(mixed.at("share") == 0.5);
  CHECK(mixed.at("hash") != plane.at("hash"));
  const json facing = with({"--axes", "spfh"});
  CHECK(facing.at("heuristic") == "sah+spfh");
  CHECK(facing.at("axes") == "spfh");
  CHECK(options_of({"--axes", "lsph"}).at("heuristic") == "sah+lsph");
  CHECK(with({"--heuristic", "plane", "--axes", "lsph"}).at("heuristic") == "pah+lsph");
  CHECK(options_of({"--axes", "spfh", "--point", "0.5,1,0.5"}).at("hash") != facing.at("hash"));
}

TEST_CASE("trace, validate and render build for the same rays, and people read which") {
  const program::Folder folder;
  const std::vector<std::string> rays{"--heuristic", "window", "--direction", "-0.3,-1,0.2"};
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"build", "gen:cottage:8k", "--repeat", "1"},
           {"trace", "gen:cottage:8k", "--count", "2k", "--repeat", "1"},
           {"validate", "gen:cottage:8k", "--count", "500", "--max-rays", "100"},
           {"render", "gen:cottage:8k", "-o", folder.file("a.png"), "--width", "32", "--height", "24"}}) {
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), rays.begin(), rays.end());
    const auto outcome = run(arguments);
    CAPTURE(command.front(), outcome.err);
    REQUIRE(outcome.status == 0);
    REQUIRE_THAT(outcome.out, Contains("pah-window, rays of --direction -0.3,-1,0.2"));
  }
}

TEST_CASE("a picture is the same whatever rays its tree is for") {
  const program::Folder folder;
  const auto render = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render", "gen:cottage:8k", "-o", folder.file(name), "--width",
                                       "48",     "--height",       "32", "--preview",       "1",
                                       "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto outcome = run(arguments);
    CAPTURE(outcome.err, more);
    REQUIRE(outcome.status == 0);
    return json::parse(outcome.out);
  };
  const std::vector<std::string> view{"--heuristic", "yaw-pitch",   "--point", "1,2,8",
                                      "--direction", "0.1,-0.1,-1", "--share", "0.5"};
  const json plain = render("a.png", {});
  const json seen = render("b.png", view);
  CHECK(seen.at("options").at("heuristic") == "pah-yaw-pitch-mixed");
  CHECK(seen.at("options").at("rays_of") == "--point 1,2,8 --direction 0.1,-0.1,-1");
  CHECK(seen.at("options").at("share") == 0.5);
  CHECK(seen.at("tree").at("hash") == options_of(view).at("hash"));
  CHECK(seen.at("tree").at("hash") != plain.at("tree").at("hash"));
  CHECK(plain.at("options").at("rays_of").is_null());
  CHECK(program::read_text(folder.file("a.png")) == program::read_text(folder.file("b.png")));
  const auto refused = run({"render", "gen:cottage:8k", "-o", folder.file("c.png"), "--heuristic", "window"});
  CHECK(refused.status == 2);
  CHECK_THAT(refused.err, Contains("--heuristic window") && Contains("--light N"));
  CHECK(folder.names().size() == 2);
}

TEST_CASE("rays that are missing, doubled or of the wrong kind are refused") {
  require_refused({"--heuristic", "cone"},
                  {"sah", "plane", "window", "solid-angle", "near-plane", "yaw-pitch"});
  require_refused({"--axes", "shortest"}, {"all", "spfh", "lsph"});
  require_refused({"--heuristic", "window"}, {"--heuristic window", "--light N", "--direction"});
  require_refused({"--axes", "spfh"}, {"--axes spfh", "--light N"});
  require_refused({"--light", "0"}, {"sah", "--axes spfh"});
  require_refused({"--share", "0.5"}, {"--share", "--heuristic"});
  require_refused({"--heuristic", "plane", "--direction", "0,-1,0", "--share", "1.5"}, {"--share"});
  require_refused({"--heuristic", "plane", "--light", "0", "--direction", "0,-1,0"},
                  {"--light", "--direction"});
  require_refused({"--heuristic", "plane", "--light", "900"}, {"--light 900", "lights are 0 to"});
  require_refused({"--heuristic", "plane", "--light", "-1"}, {"--light"});
  require_refused({"--heuristic", "plane", "--direction", "0,-1"}, {"--direction 0,-1", "three numbers"});
  require_refused({"--heuristic", "plane", "--direction", "0,0,0"}, {"leads nowhere"});
  require_refused({"--heuristic", "solid-angle", "--point", "here"}, {"--point here", "three numbers"});
  require_refused({"--heuristic", "solid-angle", "--point", "0,1,nan"}, {"three numbers"});
  require_refused({"--heuristic", "plane", "--direction", "0,-1,0", "--fov", "60,60"}, {"--fov", "--point"});
  require_refused(
      {"--heuristic", "near-plane", "--point", "0,1,0", "--direction", "1,0,0", "--fov", "60,180"},
      {"--fov 60,180", "between 0 and 180"});
  require_refused({"--heuristic", "near-plane", "--direction", "0,-1,0"}, {"are parallel", "window"});
  require_refused({"--heuristic", "plane", "--point", "0,1,0"}, {"all ways", "solid-angle"});
  require_refused({"--heuristic", "yaw-pitch", "--point", "0,1,0"}, {"all ways", "solid-angle"});
  require_refused({"--heuristic", "window", "--point", "0,1,0", "--direction", "1,0,0"},
                  {"come from a point", "yaw-pitch"});
}

TEST_CASE("a scene without lights or triangles for the rays says so") {
  const program::Folder folder;
  program::write_text(folder.file("dark.obj"), "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
  const auto dark = run({"build", folder.file("dark.obj"), "--heuristic", "plane", "--light", "0"});
  CHECK(dark.status == 2);
  CHECK_THAT(dark.err, Contains("no lights") && Contains("--direction"));
}

TEST_CASE("the builder is chosen and named, by every command that builds, and refuses what it cannot heed") {
  REQUIRE(options_of({}).at("builder") == "balanced");
  const json options = options_of({"--builder", "fast"});
  REQUIRE(options.at("builder") == "fast");
  REQUIRE(options.at("hash") != options_of({}).at("hash"));
  const auto text = run({"build", "gen:cottage:8k", "--repeat", "1", "--builder", "fast"});
  REQUIRE_THAT(text.out, Contains("builder") && Contains("fast"));
  const auto valid = run({"validate", "gen:cottage:8k", "--builder", "fast", "--json"});
  CAPTURE(valid.err);
  REQUIRE(valid.status == 0);
  REQUIRE(json::parse(valid.out).at("options").at("builder") == "fast");
  require_refused({"--builder", "fast", "--heuristic", "plane", "--direction", "0,-1,0"},
                  {"builder fast", "pah", "balanced"});
  require_refused({"--builder", "fast", "--axes", "lsph"}, {"builder fast", "sah+lsph"});
  require_refused({"--builder", "fast", "--median-depth", "9"}, {"builder fast", "median_depth"});
  require_refused({"--builder", "slow"}, {"--builder", "slow"});
  const auto best = run({"validate", "gen:cottage:8k", "--builder", "best", "--json"});
  CAPTURE(best.err);
  REQUIRE(best.status == 0);
  REQUIRE(json::parse(best.out).at("options").at("builder") == "best");
  require_refused({"--builder", "best", "--axes", "lsph"}, {"builder best", "sah+lsph"});
}
