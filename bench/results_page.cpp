// Writes the page that describes stored rows from their schema, and from nothing else; or checks that the
// page is what the schema gives, that every file of rows in its folder is on it, and that it lists no file
// that is not there.
//
//   results_page PAGE.md [--check]
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "arguments.h"
#include "row_schema.h"

namespace {

using gnomon::app::FieldRole;
using gnomon::app::RowField;
using gnomon::app::RowKind;
using gnomon::app::RowSchema;

const char* const kHead =
    "# Stored rows\n"
    "\n"
    "<!-- Written by results_page from schema.json; change that, not this page. -->\n"
    "\n"
    "Every figure of README, of the notes and of CHANGELOG comes from a row here. A `.jsonl` file holds one "
    "JSON object a\n"
    "line. `gnomon rows check FILE` holds rows against what stands below, `gnomon rows diff A B` says what "
    "moved between\n"
    "two files; `bash bench/rerun.sh` takes rows again, `bash bench/figures.sh` makes the pages and tables "
    "anew.\n"
    "\n"
    "**Versions.** `schema` is the version of a kind of row. A field may be added without a new version, as "
    "an optional\n"
    "one; a field that goes, or means something else, raises it, and readers of the old one stay. Rows are "
    "appended, not\n"
    "changed: of rows of the same measurement the last one counts.\n"
    "\n"
    "**Roles.** *identity*: rows that agree in these are of the same measurement. *source*: where the row "
    "came from.\n"
    "*exact*: the same on every run of the same code and options, so any difference is one. *spread*: a time "
    "or rate with\n"
    "its spread. *single*: taken once, direction only. *detail*: not compared.\n"
    "\n"
    "**Types.** spread: `{median, min, max, n}` of n rounds; mean: `{mean, standard_error}`; count: a whole "
    "number; the\n"
    "rest are JSON's. An arrow says which way is better.\n";

const char* name_of(FieldRole role) {
  switch (role) {
    case FieldRole::kIdentity:
      return "identity";
    case FieldRole::kSource:
      return "source";
    case FieldRole::kExact:
      return "exact";
    case FieldRole::kSpread:
      return "spread";
    case FieldRole::kSingle:
      return "single";
    case FieldRole::kDetail:
      break;
  }
  return "detail";
}

std::string line_of(const RowField& field) {
  std::string type = field.type;
  if (field.null) type += " or null";
  if (field.optional) type += ", optional";
  std::string role = name_of(field.role);
  if (!field.better.empty()) role += field.better == "lower" ? " ↓" : " ↑";
  return "| `" + field.name + "` | " + role + " | " + type + " | " + field.unit + " | " + field.means +
         " |\n";
}

std::string section_of(const RowKind& kind) {
  std::string text =
      "\n## " + kind.title + "\n\n`bench` " + kind.bench + ", `schema` " + std::to_string(kind.schema);
  for (const auto& [field, values] : kind.when) {
    text += ", `" + field + "` ";
    for (const std::string& value : values) text += (value == values.front() ? "" : " or ") + value;
  }
  text += ". Written by `" + kind.written_by + "`; in";
  for (const std::string& file : kind.files) text += " `" + file + "`";
  text += kind.files.empty() ? " no stored file yet" : "";
  text += ".\n\n| field | role | type | unit | |\n|---|---|---|---|---|\n";
  for (const RowField& field : kind.fields) text += line_of(field);
  return text;
}

// What the folder and the schema do not have in common.
std::string files_apart(const std::filesystem::path& folder) {
  std::set<std::string> described;
  for (const RowKind& kind : RowSchema::built_in().kinds())
    described.insert(kind.files.begin(), kind.files.end());
  std::string apart;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() == ".jsonl" && described.erase(name) == 0)
      apart += " " + name + " (not described)";
  }
  for (const std::string& name : described) apart += " " + name + " (not there)";
  return apart;
}

std::string read(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

int main(int argc, char** argv) {
  const char* const usage =
      "usage: results_page PAGE.md [--check]\n\nWrites the page that describes stored rows from their "
      "schema; --check: "
      "exits 1 where it is another, or where the\nfolder's files of rows are not those of the schema.\n";
  if (gnomon::bench::taught(argc, argv, usage)) return 0;
  if (argc < 2) {
    std::fputs(usage, stderr);
    return 2;
  }
  try {
    const std::filesystem::path file = argv[1];
    std::string page = kHead;
    for (const RowKind& kind : RowSchema::built_in().kinds()) page += section_of(kind);
    if (argc < 3) {
      std::ofstream(file, std::ios::binary) << page;
      return 0;
    }
    const std::string apart = files_apart(file.parent_path());
    if (!apart.empty()) std::fprintf(stderr, "schema.json and the folder disagree about%s\n", apart.c_str());
    const bool same = read(file) == page;
    if (!same) std::fprintf(stderr, "%s is behind schema.json: run bench/figures.sh\n", argv[1]);
    return same && apart.empty() ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "results_page: %s\n", error.what());
    return 1;
  }
}
