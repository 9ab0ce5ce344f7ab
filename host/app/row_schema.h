// What the fields of stored rows mean: which say what was measured, which are figures, in which units. Read
// from bench/results/schema.json, which the build puts into the program. Feeds `rows` and bench/results_page.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon::app {

// In the order they were written.
using RowJson = nlohmann::ordered_json;

enum class FieldRole {
  kIdentity,  // rows that agree in these are of the same measurement
  kSource,    // where a row came from: commit, driver
  kExact,     // a figure that is the same on every run of the same code
  kSpread,    // a figure with {median, min, max, n}, or {mean, standard_error}
  kSingle,    // a time taken once: no spread to judge it by
  kDetail,    // never compared
};

struct RowField {
  std::string name;
  FieldRole role = FieldRole::kDetail;
  std::string type;    // text, flag, count, number, spread, mean, object, list
  std::string unit;    // empty: a pure number, or none
  std::string better;  // lower, higher or empty
  bool optional = false;
  bool null = false;  // may be null
  std::string means;
};

// One kind of row: those of a bench whose `when` fields have one of these values.
struct RowKind {
  std::string title;
  std::string bench;
  std::uint64_t schema = 1;
  std::vector<std::pair<std::string, std::vector<std::string>>> when;
  std::string written_by;
  std::vector<std::string> files;
  std::vector<RowField> fields;  // shared ones first
  [[nodiscard]] bool matches(const RowJson& row) const;
  [[nodiscard]] const RowField* find(std::string_view name) const;
};

class RowSchema {
 public:
  // Throws Error{kInvalidArgument} for text that is not such a schema.
  explicit RowSchema(std::string_view text);
  // The one that was built in.
  static const RowSchema& built_in();

  [[nodiscard]] const std::vector<RowKind>& kinds() const { return kinds_; }
  // Null where no kind fits.
  [[nodiscard]] const RowKind* kind_of(const RowJson& row) const;
  // The first thing that is not as the schema says, or nothing.
  [[nodiscard]] std::optional<std::string> fault_of(const RowJson& row) const;

 private:
  std::vector<RowKind> kinds_;
};

}  // namespace gnomon::app
