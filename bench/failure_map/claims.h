// Why methods fail: each failure of the map with its reason in a sentence, numbers that would contradict the
// reason if it were wrong, and what gnomon does instead. Feeds the bench of failures.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "figures.h"

namespace gnomon::bench {

// A number that the reason foretells.
struct Check {
  std::string what;  // in words, with its case
  double value = 0.0;
  char relation = '<';  // value < bound, or >, or = for whole numbers
  double bound = 0.0;
  [[nodiscard]] bool holds() const;
};

struct Claim {
  std::string method;
  std::string fails;    // how it shows
  std::string reason;   // one sentence
  std::string instead;  // what gnomon does by default
  std::vector<Check> checks;
};
[[nodiscard]] nlohmann::json to_json(const Claim& claim);

// Gathers checks while cases go by: what a failure is about is measured on the cases that it names.
class Findings {
 public:
  void look_at(const CaseScene& scene, const LightCase& light, const CaseRays& rays,
               const std::map<std::string, TreeFigures>& trees);
  // Those that any case looked at has checks for.
  [[nodiscard]] std::vector<Claim> claims() const;

 private:
  std::map<std::string, std::vector<Check>> checks_;  // by the failure's name
};

}  // namespace gnomon::bench
