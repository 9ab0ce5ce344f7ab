// The catalogue's tools: rays hit what they are aimed at, expectations are held against answers, and a long
// run gives the same whatever its chunks.
#include <catch2/catch.hpp>
#include <set>

#include "gnomon/scene/generators.h"
#include "gnomon/stability/aim.h"
#include "gnomon/stability/cases.h"
#include "gnomon/stability/catalogue.h"
#include "gnomon/stability/flavours.h"
#include "gnomon/stability/soak.h"
#include "gnomon/stability/soak_rays.h"
#include "support/device.h"

using namespace gnomon;
using namespace gnomon::stability;

namespace {

Bench bench() {
  return {test::context(), builders(), flavours_of(test::context().device()), 1, 64, {}, {}};
}

Verdict verdict_of(const Specimen& specimen, const std::vector<Hit>& hits, std::uint64_t invalid = 0) {
  Verdict verdict = empty_verdict(bench(), {1, "rays", "test", "none"}, "-", "-");
  verdict.exact = true;
  std::vector<std::uint32_t> any;
  for (const Hit& hit : hits) any.push_back(hit.primitive != GN_NONE ? 1 : 0);
  judge_answers(specimen, hits, any, invalid, verdict);
  return verdict;
}

const Hit kMiss{kInfinity, 0, 0, GN_NONE};

}  // namespace

TEST_CASE("rays through a place have it exactly, at any distance from the origin") {
  SteadyRandom random(3);
  for (const float offset : {0.0F, 1e3F, 1e5F, 1e6F}) {
    int exactly = 0;
    int lost = 0;
    const Triangles mesh = soup(50, 0.3F, offset, 10.0F, 7);
    for (int i = 0; i < 500; ++i) {
      const Triangle& t = mesh[random.below(50)];
      const Point place = place_on(t, 0, random);
      const Ray ray = through(place, 5.0F, random);
      exactly += passes_exactly(ray, place) ? 1 : 0;
      lost += exact_intersect(ray, t).inside ? 0 : 1;
    }
    CAPTURE(offset);
    REQUIRE(exactly >= 495);
    REQUIRE(lost <= 10);  // in the triangle's own plane by chance
  }
}

TEST_CASE("corners and middles of edges of lattice shapes are met exactly") {
  SteadyRandom random(4);
  for (const Triangles& mesh : {hill(6, 3, 5), cube_shell(4), t_junctions(3)}) {
    for (std::uint32_t kind = 0; kind < 3; ++kind) {
      for (int i = 0; i < 100; ++i) {
        const Triangle& t = mesh[random.below(static_cast<unsigned>(mesh.size()))];
        const Ray ray = towards({3, 50, 7}, place_on(t, kind, random));
        const ExactHit hit = exact_intersect(ray, t);
        if (hit.inside) REQUIRE(hit.t == 1.0);
      }
    }
  }
}

TEST_CASE("flat triangles have no area, slivers have some") {
  for (const Triangle& t : flat_triangles(100, 6)) {
    for (int i = 0; i < 20; ++i) {
      const Ray ray = towards({static_cast<float>(i), 40, 3}, corner(t, 0));
      REQUIRE_FALSE(exact_intersect(ray, t).inside);
    }
  }
  REQUIRE(slivers(10, 1.0F, 1e-6F, 1).size() == 10);
}

TEST_CASE("an expectation that is not met is a fault, whatever the oracle says") {
  const Triangle wall = triangle_of({-1, -1, 3}, {3, -1, 3}, {-1, 3, 3});
  Specimen specimen{
      {wall, wall}, {ray_of({0, 0, 0}, {0, 0, 1}), ray_of({0, 0, 0}, {0, 0, -1})}, Expect::kOracle};
  const Hit hit{3, 0.25F, 0.25F, 0};
  REQUIRE(verdict_of(specimen, {hit, kMiss}).ok());
  REQUIRE_FALSE(verdict_of(specimen, {kMiss, kMiss}).ok());
  REQUIRE_FALSE(verdict_of(specimen, {hit, hit}).ok());
  REQUIRE_FALSE(verdict_of(specimen, {hit, kMiss}, 1).ok());
  specimen.expect = Expect::kAllHit;
  REQUIRE(verdict_of(specimen, {hit, kMiss}).other_faults == 1);
  specimen.expect = Expect::kNoneHit;
  REQUIRE(verdict_of(specimen, {hit, kMiss}).other_faults == 1);
  specimen.expect = Expect::kOracle;
  const Hit second{3, 0.25F, 0.25F, 1};
  REQUIRE(verdict_of(specimen, {second, kMiss}).ok());
  specimen.in_order = true;
  REQUIRE_FALSE(verdict_of(specimen, {second, kMiss}).ok());
  const Hit off{std::nextafter(3.0F, 4.0F), 0.25F, 0.25F,
                0};  // within the oracle's tolerance, not the case's
  REQUIRE_FALSE(verdict_of(specimen, {off, kMiss}).ok());
}

TEST_CASE("without double a hit too many is forgiven, a lost one is not") {
  Verdict verdict;
  verdict.exact = false;
  verdict.most_ulp = 1.0;
  verdict.oracle.false_hits = 1;
  REQUIRE(verdict.ok());
  verdict.oracle.lost = 1;
  REQUIRE_FALSE(verdict.ok());
}

TEST_CASE("cases have numbers of their own, and a number without a case is refused") {
  std::set<std::uint32_t> numbers;
  for (const CaseInfo& info : catalogue()) REQUIRE(numbers.insert(info.number).second);
  CatalogueOptions options;
  options.only = {1000};
  REQUIRE_THROWS_AS(run_catalogue(test::context(), options), Error);
}

TEST_CASE("a long run gives the same whatever its chunks and threads") {
  SoakOptions options;
  options.rays = 3600;  // as many for each of nine places
  options.scenes = {generate_scene("random", 500, 1)};
  const SoakPart whole = soak(test::context(), options).total();
  options.chunk = 170;
  options.threads = 1;
  const SoakPart cut = soak(test::context(), options).total();
  REQUIRE(whole.rays == 3600);
  REQUIRE(cut.rays == whole.rays);
  REQUIRE(cut.oracle.hits == whole.oracle.hits);
  REQUIRE(cut.oracle.t_errors.steps == whole.oracle.t_errors.steps);
  REQUIRE(cut.at_corners == whole.at_corners);
  REQUIRE(cut.exactly == whole.exactly);
  REQUIRE(whole.oracle.lost == 0);
  REQUIRE(whole.exactly > 500);
}

TEST_CASE("a long run's part is right only with every ray right, and t within its bound") {
  SoakPart part;
  part.oracle.max_t_error_ulp = kMostUlp;
  REQUIRE(part.ok(true));
  part.oracle.max_t_error_ulp = 0.57;
  REQUIRE_FALSE(part.ok(true));
  REQUIRE(part.ok(false));  // there each hit has its own
  part = {};
  part.oracle.false_hits = 1;
  REQUIRE_FALSE(part.ok(true));
  REQUIRE(part.ok(false));
  for (const auto count : {&OracleReport::lost, &OracleReport::any_closest_disagree}) {
    part = {};
    part.oracle.*count = 1;
    REQUIRE_FALSE(part.ok(true));
    REQUIRE_FALSE(part.ok(false));
  }
  for (const auto count : {&SoakPart::invalid, &SoakPart::flavours_differ}) {
    part = {};
    part.*count = 1;
    REQUIRE_FALSE(part.ok(true));
    REQUIRE_FALSE(part.ok(false));
  }
}

TEST_CASE("a long run stops where it is told, and refuses to be none") {
  SoakOptions options;
  options.rays = 1000000;
  options.chunk = 100;
  options.scenes = {generate_scene("random", 100, 1)};
  int calls = 0;
  const SoakReport report =
      soak(test::context(), options, [&](std::string_view, double) { return ++calls < 3; });
  REQUIRE(report.stopped);
  REQUIRE(report.total().rays == 300);
  options.rays = 0;
  REQUIRE_THROWS_AS(soak(test::context(), options), Error);
}

// Sixteen rays of a packet are tested against the same triangles; sixteen single rays hardly ever are.
TEST_CASE("a quarter of a long run's rays come in bundles, and most of these are traced as packets") {
  if (test::context().device().loop_limit != 0) return;  // such devices have no packets
  const Scene scene = generate_scene("terrain", 5000, 1);
  const RaySource source(scene.triangles, 1);
  SoakPart part;
  std::vector<Ray> rays;
  for (std::uint64_t i = 0; i < 16384; ++i) rays.push_back(source.draw(i, part));
  TraceOptions options;
  options.flavour = TraceFlavour::kPacket;
  options.counters = true;
  const DeviceBvh tree = build_device(test::context(), scene.triangles);
  const TraceResult traced = Tracer(test::context(), tree, options).closest(rays);
  int packets = 0;
  int bundled = 0;
  int single = 0;
  for (std::size_t first = 0; first < rays.size(); first += 16) {
    bool same = traced.counters[first].triangles > 0;
    for (std::size_t i = first + 1; i < first + 16; ++i)
      same &= traced.counters[i].triangles == traced.counters[first].triangles;
    const bool in_bundle = first / RaySource::kBundle % 4 == 3;
    bundled += in_bundle ? 1 : 0;
    packets += in_bundle && same ? 1 : 0;
    single += !in_bundle && same ? 1 : 0;
  }
  CAPTURE(packets, bundled, single);
  REQUIRE(bundled == 256);
  REQUIRE(packets > 128);
  REQUIRE(single == 0);
}
