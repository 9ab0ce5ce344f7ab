// The reproduction of the thesis as JSON rows. Feeds `reproduce`.
#pragma once

#include "console.h"
#include "gnomon/measure/published_results.h"
#include "gnomon/measure/reproduce.h"
#include "gnomon/measure/summary.h"

namespace gnomon::app {

// What all rows of a set-up share: schema, bench, commit, scene and its hash, area, seed.
[[nodiscard]] Json row_start(const SetUp& set_up, const ReproduceScene& scene,
                             const ReproduceOptions& options);
// One tree's costs, with the published ones where there are.
[[nodiscard]] Json tree_row(const Json& start, const TreeRun& run, const PublishedRow* published,
                            const ReproduceOptions& options);
// One measure's prediction on rays of another.
[[nodiscard]] Json prediction_row(const Json& start, const PredictionRun& run,
                                  const ReproduceOptions& options);
[[nodiscard]] Json to_json(const ReproduceSummary& summary);

}  // namespace gnomon::app
