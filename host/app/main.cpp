// gnomon: the program. Parses, runs one subcommand, turns errors into messages and exit statuses.
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "commands.h"
#include "exit_status.h"
#include "interrupt.h"
#include "version.h"

namespace gnomon::app {
namespace {

const char* const kFooter =
    "SCENE is a .gltf, .glb or .obj file, or gen:NAME[:TRIANGLES[:SEED]] for a generated one (gnomon scene "
    "--list).\n"
    "Data goes to stdout, notes and progress to stderr. Counts may be written 250000, 250k, 1M or 1e6.\n"
    "\n"
    "A first round:\n"
    "  gnomon devices\n"
    "  gnomon build gen:city:100k\n"
    "  gnomon trace gen:city:100k --rays bounce\n"
    "  gnomon validate gen:city:100k\n"
    "  gnomon render gen:atrium -o atrium.png --heat-map boxes.png\n"
    "  gnomon compare gen:atrium -o report.html     # which method to use, and why\n"
    "\n"
    "Exit status: 0 ok, 1 failure, 2 wrong usage, 3 no device, 4 bad scene, tree, ray or rows file, 5 out of "
    "memory,\n"
    "6 validation or a stability case failed, 7 rows differ, 130 interrupted.\n"
    "\n"
    "Environment: GNOMON_DEVICE (as --device), XDG_CACHE_HOME (compiled kernels go to its folder gnomon),\n"
    "GNOMON_KERNELS (a folder to read kernel sources from), NO_COLOR.";

int status_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::kInvalidArgument:
      return kUsage;
    case ErrorCode::kIo:
      return kFailure;
    case ErrorCode::kNoDevice:
      return kNoDevice;
    case ErrorCode::kBadScene:
      return kBadScene;
    case ErrorCode::kOutOfMemory:
      return kOutOfMemory;
    case ErrorCode::kDevice:
      return kFailure;
    case ErrorCode::kCancelled:
      return kInterrupted;
  }
  return kFailure;
}

// The subcommand the command line got to, for the hint after a usage error.
std::string hint(const CLI::App& program) {
  const auto chosen = program.get_subcommands();
  return "see gnomon " + (chosen.empty() ? std::string() : chosen.front()->get_name() + " ") + "--help";
}

// What the parser found wrong; it has no words for a subcommand that there is not, and says what is missing
// before what is not known, which is often why it is missing.
std::string fault(const CLI::App& program, const CLI::ParseError& error, int argc, char** argv) {
  const auto chosen = program.get_subcommands();
  if (!chosen.empty() && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    const std::vector<std::string> unknown = chosen.front()->remaining(true);
    if (!unknown.empty()) return CLI::ExtrasError(chosen.front()->get_name(), unknown).what();
  }
  if (argc < 2 || *argv[1] == '-' || !program.get_subcommands().empty()) return error.what();
  std::string names;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; }))
    names += (names.empty() ? "" : ", ") + command->get_name();
  return "there is no subcommand \"" + std::string(argv[1]) + "\"; there are " + names;
}

int run_action(const Action& action, Console& console) {
  try {
    return action(console);
  } catch (const Error& error) {
    // LLVM inside a driver takes SIGINT as well and removes the files it compiles: that program fails for no
    // other reason.
    if (interrupted()) {
      console.error("cancelled");
      return kInterrupted;
    }
    console.error(error.what());
    return status_of(error.code());
  } catch (const std::bad_alloc&) {
    console.error("out of memory on the host; use a smaller scene or fewer rays");
    return kOutOfMemory;
  } catch (const std::exception& error) {
    console.error(error.what());
    return kFailure;
  }
}

int run(int argc, char** argv) {
  CLI::App program(
      "gnomon builds bounding volume hierarchies on any OpenCL device, traces rays through them and "
      "checks the answers.",
      "gnomon");
  OutputOptions output;
  Action action;
  program.get_formatter()->column_width(36);
  program.set_version_flag("--version", "gnomon " + version() + " (" + commit() + ")");
  add_devices_command(program, output, action);
  add_scene_command(program, output, action);
  add_info_command(program, output, action);
  add_build_command(program, output, action);
  add_trace_command(program, output, action);
  add_plan_command(program, output, action);
  add_detect_command(program, output, action);
  add_validate_command(program, output, action);
  add_render_command(program, output, action);
  add_compare_command(program, output, action);
  add_stability_command(program, output, action);
  add_reproduce_command(program, output, action);
  add_rows_command(program, output, action);
  add_completion_command(program, action);
  program.footer(kFooter);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success))
      return program.exit(error);  // help
    Console(output).error(fault(program, error, argc, argv) + "\n" + hint(program));
    return kUsage;
  }
  if (!action) {
    Console(output).error("which subcommand?\n" + hint(program));
    return kUsage;
  }
  catch_interrupts();
  Console console(output);
  return run_action(action, console);
}

}  // namespace
}  // namespace gnomon::app

int main(int argc, char** argv) {
  try {
    return gnomon::app::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gnomon: error: %s\n", error.what());
    return gnomon::app::kFailure;
  }
}
