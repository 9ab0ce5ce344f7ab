#include "reproduce_text.h"

#include "document.h"
#include "gnomon/measure/prediction.h"
#include "numbers.h"
#include "table.h"

namespace gnomon::app {
namespace {

std::string percent(double share) {
  return fixed(100.0 * share, 1) + " %";
}

std::string duel_text(const Duel& duel) {
  return "geomean " + fixed(duel.geomean, 3) + ", lower in " + std::to_string(duel.wins) + " of " +
         std::to_string(duel.count) + ", worst " + fixed(duel.worst, 2);
}

std::string deviations_text(const ReproduceSummary& summary) {
  if (summary.comparisons().empty()) return {};
  Facts facts;
  facts.add(
      "median deviation from the published local cost",
      percent(summary.median_deviation(false)) + " of " + std::to_string(summary.compared(false)) + " rows");
  if (summary.compared(false) > 0) {
    facts.add("the same in standard errors of the difference, root mean square",
              fixed(summary.rms_errors_off(), 2) + " (1 where trees are equal and rays are not)");
    facts.add("SAH's estimates, which have no noise",
              std::to_string(summary.estimates_within(1e-5)) + " of " +
                  std::to_string(summary.compared(false)) + " rows within 0.001 %, " +
                  std::to_string(summary.estimates_within(1e-3)) + " within 0.1 %, " +
                  std::to_string(summary.estimates_within(1e-2)) + " within 1 %");
  }
  if (summary.compared(true) > 0)
    facts.add("of rows that are not what they were published as",
              percent(summary.median_deviation(true)) + " of " + std::to_string(summary.compared(true)));
  std::string text = facts.text();
  const auto large = summary.large_deviations();
  if (large.empty()) return text;
  Table table({"more than 12 % off", "variant", "published", "measured", "ratio", "flag"});
  for (const Comparison& row : large)
    table.add({row.set_up, row.variant, fixed(row.published, 1), fixed(row.measured, 1),
               fixed(row.ratio(), 3), row.flag});
  return text + "\n" + table.text();
}

std::string errors_text(const ReproduceSummary& summary, const std::vector<PredictionRun>& wide) {
  Table table(
      {"rays", "predicted by", "mean error", "median", "max", "noise", "max beyond 2 noise", "set-ups"});
  for (const PredictionErrors& e : summary.prediction_errors())
    table.add({std::string(to_string(e.rays)), e.surface ? "surface area" : std::string(to_string(e.measure)),
               percent(e.mean), percent(e.median), percent(e.max), percent(e.noise),
               percent(e.max_beyond_noise), std::to_string(e.count)});
  for (const PredictionRun& run : wide)
    table.add({std::string(to_string(run.rays)) + ", 130x45",
               run.surface ? "surface area" : std::string(to_string(run.measure)),
               percent(prediction_error(run.real.mean, run.predicted)), "", "",
               percent(run.predicted > 0.0 ? run.real.standard_error / run.predicted : 0.0), "", "1"});
  return table.text();
}

}  // namespace

std::string summary_text(const ReproduceSummary& summary, const std::vector<PredictionRun>& wide) {
  Facts facts;
  for (const Duel& duel : summary.variant_duels())
    facts.add(duel.builder + " over Standard", duel_text(duel));
  if (summary.three_axes_duel().count > 0)
    facts.add("PAH3 over SAH3, the thesis' rays", duel_text(summary.three_axes_duel()));
  for (const Duel& duel : summary.three_axes_duels_by_measure())
    facts.add("PAH3 over SAH3, rays " + std::string(to_string(duel.rays)), duel_text(duel));
  return deviations_text(summary) + "\n" + facts.text() + "\n" + errors_text(summary, wide);
}

}  // namespace gnomon::app
