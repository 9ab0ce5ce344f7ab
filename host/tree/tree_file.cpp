#include "gnomon/tree/tree_file.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <array>
#include <bit>
#include <cstdio>
#include <cstring>
#include <string>
#include <type_traits>

#include "gnomon/scene/read_file.h"
#include "gnomon/scene/scene.h"
#include "gnomon/scene/write_file.h"
#include "gnomon/tree/box_frame.h"
#include "gnomon/tree/bvh_check.h"
#include "gnomon/tree/joined_bytes.h"

namespace gnomon {

namespace {

static_assert(std::endian::native == std::endian::little,
              "tree files are little-endian, and copied as they are");

constexpr std::array<char, 8> kMagic{'g', 'n', 'o', 'm', 't', 'r', 'e', 'e'};
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kUnhashed = 32;  // what stands before and in the checksum is checked by value

// What a file begins with. Numbers stand as in memory, without gaps.
struct Header {
  std::array<char, 8> magic;
  std::uint32_t version;
  std::uint32_t header_bytes;
  std::uint64_t file_bytes;
  std::uint64_t checksum;
  std::uint64_t scene_hash;
  std::uint32_t triangles;
  std::uint32_t nodes;
  std::uint32_t order;
  std::uint32_t builder;
  std::uint32_t axes;
  std::uint32_t bins;
  std::uint32_t max_leaf_size;
  std::uint32_t median_depth;
  float cost_traversal;
  float cost_triangle;
  float quality_threshold;
  float acceptable;
  float excellent;
  std::uint32_t rays_from_point;
  std::uint32_t repaired;
  std::uint32_t max_metric_depth;
  std::uint32_t published_leaves;
  std::uint32_t min_split;
  std::uint32_t max_depth;
  float max_cost;
  float max_probability;
  float max_area;
  GnMeasure measure;
  std::uint32_t fitted;
  std::array<std::uint32_t, 7> reserved;
};
static_assert(sizeof(Header) == 256 && std::is_trivially_copyable_v<Header>);
static_assert(offsetof(Header, scene_hash) == kUnhashed && offsetof(Header, measure) == 128);

[[noreturn]] void refuse(const std::string& why) {
  throw Error(ErrorCode::kBadScene, "not a usable tree file: " + why);
}

std::uint64_t checksum_of(std::span<const std::byte> file) {
  const auto rest = file.subspan(kUnhashed);
  return XXH3_64bits(rest.data(), rest.size());
}

std::uint64_t size_of(std::uint64_t nodes, std::uint64_t order) {
  return sizeof(Header) + nodes * sizeof(Node) + order * sizeof(std::uint32_t);
}

std::string hex(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

Header header_of(const Bvh& bvh, const BuildOptions& options, std::span<const GnTriangle> triangles) {
  Header h{};
  h.magic = kMagic;
  h.version = kVersion;
  h.header_bytes = sizeof(Header);
  h.file_bytes = size_of(bvh.nodes.size(), bvh.primitives.size());
  h.scene_hash = triangles_hash(triangles);
  h.triangles = static_cast<std::uint32_t>(triangles.size());
  h.nodes = static_cast<std::uint32_t>(bvh.nodes.size());
  h.order = static_cast<std::uint32_t>(bvh.primitives.size());
  h.builder = static_cast<std::uint32_t>(options.builder);
  h.axes = static_cast<std::uint32_t>(options.axes);
  h.bins = options.bins;
  h.max_leaf_size = options.max_leaf_size;
  h.median_depth = options.median_depth;
  h.cost_traversal = options.cost_traversal;
  h.cost_triangle = options.cost_triangle;
  h.quality_threshold = options.policy.quality_threshold;
  h.acceptable = options.policy.acceptable;
  h.excellent = options.policy.excellent;
  h.rays_from_point = options.policy.rays_from_point ? 1 : 0;
  h.repaired = options.policy.repaired ? 1 : 0;
  h.max_metric_depth = options.policy.max_metric_depth;
  h.published_leaves = options.published_leaves.on ? 1 : 0;
  h.min_split = options.published_leaves.min_split;
  h.max_depth = options.published_leaves.max_depth;
  h.max_cost = options.published_leaves.max_cost;
  h.max_probability = options.published_leaves.max_probability;
  h.max_area = options.published_leaves.max_area;
  h.measure = options.measure;
  return h;
}

BuildOptions options_of(const Header& h) {
  BuildOptions options;
  options.builder = static_cast<Builder>(h.builder);
  options.axes = static_cast<AxisPolicy>(h.axes);
  options.bins = h.bins;
  options.max_leaf_size = h.max_leaf_size;
  options.median_depth = h.median_depth;
  options.cost_traversal = h.cost_traversal;
  options.cost_triangle = h.cost_triangle;
  options.policy = {h.quality_threshold,    h.acceptable,    h.excellent,
                    h.rays_from_point == 1, h.repaired == 1, h.max_metric_depth};
  options.published_leaves = {h.published_leaves == 1, h.min_split, h.max_depth, h.max_cost,
                              h.max_probability,       h.max_area};
  options.measure = h.measure;
  return options;
}

// What can be said before the triangles are looked at. Throws kBadScene.
Header checked_header(std::span<const std::byte> bytes) {
  if (bytes.size() < sizeof(Header))
    refuse("it has " + std::to_string(bytes.size()) + " bytes, its header alone needs " +
           std::to_string(sizeof(Header)));
  Header h;
  std::memcpy(&h, bytes.data(), sizeof h);
  if (h.magic != kMagic) refuse("it does not begin as gnomon's do");
  if (h.version != kVersion)
    refuse("it is of version " + std::to_string(h.version) + ", this gnomon reads version " +
           std::to_string(kVersion) + "; build the tree again");
  if (h.header_bytes != sizeof(Header)) refuse("its header has a wrong size");
  if (h.file_bytes != bytes.size() || h.file_bytes != size_of(h.nodes, h.order)) {
    refuse("it has " + std::to_string(bytes.size()) + " bytes and says " + std::to_string(h.file_bytes) +
           ", its parts need " + std::to_string(size_of(h.nodes, h.order)) + "; was it copied whole?");
  }
  if (h.checksum != checksum_of(bytes)) refuse("its checksum is wrong: it was damaged after it was written");
  for (const std::uint32_t flag : {h.rays_from_point, h.repaired, h.published_leaves, h.fitted})
    if (flag > 1) refuse("a flag of its options is neither 0 nor 1");
  for (const std::uint32_t word : h.reserved)
    if (word != 0) refuse("bytes that are to be 0 are not");
  try {
    options_of(h).check();
  } catch (const Error& error) {
    refuse(error.what());
  }
  return h;
}

}  // namespace

std::vector<std::byte> tree_to_bytes(const Bvh& bvh, const BuildOptions& options,
                                     std::span<const GnTriangle> triangles, bool fitted) {
  options.check();
  refuse_frame(bvh.frame, "a tree file");
  if (const auto fault = check_bvh(bvh, triangles, options))
    throw Error(ErrorCode::kInvalidArgument, "no file is made of a broken tree: " + fault->what);
  Header header = header_of(bvh, options, triangles);
  header.fitted = fitted ? 1 : 0;
  std::vector<std::byte> bytes =
      joined_bytes({std::as_bytes(std::span(&header, 1)), std::as_bytes(std::span(bvh.nodes)),
                    std::as_bytes(std::span(bvh.primitives))});
  const std::uint64_t checksum = checksum_of(bytes);
  std::memcpy(bytes.data() + offsetof(Header, checksum), &checksum, sizeof checksum);
  return bytes;
}

StoredTree tree_from_bytes(std::span<const std::byte> bytes, std::span<const GnTriangle> triangles) {
  const Header header = checked_header(bytes);
  if (header.triangles != triangles.size() || header.scene_hash != triangles_hash(triangles)) {
    throw Error(ErrorCode::kBadScene, "the tree is of another scene: it was built over " +
                                          std::to_string(header.triangles) + " triangles with hash " +
                                          hex(header.scene_hash) + ", these are " +
                                          std::to_string(triangles.size()) + " with hash " +
                                          hex(triangles_hash(triangles)) + "; build one for this scene");
  }
  StoredTree tree;
  tree.options = options_of(header);
  tree.fitted = header.fitted == 1;
  tree.bvh.nodes.resize(header.nodes);
  tree.bvh.primitives.resize(header.order);
  const std::byte* const nodes = bytes.data() + sizeof(Header);
  const std::size_t node_bytes = tree.bvh.nodes.size() * sizeof(Node);
  if (header.nodes > 0) std::memcpy(tree.bvh.nodes.data(), nodes, node_bytes);
  if (header.order > 0)
    std::memcpy(tree.bvh.primitives.data(), nodes + node_bytes, header.order * sizeof(std::uint32_t));
  if (const auto fault = check_bvh(tree.bvh, triangles, tree.options)) refuse(fault->what);
  return tree;
}

void save_tree(const std::filesystem::path& file, const Bvh& bvh, const BuildOptions& options,
               std::span<const GnTriangle> triangles, bool fitted) {
  write_file(file, tree_to_bytes(bvh, options, triangles, fitted));
}

StoredTree load_tree(const std::filesystem::path& file, std::span<const GnTriangle> triangles) {
  const std::vector<unsigned char> bytes = read_file(file);
  try {
    return tree_from_bytes(std::as_bytes(std::span(bytes)), triangles);
  } catch (const Error& error) {
    throw Error(error.code(), file.string() + ": " + error.what());
  }
}

}  // namespace gnomon
