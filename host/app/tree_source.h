// The tree a subcommand works with: built here, or read from a file that gnomon build wrote. Feeds the
// subcommands that trace.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "build_timing.h"
#include "console.h"
#include "gnomon/tree/tree_file.h"

namespace gnomon::app {

// --tree FILE; excludes the options that say how to build one, which must be there already.
void add_tree_file_option(CLI::App& command, std::string& file);

// load_tree for whom a file that cannot be read is one that cannot be used: throws Error{kBadScene} for it.
[[nodiscard]] StoredTree load_tree_of(const Scene& scene, const std::string& file);

// Builds with `options` as build_for_use does, or takes the tree of `file` where that is not empty.
[[nodiscard]] TimedBuild tree_for_use(const cl::Context& context, const Scene& scene, const std::string& file,
                                      const BuildOptions& options, const BuildRuns& runs,
                                      const Progress& progress);
// The same as build_timed does.
[[nodiscard]] TimedBuild tree_timed(const cl::Context& context, const Scene& scene, const std::string& file,
                                    const BuildOptions& options, const BuildRuns& runs,
                                    const Progress& progress);

// "tree_file", null for a tree built here; the options it was built by are among the document's already.
void add_tree_file(Json& document, const TimedBuild& build);

}  // namespace gnomon::app
