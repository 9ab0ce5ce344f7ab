// Our builders and tracers as one entrant. Feeds the list of methods.
#pragma once

#include <memory>
#include <optional>

#include "gnomon/compare/traced_tree.h"

namespace gnomon::compare {

struct OwnMethod {
  BuildOptions build;
  std::optional<RaysOf> rays;  // that the heuristic measures; none: surface area
  TracedTree::Options tracing;
};

// Throws Error{kInvalidArgument} for what the device cannot do.
[[nodiscard]] std::unique_ptr<Entrant> enter_own(const cl::Context& context, const Scene& scene,
                                                 const OwnMethod& method);

}  // namespace gnomon::compare
