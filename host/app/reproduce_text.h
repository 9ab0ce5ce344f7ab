// What gnomon reproduce says at the end, for people. Feeds the command reproduce.
#pragma once

#include <string>
#include <vector>

#include "gnomon/measure/summary.h"

namespace gnomon::app {

// Deviations from what was published, builders against each other, and how well costs were predicted; `wide`
// are the predictions of the area that the thesis' scenes have not.
[[nodiscard]] std::string summary_text(const ReproduceSummary& summary,
                                       const std::vector<PredictionRun>& wide);

}  // namespace gnomon::app
