#include "gnomon/device/build_device.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <limits>

#include "gnomon/device/build_balanced.h"
#include "gnomon/device/build_best.h"
#include "gnomon/device/build_fast.h"
#include "gnomon/tree/build_reference.h"

namespace gnomon {

namespace {

// The box no ray meets.
Node empty_root() {
  Node node{};
  for (int k = 0; k < 3; ++k) {
    node.lo[k] = std::numeric_limits<float>::infinity();
    node.hi[k] = -std::numeric_limits<float>::infinity();
  }
  node.count = 1;
  return node;
}

void refuse_what_does_not_fit(const cl::DeviceInfo& device, const std::vector<BufferNeed>& needs) {
  std::uint64_t total = 0;
  for (const BufferNeed& need : needs) {
    if (const auto reason = cl::why_not_fit(device, need.name, need.bytes))
      throw Error(ErrorCode::kOutOfMemory, *reason);
    total += need.bytes;
  }
  if (total > device.global_memory) {
    throw Error(ErrorCode::kOutOfMemory, "the build's buffers need " + std::to_string(total) +
                                             " bytes together, but " + device.name + " has " +
                                             std::to_string(device.global_memory) +
                                             "; use a smaller scene or another device");
  }
}

// needs: build_memory's.
DeviceBvh build_checked(const cl::Context& context, cl_mem triangles, std::uint32_t count,
                        const BuildOptions& options, const std::vector<BufferNeed>& needs, BuildReport* out,
                        const Progress& progress) {
  if (out != nullptr) {
    for (const BufferNeed& need : needs) out->scratch_bytes += need.scratch ? need.bytes : 0;
  }
  switch (options.builder) {
    case Builder::kFast:
      return build_fast(context, triangles, count, options, out, progress);
    case Builder::kBest:
      return build_best(context, triangles, count, options, out, progress);
    case Builder::kBalanced:
      break;
  }
  return build_balanced(context, triangles, count, {}, options, out, progress);
}

// The caller's triangles as a buffer, for as long as a build may read them: an abandoned one has commands on
// their way.
class Input {
 public:
  Input(const cl::Context& context, std::span<const Triangle> triangles)
      : context_(context), buffer_(context.share("triangles", std::as_bytes(triangles))) {}
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;
  ~Input() {
    if (!is_read_) static_cast<void>(clFinish(context_.queue()));
  }
  // Blocks until nothing reads the memory any more. Throws Error{kDevice}.
  void wait() {
    context_.wait_for_enqueued();
    is_read_ = true;
  }
  [[nodiscard]] cl_mem memory() const { return buffer_.mem.get(); }

 private:
  const cl::Context& context_;
  cl::Buffer buffer_;
  bool is_read_ = false;
};

}  // namespace

DeviceBvh build_device(const cl::Context& context, std::span<const Triangle> triangles,
                       const BuildOptions& options, BuildReport* out, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<BufferNeed> needs = build_memory(context.device(), triangles.size(), options);
  if (triangles.empty()) return upload_bvh(context, {}, {});
  refuse_what_does_not_fit(context.device(), needs);
  Input input(context, triangles);
  const auto count = static_cast<std::uint32_t>(triangles.size());
  DeviceBvh tree = build_checked(context, input.memory(), count, options, needs, out, progress);
  input.wait();
  if (out != nullptr) {
    out->total_ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  return tree;
}

DeviceBvh build_device(const cl::Context& context, cl_mem triangles, std::uint32_t triangle_count,
                       const BuildOptions& options, BuildReport* out, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<BufferNeed> needs = build_memory(context.device(), triangle_count, options);
  if (triangle_count == 0) return upload_bvh(context, {}, {});
  std::size_t bytes = 0;
  cl::check(clGetMemObjectInfo(triangles, CL_MEM_SIZE, sizeof bytes, &bytes, nullptr), "clGetMemObjectInfo");
  if (bytes / sizeof(Triangle) < triangle_count) {
    throw Error(ErrorCode::kInvalidArgument, "the triangle buffer holds " + std::to_string(bytes) +
                                                 " bytes, " + std::to_string(triangle_count) +
                                                 " triangles need 36 each");
  }
  refuse_what_does_not_fit(context.device(), needs);
  DeviceBvh tree = build_checked(context, triangles, triangle_count, options, needs, out, progress);
  if (out != nullptr) {
    out->total_ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  return tree;
}

Bvh download_bvh(const cl::Context& context, const DeviceBvh& tree) {
  Bvh bvh;
  bvh.frame = tree.frame;
  if (tree.triangle_count == 0) return bvh;
  bvh.nodes = context.download_values<Node>(tree.nodes, tree.node_count);
  bvh.primitives = context.download_values<std::uint32_t>(tree.order, tree.triangle_count);
  return bvh;
}

DeviceBvh upload_bvh(const cl::Context& context, const Bvh& bvh, std::span<const Triangle> triangles) {
  DeviceBvh tree;
  tree.triangle_count = static_cast<std::uint32_t>(bvh.primitives.size());
  tree.node_count = static_cast<std::uint32_t>(std::max<std::size_t>(1, bvh.nodes.size()));
  tree.max_depth = stats_of(bvh, {}).max_depth;
  tree.frame = bvh.frame;
  std::vector<GnLeafTriangle> leaves;
  leaves.reserve(bvh.primitives.size());
  for (const std::uint32_t primitive : bvh.primitives) {
    GnLeafTriangle leaf{};
    std::memcpy(leaf.v0, triangles[primitive].v0, sizeof leaf.v0);
    std::memcpy(leaf.v1, triangles[primitive].v1, sizeof leaf.v1);
    std::memcpy(leaf.v2, triangles[primitive].v2, sizeof leaf.v2);
    leaf.primitive = primitive;
    leaves.push_back(leaf);
  }
  const std::vector<Node> nodes = bvh.nodes.empty() ? std::vector<Node>{empty_root()} : bvh.nodes;
  tree.nodes = context.create_buffer("nodes", nodes.size() * sizeof(Node));
  tree.order = context.create_buffer("order", bvh.primitives.size() * sizeof(std::uint32_t));
  tree.leaf_triangles = context.create_buffer("leaf_triangles", leaves.size() * sizeof(GnLeafTriangle));
  context.upload_values<Node>(tree.nodes, nodes);
  context.upload_values<std::uint32_t>(tree.order, bvh.primitives);
  context.upload_values<GnLeafTriangle>(tree.leaf_triangles, leaves);
  return tree;
}

}  // namespace gnomon
