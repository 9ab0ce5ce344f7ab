// Host memory in large pages, for buffers that a CPU device shares with us: touching fresh memory a small
// page at a time costs a build more than its arithmetic, and even large pages must be cleared by the system.
// So what buffers give back is kept for the next ones, up to a limit. Not for small buffers. Feeds
// context.cpp.
#pragma once

#include <cstddef>
#include <memory>

#include "gnomon/cl/handle.h"

namespace gnomon::cl {

// Whether a buffer of this size gains: it fills at least one large page.
[[nodiscard]] bool fills_large_pages(std::size_t bytes);

class LargePages {
 public:
  // spare_bytes: how much memory without a buffer is kept at most.
  explicit LargePages(std::size_t spare_bytes);

  // A buffer over memory of its own, which comes back when the last reference to the buffer goes, be that
  // after this object is gone. Its content is anything. Empty when system or driver refuse: the caller then
  // lets the driver allocate.
  [[nodiscard]] Handle<cl_mem> create(cl_context context, std::size_t bytes) const;

  [[nodiscard]] std::size_t spare_bytes() const;  // kept at the moment

  struct Store;

 private:
  std::shared_ptr<Store> store_;
};

}  // namespace gnomon::cl
