// What the stability catalogue is made of: numbered cases, what is put to a tracer, and what came of it. Not
// for running them (catalogue.h). Feeds every file of this room and the command.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gnomon/tree/oracle.h"

namespace gnomon::stability {

// What must be true of the answers beside agreeing with the oracle.
enum class Expect {
  kOracle,   // nothing else
  kAllHit,   // every ray that is valid hits
  kNoneHit,  // no ray hits
};

// Triangles and rays for them.
struct Specimen {
  std::vector<Triangle> triangles;
  std::vector<Ray> rays;
  Expect expect = Expect::kOracle;
  std::uint64_t invalid = 0;  // so many rays must be refused
  bool in_order = false;      // of equally near triangles the first must be named
};

// A case as people read it. Its number is its name for ever; a case that goes leaves a gap.
struct CaseInfo {
  std::uint32_t number = 0;
  std::string group;        // "rays", "geometry", "areas", "machines"
  std::string name;         // a few words
  std::string expectation;  // one sentence
};

// What one case gave for one builder and one flavour of tracing. Names go to JSON rows and stay.
struct Verdict {
  CaseInfo info;
  std::string builder;  // "-" where none is used
  std::string flavour;
  std::uint64_t triangles = 0;  // of all specimens together
  std::uint64_t invalid_rays = 0;
  OracleReport oracle;
  double most_ulp = 0.0;           // t may be wrong by so much
  std::uint64_t other_faults = 0;  // expectations that the oracle knows nothing of
  std::string first_fault;         // of those, in words

  void fault(const std::string& what) {
    if (other_faults++ == 0) first_fault = what;
  }
  // Devices without double may call a ray that passes an edge by 2^-40 of the distance a hit (exact-hits.md):
  // there only losses count.
  bool exact = true;
  [[nodiscard]] bool ok() const {
    const std::uint64_t wrong = exact ? oracle.mismatches() : oracle.lost + oracle.any_closest_disagree;
    return wrong == 0 && other_faults == 0 && oracle.max_t_error_ulp <= most_ulp;
  }
};

}  // namespace gnomon::stability
