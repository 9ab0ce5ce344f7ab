// Reading the thesis' set-ups and what it published.
#include "gnomon/measure/set_up.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "gnomon/base/error.h"
#include "gnomon/measure/published_results.h"

using Catch::Contains;

namespace {

// A file of this text, gone at the end.
class TextFile {
 public:
  explicit TextFile(const std::string& text)
      : path_(std::filesystem::temp_directory_path() /
              ("gnomon-set-up-test-" + std::to_string(std::hash<std::string>{}(text)))) {
    std::ofstream(path_, std::ios::binary) << text;
  }
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;
  ~TextFile() { std::filesystem::remove(path_); }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

const std::string kPlane =
    R"({"scene": "Suzanne", "area": "plane", "orientation": "45", "kind": "plane", "point": [1, 2, 3],
  "normal": [0, 0, -2], "half_width": 4, "half_height": 0.5, "forward_size": 7, "used_by_variants": ["Full"]})";
const std::string kPoint =
    R"({"scene": "Wood", "area": "point", "orientation": "oblique", "kind": "point", "eye": [1, 2, 3],
  "direction": [0, 0, 1], "fov_x_deg": 90, "fov_y_deg": 60, "near": 0.5, "far": 9,
  "used_by_variants": ["Standard", "Facing"]})";

std::vector<gnomon::SetUp> parsed(const std::string& entries) {
  const TextFile file(R"({"configs": [)" + entries + "]}");
  return gnomon::read_set_ups(file.path());
}

std::string without(std::string text, const std::string& part, const std::string& instead = "") {
  const auto at = text.find(part);
  REQUIRE(at != std::string::npos);
  return text.replace(at, part.size(), instead);
}

}  // namespace

TEST_CASE("a set-up is read with every measure in its place") {
  const auto set_ups = parsed(kPlane + "," + kPoint);
  REQUIRE(set_ups.size() == 2);
  const gnomon::SetUp& plane = set_ups[0];
  REQUIRE(plane.label() == "Suzanne plane 45");
  REQUIRE(plane.variants == std::vector<std::string>{"Full"});
  REQUIRE(plane.area.kind() == gnomon::AreaKind::kPlane);
  REQUIRE(plane.area.half_window()[0] == 4.0);
  REQUIRE(plane.area.half_window()[1] == 0.5);
  const gnomon::Box3d box = plane.area.enclosing_box();
  const gnomon::Vec3d lo{-3, 1.5, -4};
  const gnomon::Vec3d hi{5, 2.5, 3};
  for (std::size_t k = 0; k < 3; ++k) {
    CAPTURE(k);
    REQUIRE(box.lo[k] == Approx(lo[k]));
    REQUIRE(box.hi[k] == Approx(hi[k]));
  }
  const gnomon::SetUp& point = set_ups[1];
  REQUIRE(point.label() == "Wood point oblique");
  REQUIRE(point.variants == std::vector<std::string>{"Standard", "Facing"});
  const auto& frustum = std::get<gnomon::Frustum>(point.area.region());
  REQUIRE(frustum.tan_x == Approx(1.0));
  REQUIRE(frustum.tan_y == Approx(std::tan(3.14159265358979323846 / 6)));
  REQUIRE(frustum.near_distance == 0.5);
  REQUIRE(frustum.far_distance == 9.0);
  REQUIRE(point.area.frame().origin == gnomon::Vec3d{1, 2, 3});
}

TEST_CASE("a set-up that cannot be is refused by file, entry and field") {
  const auto refusal = [](const std::string& entries) -> std::string {
    try {
      static_cast<void>(parsed(entries));
    } catch (const gnomon::Error& error) {
      REQUIRE(error.code() == gnomon::ErrorCode::kInvalidArgument);
      return error.what();
    }
    return "accepted";
  };
  REQUIRE_THAT(
      refusal(kPoint + "," + without(kPlane, R"("half_height": 0.5,)")),
      Contains("configs[1]") && Contains("half_height is missing") && Contains("gnomon-set-up-test-"));
  REQUIRE_THAT(refusal(without(kPlane, "[1, 2, 3]", "[1, 2]")), Contains("point is not a list of three"));
  REQUIRE_THAT(refusal(without(kPlane, "[1, 2, 3]", R"([1, 2, "3"])")), Contains("point is not a number"));
  REQUIRE_THAT(refusal(without(kPlane, R"("half_width": 4)", R"("half_width": -4)")), Contains("configs[0]"));
  REQUIRE_THAT(refusal(without(kPlane, "Suzanne", "Suzan")), Contains("Suzan\"") && Contains("Cottage"));
  REQUIRE_THAT(refusal(without(kPlane, R"("kind": "plane")", R"("kind": "line")")),
               Contains("kind is \"line\""));
  REQUIRE_THAT(refusal(without(kPlane, R"(["Full"])", R"("Full")")), Contains("used_by_variants"));
  REQUIRE_THAT(refusal(without(kPlane, R"(["Full"])", "[1]")), Contains("used_by_variants"));
  REQUIRE_THAT(refusal("3"), Contains("not an object"));
  REQUIRE_THAT(refusal(""), Contains("no list \"configs\""));
}

TEST_CASE("the thesis' scenes come from files or generators, two are lost") {
  REQUIRE(gnomon::scene_source_of("Random1000") == "gen:random1000");
  REQUIRE(gnomon::scene_source_of("Wood") == "woods.glb");
  for (const char* const name : {"Random100", "Random1000", "Suzanne", "Cottage", "CottageWalls", "Wood"})
    REQUIRE_FALSE(gnomon::is_lost(name));
  REQUIRE(gnomon::is_lost("Crowd"));
  REQUIRE(gnomon::is_lost("Sponza"));
}

TEST_CASE("published rows are read by the names of their columns") {
  // Columns in another order than the program reads them, one it does not know, both ends of line, a blank
  // line.
  const std::string heads =
      "variant,scene,area,orientation,flag,junk,max_level,local_cost,total_cost_local_plus_fallback,"
      "global_bvh_only_cost,hit_fraction_any,est_pah,est_sah,overlap_to_lvl4,overlap_to_lvl7,overlap_to_"
      "lvl10,"
      "overlap_to_lvl15,overlap_to_lvl100,planes_tried_per_internal_node";
  const std::string row =
      "Full,Wood,point,oblique,odd,x,19,10.5,20.5,30.5,0.25,11,12,0.4,0.7,0.10,0.15,0.99,1.75";
  const TextFile file(heads + "\r\n" + row + "\r\n\n");
  const auto rows = gnomon::read_published_results(file.path());
  REQUIRE(rows.size() == 1);
  const auto set_up = parsed(kPoint).front();
  const gnomon::PublishedRow& read = rows.at(gnomon::key_of(set_up, "Full"));
  REQUIRE(read.flag == "odd");
  REQUIRE(read.local_cost == 10.5);
  REQUIRE(read.total_cost == 20.5);
  REQUIRE(read.global_cost == 30.5);
  REQUIRE(read.hit_share == 0.25);
  REQUIRE(read.predicted_pah == 11.0);
  REQUIRE(read.predicted_sah == 12.0);
  REQUIRE(read.overlap_4 == 0.4);
  REQUIRE(read.overlap_7 == 0.7);
  REQUIRE(read.overlap_10 == 0.10);
  REQUIRE(read.overlap_15 == 0.15);
  REQUIRE(read.overlap_all == 0.99);
  REQUIRE(read.max_level == 19.0);
  REQUIRE(read.planes_tried == 1.75);
  const auto refusal = [](const std::string& text) -> std::string {
    const TextFile bad(text);
    try {
      static_cast<void>(gnomon::read_published_results(bad.path()));
    } catch (const gnomon::Error& error) {
      return error.what();
    }
    return "accepted";
  };
  REQUIRE_THAT(refusal(without(heads, "est_pah", "est") + "\n" + row), Contains("no column est_pah"));
  REQUIRE_THAT(refusal(heads + "\n" + without(row, ",1.75")), Contains("line 2") && Contains("ends before"));
  REQUIRE_THAT(refusal(heads + "\n" + without(row, "10.5", "10.5x")),
               Contains("\"10.5x\" in column local_cost"));
}
