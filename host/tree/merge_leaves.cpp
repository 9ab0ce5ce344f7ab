#include "gnomon/tree/merge_leaves.h"

#include <algorithm>
#include <string>

#include "gnomon/base/error.h"
#include "gnomon/shared/measure_math.h"
#include "gnomon/tree/parents_first.h"

namespace gnomon {

namespace {

void require(bool ok, const char* option, const std::string& value, const char* range) {
  if (ok) return;
  throw Error(ErrorCode::kInvalidArgument,
              std::string("merge option ") + option + " = " + value + " is outside its range " + range);
}

// Whether a triangle is in leaf order more than once: the tree is of parts.
bool has_repeats(const Bvh& bvh) {
  std::vector<bool> seen;
  for (const std::uint32_t primitive : bvh.primitives) {
    if (primitive >= seen.size()) seen.resize(2 * std::size_t{primitive} + 1);
    if (seen[primitive]) return true;
    seen[primitive] = true;
  }
  return false;
}

class Merger {
 public:
  // kept: null, or receives the measures of the nodes that stay.
  Merger(const Bvh& bvh, std::span<const float> measures, const MergeOptions& options,
         std::vector<float>* kept)
      : bvh_(bvh), measures_(measures), kept_(kept), repeats_(has_repeats(bvh)), below_(bvh.nodes.size()) {
    weigh(options);
  }

  Bvh run() {
    out_.primitives.reserve(bvh_.primitives.size());
    out_.frame = bvh_.frame;
    out_.nodes.resize(2 * std::size_t{below_[0].inner} + 1);
    if (kept_ != nullptr) kept_->resize(out_.nodes.size());
    write(0, 0, 0);
    return std::move(out_);
  }

 private:
  struct Below {
    float cost = 0.0F;
    std::uint32_t first = 0;      // in leaf order
    std::uint32_t places = 0;     // there
    std::uint32_t triangles = 0;  // different ones, where a leaf could hold them
    std::uint32_t inner = 0;      // inner nodes that stay
  };

  // Children before parents.
  void weigh(const MergeOptions& options) {
    const std::vector<std::uint32_t> order = parents_first(bvh_);
    for (auto index = order.rbegin(); index != order.rend(); ++index) {
      const Node& node = bvh_.nodes[*index];
      Below& below = below_[*index];
      const auto leaf_cost = [&](std::uint32_t triangles) {
        return measures_[*index] * (options.cost_triangle * static_cast<float>(triangles));
      };
      if (node.count > 0) {
        below = {leaf_cost(node.count), node.first, node.count, node.count, 0};
        continue;
      }
      const Below& left = below_[node.first];
      const Below& right = below_[node.first + 1];
      below = {measures_[*index] * options.cost_inner + left.cost + right.cost, left.first,
               left.places + right.places, left.triangles + right.triangles, left.inner + right.inner + 1};
      if (repeats_ && std::max(left.triangles, right.triangles) <= options.max_leaf_size)
        below.triangles = different(below.first, below.places, options.max_leaf_size);
      const float as_leaf = leaf_cost(below.triangles);
      if (below.triangles <= options.max_leaf_size && as_leaf <= below.cost) {
        below.cost = as_leaf;
        below.inner = 0;
      }
    }
  }

  // Triangles at so many places; where they are more than `most`, some number above it.
  std::uint32_t different(std::uint32_t first, std::uint32_t places, std::uint32_t most) {
    held_.clear();
    for (std::uint32_t i = first; i < first + places && held_.size() <= most; ++i) hold(held_, i);
    return static_cast<std::uint32_t>(held_.size());
  }

  void hold(std::vector<std::uint32_t>& held, std::uint32_t place, std::size_t since = 0) const {
    const std::uint32_t primitive = bvh_.primitives[place];
    const auto from = held.begin() + static_cast<std::ptrdiff_t>(since);
    if (!repeats_ || std::find(from, held.end(), primitive) == held.end()) held.push_back(primitive);
  }

  // splits: inner nodes to the left of the subtree. As deep as the tree.
  void write(std::uint32_t index, std::uint32_t number, std::uint32_t splits) {
    Node node = bvh_.nodes[index];
    if (kept_ != nullptr) (*kept_)[number] = measures_[index];
    if (below_[index].inner == 0) {
      const Below& below = below_[index];
      const std::size_t start = out_.primitives.size();
      for (std::uint32_t i = below.first; i < below.first + below.places; ++i)
        hold(out_.primitives, i, start);
      node.first = static_cast<std::uint32_t>(start);
      node.count = static_cast<std::uint32_t>(out_.primitives.size() - start);
      out_.nodes[number] = node;
      return;
    }
    const std::uint32_t left = node.first;
    const std::uint32_t own = splits + below_[left].inner;
    node.first = 1 + 2 * own;
    out_.nodes[number] = node;
    write(left, node.first, splits);
    write(left + 1, node.first + 1, own + 1);
  }

  const Bvh& bvh_;
  std::span<const float> measures_;
  std::vector<float>* kept_;
  bool repeats_;
  std::vector<std::uint32_t> held_;
  std::vector<Below> below_;
  Bvh out_;
};

}  // namespace

void MergeOptions::check() const {
  require(max_leaf_size >= 1 && max_leaf_size <= 255, "max_leaf_size", std::to_string(max_leaf_size),
          "1..255");
  require(cost_inner > 0.0F && cost_inner <= 1000.0F, "cost_inner", std::to_string(cost_inner), "(0, 1000]");
  require(cost_triangle > 0.0F && cost_triangle <= 1000.0F, "cost_triangle", std::to_string(cost_triangle),
          "(0, 1000]");
}

std::vector<float> face_measures(const Bvh& bvh, const std::array<float, 3>& face_weights) {
  std::vector<float> out;
  out.reserve(bvh.nodes.size());
  for (const Node& node : bvh.nodes) out.push_back(gn_linear_measure(face_weights.data(), node.lo, node.hi));
  return out;
}

Bvh merge_leaves(const Bvh& bvh, std::span<const float> measures, const MergeOptions& options,
                 std::vector<float>* kept) {
  options.check();
  if (measures.size() != bvh.nodes.size()) {
    throw Error(ErrorCode::kInvalidArgument, std::to_string(measures.size()) + " measures for " +
                                                 std::to_string(bvh.nodes.size()) +
                                                 " nodes; merge_leaves takes one a node");
  }
  if (kept != nullptr) kept->clear();
  if (bvh.nodes.empty()) return bvh;
  return Merger(bvh, measures, options, kept).run();
}

}  // namespace gnomon
