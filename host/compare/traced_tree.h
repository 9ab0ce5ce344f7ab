// A tree of ours on the device with what traces it there: in packets on CPUs that let loops run, one ray a
// work-item elsewhere. Not for building it. Feeds our entrants.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gnomon/compare/method.h"

namespace gnomon::compare {

// Whether the device is traced in packets over wide trees.
[[nodiscard]] bool traces_wide(const cl::DeviceInfo& device);

class TracedTree {
 public:
  struct Options {
    Accuracy accuracy = Accuracy::kWatertight;
    bool portable = false;  // OpenCL C alone, without the device compiler's own instructions
  };

  // slot_keys, weights: for the wide tree (gnomon/tree/wide.h). Collapsing's stages go to `report`. The
  // context must outlive it. Throws Error as collapse_device and Tracer do.
  TracedTree(const cl::Context& context, DeviceBvh tree, const Options& options,
             std::span<const float> slot_keys = {}, BuildReport* report = nullptr,
             std::span<const float> weights = {});

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
