// The stability catalogue's rays through Embree, default and ROBUST, beside gnomon: how many hits each loses,
// sees where none are, or gets wrong. One JSON row per case and tracer on stdout.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "gnomon/device/trace_device.h"
#include "gnomon/peers/embree_peer.h"
#include "gnomon/stability/catalogue.h"
#include "gnomon_commit.h"

namespace {

using gnomon::OracleReport;
using gnomon::stability::CaseInfo;
using gnomon::stability::Specimen;
using Json = nlohmann::ordered_json;

// Embree's t are rounded more often than ours: what it sees within this is no fault.
constexpr double kPeerToleranceUlp = 1000.0;

// Coordinates and directions beyond this are not for Embree, which asserts it.
constexpr float kPeerLargest = 1.8e18F;

bool embree_takes(const GnRay& ray) {
  const auto takes = [](float x) { return std::fabs(x) < kPeerLargest; };
  return std::all_of(ray.origin, ray.origin + 3, takes) &&
         std::all_of(ray.direction, ray.direction + 3, takes);
}

// What all of them can be asked: no refused rays, and ranges that begin at the origin or later.
Specimen for_all(Specimen specimen) {
  for (GnRay& ray : specimen.rays) ray.tmin = std::max(ray.tmin, 0.0F);
  std::erase_if(specimen.rays, [](const GnRay& ray) { return !embree_takes(ray); });
  return specimen;
}

void judge_into(const Specimen& specimen, std::span<const GnHit> hits, std::span<const std::uint32_t> any,
                double tolerance_ulp, OracleReport& sum) {
  gnomon::OracleOptions options;
  options.max_rays = specimen.rays.size();
  options.time_budget = std::chrono::hours(1);
  options.t_tolerance_ulp = tolerance_ulp;
  sum.add(gnomon::judge(specimen.triangles, specimen.rays, hits, any, options));
}

void by_gnomon(const gnomon::cl::Context& context, const Specimen& specimen, OracleReport& sum) {
  const gnomon::DeviceBvh tree = gnomon::build_device(context, specimen.triangles);
  const gnomon::Tracer tracer(context, tree);
  judge_into(specimen, tracer.closest(specimen.rays).hits, tracer.any(specimen.rays).occluded, 4.0, sum);
}

void by_embree(const Specimen& specimen, bool robust, OracleReport& sum) {
  gnomon::peers::EmbreeScene scene(specimen.triangles, gnomon::peers::EmbreeQuality::kMedium, robust);
  scene.build();
  std::vector<GnHit> hits(specimen.rays.size());
  std::vector<std::uint32_t> any(specimen.rays.size());
  scene.closest(specimen.rays, hits);
  scene.any(specimen.rays, any);
  judge_into(specimen, hits, any, kPeerToleranceUlp, sum);
}

void print_row(const CaseInfo& info, const std::string& tracer, const std::string& device, std::uint64_t seed,
               const OracleReport& report) {
  const Json row{{"bench", "stability_peer"},
                 {"schema", 1},
                 {"commit", GNOMON_COMMIT},
                 {"device", device},
                 {"case", info.number},
                 {"name", info.name},
                 {"tracer", tracer},
                 {"seed", seed},
                 {"rays", report.rays_judged},
                 {"hits", report.hits},
                 {"lost", report.lost},
                 {"false_hits", report.false_hits},
                 {"wrong_primitive", report.wrong_primitive},
                 {"any_closest_disagree", report.any_closest_disagree},
                 {"t_error_max_ulp", report.max_t_error_ulp}};
  std::printf("%s\n", row.dump().c_str());
}

}  // namespace

int main(int argc, char** argv) {
  gnomon::stability::CatalogueOptions options;
  options.rays = 4096;
  CLI::App program(
      "stability_peer: gnomon stability's rays through gnomon and Embree, one JSON row a case and tracer");
  program.add_option("--rays-per-case", options.rays, "of one kind on one specimen, about")
      ->capture_default_str();
  program.add_option("--seed", options.seed, "for what is drawn at random")->capture_default_str();
  CLI11_PARSE(program, argc, argv);
  try {
    const gnomon::cl::Context context(gnomon::cl::choose_device(gnomon::cl::list_devices(), ""));
    for (const CaseInfo& info : gnomon::stability::catalogue()) {
      OracleReport ours;
      OracleReport plain;
      OracleReport robust;
      for (const Specimen& given : gnomon::stability::specimens_of(context, info.number, options)) {
        if (given.invalid > 0) continue;  // Embree does not say what it refuses
        const Specimen specimen = for_all(given);
        if (specimen.rays.empty()) continue;
        by_gnomon(context, specimen, ours);
        by_embree(specimen, false, plain);
        by_embree(specimen, true, robust);
      }
      if (ours.rays_judged == 0) continue;
      print_row(info, "gnomon", context.device().name, options.seed, ours);
      print_row(info, "Embree " RTC_VERSION_STRING " MEDIUM", context.device().name, options.seed, plain);
      print_row(info, "Embree " RTC_VERSION_STRING " MEDIUM ROBUST", context.device().name, options.seed,
                robust);
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "stability_peer: %s\n", error.what());
    return 1;
  }
}
