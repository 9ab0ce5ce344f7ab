// The lookup of areas on the device against the same in plain C++.
#include "gnomon/device/find_areas.h"

#include <catch2/catch.hpp>

#include "gnomon/areas/shared_area.h"
#include "gnomon/cl/launch.h"
#include "gnomon/cl/program.h"
#include "gnomon/shared/area_math.h"
#include "support/area_shapes.h"
#include "support/device.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

std::vector<InfluenceArea> only_areas(std::size_t count) {
  std::vector<InfluenceArea> areas;
  for (const auto& [name, area] : areas_of_every_kind()) {
    if (areas.size() < count) areas.push_back(area);
  }
  return areas;
}

std::vector<GnRay> rays_near(const std::vector<InfluenceArea>& areas, std::size_t count, std::uint64_t seed) {
  Source source(seed);
  std::vector<GnRay> rays;
  for (std::size_t i = 0; i < count; ++i) rays.push_back(ray_near(areas[i % areas.size()], source));
  return rays;
}

cl::Buffer buffer_of(const char* name, std::size_t bytes) {
  return context().create_buffer(name, bytes);
}

// Every structure: the device's choices and counts are the host's. Comparisons of floats that no division led
// to, so they hold on every device.
void require_the_hosts_lookup(const std::vector<InfluenceArea>& areas, const std::vector<GnRay>& rays) {
  std::vector<GnArea> shared;
  for (const InfluenceArea& area : areas) shared.push_back(to_shared(area, 0.2));
  for (const AreaLookup lookup : {AreaLookup::kList, AreaLookup::kBvh, AreaLookup::kOctree}) {
    const TopLevel top = build_top_level(areas, lookup, {4, false});
    const DeviceTopLevel on_device = upload_top_level(context(), top, shared);
    const AreaFinder finder(context(), on_device);
    const AreaFinder::Chosen chosen = finder.choose(rays);
    const AreaFinder::Counted counted = finder.count(rays);
    std::size_t found = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      CAPTURE(i, to_string(lookup), rays[i].origin, rays[i].direction, rays[i].tmin);
      const GnRayStart start = gn_ray_start(&rays[i]);
      std::uint32_t holding = 0;
      for (const GnArea& area : shared) holding += gn_area_contains(&area, &start) != 0 ? 1 : 0;
      REQUIRE(counted.holding[i] == holding);
      REQUIRE(counted.offered[i] == candidates(top, start.point).size());
      // Affinity is of a quotient, which devices may round otherwise.
      if (context().device().is_cpu) REQUIRE(chosen.areas[i] == choose_area(top, shared, rays[i]).area);
      found += chosen.areas[i] != GN_NONE ? 1 : 0;
    }
    REQUIRE(found > rays.size() / 10);
  }
}

}  // namespace

TEST_CASE("the device looks areas up as the host does", "[portable]") {
  const auto areas = only_areas(1000);
  require_the_hosts_lookup(areas, rays_near(areas, 3000, 121));
}

TEST_CASE("the device looks a few areas up within its buffers", "[memcheck]") {
  const auto areas = only_areas(6);
  require_the_hosts_lookup(areas, rays_near(areas, 130, 122));
}

TEST_CASE("containment, affinity and exits on the device are the host's", "[portable][memcheck]") {
  const auto areas = areas_of_every_kind({20, -3, 5}, 2.0);
  Source source(123);
  std::vector<GnArea> shared;
  std::vector<GnRay> rays;
  for (int i = 0; i < 1000; ++i) {
    const InfluenceArea& area = areas[static_cast<std::size_t>(i) % areas.size()].second;
    shared.push_back(to_shared(area));
    rays.push_back(ray_near(area, source));
  }
  const cl::Buffer in_rays = buffer_of("rays", rays.size() * sizeof(GnRay));
  const cl::Buffer in_areas = buffer_of("areas", shared.size() * sizeof(GnArea));
  context().upload_values<GnRay>(in_rays, rays);
  context().upload_values<GnArea>(in_areas, shared);
  const cl::Buffer contains = buffer_of("contains", rays.size() * 4);
  const cl::Buffer affine = buffer_of("affine", rays.size() * 4);
  const cl::Buffer exits = buffer_of("exits", rays.size() * 4);
  const auto kernel = context().programs().kernel({"probe.cl"}, "", "probe_areas");
  cl::set_arguments(kernel.get(), in_rays, in_areas, contains, affine, exits);
  cl::wait(cl::enqueue(context().queue(), kernel.get(), rays.size(), 0));
  const auto got_contains = context().download_values<std::uint32_t>(contains, rays.size());
  const auto got_affine = context().download_values<std::uint32_t>(affine, rays.size());
  const auto got_exits = context().download_values<float>(exits, rays.size());
  std::size_t inside = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CAPTURE(i);
    const GnRayStart start = gn_ray_start(&rays[i]);
    REQUIRE((got_contains[i] == 1) == (gn_area_contains(&shared[i], &start) != 0));
    if (context().device().is_cpu)
      REQUIRE((got_affine[i] == 1) == (gn_area_is_affine(&shared[i], &start) != 0));
    if (got_contains[i] == 0) continue;
    inside += 1;
    REQUIRE(got_exits[i] == Approx(gn_area_exit(&shared[i], &start)).epsilon(1e-5));
  }
  REQUIRE(inside > 300);
}

TEST_CASE("a structure of other areas is refused, and so are more than the device can look up") {
  const auto areas = only_areas(3);
  const std::vector<GnArea> shared(2, to_shared(areas[0]));
  const TopLevel top = build_top_level(areas, AreaLookup::kList);
  REQUIRE_THROWS_WITH(upload_top_level(context(), top, shared), Catch::Contains("3 areas does not fit 2"));
  const DeviceTopLevel none = upload_top_level(context(), build_top_level({}, AreaLookup::kOctree), {});
  const AreaFinder finder(context(), none);
  REQUIRE(finder.choose(random_rays(70, 124)).areas == std::vector<std::uint32_t>(70, GN_NONE));
  REQUIRE(finder.choose({}).areas.empty());
}
