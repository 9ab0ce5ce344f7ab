// The subcommands, one file each. Each adds itself to the program: its options, its help, and what `action`
// becomes when the command line names it. Feeds main.
#pragma once

#include "options.h"

namespace gnomon::app {

void add_devices_command(CLI::App& program, OutputOptions& output, Action& action);
void add_scene_command(CLI::App& program, OutputOptions& output, Action& action);
void add_info_command(CLI::App& program, OutputOptions& output, Action& action);
void add_build_command(CLI::App& program, OutputOptions& output, Action& action);
void add_trace_command(CLI::App& program, OutputOptions& output, Action& action);
void add_validate_command(CLI::App& program, OutputOptions& output, Action& action);
void add_render_command(CLI::App& program, OutputOptions& output, Action& action);
void add_compare_command(CLI::App& program, OutputOptions& output, Action& action);
void add_stability_command(CLI::App& program, OutputOptions& output, Action& action);
void add_detect_command(CLI::App& program, OutputOptions& output, Action& action);
void add_plan_command(CLI::App& program, OutputOptions& output, Action& action);
void add_reproduce_command(CLI::App& program, OutputOptions& output, Action& action);
void add_rows_command(CLI::App& program, OutputOptions& output, Action& action);
void add_completion_command(CLI::App& program, Action& action);

}  // namespace gnomon::app
