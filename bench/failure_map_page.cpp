// Writes the page of failures from the rows of failure_map_bench, and from nothing else; or checks that the
// page is what the rows give.
//
//   failure_map_page ROWS.jsonl PAGE.md [--check]
#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "page_file.h"

namespace {

using nlohmann::json;
using page::cell_of;
using page::number;

constexpr double kLoss = 1.02;  // more of the work of SAH's tree than this is set in bold

std::string percent(double share) {
  return number(100.0 * share, std::fabs(share) < 0.0995 ? "%.1f %%" : "%.0f %%");
}

// As short as it is exact enough to read.
std::string plain(double value) {
  if (value == std::floor(value) && std::fabs(value) < 1e7) return number(value, "%.0f");
  return number(value, std::fabs(value) < 0.01 ? "%.2g" : "%.3f");
}

double work_of(const json& row, const char* rays) {
  const json& work = row.at(rays);
  return work.at("boxes").get<double>() + 1.2 * work.at("triangles").get<double>();
}

class Page {
 public:
  explicit Page(const std::string& text) {
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
      if (line.empty()) continue;
      json row = json::parse(line);
      if (row.at("bench") != "failure_map" || row.at("schema") != 1) continue;
      (row.at("kind") == "tree" ? trees_ : claims_).push_back(std::move(row));
    }
    if (trees_.empty()) throw std::runtime_error("no rows of bench failure_map, schema 1");
    for (const json& row : trees_) {
      add_once(cases_, row.at("case"));
      add_once(methods_, row.at("method"));
    }
  }

  std::string text() const {
    return head() + cases() +
           ratios("Closest hit, the light's own rays",
                  "Boxes plus 1.2 times triangles that a ray tests, nearest child first, over those of SAH's "
                  "tree.",
                  "closest") +
           ratios("Any hit, shadow rays", "From what a camera sees to the light, lit or not. The same ratio.",
                  "shadow") +
           ratios("Closest hit, rays that ignore the light", "From anywhere to anywhere. The same ratio.",
                  "other") +
           pierced() + predictions() + shapes() + failures();
  }

 private:
  static void add_once(std::vector<std::string>& names, const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }

  const json* find(const std::string& name, const std::string& method) const {
    for (const json& row : trees_) {
      if (row.at("case") == name && row.at("method") == method) return &row;
    }
    return nullptr;
  }

  std::string head() const {
    const json& row = trees_.front();
    return "# Where heuristics fail\n\n"
           "<!-- Written by failure_map_page from failure_map.jsonl; change the bench and its rows, not this "
           "page. -->\n\n"
           "Ways to build a tree, crossed with lights over generated scenes, in counts: they are exact, and "
           "the same on "
           "every machine. Three axes, 16 bins, leaves by cost, unless the name says otherwise; published "
           "and repaired "
           "are the thesis' axis policies (`host/notes/heuristics.md`) on leaves by cost. Every tree is held "
           "against the "
           "same builder's by surface area (SAH), which is what gnomon builds unless told whose rays the "
           "tree is for. "
           "**Bold**: more than " +
           number(100.0 * (kLoss - 1.0), "%.0f") + " % more work than SAH's tree.\n\nCommit " +
           row.at("commit").get<std::string>() + ", seeds " +
           std::to_string(row.at("seeds").at("scene").get<int>()) + " (scenes), " +
           std::to_string(row.at("seeds").at("rays").get<int>()) + " (rays that measure), " +
           std::to_string(row.at("seeds").at("fit").get<int>()) +
           " on (rays that choose). Again: `build/bench/failure_map_bench "
           "> rows`, `build/bench/failure_map_page rows page`.\n\n";
  }

  std::string cases() const {
    std::string out =
        "| | case | triangles | rays of the light | own, shadow, other |\n|---|---|---|---|---|\n";
    for (std::size_t i = 0; i < cases_.size(); ++i) {
      const json& row = *find(cases_[i], "SAH");
      const json& rays = row.at("rays");
      std::string counts = std::to_string(rays.at("own").get<int>());
      for (const char* const kind : {"shadow", "other"})
        counts.append(", ").append(std::to_string(rays.at(kind).get<int>()));
      out.append("|").append(cell_of(std::to_string(i + 1))).append(cell_of(cases_[i]));
      out.append(cell_of(std::to_string(row.at("triangles").get<int>()))).append(cell_of(row.at("light")));
      out.append(cell_of(counts)).append("\n");
    }
    return out;
  }

  // Methods by cases; a cell is made from the method's row and SAH's.
  std::string table(const std::string& title, const std::string& words,
                    const std::function<std::string(const json&, const json&)>& cell) const {
    std::string out = "\n## " + title + "\n\n" + words + "\n\n| |";
    std::string line = "|---|";
    for (std::size_t i = 0; i < cases_.size(); ++i) {
      out += cell_of(std::to_string(i + 1));
      line += "---|";
    }
    out += "\n" + line + "\n";
    for (const std::string& method : methods_) {
      std::string cells;
      for (const std::string& name : cases_) {
        const json* const row = find(name, method);
        cells += cell_of(row == nullptr ? std::string("–") : cell(*row, *find(name, "SAH")));
      }
      out.append("|").append(cell_of(method)).append(cells).append("\n");
    }
    return out;
  }

  std::string ratios(const std::string& title, const std::string& words, const char* rays) const {
    return table(title, words + " SAH's row: its own.", [&](const json& row, const json& sah) {
      if (row.at("method") == "SAH") return number(work_of(row, rays), "%.0f");
      const double of = work_of(sah, rays);
      if (of == 0.0) return std::string("–");
      return bold(work_of(row, rays) / of);
    });
  }

  static std::string bold(double ratio) {
    const std::string text = number(ratio, "%.2f");
    if (ratio <= kLoss) return text;
    return std::string("**").append(text).append("**");
  }

  std::string pierced() const {
    return table(
        "All pierced, the light's own rays",
        "The thesis' cost of a ray: everything it pierces to infinity, in no order. SAH's row: its own; "
        "the others over that.",
        [](const json& row, const json& sah) {
          if (row.at("method") == "SAH") return number(row.at("pierced"), "%.0f");
          return bold(row.at("pierced").get<double>() / sah.at("pierced").get<double>());
        });
  }

  std::string predictions() const {
    return table("Predictions",
                 "How far the all-pierced cost is from what was predicted: by the rays' own measure / by "
                 "surface area.",
                 [](const json& row, const json&) {
                   const double real = row.at("pierced");
                   const auto error = [&](const char* by) {
                     const double predicted = row.at(by);
                     return percent(std::fabs(real - predicted) / predicted);
                   };
                   return error("predicted") + " / " + error("predicted_surface");
                 });
  }

  std::string shapes() const {
    return table(
        "Shapes",
        "Depth / triangles a leaf / inner nodes both of whose children measure as much as they do, to the "
        "light's rays / overlap of siblings to level 4, as these rays see it.",
        [](const json& row, const json&) {
          const json& overlap = row.at("overlap_4");
          return std::to_string(row.at("depth").get<int>()) + " / " + number(row.at("mean_leaf"), "%.1f") +
                 " / " + percent(row.at("idle_share")) + " / " +
                 (overlap.is_null() ? std::string("–") : percent(overlap));
        });
  }

  std::string failures() const {
    std::string out =
        "\n## The failures, and why\n\nEach reason comes with numbers that would be otherwise if it were "
        "wrong. A check that does not hold is marked.\n";
    for (const json& claim : claims_) {
      out.append("\n### ").append(claim.at("method").get<std::string>());
      for (const auto& [label, key] :
           {std::pair{"**Fails:** ", "fails"}, {"**Because** ", "reason"}, {"**Instead:** ", "instead"}})
        out.append("\n\n").append(label).append(claim.at(key).get<std::string>());
      out += "\n\n| check | value | expected |\n|---|---|---|\n";
      for (const json& check : claim.at("checks")) {
        const std::string relation = check.at("relation");
        std::string expected = relation;
        expected.append(" ").append(plain(check.at("bound")));
        if (!check.at("holds").get<bool>()) expected += ", **does not hold**";
        out.append("|").append(cell_of(check.at("what"))).append(cell_of(plain(check.at("value"))));
        out.append(cell_of(expected)).append("\n");
      }
    }
    return out;
  }

  std::vector<json> trees_;
  std::vector<json> claims_;
  std::vector<std::string> cases_;
  std::vector<std::string> methods_;
};

}  // namespace

int main(int argc, char** argv) {
  return page::run(argc, argv, "failure_map_page", [](const std::string& rows) { return Page(rows).text(); });
}
