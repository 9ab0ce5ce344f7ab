// The subcommands of benches that go over the thesis' set-ups or over generated scenes. Feeds
// ray_aware_bench, plan_clock_bench.
#pragma once

#include <CLI/CLI.hpp>

#include "set_ups.h"

namespace gnomon::bench {

struct SetUpCommands {
  CLI::App* thesis = nullptr;
  CLI::App* generated = nullptr;
};

// `sources` must outlive `app`.
inline SetUpCommands add_set_up_commands(CLI::App& app, SetUpSources& sources) {
  app.require_subcommand(1);
  CLI::App* const thesis = app.add_subcommand("thesis", "the thesis' set-ups");
  thesis->add_option("--configs", sources.configs)->required();
  thesis->add_option("--scenes", sources.models)->required();
  thesis->add_option("--only", sources.only, "set-ups whose label has this");
  CLI::App* const generated = app.add_subcommand("generated", "generated scenes");
  generated->add_option("--scenes", sources.scenes)->delimiter(',');
  generated->add_option("--triangles", sources.triangles);
  return {thesis, generated};
}

}  // namespace gnomon::bench
