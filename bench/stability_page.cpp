// Writes the page of hard rays from stored rows, and from nothing else: the catalogue's and the long run's
// (gnomon stability), the same rays through Embree (stability_peer), and what fast accuracy costs
// (accuracy_bench). Or checks that the page is what the rows give.
//
//   stability_page ROWS.jsonl... PAGE.md [--check]
#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "page_file.h"
#include "stability_page/fast_accuracy.h"
#include "stability_page/rows.h"

namespace {

using namespace stability_page;
using page::head_of;
using page::line_of;
using page::number;

class Page {
 public:
  explicit Page(const std::string& rows) {
    std::istringstream lines(rows);
    for (std::string line; std::getline(lines, line);) {
      json row = json::parse(line);
      const std::string bench = row.at("bench");
      if (bench == "stability_peer") {
        peers_.push_back(std::move(row));
      } else if (bench == "accuracy") {
        accuracy_.push_back(std::move(row));
      } else {
        (row.at("kind") == "soak" ? soaks_ : cases_).push_back(std::move(row));
      }
    }
    if (cases_.empty() || soaks_.empty() || peers_.empty() || accuracy_.empty())
      throw std::runtime_error("rows of the catalogue, of the long run, of peers or of accuracy are missing");
  }

  [[nodiscard]] std::string text() const {
    std::string out =
        "# Hard rays\n\n"
        "<!-- Written by stability_page from stability.jsonl, stability_peer.jsonl and accuracy.jsonl; run "
        "bench/figures.sh, do not change this page. -->\n\n"
        "What `gnomon stability` found on each device, the same rays through Embree, the long run, and what "
        "fast "
        "accuracy costs. An oracle of exact arithmetic judges every ray (`host/notes/stability.md`). "
        "**Lost**: hits "
        "that are not reported, or a farther one; **false**: hits where nothing is; **wrong**: of a triangle "
        "that is "
        "not there; **any**: any hit and closest hit disagree. t's error is in ulp of the exact t.\n";
    for (const auto& [device, rows] : by_device(cases_)) out += catalogue(device, rows);
    out += peers();
    for (const json& row : soaks_) out += soak(row);
    return out + fast_accuracy(accuracy_);
  }

 private:
  static std::vector<std::pair<std::string, Rows>> by_device(const Rows& rows) {
    return grouped(rows, [](const json& row) { return text_at(row, "device"); });
  }

  // Counts and verdicts by flavour and builder, then by case.
  static std::string catalogue(const std::string& device, const Rows& rows) {
    const json& first = rows.front();
    const bool exact = first.at("fp64").get<bool>();
    std::string out = "\n## The catalogue on " + device + "\n\nDriver " + text_at(first, "driver") + ", " +
                      (exact ? "" : "no ") + "double precision, commit" + commits(rows) +
                      ". Verdicts: " + verdicts(rows) + " are right. ";
    out += exact ? "No hit may be lost, false or wrong, and t off by more than 9/16 ulp.\n"
                 : "Without double precision a ray may hit what it misses by 2^-40 of the distance: hits may "
                   "be false "
                   "or wrong there, but none lost (`host/notes/exact-hits.md`).\n";
    out +=
        head_of({"flavour", "builder", "verdicts", "rays", "hits", "lost", "false", "wrong", "any", "t max"});
    for (const auto& [flavour, some] : grouped(rows, [](const json& r) { return text_at(r, "flavour"); })) {
      for (const auto& [builder, few] : grouped(some, [](const json& r) { return text_at(r, "builder"); })) {
        Names cells{flavour, builder, verdicts(few), sum_of(few, "rays"), sum_of(few, "hits")};
        append(cells, faults_of(few));
        cells.push_back(largest_error(few));
        out += line_of(cells);
      }
    }
    out += "\nBy case, over all flavours and builders:\n" +
           head_of({"", "case", "expected", "verdicts", "rays", "hits", "lost", "false", "wrong", "any",
                    "t max"});
    for (const auto& [name, some] : grouped(rows, number_of_case)) {
      const json& one = some.front();
      Names cells{name,           text_at(one, "name"), text_at(one, "expectation"),
                  verdicts(some), sum_of(some, "rays"), sum_of(some, "hits")};
      append(cells, faults_of(some));
      cells.push_back(largest_error(some));
      out += line_of(cells);
    }
    return out;
  }

  [[nodiscard]] std::string peers() const {
    const auto tracers = grouped(peers_, [](const json& row) { return text_at(row, "tracer"); });
    Names head{"", "case", "rays", "hits"};
    for (const auto& [tracer, rows] : tracers) head.push_back(tracer);
    std::string out =
        "\n## The same rays through Embree\n\nCases that all tracers can be asked: ranges begin at the "
        "origin or "
        "later, and coordinates are such as Embree takes. Each cell: lost / false / wrong / any. Embree's t "
        "may be off "
        "by 1000 ulp here without being at fault; ours by 4. Commit" +
        commits(peers_) + ", on " + text_at(peers_.front(), "device") + ".\n" + head_of(head);
    for (const auto& [name, rows] : grouped(peers_, number_of_case)) {
      const json& one = rows.front();
      Names cells{name, text_at(one, "name"), sum_of({one}, "rays"), sum_of({one}, "hits")};
      for (const auto& [tracer, all] : tracers) {
        for (const json& row : rows) {
          if (row.at("tracer") == tracer) cells.push_back(slashed({row}));
        }
      }
      out += line_of(cells);
    }
    const Rows& ours = tracers.front().second;
    Names cells{"", "all", sum_of(ours, "rays"), sum_of(ours, "hits")};
    for (const auto& [tracer, rows] : tracers) cells.push_back(slashed(rows));
    return out + line_of(cells);
  }

  static std::string slashed(const Rows& rows) {
    std::string out;
    for (const std::string& fault : faults_of(rows)) out.append(out.empty() ? "" : " / ").append(fault);
    return out;
  }

  static std::string soak(const json& row) {
    const json& bound = row.contains("tolerance_ulp") ? row.at("tolerance_ulp") : json();
    std::string out =
        "\n## The long run\n\n`gnomon stability --rays " +
        std::to_string(count_of(row.at("options"), "rays")) + "` on " + text_at(row, "device") + ", commit " +
        text_at(row, "commit") + ", seed " + std::to_string(count_of(row, "seed")) + ", " +
        number(row.at("seconds").get<double>() / 60.0, "%.0f") +
        " minutes. Every flavour traces every "
        "ray, closest and any hit: " +
        names_of(row.at("options").at("flavours")) +
        "; the judge looks at each answer. Offsets are in sizes of the scene; exactly: the ray has the "
        "corner or the middle of the edge to the last bit; rounded: whether it hits is not what the "
        "exact t says, at an end of its range.\n";
    if (!bound.is_null())
      out.append("t may be off by ").append(number(bound.get<double>(), "%.4f")).append(" ulp.\n");
    out += head_of({"offset", "builder", "rays", "at corners", "at edges", "exactly", "hits", "lost", "false",
                    "wrong", "any", "flavours differ", "rounded", "t p99", "t max", "verdict"});
    const Rows parts(row.at("parts").begin(), row.at("parts").end());
    for (const auto& [offset, some] :
         grouped(parts, [](const json& p) { return number(p.at("offset"), "%.0f"); })) {
      for (const auto& [builder, few] : grouped(some, [](const json& p) { return text_at(p, "builder"); }))
        out += soak_line(offset, builder, few);
    }
    Rows all{row};
    return out + soak_line("all", "", all);
  }

  static std::string soak_line(const std::string& offset, const std::string& builder, const Rows& rows) {
    Names cells{offset, builder};
    for (const char* const key : {"rays", "at_corners", "at_edges", "exactly", "hits"})
      cells.push_back(sum_of(rows, key));
    append(cells, faults_of(rows));
    cells.push_back(sum_of(rows, "flavours_differ"));
    cells.push_back(sum_of(rows, "range_rounded"));
    double p99 = 0.0;
    for (const json& row : rows) p99 = std::max(p99, row.at("t_error_ulp").at("p99").get<double>());
    append(cells, {number(p99, "%.4f"), largest_error(rows), verdicts(rows)});
    return line_of(cells);
  }

  static std::string names_of(const json& list) {
    std::string out;
    for (const json& name : list) out.append(out.empty() ? "" : ", ").append(name.get<std::string>());
    return out;
  }

  Rows cases_;
  Rows soaks_;
  Rows peers_;
  Rows accuracy_;
};

}  // namespace

int main(int argc, char** argv) {
  return page::run(argc, argv, "stability_page", [](const std::string& rows) { return Page(rows).text(); });
}
