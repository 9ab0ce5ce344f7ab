// The top level on a device: areas and the structure that looks them up, and that lookup by itself for
// batches of rays. Not for tracing (trace_areas.h). Feeds the tracer of areas, benches and tests.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gnomon/cl/context.h"
#include "gnomon/tree/top_level.h"

namespace gnomon {

using Ray = GnRay;

// A TopLevel and its areas in device memory. Every buffer has at least one byte.
struct DeviceTopLevel {
  cl::Buffer areas;  // GnArea
  cl::Buffer boxes;
  cl::Buffer cells;
  cl::Buffer cell_areas;
  std::uint32_t box_count = 0;
  std::uint32_t area_count = 0;
  AreaLookup lookup = AreaLookup::kList;
  [[nodiscard]] std::uint64_t bytes() const;
  // What kernels that look areas up are compiled with.
  [[nodiscard]] std::string program_options() const;
};

// Throws Error: kInvalidArgument (the structure is of another number of areas), kDevice (more areas than a
// device that ends long loops can look up: DeviceInfo::loop_limit / 512), kOutOfMemory.
[[nodiscard]] DeviceTopLevel upload_top_level(const cl::Context& context, const TopLevel& top_level,
                                              std::span<const GnArea> areas);

// Looks up the areas of rays' starts. Context and top level must outlive it.
class AreaFinder {
 public:
  AreaFinder(const cl::Context& context, const DeviceTopLevel& top_level);

  // The area each ray asks when it is traced, or GN_NONE. Blocking, one launch.
  struct Chosen {
    std::vector<std::uint32_t> areas;
    double kernel_ms = 0.0;
  };
  [[nodiscard]] Chosen choose(std::span<const Ray> rays) const;

  // How many areas the structure offers for each ray's start, and how many of them have it for certain.
  struct Counted {
    std::vector<std::uint32_t> offered;
    std::vector<std::uint32_t> holding;
    double kernel_ms = 0.0;
  };
  [[nodiscard]] Counted count(std::span<const Ray> rays) const;

 private:
  [[nodiscard]] double run(const cl::Handle<cl_kernel>& kernel, std::size_t rays) const;

  const cl::Context& context_;
  const DeviceTopLevel& top_level_;
  cl::Handle<cl_kernel> choose_;
  cl::Handle<cl_kernel> count_;
};

}  // namespace gnomon
