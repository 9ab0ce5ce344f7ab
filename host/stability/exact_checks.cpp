// Checks of the geometry group that compare bits: scaled scenes with each other, and sums of whole numbers
// with the same sums in 64 bits.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "gnomon/device/level_loop.h"
#include "gnomon/shared/wide_layout.h"
#include "gnomon/stability/aim.h"
#include "gnomon/stability/cases.h"
#include "gnomon/tree/build_best_reference.h"
#include "gnomon/tree/bvh_check.h"
#include "gnomon/tree/parts.h"

namespace gnomon::stability {

namespace {

// Links and order of a tree, and its boxes at another scale.
bool same_tree(const Bvh& a, const Bvh& b, int power) {
  if (a.primitives != b.primitives || a.nodes.size() != b.nodes.size()) return false;
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    const Node& x = a.nodes[i];
    const Node& y = b.nodes[i];
    if (x.first != y.first || x.count != y.count) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      if (std::ldexp(x.lo[k], power) != y.lo[k] || std::ldexp(x.hi[k], power) != y.hi[k]) return false;
    }
  }
  return true;
}

bool same_hit(const Hit& a, const Hit& b, int power) {
  return a.primitive == b.primitive && std::ldexp(a.t, power) == b.t &&
         std::memcmp(&a.u, &b.u, 2 * sizeof a.u) == 0;
}

// Origins scale with the scene, directions do not: so t does.
Specimen scaled_by(const Specimen& base, int power) {
  Specimen out{scaled(base.triangles, power), base.rays, base.expect};
  for (Ray& ray : out.rays) {
    for (float& x : ray.origin) x = std::ldexp(x, power);
  }
  return out;
}

}  // namespace

Specimen soup_and_hill(const Bench& bench, unsigned triangles) {
  Specimen specimen{soup(triangles, 0.6F, 0.0F, 10.0F, bench.seed), {}, Expect::kOracle};
  append(specimen.triangles, hill(8, 3, bench.seed));
  SteadyRandom random(bench.seed);
  for (std::uint32_t i = 0; i < bench.rays; ++i) {
    const Triangle& t = specimen.triangles[random.below(static_cast<unsigned>(specimen.triangles.size()))];
    specimen.rays.push_back(through(place_on(t, i % 3, random), 12.0F, random));
  }
  return specimen;
}

std::vector<Verdict> check_scales(const Bench& bench, const CaseInfo& info) {
  std::vector<Verdict> all;
  const Specimen base = soup_and_hill(bench, 500);
  for (const Builder& builder : bench.builders) {
    std::vector<Verdict> verdicts;
    for (const Flavour& flavour : bench.flavours)
      verdicts.push_back(empty_verdict(bench, info, builder.name, flavour.name));
    const DeviceBvh base_tree = build_device(bench.context, base.triangles, builder.options);
    const Bvh base_bvh = download_bvh(bench.context, base_tree);
    std::vector<std::vector<Hit>> base_hits;
    for (const Flavour& flavour : bench.flavours)
      base_hits.push_back(Tracer(bench.context, base_tree, flavour.options).closest(base.rays).hits);
    for (const int power : {-40, -30, -20, -10, -1, 1, 10, 20, 30, 40}) {
      const Specimen specimen = scaled_by(base, power);
      const DeviceBvh tree = build_device(bench.context, specimen.triangles, builder.options);
      const bool same = same_tree(base_bvh, download_bvh(bench.context, tree), power);
      judge_specimen(bench, specimen, tree, verdicts);
      for (std::size_t f = 0; f < bench.flavours.size(); ++f) {
        const std::string where = " at scale 2^" + std::to_string(power);
        if (!same) verdicts[f].fault("another tree" + where);
        const std::vector<Hit> hits =
            Tracer(bench.context, tree, bench.flavours[f].options).closest(specimen.rays).hits;
        for (std::size_t i = 0; i < hits.size(); ++i) {
          if (!same_hit(base_hits[f][i], hits[i], power))
            verdicts[f].fault("another hit of ray " + std::to_string(i) + where);
        }
      }
    }
    all.insert(all.end(), verdicts.begin(), verdicts.end());
  }
  return all;
}

namespace {

constexpr std::uint32_t kMost = 0x7fffffffU;  // triangles that builders take

// Buffers of the largest build: twice those of one half as large, but for what does not grow.
void check_memory(const Bench& bench, const Builder& builder, Verdict& verdict) {
  cl::DeviceInfo device = bench.context.device();
  device.loop_limit = 0;  // or it would refuse so many
  // Parts are what the best builder has no more of than others have triangles.
  const bool has_parts = builder.options.builder == gnomon::Builder::kBest;
  const std::uint32_t most = has_parts ? kMost / 4 * 3 : kMost;
  const std::uint64_t leaves = has_parts ? most_parts(most, kPartBudget) : most;
  const auto whole = build_memory(device, most, builder.options);
  const auto half = build_memory(device, most / 2, builder.options);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const double ratio = static_cast<double>(whole[i].bytes) / static_cast<double>(half[i].bytes);
    const bool grows = half[i].bytes > (1U << 28U);
    if (ratio < 1.0 || (grows && std::fabs(ratio - 2.0) > 0.01))
      verdict.fault("buffer " + whole[i].name + " of " + std::to_string(whole[i].bytes) + " bytes");
  }
  for (const BufferNeed& need : whole) {
    if (need.name == "nodes" && need.bytes != 2 * leaves * sizeof(Node))
      verdict.fault("nodes take " + std::to_string(need.bytes) + " bytes");
  }
}

// Chunks of the largest root cover it, and its children stand where 64-bit sums say.
void check_levels(Verdict& verdict) {
  GnTask root{};
  root.end = kMost;
  for (const std::uint32_t chunk_size : {1U << 20U, (1U << 20U) - 1}) {
    const Level level = make_level({root}, chunk_size);
    std::uint64_t at = 0;
    for (const GnChunk& chunk : level.chunks) {
      if (chunk.begin != at || chunk.end <= chunk.begin)
        verdict.fault("chunk " + std::to_string(chunk.begin) + " is not next");
      at = chunk.end;
    }
    if (at != kMost) verdict.fault("chunks end at " + std::to_string(at));
  }
  for (const std::uint32_t left : {1U, kMost / 2, kMost - 1}) {
    Level level = make_level({root}, 1U << 20U);
    level.tasks[0].left_count = left;
    LargeNodes large;
    const std::vector<GnChildren> children(1);
    const std::vector<GnBounds> bounds(4 * level.chunks.size());
    std::vector<GnTask> tasks = next_tasks(level, children, bounds, 32, large);
    tasks.insert(tasks.end(), large.roots.begin(), large.roots.end());
    std::uint64_t triangles = 0;
    for (const GnTask& task : tasks) {
      triangles += task.end - task.begin;
      const bool is_left = task.begin == 0;
      if (task.slot != std::uint64_t{2} * left + (is_left ? 0 : 1))
        verdict.fault("a child stands at " + std::to_string(task.slot));
    }
    if (triangles != kMost) verdict.fault("children hold " + std::to_string(triangles) + " triangles");
  }
}

// Runs of rays cover every count up to the last.
void check_runs(Verdict& verdict) {
  for (const std::uint32_t count :
       {1U, 63U, 64U, kMost, kMost + 1U, kMost + 2U, 0xffffffc0U, 0xfffffffeU, 0xffffffffU}) {
    const std::uint64_t runs = (std::uint64_t{count} + 63) / 64;
    const auto first = static_cast<std::uint32_t>(64 * (runs - 1));
    if (gn_run_end(first, count, 64) != count)
      verdict.fault("the last run of " + std::to_string(count) + " ends elsewhere");
    if (runs > 1 && gn_run_end(first - 64, count, 64) != first)
      verdict.fault("a run of " + std::to_string(count) + " is cut");
  }
}

// Leaves at both ends of what links can say, and their triangles; none reads as a slot that is empty.
void check_links(Verdict& verdict) {
  for (const std::uint32_t count : {1U, 8U, 9U, GN_LONG_LEAF - 1U, GN_LONG_LEAF, GN_MAX_WIDE_LEAF}) {
    const std::uint32_t places = gn_leaf_places(count);
    for (const std::uint32_t place : {0U, 1U, GN_MAX_PLACES - places}) {
      const std::uint32_t link = gn_leaf_link(place, count);
      const std::string which = "a leaf of " + std::to_string(count) + " at place " + std::to_string(place);
      if ((link & GN_LEAF_LINK) == 0 || link == GN_NONE || gn_link_place(link) != place) verdict.fault(which);
      GnLeaf leaf{place + places - count, count};
      if (count < GN_LONG_LEAF) leaf = gn_leaf_at(nullptr, link);
      if (leaf.first + leaf.count != place + places || leaf.count != count)
        verdict.fault("the end of " + which);
      for (const std::uint32_t i : {0U, count / 2, count - 1}) {
        const std::uint32_t seat = gn_seat_in(leaf, i);
        const std::uint32_t block = leaf.first + i / GN_WIDTH * GN_WIDTH;
        if (gn_seat_word(seat) != GN_TRIANGLE_WORDS * block + i % GN_WIDTH)
          verdict.fault("triangle " + std::to_string(i) + " of " + which);
        if (gn_seat_stride(seat) != std::min(GN_WIDTH, leaf.first + leaf.count - block))
          verdict.fault("the stride of triangle " + std::to_string(i) + " of " + which);
      }
    }
  }
}

}  // namespace

std::vector<Verdict> check_indices(const Bench& bench, const CaseInfo& info) {
  std::vector<Verdict> all;
  for (const Builder& builder : bench.builders) {
    Verdict verdict = empty_verdict(bench, info, builder.name, "-");
    check_memory(bench, builder, verdict);
    check_levels(verdict);
    check_runs(verdict);
    check_links(verdict);
    all.push_back(verdict);
  }
  return all;
}

}  // namespace gnomon::stability
