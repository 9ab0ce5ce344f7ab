#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

#include "gnomon/tree/compact.h"

namespace gnomon {
namespace {

using MaybeFault = std::optional<BvhFault>;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

BvhFault fault(std::string what, std::size_t node = GN_NONE) {
  return {std::move(what), static_cast<std::uint32_t>(node)};
}

std::string text(std::uint64_t number) {
  return std::to_string(number);
}

struct Box {
  float lo[3] = {kInfinity, kInfinity, kInfinity};
  float hi[3] = {-kInfinity, -kInfinity, -kInfinity};
  void grow(const float* low, const float* high) {
    for (int k = 0; k < 3; ++k) {
      lo[k] = std::min(lo[k], low[k]);
      hi[k] = std::max(hi[k], high[k]);
    }
  }
};

// In double, independently of the shared arithmetic: a step's plane rounded once to float.
Box box_of(const CompactNode& node, std::uint32_t slot) {
  Box box;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const int exponent = static_cast<int>((node.scales >> (8 * k)) & 255U) - 127;
    const auto plane = [&](std::uint32_t index) {
      const std::uint32_t step = (node.planes[index][slot / 4] >> (8 * (slot % 4))) & 255U;
      return static_cast<float>(static_cast<double>(node.origin[k]) + std::ldexp(step, exponent));
    };
    box.lo[k] = plane(2 * k);
    box.hi[k] = plane(2 * k + 1);
  }
  return box;
}

bool holds_node(const CompactNode& node, std::uint32_t slot) {
  return (node.scales >> (24 + slot) & 1U) != 0;
}

class Check {
 public:
  Check(const CompactBvh& compact, std::span<const GnTriangle> triangles)
      : compact_(compact), triangles_(triangles) {}

  MaybeFault run() {
    if (MaybeFault found = check_form()) return found;
    if (MaybeFault found = check_vertices()) return found;
    if (MaybeFault found = check_triangles()) return found;
    if (MaybeFault found = check_links()) return found;
    for (auto node = order_.rbegin(); node != order_.rend(); ++node) {
      if (MaybeFault found = check_boxes(*node)) return found;
    }
    if (compact_.depth != deepest_)
      return fault("depth: " + text(compact_.depth) + " instead of " + text(deepest_));
    return std::nullopt;
  }

 private:
  [[nodiscard]] bool is_plain() const { return !compact_.plain.empty(); }
  [[nodiscard]] std::size_t leaf_triangles() const {
    return is_plain() ? compact_.plain.size() : compact_.triangles.size();
  }

  [[nodiscard]] MaybeFault check_form() const {
    if (compact_.nodes.empty()) return fault("sizes: no root");
    if (is_plain() && (!compact_.triangles.empty() || !compact_.vertices.empty()))
      return fault("sizes: triangles in both forms");
    if (leaf_triangles() != triangles_.size())
      return fault("sizes: " + text(leaf_triangles()) + " triangles of " + text(triangles_.size()));
    return std::nullopt;
  }

  // Distinct bit for bit, each used, the first uses in order; and the form that takes less memory.
  [[nodiscard]] MaybeFault check_vertices() const {
    using Bits = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;
    const auto bits_of = [](const float* position) {
      std::uint32_t bits[3];
      std::memcpy(bits, position, sizeof bits);
      return Bits{bits[0], bits[1], bits[2]};
    };
    std::set<Bits> distinct;
    if (is_plain()) {
      for (const GnPlainTriangle& t : compact_.plain)
        for (std::size_t corner = 0; corner < 3; ++corner) distinct.insert(bits_of(t.corners + 3 * corner));
      if (distinct.size() <= 2 * compact_.plain.size())
        return fault("sizes: shared corners would be smaller");
      return std::nullopt;
    }
    for (const GnVertex& vertex : compact_.vertices) {
      if (!distinct.insert(bits_of(vertex.position)).second)
        return fault("vertices: " + text(static_cast<std::uint64_t>(&vertex - compact_.vertices.data())) +
                     " is the copy of another");
    }
    if (compact_.vertices.size() > 2 * compact_.triangles.size())
      return fault("sizes: plain triangles would be smaller");
    std::uint32_t used = 0;
    for (const GnIndexedTriangle& t : compact_.triangles) {
      for (const std::uint32_t corner : t.corners) {
        if (corner > used || corner >= compact_.vertices.size())
          return fault("vertices: " + text(corner) + " is used before " + text(used));
        if (corner == used) used += 1;
      }
    }
    if (used != compact_.vertices.size()) return fault("vertices: " + text(used) + " is never used");
    return std::nullopt;
  }

  [[nodiscard]] std::uint32_t primitive_at(std::size_t place) const {
    return is_plain() ? compact_.plain[place].primitive : compact_.triangles[place].primitive;
  }

  [[nodiscard]] GnTriangle triangle_at(std::size_t place) const {
    GnTriangle triangle{};
    if (is_plain()) {
      std::memcpy(&triangle, compact_.plain[place].corners, sizeof triangle);
      return triangle;
    }
    float* corners[3] = {triangle.v0, triangle.v1, triangle.v2};
    for (std::size_t corner = 0; corner < 3; ++corner)
      std::memcpy(corners[corner], &compact_.vertices[compact_.triangles[place].corners[corner]],
                  sizeof(GnVertex));
    return triangle;
  }

  [[nodiscard]] MaybeFault check_triangles() const {
    std::vector<char> seen(triangles_.size(), 0);
    for (std::size_t place = 0; place < leaf_triangles(); ++place) {
      const std::uint32_t primitive = primitive_at(place);
      if (primitive >= triangles_.size())
        return fault("triangles: number " + text(primitive) + " of " + text(triangles_.size()));
      if (std::exchange(seen[primitive], 1) != 0)
        return fault("triangles: " + text(primitive) + " appears twice");
      const GnTriangle triangle = triangle_at(place);
      if (std::memcmp(&triangle, &triangles_[primitive], sizeof triangle) != 0)
        return fault("triangles: a corner of " + text(primitive) + " is another");
    }
    return std::nullopt;
  }

  // Each node and each place of a triangle is reached once. Parents come before children in order_.
  MaybeFault check_links() {
    std::vector<char> node_seen(compact_.nodes.size(), 0);
    std::vector<char> place_seen(leaf_triangles(), 0);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> open{{0, 1}};
    node_seen[0] = 1;
    while (!open.empty()) {
      const auto [index, depth] = open.back();
      open.pop_back();
      order_.push_back(index);
      deepest_ = std::max(deepest_, depth);
      const CompactNode& node = compact_.nodes[index];
      std::uint64_t next_node = node.first_node;
      std::uint64_t next_place = node.first_triangle;
      for (std::uint32_t slot = 0; slot < GN_WIDTH; ++slot) {
        const std::uint32_t count = gn_byte_of(node.counts, slot);
        if (holds_node(node, slot)) {
          if (count != 0) return fault("slots: slot " + text(slot) + " holds a node and triangles", index);
          if (next_node >= compact_.nodes.size()) return fault("links: node " + text(next_node), index);
          if (std::exchange(node_seen[next_node], 1) != 0)
            return fault("links: node " + text(next_node) + " is referenced twice or is the root", index);
          open.emplace_back(static_cast<std::uint32_t>(next_node), depth + 1);
          next_node += 1;
        }
        for (std::uint32_t i = 0; i < count; ++i, ++next_place) {
          if (next_place >= place_seen.size())
            return fault("links: triangle place " + text(next_place), index);
          if (std::exchange(place_seen[next_place], 1) != 0)
            return fault("links: triangle place " + text(next_place) + " is in two leaves", index);
        }
      }
    }
    if (std::find(node_seen.begin(), node_seen.end(), 0) != node_seen.end())
      return fault("links: node never referenced");
    if (std::find(place_seen.begin(), place_seen.end(), 0) != place_seen.end())
      return fault("links: a triangle is in no leaf");
    boxes_.resize(compact_.nodes.size());
    return std::nullopt;
  }

  // Children come first: boxes_ of them hold exactly the triangles below.
  MaybeFault check_boxes(std::uint32_t index) {
    const CompactNode& node = compact_.nodes[index];
    std::uint32_t next_node = node.first_node;
    std::uint32_t next_place = node.first_triangle;
    for (std::uint32_t slot = 0; slot < GN_WIDTH; ++slot) {
      const std::uint32_t count = gn_byte_of(node.counts, slot);
      if (!holds_node(node, slot) && count == 0) continue;
      Box below;
      if (holds_node(node, slot)) below = boxes_[next_node++];
      for (std::uint32_t i = 0; i < count; ++i) {
        const GnTriangle t = triangle_at(next_place++);
        for (const float* corner : {t.v0, t.v1, t.v2}) below.grow(corner, corner);
      }
      const Box box = box_of(node, slot);
      for (int k = 0; k < 3; ++k) {
        if (!(box.lo[k] <= below.lo[k] && below.hi[k] <= box.hi[k]))
          return fault("box: a triangle reaches beyond slot " + text(slot), index);
      }
      boxes_[index].grow(below.lo, below.hi);
    }
    return std::nullopt;
  }

  const CompactBvh& compact_;
  std::span<const GnTriangle> triangles_;
  std::vector<std::uint32_t> order_;
  std::vector<Box> boxes_;
  std::uint32_t deepest_ = 0;
};

}  // namespace

std::optional<BvhFault> check_compact(const CompactBvh& compact, std::span<const GnTriangle> triangles) {
  return Check(compact, triangles).run();
}

}  // namespace gnomon
