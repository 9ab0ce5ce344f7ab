#include "row_diff.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "gnomon/base/error.h"
#include "gnomon/scene/read_file.h"

namespace gnomon::app {
namespace {

constexpr double kStandardErrors = 3.0;

struct Row {
  RowJson identity;
  const RowJson* values = nullptr;
  const RowKind* kind = nullptr;
};

FieldRole role_in(const RowField& field, const DiffOptions& options) {
  return options.across_devices && field.name == "device" ? FieldRole::kSource : field.role;
}

RowJson identity_of(const RowJson& row, const RowKind& kind, const DiffOptions& options) {
  RowJson identity;
  for (const RowField& field : kind.fields) {
    if (role_in(field, options) == FieldRole::kIdentity && row.contains(field.name))
      identity[field.name] = row.at(field.name);
  }
  return identity;
}

struct Side {
  std::vector<Row> rows;  // in the file's order
  std::map<std::string, std::size_t> places;
  std::uint64_t older = 0;
  RowJson sources = RowJson::object();
};

void note_source(RowJson& sources, const std::string& name, const RowJson& value) {
  RowJson& values = sources[name];
  if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
}

Side side_of(const std::vector<RowJson>& rows, const std::string& commit, const DiffOptions& options) {
  Side side;
  for (const RowJson& row : rows) {
    if (!row.value("commit", "").starts_with(commit)) continue;
    const RowKind& kind = *RowSchema::built_in().kind_of(row);
    const RowJson identity = identity_of(row, kind, options);
    const auto [place, fresh] = side.places.emplace(identity.dump(), side.rows.size());
    if (fresh)
      side.rows.push_back({identity, &row, &kind});
    else
      side.rows[place->second].values = &row;
    side.older += fresh ? 0 : 1;
  }
  for (const Row& row : side.rows) {
    for (const RowField& field : row.kind->fields) {
      if (role_in(field, options) == FieldRole::kSource && row.values->contains(field.name))
        note_source(side.sources, field.name, row.values->at(field.name));
    }
  }
  return side;
}

std::string verdict_of(const std::string& better, double before, double after) {
  if (better.empty() || before == after) return "moved";
  return (after < before) == (better == "lower") ? "better" : "worse";
}

class Comparison {
 public:
  Comparison(RowDiff& diff, MatchedRow& row) : diff_(diff), row_(row) {}

  void field(const RowField& field, const RowJson& before, const RowJson& after) {
    if (field.role == FieldRole::kSingle) diff_.single += 1;
    if (field.role == FieldRole::kExact) exact(field, field.name, before, after);
    if (field.role == FieldRole::kSpread) spread(field, before, after);
  }

 private:
  void add(const std::string& figure, const RowField& field, const RowJson& before, const RowJson& after,
           std::optional<double> from, std::optional<double> to) {
    Move move{figure, before, after, std::nullopt, "moved"};
    if (from && to) {
      if (*from != 0.0) move.ratio = *to / *from;
      move.verdict = verdict_of(field.better, *from, *to);
    }
    row_.moves.push_back(std::move(move));
  }

  // One round has a value and no spread.
  static bool taken_once(const RowJson& figure) { return figure.is_object() && figure.value("n", 2) < 2; }

  // Parts of objects each by itself.
  void exact(const RowField& field, const std::string& name, const RowJson& before, const RowJson& after) {
    if (before.is_object() && after.is_object()) {
      for (const auto& [part, value] : before.items())
        exact(field, name + "." + part, value, after.contains(part) ? after.at(part) : RowJson(nullptr));
      for (const auto& [part, value] : after.items())
        if (!before.contains(part)) exact(field, name + "." + part, nullptr, value);
      return;
    }
    diff_.figures += 1;
    if (before == after) return;
    const bool numbers = before.is_number() && after.is_number();
    add(name, field, before, after, numbers ? std::optional<double>(before) : std::nullopt,
        numbers ? std::optional<double>(after) : std::nullopt);
  }

  void spread(const RowField& field, const RowJson& before, const RowJson& after) {
    if (taken_once(before) || taken_once(after)) {
      diff_.single += 1;
      return;
    }
    diff_.figures += 1;
    if (before.is_null() || after.is_null()) {
      add(field.name, field, before, after, std::nullopt, std::nullopt);
      return;
    }
    const char* const middle = field.type == "mean" ? "mean" : "median";
    const double from = before.at(middle);
    const double to = after.at(middle);
    if (field.type == "mean") {
      const double error =
          std::hypot(before.at("standard_error").get<double>(), after.at("standard_error").get<double>());
      if (std::fabs(to - from) <= kStandardErrors * error) return;
    } else if (before.at("min") <= after.at("max") && after.at("min") <= before.at("max")) {
      return;
    }
    add(field.name, field, before, after, from, to);
  }

  RowDiff& diff_;
  MatchedRow& row_;
};

}  // namespace

std::uint64_t RowDiff::moves() const {
  std::uint64_t sum = 0;
  for (const MatchedRow& row : matched) sum += row.moves.size();
  return sum;
}

std::vector<RowJson> read_rows_of(const std::filesystem::path& file) {
  const auto refuse = [&](const std::string& where, const std::string& why) {
    throw Error(ErrorCode::kBadScene, file.string() + where + ": " + why);
  };
  std::vector<unsigned char> bytes;
  try {
    bytes = read_file(file);
  } catch (const Error& error) {
    throw Error(error.code() == ErrorCode::kIo ? ErrorCode::kBadScene : error.code(), error.what());
  }
  std::istringstream lines(std::string(bytes.begin(), bytes.end()));
  std::vector<RowJson> rows;
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.empty()) continue;
    RowJson row = RowJson::parse(line, nullptr, false);
    const std::string where = ", line " + std::to_string(number);
    if (row.is_discarded() || !row.is_object()) refuse(where, "not a JSON object");
    try {
      if (const auto fault = RowSchema::built_in().fault_of(row)) refuse(where, *fault);
    } catch (const RowJson::exception& error) {  // a field that says what kind of row it is, of another type
      refuse(where, error.what());
    }
    rows.push_back(std::move(row));
  }
  if (rows.empty()) refuse("", "there are no rows in it");
  return rows;
}

RowDiff diff_rows(const std::vector<RowJson>& before, const std::vector<RowJson>& after,
                  const DiffOptions& options) {
  const Side a = side_of(before, options.commit_before, options);
  const Side b = side_of(after, options.commit_after, options);
  RowDiff diff;
  diff.older_before = a.older;
  diff.older_after = b.older;
  diff.sources_before = a.sources;
  diff.sources_after = b.sources;
  for (const Row& row : a.rows) {
    const auto place = b.places.find(row.identity.dump());
    if (place == b.places.end()) {
      diff.only_before.push_back(row.identity);
      continue;
    }
    const RowJson& other = *b.rows[place->second].values;
    MatchedRow matched{row.identity, {}};
    Comparison comparison(diff, matched);
    for (const RowField& field : row.kind->fields) {
      if (!row.values->contains(field.name) || !other.contains(field.name)) continue;
      const RowJson& from = row.values->at(field.name);
      const RowJson& to = other.at(field.name);
      if (!from.is_null() || !to.is_null()) comparison.field(field, from, to);
    }
    diff.matched.push_back(std::move(matched));
  }
  for (const Row& row : b.rows)
    if (!a.places.contains(row.identity.dump())) diff.only_after.push_back(row.identity);
  return diff;
}

}  // namespace gnomon::app
