#include "stability_rows.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "numbers.h"
#include "oracle_rows.h"

namespace gnomon::app {

using stability::SoakPart;
using stability::Verdict;

namespace {

std::string ulp_text(double ulp) {
  return std::isfinite(ulp) ? fixed(ulp, 2) : "> 8";
}

}  // namespace

Json to_json(const stability::CaseInfo& info) {
  return {
      {"case", info.number}, {"group", info.group}, {"name", info.name}, {"expectation", info.expectation}};
}

Json to_json(const Verdict& verdict) {
  Json row = to_json(verdict.info);
  row["builder"] = verdict.builder;
  row["flavour"] = verdict.flavour;
  row["triangles"] = verdict.triangles;
  add_oracle(row, verdict.oracle);
  row["invalid_rays"] = verdict.invalid_rays;
  row["tolerance_ulp"] = verdict.exact ? Json(verdict.most_ulp) : Json(nullptr);  // else each hit has its own
  row["other_faults"] = verdict.other_faults;
  row["first_fault"] = verdict.first_fault;
  row["ok"] = verdict.ok();
  return row;
}

Json to_json(const SoakPart& part, bool exact) {
  Json row{{"scene", part.scene},
           {"scene_hash", part.scene_hash},
           {"builder", part.builder},
           {"triangles", part.triangles},
           {"offset", part.offset}};
  add_oracle(row, part.oracle);
  row["at_corners"] = part.at_corners;
  row["at_edges"] = part.at_edges;
  row["exactly"] = part.exactly;
  row["invalid_rays"] = part.invalid;
  row["flavours_differ"] = part.flavours_differ;
  row["bad_rays"] = Json(part.oracle.bad_rays);
  row["ok"] = part.ok(exact);
  return row;
}

std::string case_list(const std::vector<stability::CaseInfo>& cases) {
  Table table({"case", "group", "name", "expectation"});
  for (const stability::CaseInfo& info : cases)
    table.add({std::to_string(info.number), info.group, info.name, info.expectation});
  return table.text();
}

std::string verdict_table(const std::vector<Verdict>& verdicts, const Console& console) {
  Table table({"case", "name", "builder", "flavour", "rays", "hits", "lost", "false", "wrong", "any", "t p99",
               "t max", "verdict"});
  std::string faults;
  for (const Verdict& v : verdicts) {
    const OracleReport& o = v.oracle;
    table.add({std::to_string(v.info.number), v.info.name, v.builder, v.flavour,
               std::to_string(o.rays_judged), std::to_string(o.hits), std::to_string(o.lost),
               std::to_string(o.false_hits), std::to_string(o.wrong_primitive),
               std::to_string(o.any_closest_disagree), ulp_text(o.t_errors.quantile(0.99)),
               ulp_text(o.max_t_error_ulp), v.ok() ? "ok" : "FAILED"});
    if (v.ok()) continue;
    std::ostringstream line;
    line << "case " << v.info.number << ", " << v.info.name << ", " << v.builder << ", " << v.flavour << ": ";
    if (v.other_faults > 0) {
      line << v.first_fault << " (" << v.other_faults << " such)";
    } else {
      line << "against the oracle";
    }
    line << "; expected: " << v.info.expectation << "\n";
    faults += line.str();
  }
  std::string text = table.text();
  if (!faults.empty()) text.append("\n").append(console.paint(Paint::kBad, faults));
  return text;
}

std::string soak_table(const stability::SoakReport& report, bool exact) {
  Table table({"scene", "offset", "builder", "rays", "corners", "edges", "exactly", "hits", "lost", "false",
               "wrong", "any", "flavours", "t p99", "t max", "verdict"});
  const auto add = [&](const SoakPart& p, const std::string& scene, const std::string& offset) {
    const OracleReport& o = p.oracle;
    table.add({scene, offset, p.builder, std::to_string(p.rays), std::to_string(p.at_corners),
               std::to_string(p.at_edges), std::to_string(p.exactly), std::to_string(o.hits),
               std::to_string(o.lost), std::to_string(o.false_hits), std::to_string(o.wrong_primitive),
               std::to_string(o.any_closest_disagree), std::to_string(p.flavours_differ),
               ulp_text(o.t_errors.quantile(0.99)), ulp_text(o.max_t_error_ulp),
               p.ok(exact) ? "ok" : "FAILED"});
  };
  for (const SoakPart& part : report.parts) add(part, part.scene, fixed(part.offset, 0));
  add(report.total(), "all", "");
  return table.text();
}

}  // namespace gnomon::app
