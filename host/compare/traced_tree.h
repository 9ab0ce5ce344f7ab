// A tree of ours on the device with what traces it there: in packets on CPUs that let loops run, one ray a
// work-item elsewhere. Not for building it. Feeds our entrants.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gnomon/compare/method.h"
#include "gnomon/plan/ray_sample.h"

namespace gnomon::compare {

// Whether the device is traced in packets over wide trees.
[[nodiscard]] bool traces_wide(const cl::DeviceInfo& device);

class TracedTree {
 public:
  struct Options {
    Accuracy accuracy = Accuracy::kWatertight;
    bool portable = false;  // OpenCL C alone, without the device compiler's own instructions
  };

  // Collapsing's stages go to `report`. The context must outlive it. Throws Error as collapse_device and
  // Tracer do.
  TracedTree(const cl::Context& context, DeviceBvh tree, const Options& options,
             BuildReport* report = nullptr);
  // A plan's, with what wide trees take of it.
  TracedTree(const cl::Context& context, const OrderedTree& tree, std::span<const Triangle> triangles);

  void trace(const Batch& batch) const;
  [[nodiscard]] Answers answers(const Batch& batch) const;
  [[nodiscard]] std::vector<Hit> closest(std::span<const Ray> rays) const;
  // Of each ray by itself.
  [[nodiscard]] Work work(const Batch& batch);
  [[nodiscard]] std::vector<float> boxes(std::span<const Ray> rays);

  [[nodiscard]] std::uint64_t bytes() const { return wide_flavour_ ? wide_.bytes() : tree_.bytes(); }
  [[nodiscard]] std::string flavour() const;
  // Null when forgotten.
  [[nodiscard]] const DeviceBvh* tree() const { return tree_.node_count > 0 ? &tree_ : nullptr; }
  // Where tracing does not need it.
  void forget_tree();

 private:
  void set_up(const Options& options);
  [[nodiscard]] std::unique_ptr<Tracer> make_tracer(const TraceOptions& options) const;
  [[nodiscard]] const Tracer& counter();

  const cl::Context& context_;
  bool wide_flavour_;
  DeviceBvh tree_;
  DeviceWideBvh wide_;
  std::unique_ptr<Tracer> tracer_;
  std::unique_ptr<Tracer> counter_;
};

}  // namespace gnomon::compare
