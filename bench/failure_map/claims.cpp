#include "claims.h"

#include <cmath>

#include "claim_tools.h"
#include "local_trees.h"

namespace gnomon::bench {

void Findings::about_measures(const Look& look) {
  const std::string& name = look.light.name;
  if (name == "random, sun along x" || name == "city, sun overhead" || name == "atrium, sun along x") {
    const std::size_t axis = main_axis(look.light.area.frame().forward);
    add("axis", name + ": cuts across the rays, PAH over SAH",
        share_split_on(look.trees.at("PAH plane"), axis) / share_split_on(look.trees.at("SAH"), axis), '<',
        0.75);
    add("axis", name + ": triangles a leaf, PAH over SAH",
        look.trees.at("PAH plane").stats.mean_leaf / look.trees.at("SAH").stats.mean_leaf, '>', 1.4);
    add("axis", name + ": what closest hits gain less than all-pierced costs",
        of_sah(look, "PAH plane", &TreeFigures::closest) - pierced_of_sah(look, "PAH plane"), '>', 0.05);
    add("other", name + ": other rays, PAH over SAH", of_sah(look, "PAH plane", &TreeFigures::other), '>',
        1.02);
    add("other", name + ": surface of boxes that counts, PAH over SAH",
        look.trees.at("PAH plane").predicted_surface / look.trees.at("SAH").predicted_surface, '>', 1.1);
    add("other", name + ": other rays, half SAH mixed in, over SAH",
        of_sah(look, "mixture 0.5", &TreeFigures::other), '<', 1.15);
  }
  if (name == "random, sun on (1, 1, 1)") {
    add("diagonal", name + ": all-pierced, PAH over SAH, less 1",
        std::fabs(pierced_of_sah(look, "PAH plane") - 1.0), '<', 1e-3);
    add("diagonal", name + ": inner nodes split otherwise than SAH's, on any axis",
        std::fabs(share_split_on(look.trees.at("PAH plane"), 0) - share_split_on(look.trees.at("SAH"), 0)),
        '<', 1e-3);
  }
  if (name == "crowd, wide view") {
    const TreeFigures& tree = look.trees.at("PAH near plane");
    add("measure", name + ": error of the near plane's prediction",
        error_of(tree, predicted_cost(tree.tree, look.light.area, RayMeasure::kNearPlane)), '>', 0.1);
    add("measure", name + ": error of the rays' own", error_of(tree, tree.predicted), '<', 0.02);
    add("measure", name + ": rays a unit of near plane at the corner over those in the middle",
        std::pow(std::cos(look.light.area.half_window()[0]) * std::cos(look.light.area.half_window()[1]),
                 3.0),
        '<', 0.2);
    double outside = 0.0;
    for (const GnRay& ray : look.rays.own) {
      outside += look.light.area.contains({ray.origin[0], ray.origin[1], ray.origin[2]}) ? 0.0 : 1.0;
    }
    add("outside", name + ": share of rays that start outside the region",
        outside / static_cast<double>(look.rays.own.size()), '>', 0.1);
  }
  if (name == "atrium, narrow view") {
    const TreeFigures& tree = look.trees.at("PAH yaw-pitch");
    add("measure", name + ": error of yaw and pitch's prediction of near-plane rays",
        error_of(tree, predicted_cost(tree.tree, look.light.area, RayMeasure::kYawPitch)), '<', 0.05);
  }
  if (name == "atrium, lamp") {
    const Method method = method_named(look.light, "PAH+SPFH repaired");
    add("face", name + ": error of the prediction, PAH+SPFH repaired",
        error_of(look.trees.at(method.name), look.trees.at(method.name).predicted), '>', 0.05);
    const Vec3d& at = look.light.area.frame().origin;
    const auto& ball = std::get<Ball>(look.light.area.region());
    LightCase moved = look.light;
    moved.area = InfluenceArea::omni(at + 1e-4 * ball.radius * Vec3d{1.0, 0.7, 0.9}, ball.radius);
    CaseRays rays;
    rays.own = area_rays(moved.area, moved.rays, look.rays.own.size(), kMeasureSeed);
    const TreeFigures off = figures_of(look.scene, moved, method_named(moved, method.name), rays);
    add("face", name + ": the same with the lamp 1e-4 of the scene aside", error_of(off, off.predicted), '<',
        0.02);
  }
  if (name == "terrain, low sun" || name == "cottage, lamp") {
    const TreeFigures& tree = look.trees.at("SAH");
    add("sah", name + ": error of surface area's prediction", error_of(tree, tree.predicted_surface), '>',
        0.1);
    add("sah", name + ": the same for lines from everywhere through the scene", surface_error(tree), '<',
        0.03);
    add("sah", name + ": error of the rays' own measure on the same tree", error_of(tree, tree.predicted),
        '<', 0.03);
  }
}

void Findings::about_policies(const Look& look) {
  const std::string& name = look.light.name;
  if (name == "city, slanted sun" || name == "atrium, lamp" || name == "atrium, narrow view") {
    add("spfh", name + ": SAH+SPFH published over SAH",
        of_sah(look, "SAH+SPFH published", &TreeFigures::closest), '>', 1.1);
    add("spfh", name + ": nodes that fell back, of SAH+SPFH published",
        static_cast<double>(look.trees.at("SAH+SPFH published").tally.fallback_on[0] +
                            look.trees.at("SAH+SPFH published").tally.fallback_on[1] +
                            look.trees.at("SAH+SPFH published").tally.fallback_on[2]) /
            static_cast<double>(look.trees.at("SAH+SPFH published").tally.inner_nodes),
        '>', 0.2);
    add("spfh", name + ": SAH+SPFH repaired, over published",
        look.trees.at("SAH+SPFH repaired").closest.cost() /
            look.trees.at("SAH+SPFH published").closest.cost(),
        '<', 1.0);
    add("spfh", name + ": the same policy, no axis barred, over SAH",
        unbarred_of_sah(look, "SAH+SPFH repaired"), '<', 1.02);
  }
  if (name == "atrium, sun along x" || name == "atrium, small window") {
    add("mixed units", name + ": all-pierced, PAH+SPFH published over SAH",
        pierced_of_sah(look, "PAH+SPFH published"), '>', 1.5);
    add("mixed units", name + ": all-pierced, PAH+SPFH repaired over published",
        pierced_of_sah(look, "PAH+SPFH repaired") / pierced_of_sah(look, "PAH+SPFH published"), '<', 0.6);
  }
  if (name == "atrium, sun along x" || name == "cottage, slanted sun") {
    add("lsph", name + ": SAH+LSPH published over SAH",
        of_sah(look, "SAH+LSPH published", &TreeFigures::closest), '>', 1.2);
    add("lsph", name + ": SAH+LSPH repaired over SAH",
        of_sah(look, "SAH+LSPH repaired", &TreeFigures::closest), '>', 1.2);
    add("lsph", name + ": the same policy, no axis barred, over SAH",
        unbarred_of_sah(look, "SAH+LSPH repaired"), '<', 1.02);
  }
  if (name == "atrium, small window") {
    add("window", name + ": inner nodes that no ray of the window meets",
        unseen_share(look, look.trees.at("PAH window")), '>', 0.2);
    add("window", name + ": other rays, PAH window with ties unsettled over SAH",
        of_sah(look, "PAH, ties unsettled", &TreeFigures::other), '>', 1.3);
    add("window", name + ": other rays, PAH window over SAH", of_sah(look, "PAH window", &TreeFigures::other),
        '<', 1.3);
    add("window", name + ": other rays, PAH plane over SAH", of_sah(look, "PAH plane", &TreeFigures::other),
        '<', 1.05);
  }
}

void Findings::about_use(const Look& look) {
  const std::string& name = look.light.name;
  const std::string own = look.light.area.kind() == AreaKind::kPlane ? "PAH window" : "PAH, ties unsettled";
  if (name == "city, wide view" || name == "atrium, small window") {
    add("occluded", name + ": all-pierced, PAH over SAH", pierced_of_sah(look, own), '<', 1.0);
    add("occluded", name + ": any hit of the same rays, PAH over SAH", of_sah(look, own, &TreeFigures::any),
        '>', 1.2);
    add("occluded", name + ": what any hit does of what is pierced, on SAH's tree",
        look.trees.at("SAH").any.cost() / look.trees.at("SAH").pierced.mean, '<', 0.6);
    add("occluded", name + ": shadow rays that are blocked, PAH over SAH, less those that are not",
        shadow_of_sah(look, own, false) - shadow_of_sah(look, own, true), '>', 0.0);
  }
  if (name == "atrium, sun along x") {
    const std::size_t axis = main_axis(look.light.area.frame().forward);
    add("mixture", name + ": all-pierced, share 0.75 over share 1",
        pierced_of_sah(look, "mixture 0.75") / pierced_of_sah(look, "PAH window"), '>', 1.0);
    add("mixture", name + ": closest hits, share 0.75 over share 1",
        of_sah(look, "mixture 0.75", &TreeFigures::closest) /
            of_sah(look, "PAH window", &TreeFigures::closest),
        '<', 1.0);
    add("mixture", name + ": cuts across the rays, share 0.75 over share 1",
        share_split_on(look.trees.at("mixture 0.75"), axis) /
            share_split_on(look.trees.at("PAH window"), axis),
        '>', 1.0);
  }
  if (name == "random, sun along x") {
    add("mixture", name + ": closest hits, share 0.5 over share 1",
        of_sah(look, "mixture 0.5", &TreeFigures::closest) /
            of_sah(look, "PAH window", &TreeFigures::closest),
        '>', 1.0);
  }
  if (name == "city, slanted sun") {
    const TreeFigures& a = look.trees.at("PAH window");
    const TreeFigures& b = look.trees.at("SAH");
    add("samples", name + ": standard error of 1000 rays, of the mean",
        a.pierced.standard_error / a.pierced.mean *
            std::sqrt(static_cast<double>(look.rays.own.size()) / 1000.0),
        '>', 0.02);
    add("samples", name + ": how far PAH and SAH are apart, predicted",
        std::fabs(a.predicted / b.predicted - 1.0), '<', 0.04);
    add("samples", name + ": 40 pairs of 1000 rays that rank them wrongly", wrong_ranks(look, a, b), '>',
        0.1);
    add("samples", name + ": error of the exact prediction", error_of(a, a.predicted), '<', 0.05);
  }
  if (name == "random, sun along x" || name == "atrium, small window" || name == "forest, slanted sun") {
    const LocalFigures half = local_figures(look.scene, shortened(look.light.area, 0.5), look.rays.own);
    const std::string at = name + ", to half its depth: ";
    const bool pays = name == "atrium, small window";
    add("local", at + "rays that go on to the global tree", half.left_share, pays ? '<' : '>',
        pays ? 0.25 : 0.4);
    add("local", at + "exit rule over the global tree alone", half.by_exit.cost() / half.global.cost(),
        pays ? '<' : '>', 1.0);
    add("local", at + "published rule over the exit rule", half.published.cost() / half.by_exit.cost(), '>',
        1.0);
    if (half.share < 0.99 && name != "random, sun along x") {
      add("local wrong", at + "hits of the published rule that are not the nearest",
          static_cast<double>(half.wrong), '>', 0.0);
    }
  }
}

void Findings::look_at(const Look& look) {
  about_measures(look);
  about_policies(look);
  about_use(look);
}

std::vector<nlohmann::json> Findings::rows() const {
  std::vector<nlohmann::json> rows;
  for (const Claim& claim : claims()) {
    const auto found = checks_.find(claim.key);
    if (found == checks_.end()) continue;
    nlohmann::json checks = nlohmann::json::array();
    for (const Check& check : found->second) {
      checks.push_back({{"what", check.what},
                        {"value", check.value},
                        {"relation", std::string(1, check.relation)},
                        {"bound", check.bound},
                        {"holds", check.holds()}});
    }
    rows.push_back({{"kind", "failure"},
                    {"method", claim.method},
                    {"fails", claim.fails},
                    {"reason", claim.reason},
                    {"instead", claim.instead},
                    {"checks", checks}});
  }
  return rows;
}

}  // namespace gnomon::bench
