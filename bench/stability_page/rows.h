// Sums and groups of rows, for the page of hard rays.
#pragma once

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "../page_file.h"

namespace stability_page {

using nlohmann::json;
using Rows = std::vector<json>;
using Names = std::vector<std::string>;

inline std::uint64_t count_of(const json& row, const char* key) {
  return row.at(key).get<std::uint64_t>();
}

// A sum over rows; rows of before the field was there say so.
inline std::string sum_of(const Rows& rows, const char* key) {
  std::uint64_t sum = 0;
  for (const json& row : rows) {
    if (!row.contains(key)) return "–";
    sum += count_of(row, key);
  }
  return std::to_string(sum);
}

inline std::string largest_error(const Rows& rows) {
  double most = 0.0;
  for (const json& row : rows) {
    const json& max = row.at("t_error_ulp").at("max");
    if (max.is_null()) return "> 8";
    most = std::max(most, max.get<double>());
  }
  return page::number(most, most < 100.0 ? "%.3f" : "%.0f");
}

inline std::string verdicts(const Rows& rows) {
  const auto ok =
      std::count_if(rows.begin(), rows.end(), [](const json& r) { return r.at("ok").get<bool>(); });
  const std::string text = std::to_string(ok) + " of " + std::to_string(rows.size());
  return static_cast<std::size_t>(ok) == rows.size() ? text : std::string("**").append(text).append("**");
}

inline const Names kFaults{"lost", "false_hits", "wrong_primitive", "any_closest_disagree"};

// The four counts of faults, as the tables' columns name them.
inline Names faults_of(const Rows& rows) {
  Names cells;
  for (const std::string& key : kFaults) cells.push_back(sum_of(rows, key.c_str()));
  return cells;
}

template <typename Key>
std::vector<std::pair<std::string, Rows>> grouped(const Rows& rows, Key key) {
  std::vector<std::pair<std::string, Rows>> groups;
  for (const json& row : rows) {
    const std::string name = key(row);
    auto at = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == name; });
    if (at == groups.end()) at = groups.insert(groups.end(), {name, {}});
    at->second.push_back(row);
  }
  return groups;
}

inline std::string text_at(const json& row, const char* key) {
  return row.at(key).get<std::string>();
}

inline std::string number_of_case(const json& row) {
  return std::to_string(count_of(row, "case"));
}

inline void append(Names& cells, const Names& more) {
  cells.insert(cells.end(), more.begin(), more.end());
}

// As the page says them, each behind a space.
inline std::string commits(const Rows& rows) {
  std::set<std::string> all;
  for (const json& row : rows) all.insert(text_at(row, "commit"));
  std::string out;
  for (const std::string& one : all) out.append(" ").append(one);
  return out;
}

}  // namespace stability_page
