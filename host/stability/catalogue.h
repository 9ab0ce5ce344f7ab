// The stability catalogue: hard rays, shapes and areas, run on one device through every builder and every
// flavour of tracing, judged by the oracle. Not for long runs (soak.h). Feeds the command, tests and the
// peer's bench.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "gnomon/cl/context.h"
#include "gnomon/scene/scene.h"
#include "gnomon/stability/case.h"

namespace gnomon::stability {

struct CatalogueOptions {
  std::vector<std::uint32_t> only;  // case numbers; empty: all
  std::uint64_t seed = 1;
  std::uint32_t rays = 256;   // of one kind on one shape, about; 1..1e6
  std::vector<Scene> scenes;  // what case 18 runs on instead of a generated one
  std::string builder;        // through this one alone, by its name in verdicts; empty: through all
  std::string flavour;        // likewise
};

// All cases, by number.
[[nodiscard]] std::vector<CaseInfo> catalogue();

// Throws Error: kInvalidArgument (a number there is no case of; rays; a builder or flavour that the device
// does not have), and as builders and tracers do.
[[nodiscard]] std::vector<Verdict> run_catalogue(const cl::Context& context, const CatalogueOptions& options,
                                                 const Progress& progress = {});

// What tracers of other libraries can be asked too: the specimens of a case, none where it has checks of its
// own.
[[nodiscard]] std::vector<Specimen> specimens_of(const cl::Context& context, std::uint32_t number,
                                                 const CatalogueOptions& options);

}  // namespace gnomon::stability
