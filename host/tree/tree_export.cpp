#include "gnomon/tree/tree_export.h"

#include <array>
#include <bit>
#include <utility>

#include "gnomon/scene/write_file.h"
#include "gnomon/tree/box_frame.h"
#include "gnomon/tree/joined_bytes.h"

namespace gnomon {

namespace {

static_assert(std::endian::native == std::endian::little, "exported trees are little-endian");

struct Header {
  std::array<char, 8> magic{'g', 'n', 'o', 'm', 'b', 'v', 'h', '2'};
  std::uint32_t version = 1;
  std::uint32_t nodes = 0;
  std::uint32_t indices = 0;
  std::uint32_t triangles = 0;
  std::uint32_t repeats = 0;
  std::uint32_t reserved = 0;
};
static_assert(sizeof(Header) == 32);

// Parents before children, left before right, siblings at an even number and the next.
std::vector<Node> renumbered(const std::vector<Node>& nodes) {
  if (nodes.empty()) return {};
  std::vector<Node> out(nodes.size() + 1, Node{});
  std::vector<std::pair<std::uint32_t, std::uint32_t>> open{{0U, 0U}};  // old and new number
  std::uint32_t next = 2;
  while (!open.empty()) {
    const auto [from, to] = open.back();
    open.pop_back();
    out[to] = nodes[from];
    if (nodes[from].count > 0) continue;
    out[to].first = next;
    open.emplace_back(nodes[from].first + 1, next + 1);
    open.emplace_back(nodes[from].first, next);
    next += 2;
  }
  return out;
}

}  // namespace

std::vector<std::byte> bvh2_bytes(const Bvh& bvh, std::span<const GnTriangle> triangles) {
  refuse_frame(bvh.frame, "the plain node layout");
  const std::vector<Node> nodes = renumbered(bvh.nodes);
  Header header;
  header.nodes = static_cast<std::uint32_t>(nodes.size());
  header.indices = static_cast<std::uint32_t>(bvh.primitives.size());
  header.triangles = static_cast<std::uint32_t>(triangles.size());
  header.repeats = bvh.primitives.size() > triangles.size() ? 1 : 0;
  return joined_bytes({std::as_bytes(std::span(&header, 1)), std::as_bytes(std::span(nodes)),
                       std::as_bytes(std::span(bvh.primitives)), std::as_bytes(triangles)});
}

void export_bvh2(const std::filesystem::path& file, const Bvh& bvh, std::span<const GnTriangle> triangles) {
  write_file(file, bvh2_bytes(bvh, triangles));
}

}  // namespace gnomon
