#include "gnomon/tree/build_fast_reference.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gnomon/shared/fast_math.h"
#include "gnomon/tree/build_reference.h"

namespace gnomon {

namespace {

// A cluster while its segment is merged.
struct Cluster {
  GnPrimitive box{};
  std::uint32_t number = 0;  // in its segment
  std::uint32_t counts = 1;
  float cost = 0.0F;
};

float half_area(const GnPrimitive& box) {
  return gn_surface_measure(box.lo, box.hi);
}

GnPrimitive united(const GnPrimitive& a, const GnPrimitive& b) {
  GnPrimitive box{};
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = gn_min(a.lo[k], b.lo[k]);
    box.hi[k] = gn_max(a.hi[k], b.hi[k]);
  }
  return box;
}

std::vector<GnPrimitive> boxes_of(std::span<const GnTriangle> triangles) {
  std::vector<GnPrimitive> boxes;
  boxes.reserve(triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) boxes.push_back(primitive_of(triangles[i], i));
  return boxes;
}

GnMortonFrame frame_of(const std::vector<GnPrimitive>& boxes) {
  float lo[3];
  float hi[3];
  gn_empty_box(lo, hi);
  for (const GnPrimitive& box : boxes) {
    for (int k = 0; k < 3; ++k) {
      lo[k] = gn_min(box.lo[k] + box.hi[k], lo[k]);
      hi[k] = gn_max(box.lo[k] + box.hi[k], hi[k]);
    }
  }
  return gn_morton_frame(lo, hi);
}

// Boxes in the curve's order, their numbers in `index`.
void sort_along_curve(std::vector<GnPrimitive>& boxes) {
  const GnMortonFrame frame = frame_of(boxes);
  const auto code = [&](const GnPrimitive& box, int fine) {
    return gn_morton_code(frame, box.lo[0] + box.hi[0], box.lo[1] + box.hi[1], box.lo[2] + box.hi[2], fine);
  };
  const auto sort_by = [&](int fine) {
    std::stable_sort(boxes.begin(), boxes.end(), [&](const GnPrimitive& a, const GnPrimitive& b) {
      return code(a, fine) < code(b, fine);
    });
  };
  sort_by(0);
  // A whole segment in one cell asks for finer ones.
  for (std::size_t i = GN_SEGMENT; i <= boxes.size(); i += GN_SEGMENT) {
    if (code(boxes[i - GN_SEGMENT], 0) != code(boxes[i - 1], 0)) continue;
    // Stable, so this order decides where the upper bits are equal; ties within it stay by number.
    std::sort(boxes.begin(), boxes.end(), [](const auto& a, const auto& b) { return a.index < b.index; });
    sort_by(1);
    sort_by(0);
    return;
  }
}

// Merges one segment's clusters down to a few.
class Segment {
 public:
  Segment(std::span<const GnPrimitive> boxes, GnLeafRule rule) : rule_(rule) {
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
      clusters_.push_back({boxes[i], i, 1, gn_triangle_cost(rule, half_area(boxes[i]))});
    }
    const std::size_t few = (boxes.size() + GN_PER_CLUSTER - 1) / GN_PER_CLUSTER;
    for (std::uint32_t round = 0; clusters_.size() > few; ++round) merge_round(round < GN_FREE_ROUNDS);
  }

  [[nodiscard]] const std::vector<Cluster>& clusters() const { return clusters_; }
  [[nodiscard]] const std::vector<GnMerge>& merges() const { return merges_; }

 private:
  [[nodiscard]] std::uint32_t partner_of(std::uint32_t i, bool free) const {
    const auto count = static_cast<std::uint32_t>(clusters_.size());
    if (!free) return (i ^ 1U) < count ? i ^ 1U : i;
    std::uint32_t best = GN_NONE;
    const std::uint32_t end = std::min(count, i + GN_NEIGHBOURS + 1);
    for (std::uint32_t j = i - std::min<std::uint32_t>(i, GN_NEIGHBOURS); j < end; ++j) {
      if (j == i) continue;
      const float area = half_area(united(clusters_[i].box, clusters_[j].box));
      best = std::min(best, gn_pair_key(area, j > i ? j - i : i - j, std::min(i, j)));
    }
    return gn_pair_partner(best, i);
  }

  void merge_round(bool free) {
    std::vector<std::uint32_t> partner;
    for (std::uint32_t i = 0; i < clusters_.size(); ++i) partner.push_back(partner_of(i, free));
    std::vector<Cluster> next;
    for (std::uint32_t i = 0; i < clusters_.size(); ++i) {
      const bool mutual = partner[partner[i]] == i;
      if (!mutual || partner[i] == i) next.push_back(clusters_[i]);
      if (mutual && partner[i] > i) next.push_back(merge(clusters_[i], clusters_[partner[i]]));
    }
    clusters_ = std::move(next);
  }

  Cluster merge(const Cluster& left, const Cluster& right) {
    Cluster out;
    out.box = united(left.box, right.box);
    out.number = GN_SEGMENT + static_cast<std::uint32_t>(merges_.size());
    out.counts = gn_merge_counts(rule_, half_area(out.box), left.cost + right.cost, left.counts, right.counts,
                                 &out.cost);
    GnMerge record{};
    std::copy_n(out.box.lo, 3, record.lo);
    std::copy_n(out.box.hi, 3, record.hi);
    record.children = left.number | right.number << 16U;
    record.counts = out.counts;
    merges_.push_back(record);
    return out;
  }

  GnLeafRule rule_;
  std::vector<Cluster> clusters_;
  std::vector<GnMerge> merges_;
};

// The tree put together: the tree over the clusters, each of its leaves replaced by its cluster.
class Assembly {
 public:
  Assembly(const std::vector<GnPrimitive>& boxes, const std::vector<Segment>& segments, const Bvh& top)
      : boxes_(boxes), segments_(segments), top_(top) {
    for (std::uint32_t s = 0; s < segments.size(); ++s) {
      for (const Cluster& cluster : segments[s].clusters()) clusters_.emplace_back(s, cluster);
    }
    for (const std::uint32_t c : top.primitives) {
      const std::uint32_t counts = clusters_[c].second.counts;
      first_split_.push_back(splits_);
      splits_ += (counts >> 16U) + 1;  // its own, and the one between it and the next
    }
    out_.nodes.resize(2 * static_cast<std::size_t>(splits_) - 1);
    out_.primitives.reserve(boxes.size());
  }

  Bvh run() {
    emit_over_clusters(0, 0);
    return std::move(out_);
  }

 private:
  // Left to right, so that leaf order is that of the calls. Depth is bounded: recursion is shallow.
  void emit_over_clusters(std::uint32_t index, std::uint32_t place) {
    Node node = top_.nodes[index];
    if (node.count > 0) {
      const auto& [segment, cluster] = clusters_[top_.primitives[node.first]];
      split_ = first_split_[node.first];
      emit_cluster(segment, cluster.number, place);
      return;
    }
    const std::uint32_t left = node.first;
    // The k-th split between clusters comes after all splits of the clusters before it.
    node.first = 1 + 2 * (first_split_[(left - 1) / 2 + 1] - 1);
    out_.nodes[place] = node;
    emit_over_clusters(left, node.first);
    emit_over_clusters(left + 1, node.first + 1);
  }

  void emit_cluster(std::uint32_t segment, std::uint32_t number, std::uint32_t place) {
    Node node = node_of(segment, number);
    const std::uint32_t counts = counts_of(segment, number);
    if (counts >> 16U == 0) {
      node.first = static_cast<std::uint32_t>(out_.primitives.size());
      node.count = counts;
      out_.nodes[place] = node;
      list_triangles(segment, number);
      return;
    }
    const std::uint32_t children = segments_[segment].merges()[number - GN_SEGMENT].children;
    const std::uint32_t left = children & 0xffffU;
    const std::uint32_t split = split_ + (counts_of(segment, left) >> 16U);
    node.first = 1 + 2 * split;
    out_.nodes[place] = node;
    emit_cluster(segment, left, node.first);
    split_ = split + 1;
    emit_cluster(segment, children >> 16U, node.first + 1);
  }

  void list_triangles(std::uint32_t segment, std::uint32_t number) {
    if (number < GN_SEGMENT) {
      out_.primitives.push_back(boxes_[segment * std::size_t{GN_SEGMENT} + number].index);
      return;
    }
    const std::uint32_t children = segments_[segment].merges()[number - GN_SEGMENT].children;
    list_triangles(segment, children & 0xffffU);
    list_triangles(segment, children >> 16U);
  }

  [[nodiscard]] std::uint32_t counts_of(std::uint32_t segment, std::uint32_t number) const {
    return number < GN_SEGMENT ? 1 : segments_[segment].merges()[number - GN_SEGMENT].counts;
  }

  [[nodiscard]] Node node_of(std::uint32_t segment, std::uint32_t number) const {
    Node node{};
    if (number < GN_SEGMENT) {
      const GnPrimitive& box = boxes_[segment * std::size_t{GN_SEGMENT} + number];
      std::copy_n(box.lo, 3, node.lo);
      std::copy_n(box.hi, 3, node.hi);
    } else {
      const GnMerge& merge = segments_[segment].merges()[number - GN_SEGMENT];
      std::copy_n(merge.lo, 3, node.lo);
      std::copy_n(merge.hi, 3, node.hi);
    }
    return node;
  }

  const std::vector<GnPrimitive>& boxes_;
  const std::vector<Segment>& segments_;
  const Bvh& top_;
  std::vector<std::pair<std::uint32_t, Cluster>> clusters_;
  std::vector<std::uint32_t> first_split_;  // by place in the order of the tree over the clusters
  std::uint32_t splits_ = 0;
  std::uint32_t split_ = 0;  // the next one of the cluster being emitted
  Bvh out_;
};

// A box as the builder over clusters takes it.
GnTriangle stand_in(const GnPrimitive& box) {
  GnTriangle triangle{};
  std::copy_n(box.lo, 3, triangle.v0);
  std::copy_n(box.hi, 3, triangle.v1);
  std::copy_n(box.lo, 3, triangle.v2);
  return triangle;
}

}  // namespace

BuildOptions options_over_clusters(const BuildOptions& options) {
  BuildOptions out;
  out.bins = options.bins;
  out.max_leaf_size = 1;
  out.median_depth = GN_CLUSTERS_BY_COST;
  out.work_group_size = options.work_group_size;
  out.subtree_size = options.subtree_size;
  out.chunk_size = options.chunk_size;
  return out;
}

std::vector<std::uint32_t> morton_order(std::span<const GnTriangle> triangles) {
  std::vector<GnPrimitive> boxes = boxes_of(triangles);
  sort_along_curve(boxes);
  std::vector<std::uint32_t> order;
  for (const GnPrimitive& box : boxes) order.push_back(box.index);
  return order;
}

Bvh build_fast_reference(std::span<const GnTriangle> triangles, const BuildOptions& options) {
  options.check();
  if (triangles.empty()) return {};
  std::vector<GnPrimitive> boxes = boxes_of(triangles);
  sort_along_curve(boxes);
  const GnLeafRule rule{options.cost_traversal, options.cost_triangle, options.max_leaf_size};
  std::vector<Segment> segments;
  std::vector<GnTriangle> stand_ins;
  for (std::size_t first = 0; first < boxes.size(); first += GN_SEGMENT) {
    const std::size_t count = std::min<std::size_t>(GN_SEGMENT, boxes.size() - first);
    segments.emplace_back(std::span(boxes).subspan(first, count), rule);
    for (const Cluster& cluster : segments.back().clusters()) stand_ins.push_back(stand_in(cluster.box));
  }
  return Assembly(boxes, segments, build_reference(stand_ins, options_over_clusters(options))).run();
}

}  // namespace gnomon
