#include "gnomon/cl/large_pages.h"

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <utility>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace gnomon::cl {
namespace {

constexpr std::size_t kLargePage = std::size_t{2} << 20U;

struct Free {
  void operator()(void* memory) const { std::free(memory); }
};

struct Block {
  std::unique_ptr<void, Free> memory;
  std::size_t bytes = 0;
};

Block fresh_block(std::size_t bytes) {
  void* memory = std::aligned_alloc(kLargePage, bytes);
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  // Advice only: where the system has no large pages to give, small ones do.
  if (memory != nullptr) static_cast<void>(madvise(memory, bytes, MADV_HUGEPAGE));
#endif
  return {std::unique_ptr<void, Free>(memory), bytes};
}

}  // namespace

// Shared by the buffers that will give their memory back, from whichever thread releases them.
struct LargePages::Store {
  explicit Store(std::size_t most) : limit(most) {}

  // The smallest that does and wastes no more than a quarter.
  Block take(std::size_t bytes) {
    const std::lock_guard<std::mutex> lock(mutex);
    auto best = blocks.end();
    for (auto block = blocks.begin(); block != blocks.end(); ++block) {
      if (block->bytes < bytes || block->bytes > bytes + bytes / 4) continue;
      if (best == blocks.end() || block->bytes < best->bytes) best = block;
    }
    if (best == blocks.end()) return {};
    Block out = std::move(*best);
    blocks.erase(best);
    kept -= out.bytes;
    return out;
  }

  // The oldest make room for it.
  void give(Block block) {
    const std::lock_guard<std::mutex> lock(mutex);
    if (block.bytes > limit) return;
    while (kept + block.bytes > limit) {
      kept -= blocks.front().bytes;
      blocks.erase(blocks.begin());
    }
    kept += block.bytes;
    blocks.push_back(std::move(block));
  }

  std::mutex mutex;
  std::size_t limit;
  std::size_t kept = 0;
  std::vector<Block> blocks;  // the oldest first
};

namespace {

// What a buffer's end needs to know.
struct Loan {
  std::shared_ptr<LargePages::Store> store;
  Block block;
};

void CL_CALLBACK give_back(cl_mem /*buffer*/, void* loan) {
  const std::unique_ptr<Loan> ended(static_cast<Loan*>(loan));
  ended->store->give(std::move(ended->block));
}

}  // namespace

bool fills_large_pages(std::size_t bytes) {
  return bytes >= kLargePage;
}

LargePages::LargePages(std::size_t spare_bytes) : store_(std::make_shared<Store>(spare_bytes)) {}

std::size_t LargePages::spare_bytes() const {
  const std::lock_guard<std::mutex> lock(store_->mutex);
  return store_->kept;
}

Handle<cl_mem> LargePages::create(cl_context context, std::size_t bytes) const {
  const std::size_t whole = (bytes + kLargePage - 1) / kLargePage * kLargePage;
  auto loan = std::make_unique<Loan>(Loan{store_, store_->take(whole)});
  if (loan->block.memory == nullptr) loan->block = fresh_block(whole);
  if (loan->block.memory == nullptr) return {};
  cl_int status = CL_SUCCESS;
  Handle<cl_mem> buffer(clCreateBuffer(context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes,
                                       loan->block.memory.get(), &status));
  if (status != CL_SUCCESS) return {};
  if (clSetMemObjectDestructorCallback(buffer.get(), give_back, loan.get()) != CL_SUCCESS) {
    buffer = {};
    return {};
  }
  static_cast<void>(loan.release());  // the buffer's now
  return buffer;
}

}  // namespace gnomon::cl
