#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
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

// Bit by bit, independently of the shared arithmetic; beyond the end all bits are 0 and overrun() is true.
class BitReader {
 public:
  BitReader(std::span<const std::uint32_t> words, std::uint64_t first_word)
      : words_(words), bit_(32 * first_word) {}
  std::uint32_t read(std::uint32_t width) {
    std::uint32_t value = 0;
    for (std::uint32_t i = 0; i < width; ++i, ++bit_)
      if (!overrun() && (words_[bit_ / 32] >> (bit_ % 32) & 1U) != 0) value |= 1U << i;
    return value;
  }
  [[nodiscard]] bool overrun() const { return bit_ >= 32 * std::uint64_t{words_.size()}; }
  // Goes to the next whole word; whether nothing was left in this one.
  bool finish() { return read(static_cast<std::uint32_t>((32 - bit_ % 32) % 32)) == 0; }
  [[nodiscard]] std::uint64_t word() const { return bit_ / 32; }

 private:
  std::span<const std::uint32_t> words_;
  std::uint64_t bit_;
};

using Keys = std::array<std::int32_t, 3>;  // of a corner, in the floats' order

// What one node's leaves say.
struct NodeLeaves {
  std::array<std::uint32_t, 5> widths{};  // x, y, z, numbers, places
  std::array<std::uint32_t, 4> least{};
  std::vector<Keys> corners;
  std::vector<std::uint32_t> numbers;
  std::vector<Keys> vertices;
};

// Floats below 0, -0 the first of them, count down from -1.
float position_of(std::int32_t key) {
  return key >= 0 ? std::bit_cast<float>(key) : -std::bit_cast<float>(-1 - key);
}

class Check {
 public:
  Check(const CompactBvh& compact, std::span<const GnTriangle> triangles)
      : compact_(compact), triangles_(triangles) {}

  MaybeFault run() {
    if (compact_.nodes.empty()) return fault("sizes: no root");
    if (MaybeFault found = check_leaves()) return found;
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
  // Leaves follow each other in order of nodes, without gaps; one word of 0 is left.
  [[nodiscard]] MaybeFault check_leaves() {
    std::uint64_t next = 0;
    for (std::size_t index = 0; index < compact_.nodes.size(); ++index) {
      const CompactNode& node = compact_.nodes[index];
      std::uint32_t count = 0;
      for (std::uint32_t slot = 0; slot < GN_WIDTH; ++slot) count += gn_byte_of(node.counts, slot);
      first_.push_back(numbers_.size());
      const std::uint64_t expected = count == 0 ? 0 : next;
      if (node.leaves != expected)
        return fault("leaves: at word " + text(node.leaves) + " instead of " + text(expected), index);
      if (count == 0) continue;
      BitReader reader(compact_.leaves, next);
      if (MaybeFault found = read_leaves(reader, count, index)) return found;
      next = reader.word();
    }
    if (compact_.leaves.size() != next + 1 || compact_.leaves.back() != 0)
      return fault("leaves: " + text(compact_.leaves.size()) + " words instead of " + text(next) +
                   " and a 0");
    return std::nullopt;
  }

  [[nodiscard]] MaybeFault read_leaves(BitReader& reader, std::uint32_t count, std::size_t index) {
    NodeLeaves leaves;
    for (std::uint32_t& width : leaves.widths) width = reader.read(6);
    if (*std::max_element(leaves.widths.begin(), leaves.widths.begin() + 4) > 32 || leaves.widths[4] > 8)
      return fault("leaves: fields are too wide", index);
    if (!reader.finish()) return fault("leaves: more fields than there are", index);
    for (std::uint32_t& least : leaves.least) least = reader.read(32);
    std::vector<std::uint32_t> places;
    std::uint32_t used = 0;
    for (std::uint32_t i = 0; i < 3 * count; ++i) {
      places.push_back(leaves.widths[4] == 0 ? i : reader.read(leaves.widths[4]));
      if (places.back() > used)
        return fault("leaves: vertex " + text(places.back()) + " is used before " + text(used), index);
      used = std::max(used, places.back() + 1);
      if (i % 3 == 2) leaves.numbers.push_back(leaves.least[3] + reader.read(leaves.widths[3]));
    }
    for (std::uint32_t vertex = 0; vertex < used; ++vertex) {
      Keys keys{};
      for (std::size_t k = 0; k < 3; ++k)
        keys[k] = static_cast<std::int32_t>(leaves.least[k] + reader.read(leaves.widths[k]));
      leaves.vertices.push_back(keys);
    }
    if (!reader.finish()) return fault("leaves: bits are set behind the last field", index);
    if (reader.overrun()) return fault("leaves: they reach beyond the last word", index);
    for (const std::uint32_t place : places) leaves.corners.push_back(leaves.vertices[place]);
    if (MaybeFault found = check_widths(leaves, index)) return found;
    for (const Keys& corner : leaves.corners)
      corners_.push_back({position_of(corner[0]), position_of(corner[1]), position_of(corner[2])});
    numbers_.insert(numbers_.end(), leaves.numbers.begin(), leaves.numbers.end());
    return std::nullopt;
  }

  // The fewest bits: no field is wider than its column needs, and equal corners are one vertex if that pays.
  [[nodiscard]] static MaybeFault check_widths(const NodeLeaves& leaves, std::size_t index) {
    const auto misfit = [&](std::size_t column, std::uint32_t least, std::uint32_t most) {
      return leaves.least[column] != least ||
             leaves.widths[column] != static_cast<std::uint32_t>(std::bit_width(most - least));
    };
    const auto numbers = std::minmax_element(leaves.numbers.begin(), leaves.numbers.end());
    if (misfit(3, *numbers.first, *numbers.second)) return fault("leaves: numbers could be narrower", index);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax_element(leaves.vertices.begin(), leaves.vertices.end(),
                                                   [k](const Keys& a, const Keys& b) { return a[k] < b[k]; });
      if (misfit(k, static_cast<std::uint32_t>((*low)[k]), static_cast<std::uint32_t>((*high)[k])))
        return fault("leaves: corners could be narrower", index);
    }
    const std::set<Keys> distinct(leaves.vertices.begin(), leaves.vertices.end());
    const std::size_t corners = leaves.corners.size();
    const std::uint32_t vertex = leaves.widths[0] + leaves.widths[1] + leaves.widths[2];
    const auto place = std::max(1U, static_cast<std::uint32_t>(std::bit_width(distinct.size() - 1)));
    const bool may_share = corners <= 3 * GN_MOST_SHARING;
    const bool shares = may_share && corners * place + distinct.size() * vertex < corners * vertex;
    if (leaves.widths[4] != (shares ? place : 0))
      return fault("leaves: the other form would be smaller", index);
    if (shares && distinct.size() != leaves.vertices.size())
      return fault("leaves: a vertex is the copy of another", index);
    return std::nullopt;
  }

  [[nodiscard]] MaybeFault check_triangles() const {
    if (numbers_.size() != triangles_.size())
      return fault("sizes: " + text(numbers_.size()) + " triangles of " + text(triangles_.size()));
    std::vector<char> seen(triangles_.size(), 0);
    for (std::size_t place = 0; place < numbers_.size(); ++place) {
      const std::uint32_t number = numbers_[place];
      if (number >= triangles_.size())
        return fault("triangles: number " + text(number) + " of " + text(triangles_.size()));
      if (std::exchange(seen[number], 1) != 0) return fault("triangles: " + text(number) + " appears twice");
      if (std::memcmp(&corners_[3 * place], &triangles_[number], sizeof(GnTriangle)) != 0)
        return fault("triangles: a corner of " + text(number) + " is another");
    }
    return std::nullopt;
  }

  // Each node is reached once. Parents come before children in order_.
  MaybeFault check_links() {
    std::vector<char> node_seen(compact_.nodes.size(), 0);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> open{{0, 1}};
    node_seen[0] = 1;
    while (!open.empty()) {
      const auto [index, depth] = open.back();
      open.pop_back();
      order_.push_back(index);
      deepest_ = std::max(deepest_, depth);
      const CompactNode& node = compact_.nodes[index];
      std::uint64_t next_node = node.first_node;
      for (std::uint32_t slot = 0; slot < GN_WIDTH; ++slot) {
        if (!holds_node(node, slot)) continue;
        if (gn_byte_of(node.counts, slot) != 0)
          return fault("slots: slot " + text(slot) + " holds a node and triangles", index);
        if (next_node >= compact_.nodes.size()) return fault("links: node " + text(next_node), index);
        if (std::exchange(node_seen[next_node], 1) != 0)
          return fault("links: node " + text(next_node) + " is referenced twice or is the root", index);
        open.emplace_back(static_cast<std::uint32_t>(next_node), depth + 1);
        next_node += 1;
      }
    }
    if (std::find(node_seen.begin(), node_seen.end(), 0) != node_seen.end())
      return fault("links: node never referenced");
    boxes_.resize(compact_.nodes.size());
    return std::nullopt;
  }

  // Children come first: boxes_ of them hold exactly the triangles below.
  MaybeFault check_boxes(std::uint32_t index) {
    const CompactNode& node = compact_.nodes[index];
    std::uint32_t next_node = node.first_node;
    std::size_t next_corner = 3 * first_[index];
    for (std::uint32_t slot = 0; slot < GN_WIDTH; ++slot) {
      const std::uint32_t count = gn_byte_of(node.counts, slot);
      if (!holds_node(node, slot) && count == 0) continue;
      Box below;
      if (holds_node(node, slot)) below = boxes_[next_node++];
      for (std::uint32_t i = 0; i < 3 * count; ++i, ++next_corner)
        below.grow(corners_[next_corner].data(), corners_[next_corner].data());
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
  std::vector<std::size_t> first_;  // of each node's triangles, among all in order of nodes
  std::vector<std::array<float, 3>> corners_;
  std::vector<std::uint32_t> numbers_;
  std::vector<std::uint32_t> order_;
  std::vector<Box> boxes_;
  std::uint32_t deepest_ = 0;
};

}  // namespace

std::optional<BvhFault> check_compact(const CompactBvh& compact, std::span<const GnTriangle> triangles) {
  return Check(compact, triangles).run();
}

}  // namespace gnomon
