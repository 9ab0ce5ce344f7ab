// Records are bounded, fair within each kind, light and depth, and the same however rays came in.
#include "gnomon/render/ray_recorder.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

using namespace gnomon;

namespace {

struct OneRay {
  RayUse use;
  std::uint32_t bounce;
  PathId path;
  std::uint32_t light;
};

// Camera rays of `cells` x 4 samples, half as many bounces and so on, and a shadow ray to light cell % 3
// each.
std::vector<OneRay> rays_of(std::uint32_t cells) {
  std::vector<OneRay> out;
  for (std::uint32_t sample = 0; sample < 4; ++sample) {
    for (std::uint32_t bounce = 0; bounce < 7; ++bounce) {
      for (std::uint32_t cell = 0; cell < cells >> bounce; ++cell)
        out.push_back({bounce == 0 ? RayUse::kCamera : RayUse::kBounce, bounce, {cell, sample}, kNoLight});
      for (std::uint32_t cell = 0; cell < cells >> bounce; ++cell)
        out.push_back({RayUse::kShadow, bounce + 1, {cell, sample}, cell % 3});
    }
  }
  return out;
}

// Handed over in runs of at most `most`.
RayRecord recorded(const std::vector<OneRay>& all, std::uint64_t bound, std::size_t most,
                   std::uint64_t seed = 5) {
  RayRecorder recorder(bound, seed);
  for (std::size_t first = 0; first < all.size();) {
    std::vector<Ray> rays;
    std::vector<PathId> paths;
    std::vector<std::uint32_t> lights;
    std::size_t last = first;
    for (; last < all.size() && last - first < most && all[last].use == all[first].use &&
           all[last].bounce == all[first].bounce;
         ++last) {
      // The ray says which it is.
      Ray ray{};
      ray.origin[0] = static_cast<float>(all[last].path.cell);
      ray.origin[1] = static_cast<float>(all[last].path.sample);
      ray.origin[2] = static_cast<float>(all[last].bounce);
      rays.push_back(ray);
      paths.push_back(all[last].path);
      if (all[last].use == RayUse::kShadow) lights.push_back(all[last].light);
    }
    recorder.add({all[first].use, all[first].bounce, rays, paths, lights});
    first = last;
  }
  return recorder.record();
}

}  // namespace

TEST_CASE("a record has everything where there is room, and what was traced in any case") {
  const auto all = rays_of(100);
  const RayRecord record = recorded(all, 100'000, 1000);
  REQUIRE(record.rays.size() == all.size());
  // Camera; bounces at depth 1 to 4; shadow rays to three lights at depths 1 to 4.
  REQUIRE(record.strata.size() == 1 + 4 + 3 * 4);
  std::uint64_t traced = 0;
  for (const RayStratum& stratum : record.strata) {
    REQUIRE(stratum.traced == stratum.stored);
    traced += stratum.traced;
  }
  REQUIRE(traced == all.size());
  REQUIRE(record.strata.front().kind == RecordedKind::kCamera);
  REQUIRE(record.strata.front().traced == 400);
}

TEST_CASE("a record keeps its bound and shares it evenly, whatever the batches") {
  auto all = rays_of(1000);
  const RayRecord record = recorded(all, 1700, 1000);
  REQUIRE(record.rays.size() <= 1700);
  REQUIRE(record.rays.size() > 1700 - record.strata.size());
  std::uint64_t largest = 0;
  for (const RayStratum& stratum : record.strata) largest = std::max(largest, stratum.stored);
  for (const RayStratum& stratum : record.strata) {
    CAPTURE(static_cast<int>(stratum.kind), stratum.light, stratum.depth);
    REQUIRE(stratum.stored == std::min(stratum.traced, largest));
  }
  for (const std::size_t most : {1U, 7U, 100'000U}) {
    CAPTURE(most);
    REQUIRE(ray_record_bytes(recorded(all, 1700, most)) == ray_record_bytes(record));
  }
  // Last come first.
  std::reverse(all.begin(), all.end());
  REQUIRE(ray_record_bytes(recorded(all, 1700, 50)) == ray_record_bytes(record));
  REQUIRE(ray_record_bytes(recorded(all, 1700, 50, 6)) != ray_record_bytes(record));
  REQUIRE(recorded(all, 3, 50).rays.size() <= 3);
}

TEST_CASE("every ray of a stratum is as likely to be kept as any other") {
  const auto all = rays_of(64);
  // Of 256 camera rays a tenth or so, over many seeds: counts by cell and by sample are those of a fair draw.
  std::vector<double> by_cell(64), by_sample(4);
  double kept = 0.0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const RayRecord camera = only_kinds(recorded(all, 400, 1000, seed), std::vector{RecordedKind::kCamera});
    for (const Ray& ray : camera.rays) {
      by_cell[static_cast<std::size_t>(ray.origin[0])] += 1.0;
      by_sample[static_cast<std::size_t>(ray.origin[1])] += 1.0;
      kept += 1.0;
    }
  }
  REQUIRE(kept > 3000.0);
  const auto chi_square = [&](const std::vector<double>& counts) {
    double sum = 0.0;
    const double expected = kept / static_cast<double>(counts.size());
    for (const double count : counts) sum += (count - expected) * (count - expected) / expected;
    return sum;
  };
  CHECK(chi_square(by_cell) < 63.0 + 4.0 * std::sqrt(2.0 * 63.0));
  CHECK(chi_square(by_sample) < 3.0 + 5.0 * std::sqrt(2.0 * 3.0));
}
