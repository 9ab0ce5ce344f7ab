// The sentences of the map. Numbers that bear them out are in claims.cpp, by the same keys.
#include "claims.h"

namespace gnomon::bench {

const std::vector<Claim>& claims() {
  static const std::vector<Claim> all{
      {"axis", "PAH plane, light along an axis",
       "The all-pierced cost falls as foretold, closest hits gain much less, and leaves grow.",
       "a cut across the rays leaves both halves as large as the whole to them, so it never lowers the "
       "measure, though "
       "telling near from far is what lets a tracer stop early.",
       "SAH unless a light is named; then all three axes are tried, equal costs go to the smaller surface "
       "area, and "
       "`--share` mixes surface area in, which brings such cuts back."},
      {"diagonal", "PAH plane, light on (1, 1, 1)", "The tree is SAH's: nothing is gained.",
       "with three equal weights the projected area is the surface area but for a constant factor, which no "
       "choice of "
       "a split can feel.",
       "The same tree at the same cost: three weights are all that a linear measure has, so nothing is lost "
       "either."},
      {"measure", "PAH near plane, wide views",
       "The predicted cost of rays that are even in yaw and pitch is far off.",
       "the near plane of a wide window is large at its edges, where such rays are thin: it counts boxes "
       "there many "
       "times over.",
       "Rays are measured as they are distributed: solid angle for lamps, the near plane for pictures, yaw "
       "and pitch "
       "where those are asked for (`measure_of` takes the light's own)."},
      {"other", "PAH trees, rays that ignore the light",
       "Rays from elsewhere cost up to three times what they cost on SAH's tree.",
       "length along the light's rays costs nothing, so boxes are drawn out along them and show large sides "
       "to rays "
       "that come across.",
       "The global tree is SAH's; trees for a light are local or asked for, and a mixture is the insurance."},
      {"window", "PAH window, rays from outside the window",
       "What lies outside the window is divided any old way, and rays that come there pay.",
       "boxes that no ray of the window meets measure nothing, so that all divisions of them cost the same.",
       "Equal costs, zero among them, are settled by surface area; `plane` measures without a window."},
      {"face", "PAH solid angle, a lamp in a face of boxes",
       "The predicted cost is too small by a tenth and more, and trees cut along the lamp's own plane are "
       "bad.",
       "an eye exactly in a box's face is taken to send half of its rays inside, while boxes are closed, so "
       "that every "
       "ray, as it starts on the face, is tested against the box and all that touch the eye below it.",
       "Nothing: it takes coordinates that are equal to the last bit, as generated scenes have and lights of "
       "real ones "
       "hardly do; moving the lamp by 1e-4 of the scene mends it."},
      {"sah", "SAH's predictions for the rays of one light", "Off by tens of per cent, either way.",
       "it foretells lines from everywhere that go through the whole scene, and foretells those well; a "
       "light's rays come "
       "from one side, or start within.",
       "`predicted_cost` by the rays' own measure foretells the all-pierced cost of any tree, SAH's too."},
      {"spfh", "SPFH, slanted light and views", "Up to 1.8 times SAH's work.",
       "it bars the axes that the rays run along, and where no axis is good it falls back on the longest, so "
       "that the "
       "cheapest split is often not among those it looks at.",
       "All three axes are tried. `--axes spfh` is the repaired policy, which keeps the better of two "
       "splits."},
      {"mixed units", "PAH with SPFH, as published", "All-pierced costs of two to five times SAH's.",
       "at the fallback an earlier split is forgotten however good it was, and the next level compares "
       "probabilities by "
       "surface area with those by projected area.",
       "The repaired policy measures both sides alike and keeps the cheaper split; the published one is kept "
       "for "
       "comparison (`repaired = false`)."},
      {"lsph", "LSPH, scenes of long triangles",
       "1.3 to 2.3 times SAH's work in halls and houses, repaired or not.",
       "the longest axis of a box says nothing about where triangles can be told apart: with the other axes "
       "let in, the "
       "same rule builds a tree as good as SAH's.",
       "All three axes are tried."},
      {"occluded", "All-pierced cost in occluded scenes",
       "PAH wins by the thesis' cost and loses by any hit.",
       "a blocked ray stops at the first hit that it comes upon, so most of what the cost counts is never "
       "visited, and "
       "finding an occluder early is not in it.",
       "Costs here are counts of boxes and triangles of real traversals; any hit goes to the largest child "
       "first on the "
       "wide tree. SAH stays the default for that reason."},
      {"mixture", "Mixtures of PAH and SAH",
       "No share is best everywhere: 1 on the random soup, 0.5 to 0.9 in most halls, streets and crowds.",
       "the share trades the all-pierced cost, best at 1, against cuts across the rays, which surface area "
       "brings and "
       "which count where rays are stopped.",
       "No mixture unless asked for by `--share`; half and half is within a sixth of the best in each of "
       "these cases but the soup."},
      {"samples", "Choosing between trees by sampled rays",
       "Of two trees some per cent apart, 1000 rays each name the wrong one often.",
       "rays differ so much in cost that the mean of 1000 is off by more than the trees are apart.",
       "Predictions are exact sums over nodes, without noise; where rays must be sampled, both trees get the "
       "same ones."},
      {"outside", "Sampling in yaw and pitch, wide views",
       "A good part of the rays starts outside the frustum, where no local tree serves them.",
       "a window of constant pitch is bounded by cones, not planes, and bulges out of the frustum at its "
       "corners.",
       "Such rays go to the global tree, whose answers are the same; views of lights are sampled in "
       "steradians."},
      {"local", "Local trees, rays that go on behind the area",
       "Dearer than the global tree alone where many rays leave the area unhit; cheaper where few do.",
       "a ray that leaves the region unhit has paid for the local tree and then pays for the global one.",
       "No local trees unless a top level is asked for; with it the global tree is asked from where the ray "
       "leaves the "
       "region, not from its start."},
      {"local wrong", "Local trees, the published rule", "Hits that are not the nearest.",
       "a triangle that sticks out of the region is hit behind another one that has no part in it.",
       "The exit rule: what a local tree says of the part beyond the region does not count "
       "(`host/notes/top-level.md`)."}};
  return all;
}

}  // namespace gnomon::bench
