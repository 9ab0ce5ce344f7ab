// What a plan may be asked for.
#include <algorithm>
#include <cmath>

#include "gnomon/base/error.h"
#include "gnomon/plan/choose.h"

namespace gnomon {

namespace {

void require(bool ok, const std::string& option, const std::string& value, const std::string& range) {
  if (ok) return;
  throw Error(ErrorCode::kInvalidArgument,
              "plan option " + option + " = " + value + " is outside its range " + range);
}

}  // namespace

const std::vector<std::string>& candidate_names() {
  static const std::vector<std::string> names{
      "sah",        "sah-order", "sah-mix", "sah-rays", "sah-segments", "sah-seen",   "seen-rays", "best",
      "best-order", "best-rays", "mix",     "mix-rays", "light-mix",    "light-rays", "local-rays"};
  return names;
}

OptimiseOptions thorough() {
  OptimiseOptions options;
  options.share = 0.25F;
  options.max_passes = 12;
  options.leave_settled = true;
  return options;
}

void PlanOptions::check() const {
  const auto& names = candidate_names();
  std::string all = "auto";
  for (const std::string& name : names) all += ", " + name;
  require(choice == "auto" || std::find(names.begin(), names.end(), choice) != names.end(), "choice", choice,
          "of " + all);
  require(fit_rays >= 1 && fit_rays <= kMostSegments, "fit_rays", std::to_string(fit_rays),
          "1.." + std::to_string(kMostSegments));
  require(probe_rays >= 1 && probe_rays <= 65536, "probe_rays", std::to_string(probe_rays), "1..65536");
  for (const float share : {mixture_share, every_share})
    require(share >= 0.0F && share <= 1.0F, "mixture_share or every_share", std::to_string(share), "[0, 1]");
  SampleMeasure{{1.0F, 1.0F, 1.0F}, prior_share}.check();
  optimise.check();
  sampled.check();
  for (const double share : {sample_share, probe_share})
    require(share >= 0.0 && std::isfinite(share), "sample_share or probe_share", std::to_string(share),
            "of finite numbers >= 0");
  require(least_oblique >= 1.0, "least_oblique", std::to_string(least_oblique), "of numbers >= 1");
  for (const double share : {most_framed, most_framed_every})
    require(share >= 0.0, "most_framed or most_framed_every", std::to_string(share), "of numbers >= 0");
  require(most_framed_cost >= 0.0, "most_framed_cost", std::to_string(most_framed_cost), "of numbers >= 0");
  for (const double work : {framed_work, packet_work})
    require(work >= 1.0 && std::isfinite(work), "framed_work or packet_work", std::to_string(work),
            "of finite numbers >= 1");
  require(most_local >= 0.0 && most_local <= 1.0, "most_local", std::to_string(most_local), "[0, 1]");
  race.check();
  for (const double price : {prices.build_start, prices.build, prices.move_start, prices.move,
                             prices.move_seen, prices.move_segments, prices.finish, prices.divide,
                             prices.turn, prices.learn, prices.trace, prices.byte, prices.saved})
    require(price >= 0.0 && std::isfinite(price), "prices", std::to_string(price), "of finite numbers >= 0");
}

}  // namespace gnomon
