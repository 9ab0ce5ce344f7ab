// What tree files keep and refuse, one rule at a time. Damage by chance: tree_file_fuzz_test.cpp.
#include "gnomon/tree/tree_file.h"

#include <unistd.h>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "gnomon/scene/scene.h"
#include "tree_file_tools.h"

using Catch::Contains;
using namespace gnomon;
using namespace gnomon::test;

namespace {

const KeptShape& soup_shape() {
  static const std::vector<KeptShape> shapes = kept_shapes();
  return shapes[3];
}

std::string refusal_of(const FileBytes& bytes, const std::vector<GnTriangle>& triangles) {
  try {
    static_cast<void>(tree_from_bytes(bytes, triangles));
  } catch (const Error& error) {
    CHECK(error.code() == ErrorCode::kBadScene);
    return error.what();
  }
  return "nothing";
}

std::string refusal_of(const FileBytes& bytes) {
  return refusal_of(bytes, soup_shape().triangles);
}

}  // namespace

TEST_CASE("a tree comes back from its file with its options, bit for bit") {
  for (const KeptShape& shape : kept_shapes()) {
    CAPTURE(shape.name);
    const Bvh bvh = build_reference(shape.triangles, shape.options);
    const FileBytes bytes = tree_to_bytes(bvh, shape.options, shape.triangles);
    const StoredTree stored = tree_from_bytes(bytes, shape.triangles);
    CHECK(tree_hash(stored.bvh) == tree_hash(bvh));
    CHECK(stored.bvh.primitives == bvh.primitives);
    CHECK(tree_to_bytes(stored.bvh, stored.options, shape.triangles) == bytes);
    CHECK(tree_hash(build_reference(shape.triangles, stored.options)) == tree_hash(bvh));
  }
}

TEST_CASE("every option that decides a tree is kept") {
  BuildOptions options;
  options.axes = AxisPolicy::kSpfh;
  options.measure.kind = GN_MEASURE_SOLID_ANGLE;
  options.measure.origin[1] = 3.0F;
  options.measure.forward[2] = 1.0F;
  options.measure.half_pitch = 0.25F;
  options.measure.area_share = 0.5F;
  options.policy = {0.3F, 1.2F, 0.8F, true, false, 77};
  options.published_leaves = {true, 5, 66, 4.0F, 0.5F, 0.25F};
  options.bins = 9;
  options.max_leaf_size = 200;
  options.cost_traversal = 1.5F;
  options.cost_triangle = 0.25F;
  options.median_depth = 20;
  const auto triangles = soup(40, 9);
  const Bvh bvh = build_reference(triangles, options);
  const BuildOptions kept = tree_from_bytes(tree_to_bytes(bvh, options, triangles), triangles).options;
  CHECK(kept.axes == options.axes);
  CHECK(std::memcmp(&kept.measure, &options.measure, sizeof kept.measure) == 0);
  CHECK(kept.policy.quality_threshold == 0.3F);
  CHECK(kept.policy.acceptable == 1.2F);
  CHECK(kept.policy.excellent == 0.8F);
  CHECK(kept.policy.rays_from_point);
  CHECK_FALSE(kept.policy.repaired);
  CHECK(kept.policy.max_metric_depth == 77);
  CHECK(kept.published_leaves.on);
  CHECK(kept.published_leaves.min_split == 5);
  CHECK(kept.published_leaves.max_depth == 66);
  CHECK(kept.published_leaves.max_cost == 4.0F);
  CHECK(kept.published_leaves.max_probability == 0.5F);
  CHECK(kept.published_leaves.max_area == 0.25F);
  CHECK(kept.bins == 9);
  CHECK(kept.max_leaf_size == 200);
  CHECK(kept.cost_traversal == 1.5F);
  CHECK(kept.cost_triangle == 0.25F);
  CHECK(kept.median_depth == 20);
}

TEST_CASE("numbers stand where the note says") {
  const KeptShape& shape = soup_shape();
  const Bvh bvh = build_reference(shape.triangles, shape.options);
  const FileBytes bytes = file_of(shape);
  CHECK(std::memcmp(bytes.data(), "gnomtree", 8) == 0);
  CHECK(value_at<std::uint32_t>(bytes, 8) == 1);
  CHECK(value_at<std::uint32_t>(bytes, 12) == kHeaderBytes);
  CHECK(value_at<std::uint64_t>(bytes, kFileBytesAt) == bytes.size());
  CHECK(value_at<std::uint64_t>(bytes, 32) == triangles_hash(shape.triangles));
  CHECK(value_at<std::uint32_t>(bytes, kTrianglesAt) == 90);
  CHECK(value_at<std::uint32_t>(bytes, kNodesAt) == bvh.nodes.size());
  CHECK(value_at<std::uint32_t>(bytes, kOrderAt) == bvh.primitives.size());
  CHECK(value_at<std::uint32_t>(bytes, 60) == 16);
  CHECK(value_at<std::uint32_t>(bytes, 64) == shape.options.max_leaf_size);
  CHECK(value_at<std::uint32_t>(bytes, 68) == 64);
  CHECK(value_at<float>(bytes, 76) == 1.0F);
  CHECK(value_at<float>(bytes, 88) == 0.9F);
  CHECK(value_at<std::uint32_t>(bytes, 112) == 100);
  CHECK(value_at<float>(bytes, 128) == 1.0F);
  REQUIRE(bytes.size() == kHeaderBytes + 32 * bvh.nodes.size() + 4 * bvh.primitives.size());
  CHECK(std::memcmp(bytes.data() + kHeaderBytes, bvh.nodes.data(), 32 * bvh.nodes.size()) == 0);
  CHECK(std::memcmp(bytes.data() + kHeaderBytes + 32 * bvh.nodes.size(), bvh.primitives.data(),
                    4 * bvh.primitives.size()) == 0);
  FileBytes settled = bytes;
  settle(settled);
  CHECK(settled == bytes);
}

TEST_CASE("a file that is cut off, longer, of another kind or version is refused by name") {
  const FileBytes whole = file_of(soup_shape());
  CHECK_THAT(refusal_of({}), Contains("has 0 bytes"));
  CHECK_THAT(refusal_of(FileBytes(whole.begin(), whole.begin() + 255)), Contains("header alone needs 256"));
  CHECK_THAT(refusal_of(FileBytes(whole.begin(), whole.end() - 1)), Contains("copied whole"));
  FileBytes longer = whole;
  longer.push_back(std::byte{0});
  CHECK_THAT(refusal_of(longer), Contains("copied whole"));
  settle(longer);
  CHECK_THAT(refusal_of(longer), Contains("its parts need"));
  FileBytes other = whole;
  other[0] = std::byte{'G'};
  CHECK_THAT(refusal_of(other), Contains("does not begin as gnomon's do"));
  FileBytes next = whole;
  set_at<std::uint32_t>(next, 8, 2);
  CHECK_THAT(refusal_of(next), Contains("version 2") && Contains("build the tree again"));
  FileBytes header = whole;
  set_at<std::uint32_t>(header, 12, 128);
  CHECK_THAT(refusal_of(header), Contains("header has a wrong size"));
}

TEST_CASE("each damaged bit behind the first 32 bytes is noticed by the checksum") {
  const FileBytes whole = file_of(soup_shape());
  for (std::size_t at = kChecksumAt; at < whole.size(); ++at) {
    // Counts decide the size, which is compared first.
    if (at >= kNodesAt && at < kOrderAt + 4) continue;
    CAPTURE(at);
    FileBytes damaged = whole;
    damaged[at] ^= std::byte{1};
    REQUIRE_THAT(refusal_of(damaged), Contains("checksum"));
  }
}

TEST_CASE("a tree of another scene is refused with both hashes") {
  const FileBytes bytes = file_of(soup_shape());
  auto moved = soup_shape().triangles;
  moved[17].v1[2] += 0.5F;
  CHECK_THAT(refusal_of(bytes, moved), Contains("another scene") && Contains("build one for this scene"));
  auto fewer = soup_shape().triangles;
  fewer.pop_back();
  CHECK_THAT(refusal_of(bytes, fewer), Contains("over 90 triangles") && Contains("these are 89"));
}

TEST_CASE("a file says whether a plan fitted its tree") {
  const KeptShape shape = soup_shape();
  const Bvh bvh = build_reference(shape.triangles, shape.options);
  for (const bool fitted : {false, true}) {
    const FileBytes bytes = tree_to_bytes(bvh, shape.options, shape.triangles, fitted);
    CHECK(tree_from_bytes(bytes, shape.triangles).fitted == fitted);
  }
}

TEST_CASE("wrong options, flags, reserved bytes and broken trees are refused though the checksum fits") {
  const FileBytes whole = file_of(soup_shape());
  const auto with = [&](std::size_t at, std::uint32_t value) {
    FileBytes bytes = whole;
    set_at(bytes, at, value);
    settle(bytes);
    return refusal_of(bytes);
  };
  CHECK_THAT(with(52, 3), Contains("builder"));
  CHECK_THAT(with(56, 3), Contains("axes"));
  CHECK_THAT(with(60, 65), Contains("bins"));
  CHECK_THAT(with(64, 1), Contains("leaf size"));
  CHECK_THAT(with(72, 0x7fc00000U), Contains("cost_traversal"));
  CHECK_THAT(with(92, 2), Contains("flag"));
  CHECK_THAT(with(96, 2), Contains("flag"));
  CHECK_THAT(with(104, 2), Contains("flag"));
  CHECK_THAT(with(224, 2), Contains("flag"));
  CHECK_THAT(with(228, 1), Contains("are to be 0"));
  CHECK_THAT(with(252, 1), Contains("are to be 0"));
  CHECK_THAT(with(kHeaderBytes + 12, 0xffffffffU), Contains("links"));
  CHECK_THAT(with(kHeaderBytes + 12, 0), Contains("links"));
  CHECK_THAT(with(whole.size() - 4, 90), Contains("out of range"));
}

TEST_CASE("a triangle in more leaves than it can have parts is refused before work is spent on it") {
  BuildOptions options;
  options.builder = Builder::kBest;
  const auto triangles = soup(200, 8);
  Bvh bvh = build_reference(triangles, options);
  bvh.primitives.resize(200);
  std::iota(bvh.primitives.begin(), bvh.primitives.end(), 0U);
  bvh.primitives.insert(bvh.primitives.end(), 32, 7U);
  CHECK_THROWS_WITH(tree_to_bytes(bvh, options, triangles),
                    Contains("triangle 7 appears more than 32 times"));
  bvh.primitives.pop_back();  // now it is the leaves' ranges that do not fit
  CHECK_THROWS_WITH(tree_to_bytes(bvh, options, triangles), Contains("leaf ranges"));
}

TEST_CASE("no file is made of a broken tree") {
  const KeptShape& shape = soup_shape();
  Bvh bvh = build_reference(shape.triangles, shape.options);
  std::swap(bvh.nodes[1], bvh.nodes[2]);
  CHECK_THROWS_WITH(tree_to_bytes(bvh, shape.options, shape.triangles), Contains("broken tree"));
}

TEST_CASE("saving and loading go through a file, and name it in what they complain about") {
  const KeptShape& shape = soup_shape();
  const Bvh bvh = build_reference(shape.triangles, shape.options);
  const auto file =
      std::filesystem::temp_directory_path() / ("gnomon-tree-" + std::to_string(::getpid()) + ".gnb");
  save_tree(file, bvh, shape.options, shape.triangles);
  CHECK(tree_hash(load_tree(file, shape.triangles).bvh) == tree_hash(bvh));
  std::ofstream(file, std::ios::binary) << "short";
  CHECK_THROWS_WITH(load_tree(file, shape.triangles), Contains(file.string()) && Contains("5 bytes"));
  std::filesystem::remove(file);
  CHECK_THROWS_WITH(load_tree(file, shape.triangles), Contains("no such file"));
}
