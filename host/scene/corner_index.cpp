#include "gnomon/scene/corner_index.h"

#include <bit>

#include "gnomon/scene/steady_random.h"

namespace gnomon {
namespace {

constexpr std::uint32_t kFree = 0xffffffffU;

std::uint64_t hash_of(const Vec3& p) {
  const std::uint64_t x = std::bit_cast<std::uint32_t>(p[0]);
  const std::uint64_t y = std::bit_cast<std::uint32_t>(p[1]);
  const std::uint64_t z = std::bit_cast<std::uint32_t>(p[2]);
  return mix_bits(x | (y << 32)) ^ mix_bits(z + 0x9e3779b97f4a7c15ULL);
}

bool same_bits(const Vec3& a, const Vec3& b) {
  return std::bit_cast<std::array<std::uint32_t, 3>>(a) == std::bit_cast<std::array<std::uint32_t, 3>>(b);
}

// An open-addressing table of positions seen so far; it doubles at half load.
class CornerTable {
 public:
  explicit CornerTable(std::vector<Vec3>& positions) : positions_(positions), slots_(1024, kFree) {}

  std::uint32_t find_or_add(const Vec3& p) {
    if (2 * positions_.size() >= slots_.size()) grow();
    const std::size_t slot = find(p);
    if (slots_[slot] == kFree) {
      slots_[slot] = static_cast<std::uint32_t>(positions_.size());
      positions_.push_back(p);
    }
    return slots_[slot];
  }

 private:
  [[nodiscard]] std::size_t find(const Vec3& p) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash_of(p) & mask;
    while (slots_[slot] != kFree && !same_bits(positions_[slots_[slot]], p)) slot = (slot + 1) & mask;
    return slot;
  }

  void grow() {
    slots_.assign(2 * slots_.size(), kFree);
    for (std::size_t i = 0; i < positions_.size(); ++i)
      slots_[find(positions_[i])] = static_cast<std::uint32_t>(i);
  }

  std::vector<Vec3>& positions_;
  std::vector<std::uint32_t> slots_;
};

}  // namespace

CornerIndex index_corners(std::span<const Triangle> triangles, std::span<const std::uint32_t> members) {
  CornerIndex result;
  result.indices.reserve(3 * members.size());
  CornerTable table(result.positions);
  for (const std::uint32_t member : members) {
    const Triangle& t = triangles[member];
    for (const float* v : {t.v0, t.v1, t.v2}) result.indices.push_back(table.find_or_add({v[0], v[1], v[2]}));
  }
  return result;
}

}  // namespace gnomon
