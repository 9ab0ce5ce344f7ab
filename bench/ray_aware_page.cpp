// Writes the page of trees for given rays from the rows of ray_aware_bench, and from nothing else; or checks
// that the page is what the rows give.
//
//   ray_aware_page ROWS.jsonl PAGE.md [--check]
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "page_file.h"

namespace {

using nlohmann::json;
using page::geomean;
using page::number;

constexpr double kEven = 0.005;  // ratios this near 1 are neither a win nor a loss

// The trees of one set-up's rays, by name.
struct Case {
  std::string set_up;
  std::string rays;
  std::map<std::string, json> trees;
  [[nodiscard]] bool has(const std::string& tree) const { return trees.count(tree) > 0; }
  [[nodiscard]] double cost(const std::string& tree) const { return trees.at(tree).at("cost").get<double>(); }
  // "sah", or "best" where spatial splits pay.
  [[nodiscard]] std::string baseline() const { return trees.at("auto").value("baseline", "sah"); }
};

std::string cell(const std::vector<double>& ratios) {
  if (ratios.empty()) return " – |";
  const auto wins = std::count_if(ratios.begin(), ratios.end(), [](double r) { return r < 1.0 - kEven; });
  const auto losses = std::count_if(ratios.begin(), ratios.end(), [](double r) { return r > 1.0 + kEven; });
  std::string out(" ");
  out += number(geomean(ratios), "%.3f") + " (" + std::to_string(wins) + "/" + std::to_string(losses) + ", ";
  return out + number(*std::max_element(ratios.begin(), ratios.end()), "%.3f") + ") |";
}

std::string name_of(const std::string& query) {
  if (query == "every") return "every box on the way";
  return query == "closest" ? "closest hit" : query;
}

class Page {
 public:
  explicit Page(const std::string& rows) {
    std::istringstream lines(rows);
    for (std::string line; std::getline(lines, line);) {
      const json row = json::parse(line);
      const std::string query = row.at("query");
      const std::string rays = row.at("rays");
      // Any-hit cases are told apart by their rays.
      const std::string kind = query == "any"
                                   ? (rays == "lit" ? "unoccluded shadow rays" : "shadow rays, any hit")
                                   : name_of(query);
      const std::string key = row.at("set_up").get<std::string>() + "/" + rays + "/" + query;
      Case& found = groups_[row.at("family").get<std::string>() + ": " + kind][key];
      found.set_up = row.at("set_up");
      found.rays = rays;
      const std::string tree = row.at("tree");
      found.trees[tree] = row;
      different_ += row.at("different_hits").get<std::uint64_t>();
      commit_ = row.at("commit");
      rows_ += 1;
    }
  }

  [[nodiscard]] std::string text() const {
    std::string out = "# Trees for given rays\n\nWritten by `ray_aware_page` from `ray_aware.jsonl` (" +
                      std::to_string(rows_) + " rows of `ray_aware_bench`, commit " + commit_ +
                      ").\n\nCost of a ray: 1.0 a box test and 1.2 a triangle test, two boxes a node "
                      "visited, the root's not counted. "
                      "Trees are fitted to\nrays of one seed, chosen by those of another, measured on a "
                      "third's. Cells: geometric mean "
                      "of the cost over the baseline's (wins/losses\nbeyond 0.5 %, worst). Baseline: three "
                      "axes, surface area, "
                      "reinsertion by surface area, near child first; for auto\nthe same with spatial splits "
                      "where those pay, which makes a section of its own. Hits that differ from the\n"
                      "baseline's, all rows together: " +
                      std::to_string(different_) + ".\n";
    for (const auto& [name, cases] : groups_) out += table(name, cases);
    return out + spatial_splits() + local_trees() + nothing_helps();
  }

 private:
  using Cases = std::map<std::string, Case>;

  static std::vector<double> ratios(const Cases& cases, const std::string& tree, const std::string& to) {
    std::vector<double> out;
    for (const auto& [key, c] : cases)
      if (c.has(tree) && c.has(to)) out.push_back(c.cost(tree) / c.cost(baseline_of(c, tree, to)));
    return out;
  }

  // What auto is measured by has its parts too.
  static std::string baseline_of(const Case& c, const std::string& tree, const std::string& to) {
    return tree == "auto" && c.baseline() == "best" ? "best" + to.substr(3) : to;
  }

  static std::string table(const std::string& name, const Cases& cases) {
    const bool any = !ratios(cases, "sah-order", "sah").empty();
    std::string out =
        "\n## " + name + ", " + std::to_string(cases.size()) + " cases\n\n| tree | of the baseline |" +
        (any ? std::string(
                   " near child first | of the baseline in its own learnt order |\n|---|---|---|---|\n")
             : std::string("\n|---|---|\n"));
    for (const char* const tree :
         {"sah-order", "sah-mix", "sah-rays", "sah-segments", "sah-seen", "seen-rays", "mix", "mix-rays",
          "light-mix", "light-rays", "local-rays", "auto"}) {
      const std::vector<double> own = ratios(cases, tree, "sah");
      if (own.empty()) continue;
      out += std::string("| ") + tree + " |" + cell(own);
      if (any)
        out +=
            cell(ratios(cases, std::string(tree) + " near", "sah")) + cell(ratios(cases, tree, "sah-order"));
      out += "\n";
    }
    return out + summary(cases);
  }

  // What was kept, and how far that is from the best of the pool.
  static std::string summary(const Cases& cases) {
    std::map<std::string, int> kept;
    std::vector<double> regret;
    std::vector<double> planning;
    std::vector<double> beside;
    std::string worst;
    double most = 0.0;
    for (const auto& [key, c] : cases) {
      const json& plan = c.trees.at("auto");
      kept[plan.at("kept").get<std::string>()] += 1;
      double best = c.cost("sah");
      for (const auto& [name, row] : c.trees) best = std::min(best, row.at("cost").get<double>());
      regret.push_back(c.cost("auto") / best);
      const double baseline = plan.at("baseline_units").get<double>();
      const double all = plan.at("planning_units").get<double>();
      planning.push_back(all / baseline);
      beside.push_back((all - plan.at("kept_units").get<double>()) / baseline);
      if (regret.back() <= most) continue;
      most = regret.back();
      worst = c.set_up + ", " + c.rays;
    }
    std::string out = "\nKept:";
    for (const auto& [name, count] : kept)
      out.append(" ").append(name).append(" ").append(std::to_string(count)).append(",");
    out.back() = '.';
    return out + " Regret of the choice against the best of the pool: " + number(geomean(regret), "%.4f") +
           ", at most " + number(most, "%.3f") + " (" + worst + ").\nPlanning took " + shares(planning) +
           " of the baseline's build; without making what it kept, " + shares(beside) + ".\n";
  }

  static std::string shares(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return number(sum / static_cast<double>(values.size()), "%.3f") + " (mean; geometric " +
           number(geomean(values), "%.3f") + ", most " +
           number(*std::max_element(values.begin(), values.end()), "%.3f") + ")";
  }

  // Where triangles are divided: sah and what is made of it beside best and what is made of that.
  [[nodiscard]] std::string spatial_splits() const {
    std::string out =
        "\n## Where spatial splits pay\n\nBest: the baseline over parts of those triangles that waste much. "
        "Elsewhere no triangle is divided and there is no such tree.\n\n| rays | set-up | sah | best, of sah "
        "| sah-rays, of sah | best-order, of best | best-rays, of best | kept "
        "|\n|---|---|---|---|---|---|---|"
        "---|\n";
    for (const auto& [name, cases] : groups_) {
      for (const auto& [key, c] : cases) {
        if (c.baseline() != "best") continue;
        const auto ratio = [&c](const std::string& tree, const std::string& to) {
          return c.has(tree) ? number(c.cost(tree) / c.cost(to), " %.3f |") : std::string(" – |");
        };
        out += "| " + name + " | " + c.set_up + ", " + c.rays + " | " + number(c.cost("sah"), "%.1f") + " |" +
               ratio("best", "sah") + ratio("sah-rays", "sah") + ratio("best-order", "best") +
               ratio("best-rays", "best") + " " + c.trees.at("auto").at("kept").get<std::string>() + " |\n";
      }
    }
    return out;
  }

  [[nodiscard]] std::string local_trees() const {
    std::string out =
        "\n## Local trees\n\nOver the triangles that touch a region which a tenth of the rays or more are "
        "in, "
        "where that holds no more than half of all. Others go through the tree of all, which is the one of "
        "sah-rays.\n\n| rays | set-up | triangles in local trees | rays within | sah-rays | local-rays | "
        "kept "
        "|\n|---|---|---|---|---|---|---|\n";
    for (const auto& [name, cases] : groups_) {
      for (const auto& [key, c] : cases) {
        if (!c.has("local-rays")) continue;
        const json& row = c.trees.at("local-rays");
        const auto of_sah = [&c](const char* tree) {
          return number(c.cost(tree) / c.cost("sah"), " %.3f |");
        };
        out.append("| ").append(name).append(" | ").append(c.set_up).append(", ").append(c.rays);
        out += " | " + std::to_string(row.at("local_triangles").get<std::uint64_t>()) + " of " +
               std::to_string(row.at("triangles").get<std::uint64_t>()) + ", in " +
               std::to_string(row.at("local_trees").get<std::uint64_t>()) + " | " +
               number(100.0 * row.at("local_share").get<double>(), "%.0f %%") + " |" + of_sah("sah-rays") +
               of_sah("local-rays") + " " + c.trees.at("auto").at("kept").get<std::string>() + " |\n";
      }
    }
    return out;
  }

  [[nodiscard]] std::string nothing_helps() const {
    std::string out =
        "\n## Where the baseline is kept\n\n| rays | set-up | best of the pool | why |\n|---|---|---|---|\n";
    for (const auto& [name, cases] : groups_) {
      for (const auto& [key, c] : cases) {
        const json& plan = c.trees.at("auto");
        if (plan.at("kept") != c.baseline()) continue;
        double best = c.cost(c.baseline());
        for (const auto& [tree, row] : c.trees) best = std::min(best, row.at("cost").get<double>());
        out.append("| ").append(name).append(" | ").append(c.set_up).append(", ").append(c.rays).append(
            " | ");
        out.append(number(best / c.cost(c.baseline()), "%.3f")).append(" | ");
        out.append(plan.at("reason").get<std::string>()).append(" |\n");
      }
    }
    return out;
  }

  std::map<std::string, Cases> groups_;
  std::uint64_t different_ = 0;
  std::uint64_t rows_ = 0;
  std::string commit_;
};

}  // namespace

int main(int argc, char** argv) {
  return page::run(argc, argv, "ray_aware_page", [](const std::string& rows) { return Page(rows).text(); });
}
