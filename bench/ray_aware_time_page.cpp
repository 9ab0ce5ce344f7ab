// Writes the page of what trees for given rays save in time, how well time is predicted, and what planning
// takes by the clock, from the rows of ray_aware_time and plan_clock_bench and from nothing else; or checks
// that the page is what the rows give.
//
//   ray_aware_time_page ROWS.jsonl PAGE.md [--check]
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "page_file.h"
#include "ray_aware/time_model.h"

namespace {

using gnomon::bench::kind_of;
using gnomon::bench::median;
using gnomon::bench::TimeModel;
using nlohmann::json;
using page::number;

double geomean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += std::log(value);
  return values.empty() ? 1.0 : std::exp(sum / static_cast<double>(values.size()));
}

// "1e5": a scene's triangles, roughly.
std::string size_of(const json& row) {
  return "1e" + number(std::log10(row.at("triangles").get<double>()), "%.0f");
}

// One scene's rays of one kind, its trees by name.
struct Case {
  std::string scene, rays, query, size;
  std::map<std::string, json> trees;
  // "best": over parts of triangles, where there are any.
  [[nodiscard]] const json& baseline() const { return trees.at(trees.count("best") > 0 ? "best" : "sah"); }
};

struct Quality {
  double correlation = 0.0;
  double error = 0.0;  // mean of |predicted / measured - 1|
};

Quality quality_of(const std::vector<double>& got, const std::vector<double>& wanted) {
  const auto n = static_cast<double>(got.size());
  double mean_got = 0.0, mean_wanted = 0.0;
  for (std::size_t i = 0; i < got.size(); ++i) {
    mean_got += got[i] / n;
    mean_wanted += wanted[i] / n;
  }
  double both = 0.0, own = 0.0, other = 0.0;
  Quality out;
  for (std::size_t i = 0; i < got.size(); ++i) {
    both += (got[i] - mean_got) * (wanted[i] - mean_wanted);
    own += (got[i] - mean_got) * (got[i] - mean_got);
    other += (wanted[i] - mean_wanted) * (wanted[i] - mean_wanted);
    out.error += std::fabs(got[i] / wanted[i] - 1.0) / n;
  }
  out.correlation = own > 0.0 && other > 0.0 ? both / std::sqrt(own * other) : 0.0;
  return out;
}

// Of the kept trees over others, in counts and in time.
struct Ratios {
  std::vector<double> counts, times;
  void add(const json& own, const json& other, const char* time) {
    counts.push_back(own.at("cost").get<double>() / other.at("cost").get<double>());
    times.push_back(median(own, time));
  }
  void add(const Ratios& others) {
    counts.insert(counts.end(), others.counts.begin(), others.counts.end());
    times.insert(times.end(), others.times.begin(), others.times.end());
  }
  [[nodiscard]] std::string means() const {
    return std::string(" ") + number(geomean(counts), "%.3f") + " | " + number(geomean(times), "%.3f") + " |";
  }
  [[nodiscard]] std::string share() const {
    const double saved = 1.0 - geomean(counts);
    return saved > 0.0 ? number((1.0 - geomean(times)) / saved, "%.2f") : "none is saved";
  }
};

// What planning takes of the baseline's build, by families and queries.
class PlanClock {
 public:
  void add(const json& row) {
    const std::string query = row.at("query");
    const std::string kind = query == "any" ? row.at("rays").get<std::string>() : query;
    groups_[row.at("family").get<std::string>() + ": " + kind].push_back(row);
  }

  [[nodiscard]] std::string text() const {
    if (groups_.empty()) return "";
    std::string out =
        "\n## Planning by the clock\n\nProcess CPU time of planning over that of building the baseline, "
        "trees "
        "built by the device; median of rounds. First without\nmaking what is kept, which a plan that is "
        "asked for that "
        "tree takes; then all of it. Mean over set-ups (most), those above 0.5; the same\n"
        "by the plan's own prices.\n" +
        page::head_of(
            {"rays", "set-ups", "without what is kept", "above 0.5", "by prices", "all", "by prices"});
    for (const auto& [name, rows] : groups_) {
      std::vector<double> own, own_priced, all, all_priced;
      for (const json& row : rows) {
        own.push_back(median(row, "own_share"));
        all.push_back(median(row, "share"));
        own_priced.push_back(row.at("priced_own_share"));
        all_priced.push_back(row.at("priced_share"));
      }
      const auto above = std::count_if(own.begin(), own.end(), [](double share) { return share > 0.5; });
      out += page::line_of({name, std::to_string(rows.size()), means(own), std::to_string(above),
                            number(mean(own_priced), "%.2f"), means(all), number(mean(all_priced), "%.2f")});
    }
    return out;
  }

 private:
  static double mean(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
  }
  static std::string means(const std::vector<double>& values) {
    return number(mean(values), "%.2f") + " (most " +
           number(*std::max_element(values.begin(), values.end()), "%.2f") + ")";
  }

  std::map<std::string, std::vector<json>> groups_;
};

class Page {
 public:
  explicit Page(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      const json row = json::parse(line);
      commit_ = row.at("commit");
      if (row.at("bench") == "plan_clock") {
        clock_.add(row);
        continue;
      }
      Case& found = cases_[{row.at("query"), size_of(row), row.at("scene"), row.at("rays")}];
      found.size = size_of(row);
      found.scene = row.at("scene");
      found.rays = row.at("rays");
      found.query = row.at("query");
      found.trees[row.at("tree").get<std::string>()] = row;
      different_ += row.at("different_hits").get<std::uint64_t>();
      device_ = row.at("device");
      sizes_.insert(found.size);
      rows_ += 1;
    }
  }

  [[nodiscard]] std::string text() const {
    std::string out =
        "# What trees for given rays save in time\n\nWritten by `ray_aware_time_page` from "
        "`ray_aware_time.jsonl` "
        "(" +
        std::to_string(rows_) + " rows of `ray_aware_time`, commit " + commit_ + ", " + device_ +
        ", one thread).\n\nTime: process CPU time of rounds in which all trees trace the same rays once, in "
        "an order "
        "that turns; median (least–most)\nof the rounds' ratios. Counts: 1.0 a box and 1.2 a triangle in the "
        "binary "
        "tree. sah: the plan's baseline; balanced: what is\nbuilt without a plan. Hits that differ: " +
        std::to_string(different_) + ".\n";
    Ratios of_sah, of_balanced;
    for (const std::string& size : sizes_) {
      for (const char* const query : {"closest", "any"}) out += savings(query, size, of_sah, of_balanced);
    }
    out +=
        "\n## All of them\n\n| set-ups | counts of sah | time of sah | counts of balanced | time of balanced "
        "|\n"
        "|---|---|---|---|---|\n| " +
        std::to_string(of_sah.counts.size()) + " |" + of_sah.means() + of_balanced.means() +
        shares(of_sah, of_balanced);
    out +=
        "\n## Time predicted\n\nNanoseconds a ray: what any ray of its kind takes, and so much a node and a "
        "block of "
        "eight triangles that it looks into; where rays run\ntogether and tests are shared, so much a box "
        "and a "
        "triangle. By least squares of relative errors over all rows of a query. Other\nscenes: each scene "
        "by "
        "what was fitted to all others. Counts alone: one factor. Cells: correlation, mean error.\n\n| "
        "query | rows | ns | fitted | other scenes | counts alone |\n|---|---|---|---|---|---|\n";
    for (const std::string& size : sizes_) {
      for (const char* const query : {"closest", "any"}) out += prediction(query, size);
    }
    return out + clock_.text();
  }

 private:
  [[nodiscard]] static std::string spread(const json& row, const char* field) {
    const json& s = row.at(field);
    return number(s.at("median"), "%.3f") + " (" + number(s.at("min"), "%.2f") + "–" +
           number(s.at("max"), "%.2f") + ")";
  }

  [[nodiscard]] static std::string shares(const Ratios& of_sah, const Ratios& of_balanced) {
    return "\n\nShare of the counts' saving that is saved in time: " + of_sah.share() + " against sah, " +
           of_balanced.share() + " against balanced.\n";
  }

  // What it finds goes to all_of_sah and all_of_balanced too.
  [[nodiscard]] std::string savings(const std::string& query, const std::string& size, Ratios& all_of_sah,
                                    Ratios& all_of_balanced) const {
    std::string out = "\n## " + std::string(query == "any" ? "Any hit" : "Closest hit") + ", " + size +
                      " triangles\n\n| scene, rays | kept | counts of sah | time of sah | counts of balanced "
                      "| time of balanced "
                      "|\n|---|---|---|---|---|---|\n";
    Ratios of_sah, of_balanced;
    for (const auto& [key, c] : cases_) {
      if (c.query != query || c.size != size) continue;
      const std::string kept = c.baseline().at("kept");
      const json& own = c.trees.at(kept);
      of_sah.add(own, c.baseline(), "time_of_sah");
      of_balanced.add(own, c.trees.at("balanced"), "time_of_balanced");
      out += "| " + c.scene + ", " + c.rays + " | " + kept + " | " + number(of_sah.counts.back(), "%.3f") +
             " | " + spread(own, "time_of_sah") + " | " + number(of_balanced.counts.back(), "%.3f") + " | " +
             spread(own, "time_of_balanced") + " |\n";
    }
    all_of_sah.add(of_sah);
    all_of_balanced.add(of_balanced);
    return out + "| geometric mean | |" + of_sah.means() + of_balanced.means() + shares(of_sah, of_balanced);
  }

  // Of one size: what lies in no near cache takes longer.
  [[nodiscard]] std::string prediction(const std::string& query, const std::string& size) const {
    std::vector<const json*> all;
    std::set<std::string> scenes;
    for (const auto& [key, c] : cases_) {
      if (c.query != query || c.size != size) continue;
      scenes.insert(c.scene);
      for (const auto& [name, row] : c.trees) all.push_back(&row);
    }
    if (scenes.size() < kFewestScenes) return "";
    const TimeModel model(all);
    std::vector<double> fitted, elsewhere, wanted, costs;
    for (const json* const row : all) {
      std::vector<const json*> others;
      for (const json* const other : all) {
        if (other->at("scene") != row->at("scene")) others.push_back(other);
      }
      fitted.push_back(model(*row));
      elsewhere.push_back(others.empty() ? 0.0 : TimeModel(others)(*row));
      wanted.push_back(median(*row, "ns_per_ray"));
      costs.push_back(row->at("cost").get<double>());
    }
    double factor = 0.0;
    for (std::size_t i = 0; i < costs.size(); ++i)
      factor += wanted[i] / costs[i] / static_cast<double>(costs.size());
    for (double& cost : costs) cost *= factor;
    std::string out =
        "| " + query + ", " + size + " | " + std::to_string(all.size()) + " | " + model.words() + " |";
    for (const auto* const values : {&fitted, &elsewhere, &costs}) {
      const Quality quality = quality_of(*values, wanted);
      out += std::string(" ") + number(quality.correlation, "%.3f") + ", " +
             number(100.0 * quality.error, "%.0f") + " % |";
    }
    return out + "\n";
  }

  static constexpr std::size_t kFewestScenes = 3;  // that tell what others take

  std::map<std::array<std::string, 4>, Case> cases_;
  std::set<std::string> sizes_;
  PlanClock clock_;
  std::string commit_, device_;
  std::uint64_t different_ = 0;
  std::size_t rows_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  return page::run(argc, argv, "ray_aware_time_page",
                   [](const std::string& rows) { return Page(rows).text(); });
}
