// Trees that travel: gnomon build -o, and what the other subcommands do with the file.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "run_program.h"

using Catch::Contains;
using nlohmann::json;
using program::Folder;
using program::run;

namespace {

const program::Setup kNoDevice{
    {{"OCL_ICD_VENDORS", "/nonexistent"}, {"GNOMON_DEVICE", std::nullopt}}, false, {}, {}};
const std::string kScene = "gen:city:3k";

json document_of(const std::vector<std::string>& arguments) {
  auto words = arguments;
  words.insert(words.end(), {"--json", "-q"});
  const auto outcome = run(words);
  CAPTURE(words, outcome.err);
  REQUIRE(outcome.status == 0);
  return json::parse(outcome.out);
}

}  // namespace

TEST_CASE("a tree of a file is traced as the tree it was") {
  const Folder folder;
  const std::string file = folder.file("tree.gnb");
  for (const char* builder : {"balanced", "fast", "best"}) {
    CAPTURE(builder);
    const json built = document_of(
        {"build", kScene, "--builder", builder, "--cost-triangle", "0.5", "-o", file, "--repeat", "1"});
    CHECK(built.at("tree_file") == file);
    const std::vector<std::string> rays{"--count", "2000", "--rays", "bounce", "--repeat", "1"};
    std::vector<std::string> from_file{"trace", kScene, "--tree", file, "--hits-out", folder.file("a.hits")};
    std::vector<std::string> anew{"trace",           kScene, "--builder",  builder,
                                  "--cost-triangle", "0.5",  "--hits-out", folder.file("b.hits")};
    from_file.insert(from_file.end(), rays.begin(), rays.end());
    anew.insert(anew.end(), rays.begin(), rays.end());
    const json traced = document_of(from_file);
    const json again = document_of(anew);
    CHECK(traced.at("tree").at("hash") == built.at("tree").at("hash"));
    CHECK(traced.at("tree") == again.at("tree"));
    CHECK(traced.at("options").at("builder") == builder);
    CHECK(traced.at("options").at("cost_triangle") == 0.5);
    CHECK(traced.at("tree_file") == file);
    CHECK(traced.at("build").is_null());
    CHECK(again.at("tree_file").is_null());
    CHECK(traced.at("boxes_per_ray") == again.at("boxes_per_ray"));
    CHECK(program::read_text(folder.file("a.hits")) == program::read_text(folder.file("b.hits")));
    const json info = document_of({"info", kScene, "--tree", file});
    CHECK(info.at("tree").at("hash") == built.at("tree").at("hash"));
    CHECK(info.at("tree").at("builder") == builder);
    CHECK(info.at("tree").at("sah_cost") == built.at("tree").at("sah_cost"));
  }
}

TEST_CASE("validate holds a file's tree against the reference builder's by the file's own options") {
  const Folder folder;
  const std::string file = folder.file("tree.gnb");
  const json built = document_of({"build", kScene, "--heuristic", "window", "--light", "0", "--axes", "spfh",
                                  "--bins", "9", "-o", file, "--repeat", "1"});
  const json good = document_of({"validate", kScene, "--tree", file, "--count", "300", "--max-rays", "50"});
  CHECK(good.at("ok") == true);
  CHECK(good.at("reference_hash") == built.at("tree").at("hash"));
  CHECK(good.at("options").at("bins") == 9);
  CHECK(good.at("options").at("axes") == "spfh");
  CHECK(good.at("options").at("heuristic") == built.at("options").at("heuristic"));
}

TEST_CASE("render takes a file's tree") {
  const Folder folder;
  const std::string file = folder.file("tree.gnb");
  static_cast<void>(document_of({"build", kScene, "-o", file, "--repeat", "1"}));
  const std::vector<std::string> small{"--width", "32", "--height", "24", "--samples", "1"};
  std::vector<std::string> kept{"render", kScene, "--tree", file, "-o", folder.file("a.png")};
  std::vector<std::string> anew{"render", kScene, "-o", folder.file("b.png")};
  kept.insert(kept.end(), small.begin(), small.end());
  anew.insert(anew.end(), small.begin(), small.end());
  CHECK(document_of(kept).at("tree_file") == file);
  static_cast<void>(document_of(anew));
  CHECK(program::read_text(folder.file("a.png")) == program::read_text(folder.file("b.png")));
}

TEST_CASE("a tree of another scene, a damaged one and a missing one exit 4 and say why") {
  const Folder folder;
  const std::string file = folder.file("tree.gnb");
  static_cast<void>(document_of({"build", kScene, "-o", file, "--repeat", "1"}));
  const auto other = run({"info", "gen:city:3k:2", "--tree", file}, kNoDevice);
  CHECK(other.status == 4);
  CHECK_THAT(other.err, Contains("another scene") && Contains(file));
  std::string bytes = program::read_text(file);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 4);
  program::write_text(file, bytes);
  for (const char* command : {"info", "trace", "validate"}) {
    CAPTURE(command);
    const auto damaged = run({command, kScene, "--tree", file});
    CHECK(damaged.status == 4);
    CHECK(damaged.out.empty());
    CHECK_THAT(damaged.err, Contains("checksum") && Contains(file));
  }
  const auto missing = run({"info", kScene, "--tree", folder.file("none.gnb")}, kNoDevice);
  CHECK(missing.status == 4);
  CHECK_THAT(missing.err, Contains("no such file"));
}

TEST_CASE("a file's tree brings its own options, and other names than .gnb and .bvh2 are refused") {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"trace", "gen:random", "--tree", "x.gnb", "--builder", "fast"},
        {"trace", "gen:random", "--tree", "x.gnb", "--bins", "8"},
        {"validate", "gen:random", "--tree", "x.gnb", "--light", "0"},
        {"render", "gen:random", "-o", "x.png", "--tree", "x.gnb", "--axes", "lsph"},
        {"build", "gen:random", "-o", "tree.txt"},
        {"build", "gen:random", "--tree", "x.gnb"}}) {
    CAPTURE(arguments);
    const auto outcome = run(arguments, kNoDevice);
    CHECK(outcome.status == 2);
    CHECK(outcome.out.empty());
  }
  CHECK_THAT(run({"build", "gen:random", "-o", "tree.txt"}, kNoDevice).err,
             Contains(".gnb") && Contains(".bvh2"));
}

TEST_CASE("the plain tree has the size its header says") {
  const Folder folder;
  const std::string file = folder.file("tree.bvh2");
  const json built = document_of({"build", kScene, "-o", file, "--repeat", "1"});
  const std::string bytes = program::read_text(file);
  const auto triangles = built.at("triangles").get<std::size_t>();
  const auto nodes = built.at("tree").at("nodes").get<std::size_t>();
  CHECK(bytes.substr(0, 8) == "gnombvh2");
  CHECK(bytes.size() == 32 + 32 * (nodes + 1) + 4 * triangles + 36 * triangles);
}

TEST_CASE("a build that is interrupted, or cannot write, leaves no file") {
  const Folder folder;
  program::Setup stopped;
  stopped.terminal = true;
  stopped.interrupt_at = "%";
  const auto outcome =
      run({"build", "gen:city:300k", "--repeat", "20", "-o", folder.file("tree.gnb")}, stopped);
  CAPTURE(outcome.err);
  CHECK(outcome.status == 130);
  CHECK(folder.names().empty());
  const auto nowhere = run({"build", kScene, "--repeat", "1", "-o", folder.file("none/tree.gnb")});
  CHECK(nowhere.status == 1);
  CHECK_THAT(nowhere.err, Contains("cannot write"));
}
