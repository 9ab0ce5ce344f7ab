#include "gnomon/plan/sample_mover.h"

#include <algorithm>

namespace gnomon {

namespace {

// What work takes beside a box test of a tracer, rounded from clocks (bench/results).
constexpr double kBoundWork = 5.4;    // two nodes' masks and boxes joined
constexpr double kWideWork = 12.6;    // 64 segments against a box
constexpr double kSingleWork = 1.8;   // one of them
constexpr double kItemWork = 27.0;    // a node of the part, before any search
constexpr double kSearchWork = 27.0;  // of a node's search, beside the rest

GnBox around(const GnBox& a, const GnBox& b) {
  GnBox both;
  for (int k = 0; k < 3; ++k) {
    both.lo[k] = gn_min(a.lo[k], b.lo[k]);
    both.hi[k] = gn_max(a.hi[k], b.hi[k]);
  }
  return both;
}

bool same(const GnBox& a, const GnBox& b) {
  return std::equal(a.lo, a.lo + 3, b.lo) && std::equal(a.hi, a.hi + 3, b.hi);
}

}  // namespace

SampleMover::SampleMover(SegmentSet& segments, const MetPart& part, const SampleMeasure& measure)
    : segments_(segments), part_(part), measure_(measure) {
  const float root = areas_of(box_of(part.top.nodes[0]));
  per_area_ = root > 0.0F ? measure.prior_share / root : 0.0F;
  if (segments.size() > 0) per_segment_ = 1.0F / static_cast<float>(segments.size());
  take_back();
}

void SampleMover::take_back() {
  root_ = 0;
  gained_ = 0.0;
  weight_ = 0.0;
  masks_ = part_.met;
  items_.assign(part_.top.nodes.size(), {});
  for (std::uint32_t i = 0; i < items_.size(); ++i) {
    const Node& node = part_.top.nodes[i];
    Item& item = items_[i];
    item.box = box_of(node);
    item.cost = cost(part_.met_counts[i], areas_of(item.box));
    if (node.count > 0) {
      item.subtree = part_.top.primitives[node.first];
      continue;
    }
    weight_ += double{item.cost};
    for (std::uint32_t side = 0; side < 2; ++side) {
      item.children[side] = node.first + side;
      items_[node.first + side].parent = i;
    }
  }
}

void SampleMover::run_plain(const SampledOptions& options) {
  least_ = options.least_saved * per_segment_;
  for (std::uint32_t i = 0; i < items_.size(); ++i) {
    if (masks_[i].any()) queue(i);
  }
  while (!queue_.empty() && work() < options.most_work) {
    const Queued next = queue_.top();
    queue_.pop();
    if (items_[next.item].turn != next.turn || next.item == root_) continue;
    const Place place = search(next.item);
    searches_ += 1;
    if (place.beside == kNone) continue;
    gained_ += double{place.gain};
    move(next.item, place);
  }
}

double SampleMover::work() const {
  return kItemWork * static_cast<double>(items_.size()) + kSearchWork * static_cast<double>(searches_) +
         kBoundWork * static_cast<double>(bounds_) + kWideWork * static_cast<double>(segments_.wide_tests()) +
         kSingleWork * static_cast<double>(segments_.single_tests());
}

void SampleMover::queue(std::uint32_t item) {
  items_[item].turn += 1;
  if (item == root_) return;
  const float hope = promise(item);
  if (hope > gn_max(least_, GN_LEAST_GAIN * items_[item].cost)) queue_.push({hope, item, items_[item].turn});
}

// What taking the item away saves at most, by what is surely left of those above it, less what it costs
// wherever it goes.
float SampleMover::promise(std::uint32_t item) {
  std::uint32_t at = sibling(item);
  GnBox shrunk = items_[at].box;
  SegmentMask left = masks_[at];
  std::uint32_t pivot = items_[item].parent;
  float saved = items_[pivot].cost;
  while (pivot != root_ && !same(shrunk, items_[pivot].box)) {
    at = sibling(pivot);
    pivot = items_[pivot].parent;
    shrunk = around(shrunk, items_[at].box);
    left |= masks_[at];
    saved += items_[pivot].cost - cost(left.count(), areas_of(shrunk));
    bounds_ += 1;
  }
  return saved - items_[item].cost;
}

// known: segments that surely meet the box; becomes all that do. within: those that may. Once it is clear
// that the box costs `enough` or more the rest is not tested, and something from there up is returned.
float SampleMover::cost_within(const GnBox& box, const SegmentMask& within, SegmentMask& known,
                               float enough) {
  const float areas = areas_of(box);
  std::uint32_t met = known.count();
  for (std::size_t w = 0; w < SegmentMask::kWords; ++w) {
    const std::uint64_t open = within.words[w] & ~known.words[w];
    if (open == 0) continue;
    if (cost(met, areas) >= enough) break;
    const std::uint64_t more = segments_.meets(w, open, box);
    known.words[w] |= more;
    met += static_cast<std::uint32_t>(std::popcount(more));
  }
  return cost(met, areas);
}

SampleMover::Waiting SampleMover::weigh(std::uint32_t item, std::uint32_t beside, std::uint32_t pivot,
                                        float saved, const SegmentMask& within, bool own_sibling) {
  const float own = items_[item].cost;
  Waiting below{beside, -GN_INFINITY, masks_[beside] | masks_[item]};
  const GnBox both = around(items_[item].box, items_[beside].box);
  bounds_ += 1;
  // What may be saved below it.
  const float reach = inner(beside) ? gn_max(0.0F, items_[beside].cost - own) : 0.0F;
  const float hope = saved - cost(below.joint.count(), areas_of(both));
  if (!(hope + reach > best_.gain)) return below;
  const float gain = saved - cost_within(both, within, below.joint, saved + reach - best_.gain);
  if (!own_sibling && gain > best_.gain) best_ = {beside, pivot, gain};
  if (inner(beside)) below.saved = gain + items_[beside].cost;
  return below;
}

void SampleMover::wait(const Waiting& one, float own) {
  if (one.saved - own > best_.gain) waiting_.push_back(one);
}

void SampleMover::search_below(std::uint32_t item, std::uint32_t pivot) {
  const float own = items_[item].cost;
  while (!waiting_.empty() && left_ > 0) {
    const Waiting next = waiting_.back();
    waiting_.pop_back();
    if (!(next.saved - own > best_.gain)) continue;
    left_ -= 1;
    const auto& pair = items_[next.item].children;
    const Waiting a = weigh(item, pair[0], pivot, next.saved, next.joint, false);
    const Waiting b = weigh(item, pair[1], pivot, next.saved, next.joint, false);
    // The more promising one is looked at first.
    const bool b_first = b.saved > a.saved;
    wait(b_first ? a : b, own);
    wait(b_first ? b : a, own);
  }
}

SampleMover::Place SampleMover::search(std::uint32_t item) {
  const float own = items_[item].cost;
  waiting_.clear();
  best_ = {kNone, kNone, gn_max(least_, GN_LEAST_GAIN * own)};
  left_ = GN_SEARCH_PAIRS;
  std::uint32_t pivot = items_[item].parent;
  std::uint32_t beside = sibling(item);
  GnBox shrunk = items_[beside].box;  // of what will be left of the pivot
  SegmentMask left = masks_[beside];
  float saved = items_[pivot].cost;
  for (bool first = true;; first = false) {
    wait(weigh(item, beside, pivot, saved, masks_[pivot], first), own);
    search_below(item, pivot);
    if (!first) {
      left |= masks_[beside];
      shrunk = around(shrunk, items_[beside].box);
      saved += items_[pivot].cost - cost_within(shrunk, masks_[pivot], left, GN_INFINITY);
    }
    // Where the pivot does not shrink, nothing above it does.
    const bool kept = same(shrunk, items_[pivot].box);
    if (pivot == root_ || left_ == 0 || (kept && saved - own <= best_.gain)) return best_;
    beside = sibling(pivot);
    pivot = items_[pivot].parent;
  }
}

// The item's parent goes with it, to be the parent of it and its new sibling.
void SampleMover::move(std::uint32_t item, const Place& place) {
  const std::uint32_t with = items_[item].parent;
  const std::uint32_t left = sibling(item);
  const std::uint32_t above = items_[with].parent;
  const auto hang = [&](std::uint32_t what, std::uint32_t instead, std::uint32_t under) {
    items_[what].parent = under;
    if (under == kNone) {
      root_ = what;
      return;
    }
    for (std::uint32_t& child : items_[under].children) child = child == instead ? what : child;
  };
  hang(left, with, above);
  const std::uint32_t onto = items_[place.beside].parent;
  hang(with, place.beside, onto);
  items_[with].children = {place.beside, item};
  items_[place.beside].parent = with;
  items_[item].parent = with;
  chain_.clear();
  if (place.pivot == with) {
    // The sibling stands where the pivot stood: around the same triangles.
    items_[left].box = items_[with].box;
    items_[left].cost = items_[with].cost;
    masks_[left] = masks_[with];
    grow(item, left);
  } else {
    shrink(above, place.pivot);
    grow(item, place.pivot);
  }
  queue(left);
  queue(place.beside);
  for (const std::uint32_t at : chain_) queue(at);
}

// From an item up to the pivot, whose box stays. What meets a box met the larger one it was.
void SampleMover::shrink(std::uint32_t from, std::uint32_t pivot) {
  for (std::uint32_t at = from; at != pivot; at = items_[at].parent) {
    Item& item = items_[at];
    const auto& pair = item.children;
    const GnBox box = around(items_[pair[0]].box, items_[pair[1]].box);
    if (same(box, item.box)) break;
    item.box = box;
    SegmentMask known = masks_[pair[0]] | masks_[pair[1]];
    item.cost = cost_within(box, masks_[at], known, GN_INFINITY);
    masks_[at] = known;
    chain_.push_back(at);
  }
}

// From below the pivot down to a new item's parent.
void SampleMover::grow(std::uint32_t item, std::uint32_t pivot) {
  const std::size_t first = chain_.size();
  const std::uint32_t made = items_[item].parent;
  for (std::uint32_t at = made; at != pivot; at = items_[at].parent) chain_.push_back(at);
  const std::uint32_t beside = items_[made].children[0];
  items_[made].box = items_[beside].box;
  masks_[made] = masks_[beside];
  for (std::size_t i = chain_.size(); i-- > first;) {
    const std::uint32_t at = chain_[i];
    Item& grown = items_[at];
    grown.box = around(grown.box, items_[item].box);
    masks_[at] |= masks_[item];
    grown.cost = cost_within(grown.box, masks_[grown.parent], masks_[at], GN_INFINITY);
  }
}

Bvh SampleMover::tree() const {
  Bvh out;
  out.primitives = part_.top.primitives;
  std::vector<std::uint32_t> open{root_};
  out.nodes.resize(1);
  for (std::size_t i = 0; i < open.size(); ++i) {
    const Item& item = items_[open[i]];
    Node node{};
    std::copy(item.box.lo, item.box.lo + 3, node.lo);
    std::copy(item.box.hi, item.box.hi + 3, node.hi);
    if (item.subtree != kNone) {
      node.count = 1;
      node.first = item.subtree;
    } else {
      node.first = static_cast<std::uint32_t>(open.size());
      open.push_back(item.children[0]);
      open.push_back(item.children[1]);
      out.nodes.resize(out.nodes.size() + 2);
    }
    out.nodes[i] = node;
  }
  return out;
}

std::vector<float> SampleMover::measures() const {
  std::vector<float> out;
  std::vector<std::uint32_t> open{root_};
  for (std::size_t i = 0; i < open.size(); ++i) {
    const Item& item = items_[open[i]];
    out.push_back(item.cost);
    if (item.subtree == kNone) open.insert(open.end(), item.children.begin(), item.children.end());
  }
  return out;
}

// The same code for machines that count bits and have wide vectors: it takes half the time.
#if defined(__x86_64__)
[[gnu::target("avx2,popcnt"), gnu::flatten]] void SampleMover::run_wide(const SampledOptions& options) {
  run_plain(options);
}
void SampleMover::run(const SampledOptions& options) {
  static const bool wide = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("popcnt") != 0;
  wide ? run_wide(options) : run_plain(options);
}
#else
void SampleMover::run(const SampledOptions& options) {
  run_plain(options);
}
#endif

}  // namespace gnomon
