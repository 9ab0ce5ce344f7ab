// Answers of many methods against the oracle; answers of the same bits are judged once. Feeds run_device.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "gnomon/compare/method.h"
#include "gnomon/tree/candidate_tree.h"

namespace gnomon::compare {

class Judge {
 public:
  // The scene must outlive it. pairs_of_floats: the device has no double (OracleOptions).
  Judge(const Scene& scene, bool pairs_of_floats);

  // Judges up to `rays` of the batch within `seconds`, unless an earlier answer to this batch was the same.
  [[nodiscard]] AccuracyRow row(const std::string& method, const Batch& batch, Answers answers,
                                std::uint64_t rays, double seconds, const Progress& progress = {});
  // Before the next batch.
  void forget() { earlier_.clear(); }

 private:
  const Scene& scene_;
  bool pairs_of_floats_;
  CandidateTree candidates_;
  std::vector<std::pair<AccuracyRow, Answers>> earlier_;
};

}  // namespace gnomon::compare
