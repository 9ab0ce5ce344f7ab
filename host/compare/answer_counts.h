// The counts of wrong answers as every row names them. Feeds reports here and the program's rows.
#pragma once

#include <nlohmann/json.hpp>

namespace gnomon {

// Of an OracleReport or of what keeps its counts.
template <typename Counts>
void put_answer_counts(nlohmann::ordered_json& row, const Counts& counts) {
  row["hits"] = counts.hits;
  row["lost"] = counts.lost;
  row["false_hits"] = counts.false_hits;
  row["wrong_primitive"] = counts.wrong_primitive;
  row["any_closest_disagree"] = counts.any_closest_disagree;
}

}  // namespace gnomon
