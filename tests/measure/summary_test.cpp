// Many set-ups in a few figures, by hand.
#include "gnomon/measure/summary.h"

#include <catch2/catch.hpp>
#include <cmath>

using gnomon::RayMeasure;

namespace {

gnomon::SetUp set_up(const std::string& orientation) {
  return {"Random100", "plane", orientation, {}, gnomon::InfluenceArea::plane({})};
}

gnomon::TreeRun run(const std::string& builder, double cost, double surface = 0.0,
                    RayMeasure rays = RayMeasure::kParallel) {
  gnomon::TreeRun out;
  out.builder = builder;
  out.rays = rays;
  out.local = {cost, 0.5};
  out.predicted_surface = surface;
  return out;
}

gnomon::PublishedRow published(double cost, double surface, const std::string& flag = "") {
  gnomon::PublishedRow row;
  row.flag = flag;
  row.local_cost = cost;
  row.predicted_sah = surface;
  return row;
}

}  // namespace

TEST_CASE("deviations are relative, of rows that are what they say apart from those that are not") {
  gnomon::PublishedResults results;
  const auto a = set_up("parallel");
  const auto b = set_up("45");
  results[gnomon::key_of(a, "Full")] = published(10.0, 100.0);
  results[gnomon::key_of(a, "Standard")] = published(10.0, 100.0);
  results[gnomon::key_of(b, "Full")] = published(20.0, 100.0);
  results[gnomon::key_of(b, "Longest")] = published(10.0, 100.0, "MISLABELLED");
  gnomon::ReproduceSummary summary;
  summary.add(a, {{run("Full", 10.5, 100.0), run("Standard", 8.0, 100.05), run("PAH3", 1.0)}, {}}, results);
  summary.add(b, {{run("Full", 22.6, 102.0), run("Longest", 15.0, 100.0)}, {}}, results);
  REQUIRE(summary.compared(false) == 3);
  REQUIRE(summary.compared(true) == 1);
  REQUIRE(summary.median_deviation(false) == Approx(0.13));  // of 0.05, 0.2 and 0.13
  REQUIRE(summary.median_deviation(true) == Approx(0.5));
  const auto large = summary.large_deviations();
  REQUIRE(large.size() == 3);  // those of more than 12 %, flagged ones too
  REQUIRE(large[0].variant == "Standard");
  REQUIRE(large[0].ratio() == Approx(0.8));
  REQUIRE(large[1].set_up == "Random100 plane 45");
  REQUIRE(large[2].flag == "MISLABELLED");
  // 0.5, -2 and 2.6 over sqrt(2) times the standard error of 0.5.
  REQUIRE(summary.rms_errors_off() == Approx(std::sqrt((0.25 + 4.0 + 6.76) / 0.5 / 3.0)));
  REQUIRE(summary.estimates_within(1e-5) == 1);
  REQUIRE(summary.estimates_within(1e-3) == 2);
  REQUIRE(summary.estimates_within(0.05) == 3);
  REQUIRE(gnomon::ReproduceSummary().median_deviation(false) == 0.0);
  REQUIRE(gnomon::ReproduceSummary().rms_errors_off() == 0.0);
}

TEST_CASE("duels compare builders on the same set-up and rays") {
  gnomon::ReproduceSummary summary;
  const auto yaw = RayMeasure::kYawPitch;
  const auto near = RayMeasure::kNearPlane;
  summary.add(set_up("parallel"),
              {{run("Standard", 10), run("Full", 20), run("Facing", 10), run("SAH3", 8), run("PAH3", 4)}, {}},
              {});
  gnomon::SetUp point{"Random100", "point", "45", {}, gnomon::InfluenceArea::point({})};
  summary.add(point,
              {{run("Standard", 10, 0, yaw), run("Full", 5, 0, yaw), run("SAH3", 10, 0, yaw),
                run("PAH3", 12, 0, yaw), run("SAH3", 6, 0, near), run("PAH3", 3, 0, near)},
               {}},
              {});
  const auto duels = summary.variant_duels();
  REQUIRE(duels.size() == 2);
  REQUIRE(duels[0].builder == "Facing");
  REQUIRE(duels[0].count == 1);
  REQUIRE(duels[0].wins == 0);  // a draw is none
  REQUIRE(duels[1].builder == "Full");
  REQUIRE(duels[1].against == "Standard");
  REQUIRE(duels[1].geomean == Approx(1.0));  // of two and a half
  REQUIRE(duels[1].worst == Approx(2.0));
  REQUIRE(duels[1].wins == 1);
  REQUIRE(duels[1].count == 2);
  const auto thesis = summary.three_axes_duel();
  REQUIRE(thesis.count == 2);  // near-plane rays are not the thesis'
  REQUIRE(thesis.geomean == Approx(std::sqrt(0.5 * 1.2)));
  const auto by_measure = summary.three_axes_duels_by_measure();
  REQUIRE(by_measure.size() == 3);
  REQUIRE(by_measure[0].geomean == Approx(0.5));
  REQUIRE(by_measure[1].rays == yaw);
  REQUIRE(by_measure[1].geomean == Approx(1.2));
  REQUIRE(by_measure[1].wins == 0);
  REQUIRE(by_measure[2].geomean == Approx(0.5));
}

TEST_CASE("prediction errors are told by rays and measure, beside what sampling alone would make") {
  const auto parallel = RayMeasure::kParallel;
  gnomon::ReproduceSummary summary;
  summary.add(set_up("parallel"),
              {{}, {{parallel, parallel, false, {11, 0.2}, 10}, {parallel, parallel, true, {11, 0.2}, 22}}},
              {});
  summary.add(set_up("45"), {{}, {{parallel, parallel, false, {9.8, 0.4}, 10}}}, {});
  const auto errors = summary.prediction_errors();
  REQUIRE(errors.size() == 2);
  REQUIRE(errors[0].count == 2);
  REQUIRE(errors[0].mean == Approx(0.06));
  REQUIRE(errors[0].median == Approx(0.06));
  REQUIRE(errors[0].max == Approx(0.1));
  REQUIRE(errors[0].noise == Approx(0.03));
  REQUIRE(errors[0].max_beyond_noise == Approx(0.06));
  REQUIRE(errors[1].surface);
  REQUIRE(errors[1].mean == Approx(0.5));
}
