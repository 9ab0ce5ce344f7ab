// What the oracle found, as JSON: the same fields wherever rays are judged. Feeds stability and validate.
#pragma once

#include "console.h"
#include "gnomon/tree/oracle.h"

namespace gnomon::app {

// Adds counts of rays, hits, lost and false ones and wrong triangles; quantiles of t errors in ulp, and their
// distribution as [upper end of a step in ulp, hits] for steps that are not empty, the last end null.
void add_oracle(Json& row, const OracleReport& report);

}  // namespace gnomon::app
