#include "gnomon/plan/segment_set.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "gnomon/shared/fast_math.h"
#include "gnomon/shared/ray_math.h"

namespace gnomon {

namespace {

// So few of a word's segments are looked at one by one.
constexpr std::uint32_t kFew = 6;
constexpr float kCells = 1024.0F;

// Cell of the middle of what of a segment lies in the box, in Morton order.
std::uint32_t place_of(const Ray& ray, const GnBox& around) {
  float near = ray.tmin;
  float far = ray.tmax;
  for (int k = 0; k < 3; ++k) {
    if (ray.direction[k] == 0.0F) continue;
    const float a = (around.lo[k] - ray.origin[k]) / ray.direction[k];
    const float b = (around.hi[k] - ray.origin[k]) / ray.direction[k];
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  const float middle = 0.5F * near + 0.5F * far;
  std::uint32_t key = 0;
  for (int k = 0; k < 3; ++k) {
    const float size = around.hi[k] - around.lo[k];
    const float at =
        size > 0.0F ? (ray.origin[k] + middle * ray.direction[k] - around.lo[k]) / size * kCells : 0.0F;
    const std::uint32_t cell = at > 0.0F ? at < kCells - 1.0F ? static_cast<std::uint32_t>(at) : 1023U : 0U;
    key |= gn_spread_bits(cell) << (2 - k);
  }
  return key;
}

// How many bits are set. Written out: std::popcount is a call where not every processor has the instruction.
std::uint32_t bits_in(std::uint64_t word) {
  word -= (word >> 1U) & 0x5555555555555555U;
  word = (word & 0x3333333333333333U) + ((word >> 2U) & 0x3333333333333333U);
  word = (word + (word >> 4U)) & 0x0f0f0f0f0f0f0f0fU;
  return static_cast<std::uint32_t>((word * 0x0101010101010101U) >> 56U);
}

// Vectors of the compilers' own: one source for all instruction sets.
template <int kWidth>
struct Vectors {
  typedef float Floats __attribute__((vector_size(4 * kWidth)));
  typedef std::uint32_t Bits __attribute__((vector_size(4 * kWidth)));
  typedef std::int32_t Truths __attribute__((vector_size(4 * kWidth)));
};

template <typename Vector>
[[gnu::always_inline]] inline void load(Vector& to, const void* from) {
  std::memcpy(&to, from, sizeof to);
}

// A bit for each lane that is not 0.
template <int kWidth>
[[gnu::always_inline]] inline std::uint64_t bits_of(const typename Vectors<kWidth>::Truths& met) {
  std::uint64_t bits = 0;
#if defined(__SSE2__)
  for (int i = 0; i < kWidth; i += 4) {
    typename Vectors<4>::Floats some;
    std::memcpy(&some, reinterpret_cast<const char*>(&met) + 4 * i, sizeof some);
    bits |= static_cast<std::uint64_t>(__builtin_ia32_movmskps(some)) << i;
  }
#else
  for (int i = 0; i < kWidth; ++i) bits |= std::uint64_t{met[i] != 0} << i;
#endif
  return bits;
}

// Of gn_box_entry, for kWidth segments at a time: which of the block's meet the box.
template <int kWidth, typename Block>
[[gnu::always_inline]] inline std::uint64_t lanes_meet(const Block& block, const GnBox& box) {
  using Floats = typename Vectors<kWidth>::Floats;
  using Bits = typename Vectors<kWidth>::Bits;
  using Truths = typename Vectors<kWidth>::Truths;
  std::uint64_t out = 0;
  for (std::size_t i = 0; i < 64; i += kWidth) {
    Floats near, limit, origin, inverse;
    Bits turned;
    load(near, &block.tmin[i]);
    load(limit, &block.limit[i]);
    Floats far = Floats{} + GN_INFINITY;
    for (std::size_t k = 0; k < 3; ++k) {
      load(origin, &block.origin[k][i]);
      load(inverse, &block.inverse[k][i]);
      load(turned, &block.backwards[k][i]);
      const Bits lo = Bits{} + gn_bits_of(box.lo[k]);
      const Bits hi = Bits{} + gn_bits_of(box.hi[k]);
      turned &= lo ^ hi;
      const Floats a = (reinterpret_cast<Floats>(lo ^ turned) - origin) * inverse;
      const Floats b = (reinterpret_cast<Floats>(hi ^ turned) - origin) * inverse;
      near = a > near ? a : near;
      far = b < far ? b : far;
    }
    far = far * (far < 0.0F ? Floats{} + (1.0F - GN_SLAB_SLACK) : Floats{} + (1.0F + GN_SLAB_SLACK));
    far = far < limit ? far : limit;
    const Truths met = near <= far;
    out |= bits_of<kWidth>(met) << i;
  }
  return out;
}

#if defined(__x86_64__)
template <typename Block>
[[gnu::target("avx2")]] std::uint64_t wide_meets(const Block& block, const GnBox& box) {
  return lanes_meet<8>(block, box);
}
#endif

}  // namespace

SegmentSet::SegmentSet(std::span<const Ray> segments, const GnBox& around) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> order;
  const std::vector<Ray> some = thinned(segments, kMostSegments);
  for (std::uint32_t i = 0; i < some.size(); ++i) {
    if (gn_ray_is_valid(&some[i]) != 0) order.emplace_back(place_of(some[i], around), i);
  }
  std::sort(order.begin(), order.end());
  size_ = order.size();
  blocks_.resize((size_ + kLanes - 1) / kLanes);
  for (std::size_t i = 0; i < order.size(); ++i) {
    Block& block = blocks_[i / kLanes];
    const std::size_t lane = i % kLanes;
    const Ray& ray = some[order[i].second];
    rays_.push_back(ray);
    const GnRayFrame frame = gn_ray_frame(&ray);
    for (std::size_t k = 0; k < 3; ++k) {
      block.origin[k][lane] = frame.origin[k];
      block.inverse[k][lane] = frame.inverse[k];
      block.backwards[k][lane] = frame.inverse[k] < 0.0F ? 0xffffffffU : 0U;
    }
    block.tmin[lane] = gn_finite_tmin(ray.tmin);
    block.limit[lane] = gn_slab_limit(gn_finite_tmax(ray.tmax));
    all_.words[i / kLanes] |= std::uint64_t{1} << lane;
  }
}

bool SegmentSet::lane_meets(const Block& block, std::size_t lane, const GnBox& box) {
  float near = block.tmin[lane];
  float far = GN_INFINITY;
  for (std::size_t k = 0; k < 3; ++k) {
    const bool backwards = block.backwards[k][lane] != 0;
    const float a = ((backwards ? box.hi[k] : box.lo[k]) - block.origin[k][lane]) * block.inverse[k][lane];
    const float b = ((backwards ? box.lo[k] : box.hi[k]) - block.origin[k][lane]) * block.inverse[k][lane];
    near = gn_max(a, near);
    far = gn_min(b, far);
  }
  return near <= gn_min(gn_slab_limit(far), block.limit[lane]);
}

std::uint64_t SegmentSet::block_meets(const Block& block, const GnBox& box) {
#if defined(__x86_64__)
  static const bool wide = __builtin_cpu_supports("avx2") != 0;
  if (wide) return wide_meets(block, box);
#endif
  return lanes_meet<4>(block, box);
}

std::uint64_t SegmentSet::meets(std::size_t word, std::uint64_t open, const GnBox& box) {
  if (open == 0) return 0;
  const Block& block = blocks_[word];
  const std::uint32_t count = bits_in(open);
  if (count > kFew) {
    wide_tests_ += 1;
    return block_meets(block, box) & open;
  }
  single_tests_ += count;
  std::uint64_t out = 0;
  for (std::uint64_t left = open; left != 0; left &= left - 1) {
    const int lane = std::countr_zero(left);
    if (lane_meets(block, static_cast<std::size_t>(lane), box)) out |= std::uint64_t{1} << lane;
  }
  return out;
}

void SegmentSet::meet(const GnBox& box, const SegmentMask& within, SegmentMask& known) {
  for (std::size_t w = 0; w < SegmentMask::kWords; ++w)
    known.words[w] |= meets(w, within.words[w] & ~known.words[w], box);
}

}  // namespace gnomon
