// gnomon compare: every method on one's own scene and devices, beside each other, as one page.
#include <CLI/CLI.hpp>
#include <memory>

#include "commands.h"
#include "comparison.h"

namespace gnomon::app {
namespace {

int run(const CompareOptions& options, Console& console) {
  try {
    return compare_methods(options, console);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kCancelled) throw;
    console.note("what is finished is kept; the same command goes on from there");
    throw;
  }
}

const char* const kFooter =
    "Builds every method's tree, traces the same rays through each, in rounds that take turns, judges the "
    "answers\n"
    "against brute force in double precision, and says in plain words which method to use, what it gains and "
    "costs,\n"
    "and where it is no better. Beside the page: its rows as .json and .csv, its charts as .svg. Exit status "
    "6 where a "
    "method\n"
    "of ours that promises exact hits has wrong ones.\n"
    "\n"
    "Kinds of rays: primary, bounce, shadow, random, parallel (gnomon trace --help), light (of the scene's "
    "first light,\n"
    "as its heuristics expect them), or a file of rays (gnomon trace --rays-out).\n"
    "\n"
    "Ctrl-C keeps what is finished; the same command goes on from there. Builds and traces are timed next to "
    "each other,\n"
    "so the times are fair to each other on a busy machine too; --clock cpu counts processor time instead of "
    "waiting\n"
    "time, where the device is the processor.\n"
    "\n"
    "Examples:\n"
    "  gnomon compare model.glb -o model.html\n"
    "  gnomon compare model.glb --rays primary,bounce --methods sah,embree --time 60s -o model.html\n"
    "  gnomon compare gen:city:1M --devices 0,1 --time 10m -o city.html";

}  // namespace

void add_compare_command(CLI::App& program, OutputOptions& output, Action& action) {
  const auto options = std::make_shared<CompareOptions>();
  CLI::App* const command = program.add_subcommand(
      "compare", "Set every method beside the others on a scene, as a page with charts.");
  add_scene_options(*command, options->scene);
  command->add_option("-o,--output", options->page, "the page to write")
      ->type_name("HTML")
      ->capture_default_str();
  command->add_option("--rays", options->kinds, "kinds of rays or files of them, by commas")
      ->delimiter(',')
      ->type_name("KINDS")
      ->capture_default_str();
  command
      ->add_option(
          "--methods", options->methods,
          "only methods whose names begin like this, by commas; sah-balanced, which others are set beside, "
          "always runs")
      ->delimiter(',')
      ->type_name("NAMES");
  command
      ->add_option("--devices", options->devices,
                   "as --device elsewhere, several by commas; default: GNOMON_DEVICE, else the first GPU, "
                   "else the first "
                   "CPU")
      ->delimiter(',')
      ->envname("GNOMON_DEVICE")
      ->type_name("D");
  command
      ->add_option("--time", options->time,
                   "how long it may take (60s, 10m), shared by the devices: fewer rays, rounds or methods "
                   "are measured "
                   "where it is "
                   "short, and the page says so")
      ->type_name("TIME")
      ->capture_default_str();
  add_count(*command, "--ray-count", options->run.ray_count, "rays of each kind at most");
  add_count(*command, "--judged-rays", options->run.judged_rays, "rays of each kind to judge");
  command->add_option("--rounds", options->run.rounds, "in which all run once")
      ->check(CLI::Range(1, 1000))
      ->type_name("N")
      ->capture_default_str();
  add_count(*command, "--seed", options->run.seed, "for the rays that are drawn at random");
  command->add_option("--clock", options->clock, "wall: waiting time; cpu: processor time of all threads")
      ->check(CLI::IsMember({"wall", "cpu"}))
      ->type_name("CLOCK")
      ->capture_default_str();
  command
      ->add_option("--rows", options->rows,
                   "append the rows to this file, one a line, as `gnomon rows` and bench/results keep them")
      ->type_name("FILE");
  command->add_flag("--afresh", options->afresh, "do not go on from rows that are there already");
  command->add_flag("--no-cache", options->no_cache,
                    "keep no compiled kernels on disk and take none from there");
  add_output_options(*command, output);
  command->footer(kFooter);
  command->callback(
      [&action, options] { action = [options](Console& console) { return run(*options, console); }; });
}

}  // namespace gnomon::app
