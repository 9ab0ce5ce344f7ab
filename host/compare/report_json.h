// A comparison as files. Feeds the command line.
//
// report.json, schema 1, is one object: "schema", "bench" ("compare"), "complete" (false after an
// interruption: a rerun goes on), "version", "commit", "command" (repeats it), "scene", "scene_name",
// "scene_hash", "triangles", "options" (an object, seeds among them), "clock" ("wall" or "cpu": the seconds
// that charts and words go by), "peer_note", and "devices". A device has its facts, "methods" (name, family,
// what, options), "done" (finished steps), "pictures" (PNG in base64), and "rows". Each row stands by itself:
// "schema", "bench", "task", "name" (stable for ever), "commit", "device", "driver", "scene", "scene_hash",
// "triangles", "method", and by task
//   build       wall_s, cpu_s (seconds of each round; equal places in different rows ran next to each
//               other), real_time, cpu_time (median ns a triangle, "time_unit"), bytes, scratch_bytes,
//               tree_hash, nodes, max_depth, sah_cost, flavour
//   trace       rays (kind), query, ray_count, hits, wall_s, cpu_s, real_time and cpu_time (median ns a ray),
//               boxes_per_ray, triangles_per_ray (null: not counted)
//   accuracy    rays, judged, hits, lost, false_hits, wrong_primitive, any_closest_disagree, max_t_error_ulp,
//               t_error_steps ([upper end in ulp, hits]; the last end null), same_as (null: judged itself)
//   prediction  rays, ray_count, predicted, measured, standard_error
//   decision    rays, query, expected_rays, kept, reason, probes, baseline_cost, cost, planning_share
//   size        rays, size (triangles of the scene at that size), ray_count, thinned, build_wall_s,
//               build_cpu_s, trace_wall_s, trace_cpu_s
//   area        area, ray_count, boxes_per_ray, triangles_per_ray
//   left_out    what, reason; method null: all
// build, trace and size also have ratio(s): {median, min, max, n} of the baseline's time over this method's,
// round by round, by the report's clock.
#pragma once

#include <string>

#include "gnomon/compare/report.h"

namespace gnomon::compare {

// One JSON text, the same for the same report. Throws nothing but bad_alloc.
[[nodiscard]] std::string to_json_text(const Report& report);
// Throws Error{kBadScene} naming `source` for a text that is no such report, or of another schema.
[[nodiscard]] Report from_json_text(const std::string& text, const std::string& source);

// The same as lines of rows, as bench/results keeps them: for each device one of task "run", with what the
// others do not say (methods, options, command), then its rows. Pictures and what a rerun goes on from are
// not in it.
[[nodiscard]] std::string to_rows_text(const Report& report);
// One report for each command that is there, in order. Throws Error{kBadScene} naming `source` and line.
[[nodiscard]] std::vector<Report> from_rows_text(const std::string& text, const std::string& source);

// A line per device, method and kind of rays, with a head; empty cells where there is no value.
[[nodiscard]] std::string to_csv(const Report& report);

}  // namespace gnomon::compare
