// Why methods fail: each failure of the map with its reason in a sentence, numbers that would be otherwise if
// the reason were wrong, and what gnomon does instead. Feeds the bench of failures.
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
  char relation = '<';  // value < bound, or >
  double bound = 0.0;
  [[nodiscard]] bool holds() const { return relation == '<' ? value < bound : value > bound; }
};

// What is said of a failure; checks are gathered apart, by its key.
struct Claim {
  std::string key;
  std::string method;
  std::string fails;    // how it shows
  std::string reason;   // one sentence
  std::string instead;  // what gnomon does by default
};
[[nodiscard]] const std::vector<Claim>& claims();

using Trees = std::map<std::string, TreeFigures>;  // by method

// One light's case, as the checks see it.
struct Look {
  const CaseScene& scene;
  const LightCase& light;
  const CaseRays& rays;
  const Trees& trees;
};

// Gathers checks while cases go by: what a failure is about is measured on the cases that it names.
class Findings {
 public:
  void look_at(const Look& look);
  // A row for each claim that any case had checks for.
  [[nodiscard]] std::vector<nlohmann::json> rows() const;

 private:
  void about_measures(const Look& look);
  void about_policies(const Look& look);
  void about_use(const Look& look);
  void add(const std::string& key, const std::string& what, double value, char relation, double bound) {
    checks_[key].push_back({what, value, relation, bound});
  }

  std::map<std::string, std::vector<Check>> checks_;
};

}  // namespace gnomon::bench
