// Host memory in large pages, for buffers that a CPU device shares with us: touching fresh memory a small
// page at a time costs a build more than its arithmetic. Not for small buffers. Feeds context.cpp.
#pragma once

#include <cstddef>

#include "gnomon/cl/handle.h"

namespace gnomon::cl {

// Whether a buffer of this size gains: it fills at least one large page.
[[nodiscard]] bool fills_large_pages(std::size_t bytes);

// A buffer over memory of its own, given back to the system when the last reference to the buffer goes. Empty
// when system or driver refuse: the caller then lets the driver allocate.
[[nodiscard]] Handle<cl_mem> create_in_large_pages(cl_context context, std::size_t bytes);

}  // namespace gnomon::cl
