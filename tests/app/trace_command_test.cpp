// gnomon trace: rays and hits in files, kinds of rays, rays that cannot be traced.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "run_program.h"

using nlohmann::json;
using program::Folder;
using program::run;

namespace {

// The documented records, written down here once more on purpose.
struct RayRecord {
  float origin[3];
  float tmin;
  float direction[3];
  float tmax;
};
struct HitRecord {
  float t, u, v;
  std::uint32_t primitive;
};
static_assert(sizeof(RayRecord) == 32 && sizeof(HitRecord) == 16);

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

template <typename Record>
std::string bytes_of(const std::vector<Record>& records) {
  std::string bytes(records.size() * sizeof(Record), '\0');
  std::memcpy(bytes.data(), records.data(), bytes.size());
  return bytes;
}

template <typename Record>
std::vector<Record> records_of(const std::string& bytes) {
  REQUIRE(bytes.size() % sizeof(Record) == 0);
  std::vector<Record> records(bytes.size() / sizeof(Record));
  std::memcpy(records.data(), bytes.data(), bytes.size());
  return records;
}

// Two triangles facing the z axis, at z = 0 and at z = -1.
const char* const kTwoTriangles =
    "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 -1\nv 4 0 -1\nv 0 4 -1\nf 1 2 3\nf 4 5 6\n";

}  // namespace

TEST_CASE("rays from a file give hits in a file, in the documented records") {
  const Folder folder;
  program::write_text(folder.file("two.obj"), kTwoTriangles);
  const std::vector<RayRecord> rays{
      {{1.0F, 1.0F, 5.0F}, 0.0F, {0.0F, 0.0F, -1.0F}, kInfinity},   // the front one
      {{1.0F, 1.0F, 5.0F}, 5.5F, {0.0F, 0.0F, -1.0F}, kInfinity},   // past the front one
      {{1.0F, 1.0F, 5.0F}, 0.0F, {0.0F, 0.0F, -2.0F}, 2.0F},        // ends before any
      {{9.0F, 9.0F, 5.0F}, 0.0F, {0.0F, 0.0F, -1.0F}, kInfinity},   // beside both
      {{kNan, 1.0F, 5.0F}, 0.0F, {0.0F, 0.0F, -1.0F}, kInfinity}};  // no ray at all
  program::write_text(folder.file("rays"), bytes_of(rays));
  const auto outcome = run({"trace", folder.file("two.obj"), "--rays-in", folder.file("rays"), "--hits-out",
                            folder.file("hits"), "--rays-out", folder.file("same"), "--json"});
  CAPTURE(outcome.err);
  REQUIRE(outcome.status == 0);
  const json document = json::parse(outcome.out);
  CHECK(document.at("rays") == 5);
  CHECK(document.at("hits") == 2);
  CHECK(document.at("invalid_rays") == 1);
  CHECK(program::read_text(folder.file("same")) == program::read_text(folder.file("rays")));

  const auto hits = records_of<HitRecord>(program::read_text(folder.file("hits")));
  REQUIRE(hits.size() == 5);
  CHECK(hits[0].t == 5.0F);
  CHECK(hits[0].primitive == 0);
  CHECK(hits[0].u == 0.25F);
  CHECK(hits[0].v == 0.25F);
  CHECK(hits[1].t == 6.0F);
  CHECK(hits[1].primitive == 1);
  for (std::size_t i = 2; i < 5; ++i) {
    CAPTURE(i);
    CHECK(hits[i].primitive == 0xffffffffU);
    CHECK(hits[i].t == kInfinity);
  }
  CHECK(folder.names().size() == 4);  // no temporaries left
}

TEST_CASE("rays written by one run are traced alike by another") {
  const Folder folder;
  const auto first = run({"trace", "gen:random:1k", "--rays", "shadow", "--count", "3k", "--rays-out",
                          folder.file("rays"), "--hits-out", folder.file("a"), "--repeat", "1", "--json"});
  REQUIRE(first.status == 0);
  CHECK(json::parse(first.out).at("options").at("query") == "closest");  // a file of hits needs those
  const auto second = run({"trace", "gen:random:1k", "--rays-in", folder.file("rays"), "--hits-out",
                           folder.file("b"), "--repeat", "1", "--json"});
  REQUIRE(second.status == 0);
  CHECK(json::parse(first.out).at("hits") == json::parse(second.out).at("hits"));
  CHECK(program::read_text(folder.file("a")) == program::read_text(folder.file("b")));
  const auto any = run({"trace", "gen:random:1k", "--rays-in", folder.file("rays"), "--query", "any",
                        "--repeat", "1", "--json"});
  CHECK(json::parse(any.out).at("hits") == json::parse(first.out).at("hits"));
}

TEST_CASE("every kind of rays can be made, by default for the query it is for") {
  for (const std::string kind : {"primary", "bounce", "shadow", "random", "parallel"}) {
    CAPTURE(kind);
    const auto outcome =
        run({"trace", "gen:cottage:8k", "--rays", kind, "--count", "2k", "--repeat", "1", "--json"});
    REQUIRE(outcome.status == 0);
    const json document = json::parse(outcome.out);
    CHECK(document.at("rays").get<int>() > 0);
    CHECK(document.at("rays").get<int>() <= 2000);
    CHECK(document.at("hits").get<int>() > 0);
    const bool any = kind == "shadow" || kind == "parallel";
    CHECK(document.at("options").at("query") == (any ? "any" : "closest"));
  }
}

TEST_CASE("rays may be sorted before they are traced, by origins or by lights: hits stay in their places") {
  const Folder folder;
  const auto trace = [&](const std::vector<std::string>& how) {
    std::vector<std::string> words{"trace", "gen:cottage:8k", "--rays", "shadow", "--count",
                                   "3k",    "--repeat",       "1",      "--json"};
    words.insert(words.end(), how.begin(), how.end());
    const auto outcome = run(words);
    CAPTURE(outcome.err);
    REQUIRE(outcome.status == 0);
    return json::parse(outcome.out);
  };
  const json given = trace({});
  CHECK(given.at("options").at("order") == "given");
  CHECK(given.at("options").at("sort") == false);
  for (const std::string order : {"origin", "light"}) {
    CAPTURE(order);
    const json sorted = trace({"--order", order});
    CHECK(sorted.at("options").at("order") == order);
    CHECK(sorted.at("options").at("sort") == true);
    CHECK(sorted.at("hits") == given.at("hits"));
    trace({"--order", order, "--query", "closest", "--hits-out", folder.file(order)});
  }
  trace({"--query", "closest", "--hits-out", folder.file("given")});
  CHECK(program::read_text(folder.file("light")) == program::read_text(folder.file("given")));
  CHECK(program::read_text(folder.file("origin")) == program::read_text(folder.file("given")));
  CHECK(trace({"--sort"}).at("options").at("order") == "origin");
  CHECK(run({"trace", "gen:random:100", "--sort", "--order", "light"}).status == 2);
  CHECK(run({"trace", "gen:random:100", "--order", "colour"}).status == 2);
}

TEST_CASE("a batch without rays is traced without fuss") {
  const auto outcome = run({"trace", "gen:random:100", "--count", "0", "--json"});
  REQUIRE(outcome.status == 0);
  const json document = json::parse(outcome.out);
  CHECK(document.at("rays") == 0);
  CHECK(document.at("hits") == 0);
}

TEST_CASE("a ray file that cannot be used exits 4") {
  const Folder folder;
  program::write_text(folder.file("short"), std::string(33, 'x'));
  CHECK(run({"trace", "gen:random:100", "--rays-in", folder.file("short")}).status == 4);
  CHECK(run({"trace", "gen:random:100", "--rays-in", folder.file("missing")}).status == 4);
}

TEST_CASE("fast accuracy says which hits it costs; the default costs none and says nothing") {
  const auto trace = [](const char* accuracy) {
    return run({"trace", "gen:city:3000", "--count", "5000", "--repeat", "1", "--rays", "bounce",
                "--accuracy", accuracy, "--json"});
  };
  const auto exact = trace("watertight");
  REQUIRE(exact.status == 0);
  CHECK(json::parse(exact.out).at("cost_of_fast").is_null());
  const auto fast = trace("fast");
  CAPTURE(fast.out, fast.err);
  const json document = json::parse(exact.out);
  if (document.at("flavour") == "thread") {
    CHECK(fast.status == 2);
    return;
  }
  REQUIRE(fast.status == 0);
  const json cost = json::parse(fast.out).at("cost_of_fast");
  CHECK(cost.at("lost").get<int>() + cost.at("added").get<int>() < 500);
  CHECK(cost.at("max_t_ulp").get<double>() > 1.0);
  CHECK(json::parse(fast.out).at("options").at("accuracy") == "fast");
  CHECK(run({"trace", "gen:random:100", "--accuracy", "sloppy"}).status == 2);
}
