#include <nlohmann/json.hpp>

#include "gnomon/plan/choose.h"
#include "gnomon/tree/bvh.h"

namespace gnomon {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Trial& trial) {
  return {{"name", trial.name},
          {"tree", trial.tree},
          {"verdict", to_string(trial.standing.verdict)},
          {"probes", trial.standing.rays},
          {"cost", trial.standing.cost},
          {"baseline_cost", trial.standing.baseline},
          {"standard_error", trial.standing.error},
          {"fit_gain", trial.fit_gain},
          {"price_units", trial.price},
          {"saving_units", trial.saving}};
}

Json json_of(const std::vector<RegionTree>& local) {
  Json out = Json::array();
  for (const RegionTree& tree : local) {
    out.push_back({{"hash", tree_hash(tree.bvh)},
                   {"nodes", tree.bvh.nodes.size()},
                   {"triangles", tree.bvh.primitives.size()}});
  }
  return out;
}

Json json_of(const Decision& decision) {
  Json local = Json::array();
  for (const LocalUse& use : decision.local)
    local.push_back({{"triangles", use.triangles}, {"share_of_rays", use.share}});
  Json trials = Json::array();
  for (const Trial& trial : decision.trials) trials.push_back(json_of(trial));
  return {{"rays", decision.rays},
          {"query", to_string(decision.query)},
          {"expected_rays", decision.expected},
          {"kept", decision.kept},
          {"tree", decision.tree},
          {"reason", decision.reason},
          {"probes", decision.probes},
          {"probe_units", decision.probe_units},
          {"baseline_cost", decision.baseline_cost},
          {"cost", decision.cost},
          {"light_space",
           {{"obliquity", decision.obliquity},
            {"framed_share", decision.framed_share > 0.0 ? Json(decision.framed_share) : Json(nullptr)}}},
          {"local",
           {{"regions", decision.regions},
            {"least_share_of_triangles", decision.regions > 0 ? Json(decision.least_members) : Json(nullptr)},
            {"trees", local}}},
          {"trials", trials}};
}

}  // namespace

std::string to_json(const Plan& plan) {
  Json trees = Json::array();
  for (const PlanTree& tree : plan.trees) {
    trees.push_back({{"name", tree.name},
                     {"hash", tree_hash(tree.tree.bvh)},
                     {"nodes", tree.tree.bvh.nodes.size()},
                     {"bytes", tree.bytes},
                     {"build_units", tree.build_units},
                     {"learnt_order", !tree.tree.ranks.empty()},
                     {"boxes_in_frame", tree.tree.bvh.frame.has_value()},
                     {"local", json_of(tree.tree.local)}});
  }
  Json decisions = Json::array();
  for (const Decision& decision : plan.decisions) decisions.push_back(json_of(decision));
  const Json document = {{"baseline_units", plan.baseline_units},
                         {"planning_units", plan.planning_units},
                         {"kept_units", plan.kept_units},
                         {"trees", trees},
                         {"decisions", decisions}};
  return document.dump();
}

}  // namespace gnomon
