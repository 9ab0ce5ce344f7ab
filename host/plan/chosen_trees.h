// Which of a plan's trees rays should be traced through instead of the tree at hand. Not public. Feeds the
// subcommands that build, trace and render.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gnomon/plan/choose.h"

namespace gnomon {

// The tree for some of the rays.
struct ChosenTree {
  std::string rays;
  std::optional<std::size_t> tree;  // place in Plan::trees; none: the plain one
  std::string name;                 // "plain" or a candidate's
  double predicted = 0.0;           // saving against the plain tree on the rays it was fitted to, a share
  double measured = 0.0;            // the same on probes
};

enum class TreesWanted {
  kOneForAll,  // the one that all kinds together cost least in, without an order: kinds' expected rays weigh
  kOneEach,    // for each kind what the plan keeps for it
};

// rays: what the plan was made for. or_plain: a tree that costs probes no less than the plain one is not
// taken; else some tree of the plan is, and not its baseline where it has others.
[[nodiscard]] std::vector<ChosenTree> choose_trees(const Plan& plan, std::span<const PlanRays> rays,
                                                   std::span<const Triangle> triangles, const Bvh& plain,
                                                   TreesWanted wanted, bool or_plain);

}  // namespace gnomon
