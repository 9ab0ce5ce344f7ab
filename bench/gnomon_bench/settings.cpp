#include "settings.h"

namespace gnomon::bench {

void add_options(CLI::App& program, Settings& s) {
  program.add_option("--scenes", s.scenes, "generators or scene files, by commas")
      ->delimiter(',')
      ->capture_default_str();
  program.add_option("--triangles", s.triangles, "of generated scenes")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 31U))
      ->capture_default_str();
  program.add_option("--rays", s.rays, "which kinds, by commas; none: builds only")
      ->delimiter(',')
      ->check(CLI::IsMember({"primary", "bounce", "bounce-shuffled", "shadow", "shadow-shuffled", "sun-axis",
                             "sun-axis-shuffled", "sun-oblique", "sun-oblique-shuffled", "point",
                             "point-shuffled", "random", "none"}))
      ->capture_default_str();
  program
      .add_option("--flavours", s.flavours,
                  "of our tracer, by commas; sorted: auto, rays sorted first; light-sorted: by the lights "
                  "that they "
                  "go to")
      ->delimiter(',')
      ->check(CLI::IsMember({"auto", "packet", "wide", "portable", "portable-packet", "thread", "sorted",
                             "light-sorted", "compact"}))
      ->capture_default_str();
  program
      .add_option("--builders", s.builders,
                  "of our trees, by commas; balanced is set beside MEDIUM, fast beside LOW and best beside "
                  "HIGH, these two with "
                  "single rays")
      ->delimiter(',')
      ->check(CLI::IsMember({"balanced", "fast", "best"}))
      ->capture_default_str();
  program.add_option("--ray-count", s.ray_count, "rays a batch")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 31U))
      ->capture_default_str();
  program.add_option("--rounds", s.rounds, "that count, after one to warm up")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  program.add_option("--seed", s.seed, "of scenes and rays")->capture_default_str();
  program.add_flag("--all-threads", s.all_threads,
                   "all compute units and wall time, instead of one and CPU time");
  program.add_flag("!--no-build", s.build, "leave out the build rows");
  program.add_option("--bins", s.options.bins, "of our trees")->capture_default_str();
  program.add_option("--max-leaf", s.options.max_leaf_size, "of our trees")->capture_default_str();
  program.add_option("--cost-traversal", s.options.cost_traversal, "of our trees")->capture_default_str();
  program.add_option("--cost-triangle", s.options.cost_triangle, "of our trees")->capture_default_str();
  program
      .add_option("--subtree-size", s.options.subtree_size,
                  "triangles one work-group builds; 0: as the device likes")
      ->capture_default_str();
  program.add_option("--cost-node", s.collapse.cost_node, "of the collapse to wide trees")
      ->capture_default_str();
  program.add_option("--cost-block", s.collapse.cost_block, "of the collapse to wide trees")
      ->capture_default_str();
}

}  // namespace gnomon::bench
