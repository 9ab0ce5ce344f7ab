// gnomon validate: passes what is right, and catches faults planted in the kernels.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "broken_kernels.h"

using Catch::Contains;
using nlohmann::json;
using program::BrokenKernels;
using program::Edit;
using program::Folder;
using program::run;

namespace {

const std::vector<std::string> kValidate{"validate", "gen:cottage:8k", "--count", "3k", "--max-rays",
                                         "300",      "--json"};

std::uint64_t sum_of(const json& document, const char* key) {
  std::uint64_t sum = 0;
  for (const json& kind : document.at("kinds")) sum += kind.at(key).get<std::uint64_t>();
  return sum;
}

}  // namespace

TEST_CASE("a right tree and right hits are found right") {
  const auto outcome = run({"validate", "gen:cottage:8k", "--count", "3k", "--max-rays", "300", "--json"});
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.status == 0);
  const json document = json::parse(outcome.out);
  CHECK(document.at("ok") == true);
  CHECK(document.at("mismatches") == 0);
  CHECK(document.at("tree_fault").is_null());
  CHECK(document.at("reference_hash") == document.at("tree").at("hash"));
  REQUIRE(document.at("kinds").size() == 5);
  for (const json& kind : document.at("kinds")) {
    CAPTURE(kind.dump());
    CHECK(kind.at("judged").get<int>() > 0);
    for (const char* key : {"lost", "false_hits", "wrong_primitive", "ties", "any_closest_disagree"}) {
      CHECK(kind.contains(key));
    }
    CHECK(kind.at("max_t_error_ulp").get<double>() < 4.0);
  }
  const auto text = run({"validate", "gen:cottage:8k", "--count", "300", "--quiet"});
  CHECK(text.status == 0);
  CHECK(text.err.empty());
  CHECK_THAT(text.out, Contains("mismatches 0") && Contains("any/closest") && Contains("parallel"));
}

TEST_CASE("the reference builder is asked on large scenes only on demand") {
  const std::vector<std::string> large{"validate", "gen:random:201k", "--count", "50", "--max-rays",
                                       "5",        "--json"};
  const json quick = json::parse(run(large).out);
  CHECK(quick.at("reference_hash").is_null());
  auto thorough = large;
  thorough.emplace_back("--reference");
  const json full = json::parse(run(thorough).out);
  CHECK(full.at("reference_hash") == full.at("tree").at("hash"));
}

TEST_CASE("kernels that lose hits near the edges of triangles are caught") {
  // What the float filter leaves undecided is taken for a miss, and it leaves more undecided, in every
  // flavour.
  const BrokenKernels broken({{"shared/hit_math.h", "  return -1;", "  return 0;"},
                              {"shared/hit_math.h", "edges.bound = ", "edges.bound = 4096.0f * "},
                              {"wide_leaf.h", ": GN_EDGE_ERROR_8 * ", ": 4096.0f * GN_EDGE_ERROR_8 * "},
                              {"wide_leaf.h", "test_exactly(walk, ray, leaves, seat, -1);", ";"},
                              {"packet_leaf.h", ": GN_PACKET_ERROR * ", ": 256.0f * GN_PACKET_ERROR * "},
                              {"packet_leaf.h", "      decide(p, rays", "      if (sure) decide(p, rays"}});
  const auto outcome = run(kValidate, broken.setup());
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.status == 6);
  const json document = json::parse(outcome.out);
  CHECK(document.at("ok") == false);
  CHECK(document.at("tree_fault").is_null());
  CHECK(sum_of(document, "lost") > 0);
  CHECK(document.at("mismatches") == sum_of(document, "lost") + sum_of(document, "false_hits") +
                                         sum_of(document, "wrong_primitive") +
                                         sum_of(document, "any_closest_disagree"));
}

TEST_CASE("kernels that build boxes too small are caught by the tree alone") {
  const BrokenKernels broken({{"triangle_box.h", "GN_VMAX(GN_VMAX(a, b), c)", "GN_VMAX(a, b)"}});
  const auto outcome = run(kValidate, broken.setup());
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.status == 6);
  const json document = json::parse(outcome.out);
  CHECK(document.at("ok") == false);
  CHECK(document.at("tree_fault").is_string());
  CHECK(document.at("tree").at("sah_cost").is_null());
  CHECK(document.at("kinds").empty());
  CHECK(document.at("reference_hash") != document.at("tree").at("hash"));
  const auto text = run({"validate", "gen:cottage:8k", "--count", "50", "-q"}, broken.setup());
  CHECK(text.status == 6);
  CHECK_THAT(text.out, Contains("MISMATCH") && Contains("BROKEN") && Contains("DIFFERS"));
  // The others do not use such a tree.
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"build", "gen:cottage:8k"},
                                             {"trace", "gen:cottage:8k"},
                                             {"render", "gen:cottage:8k", "-o", "never.png"}}) {
    CAPTURE(arguments);
    const auto refused = run(arguments, broken.setup());
    CHECK(refused.status == 1);
    CHECK_THAT(refused.err, Contains("broken tree"));
  }
}

TEST_CASE("kernels that do not compile, or are not there, are failures that say so") {
  const BrokenKernels broken(
      {{"trace.cl", "__kernel void trace_closest(", "__kernel void trace_closest(what "},
       {"trace_packet.cl", "__kernel void trace_closest(", "__kernel void trace_closest(what "}});
  const auto outcome = run(kValidate, broken.setup());
  CHECK(outcome.status == 1);
  CHECK_THAT(outcome.err, Contains("build log") && Contains("trace_packet.cl"));
  const Folder empty;
  const auto missing = run(kValidate, {{{"GNOMON_KERNELS", empty.path().string()}}, false, {}, {}});
  CHECK(missing.status == 1);
  CHECK_THAT(missing.err, Contains("GNOMON_KERNELS"));
}

TEST_CASE("every kind says how wrong t is, as a distribution that adds up to its hits") {
  const auto outcome = run({"validate", "gen:random:500", "--count", "300", "--json"});
  REQUIRE(outcome.status == 0);
  const json document = json::parse(outcome.out);
  for (const json& kind : document.at("kinds")) {
    std::uint64_t hits = 0;
    for (const json& step : kind.at("t_error_steps")) hits += step[1].get<std::uint64_t>();
    CHECK(hits == kind.at("hits"));
    for (const char* key : {"lost", "false_hits", "wrong_primitive", "t_error_ulp"})
      CHECK(kind.contains(key));
  }
}
