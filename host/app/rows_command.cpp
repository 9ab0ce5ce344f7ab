// gnomon rows: what stored rows hold, and what moved between two files of them.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>
#include <memory>
#include <set>

#include "commands.h"
#include "document.h"
#include "exit_status.h"
#include "numbers.h"
#include "row_diff.h"

namespace gnomon::app {
namespace {

struct Options {
  std::vector<std::string> files;  // to check
  std::string before, after;
  DiffOptions diff;
};

// The identity's fields that tell the rows apart, in words.
class RowNames {
 public:
  explicit RowNames(const RowDiff& diff) {
    for (const MatchedRow& row : diff.matched) learn(row.identity);
    for (const auto* side : {&diff.only_before, &diff.only_after})
      for (const RowJson& identity : *side) learn(identity);
  }
  [[nodiscard]] std::string of(const RowJson& identity) const {
    std::string name;
    for (const auto& [field, value] : identity.items()) {
      if (field == "scene_hash" || (values_.at(field).size() < 2 && field != "bench")) continue;
      const std::string text = value.is_string() ? value.get<std::string>() : field + " " + value.dump();
      name += (name.empty() ? "" : ", ") + text;
    }
    return name;
  }

 private:
  void learn(const RowJson& identity) {
    for (const auto& [field, value] : identity.items()) values_[field].insert(value.dump());
  }
  std::map<std::string, std::set<std::string>> values_;
};

std::string brief(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string brief(const RowJson& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return brief(value.get<double>());
  if (!value.is_object()) return value.dump();
  if (value.contains("median"))
    return brief(value.at("median").get<double>()) + " (" + brief(value.at("min").get<double>()) + " to " +
           brief(value.at("max").get<double>()) + ", n " + value.at("n").dump() + ")";
  return brief(value.at("mean").get<double>()) + " (error " +
         brief(value.at("standard_error").get<double>()) + ")";
}

std::string sources_text(const char* side, const std::string& file, const RowJson& sources) {
  std::string text = std::string(side) + "  " + file;
  for (const auto& [field, values] : sources.items()) {
    text += ", " + field;
    for (const RowJson& value : values)
      text.append(" ").append(value.is_string() ? value.get<std::string>() : value.dump());
  }
  return text + "\n";
}

std::string counts_text(const RowDiff& diff) {
  std::string text = std::to_string(diff.matched.size()) + " measurements in both, " +
                     std::to_string(diff.figures) + " figures compared, " + std::to_string(diff.moves()) +
                     " moved";
  if (diff.single > 0)
    text += "; " + std::to_string(diff.single) + " taken once, without a spread to judge by";
  if (diff.older_before + diff.older_after > 0)
    text += "; " + std::to_string(diff.older_before) + " and " + std::to_string(diff.older_after) +
            " rows passed over for later ones of the same measurement";
  return text + "\n";
}

std::string text_of(const Options& options, const RowDiff& diff) {
  const RowNames names(diff);
  std::string text = sources_text("before", options.before, diff.sources_before) +
                     sources_text("after ", options.after, diff.sources_after) + counts_text(diff);
  if (diff.moves() > 0) {
    Table table({"measurement", "figure", "before", "after", "ratio", ""});
    for (const MatchedRow& row : diff.matched) {
      for (const Move& move : row.moves)
        table.add({names.of(row.identity), move.figure, brief(move.before), brief(move.after),
                   move.ratio ? fixed(*move.ratio, 3) : "", move.verdict});
    }
    text.append("\n").append(table.text());
  }
  for (const auto& [side, identities] :
       {std::pair{"before", &diff.only_before}, std::pair{"after", &diff.only_after}}) {
    if (identities->empty()) continue;
    text += std::string("\nonly ") + side + ":\n";
    for (const RowJson& identity : *identities) text.append("  ").append(names.of(identity)).append("\n");
  }
  return text;
}

Json json_of(const Options& options, const RowDiff& diff) {
  Json document = start_document("rows diff");
  document["before"] = {
      {"file", options.before}, {"sources", diff.sources_before}, {"older", diff.older_before}};
  document["after"] = {{"file", options.after}, {"sources", diff.sources_after}, {"older", diff.older_after}};
  document["matched"] = diff.matched.size();
  document["figures"] = diff.figures;
  document["not_judged"] = diff.single;
  document["moves"] = Json::array();
  for (const MatchedRow& row : diff.matched) {
    for (const Move& move : row.moves)
      document["moves"].push_back({{"identity", row.identity},
                                   {"figure", move.figure},
                                   {"before", move.before},
                                   {"after", move.after},
                                   {"ratio", move.ratio ? Json(*move.ratio) : Json(nullptr)},
                                   {"verdict", move.verdict}});
  }
  document["only_before"] = diff.only_before;
  document["only_after"] = diff.only_after;
  document["same"] = diff.same();
  return document;
}

int run_diff(const Options& options, Console& console) {
  const RowDiff diff = diff_rows(read_rows_of(options.before), read_rows_of(options.after), options.diff);
  if (diff.matched.empty()) {
    std::string why = "no measurement is in both files";
    if (!options.diff.across_devices) why += "; --across-devices matches rows of different devices";
    console.note(why);
  }
  console.print(json_of(options, diff));
  console.print(text_of(options, diff));
  return diff.same() ? kOk : kMoved;
}

int run_check(const Options& options, Console& console) {
  Json document = start_document("rows check");
  document["files"] = Json::object();
  std::string text;
  for (const std::string& file : options.files) {
    std::map<std::string, std::uint64_t> counts;
    for (const RowJson& row : read_rows_of(file)) counts[RowSchema::built_in().kind_of(row)->title] += 1;
    text += file + "\n";
    for (const auto& [title, count] : counts) {
      text += "  " + std::to_string(count) + "  " + title + "\n";
      document["files"][file][title] = count;
    }
  }
  console.print(document);
  console.print(text);
  return kOk;
}

}  // namespace

void add_rows_command(CLI::App& program, OutputOptions& output, Action& action) {
  const auto options = std::make_shared<Options>();
  CLI::App* const rows = program.add_subcommand("rows", "Compare stored rows, or check them.");
  rows->require_subcommand(1);

  CLI::App* const diff =
      rows->add_subcommand("diff", "What moved between two files by more than its spread.");
  diff->add_option("before", options->before, "a file of rows")->required()->type_name("A.jsonl");
  diff->add_option("after", options->after, "another, or the same with other commits")
      ->required()
      ->type_name("B.jsonl");
  diff->add_flag("--across-devices", options->diff.across_devices,
                 "match rows of different devices; without it the device is part of what was measured");
  diff->add_option("--commit-before", options->diff.commit_before, "only A's rows of commits that begin so")
      ->type_name("C");
  diff->add_option("--commit-after", options->diff.commit_after, "only B's")->type_name("C");
  add_output_options(*diff, output);
  diff->footer(
      "Rows match where all that says what was measured is equal: bench, scene, task, options, rays, device; "
      "not commit\n"
      "and driver. Of several such rows in one file the last one counts. A figure with a spread moved when "
      "the "
      "two ranges\n"
      "from least to most have no value in common; a mean, when it is three standard errors off; a count or "
      "a "
      "hash, when\n"
      "it differs. Times taken once are not judged. bench/results/README.md describes every field.\n"
      "\nExit status: 0 nothing moved and no row is in one file only, 7 otherwise, 4 not files of rows.\n"
      "\nExamples:\n  gnomon rows diff bench/results/speed.jsonl new.jsonl\n"
      "  gnomon rows diff gpu.jsonl cpu.jsonl --across-devices --json\n"
      "  gnomon rows diff spine.jsonl spine.jsonl --commit-before 961aecd --commit-after 41934c2");
  diff->callback(
      [&action, options] { action = [options](Console& console) { return run_diff(*options, console); }; });

  CLI::App* const check = rows->add_subcommand("check", "Say what rows files hold; refuse what is none.");
  check->add_option("files", options->files, "files of rows")->required()->type_name("FILE.jsonl ...");
  add_output_options(*check, output);
  check->footer(
      "Every row must be of a kind, and every field of a type, that bench/results/README.md describes. Exit "
      "status 4 when not.\n"
      "\nExamples:\n  gnomon rows check bench/results/*.jsonl");
  check->callback(
      [&action, options] { action = [options](Console& console) { return run_check(*options, console); }; });
  rows->footer(
      "Examples:\n  gnomon rows diff old.jsonl new.jsonl\n  gnomon rows check bench/results/*.jsonl");
}

}  // namespace gnomon::app
