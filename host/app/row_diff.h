// Two files of rows set beside each other: which measurements are in both, and what moved by more than chance
// explains. Feeds `rows`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "row_schema.h"

namespace gnomon::app {

// A figure's move between the same measurement in two files.
struct Move {
  std::string figure;     // the field, or field.part
  RowJson before, after;  // as the rows have them
  // After over before, of medians, means or numbers; nothing for texts and where before is 0.
  std::optional<double> ratio;
  std::string verdict;  // better, worse or moved
};

struct MatchedRow {
  RowJson identity;  // the fields that say what was measured
  std::vector<Move> moves;
};

struct RowDiff {
  std::vector<MatchedRow> matched;
  std::vector<RowJson> only_before, only_after;     // identities
  std::uint64_t older_before = 0, older_after = 0;  // rows that a later one of the same file replaces
  std::uint64_t figures = 0;                        // compared
  std::uint64_t single = 0;                         // not judged: taken once
  RowJson sources_before, sources_after;            // source fields' values, each with its distinct values
  [[nodiscard]] std::uint64_t moves() const;
  [[nodiscard]] bool same() const { return moves() == 0 && only_before.empty() && only_after.empty(); }
};

struct DiffOptions {
  bool across_devices = false;              // the device says where a row came from, not what was measured
  std::string commit_before, commit_after;  // only rows of commits that begin so
};

// Rows of one file. Throws Error{kBadScene} naming file, line and reason: not readable, not JSON, no such
// kind.
[[nodiscard]] std::vector<RowJson> read_rows_of(const std::filesystem::path& file);

// Spreads move where their ranges have no value in common, means where they are more than three standard
// errors of the difference apart, exact figures where they differ at all. Of rows of one file with the same
// identity the last one counts.
[[nodiscard]] RowDiff diff_rows(const std::vector<RowJson>& before, const std::vector<RowJson>& after,
                                const DiffOptions& options);

}  // namespace gnomon::app
