// A device made ready: context, queue, buffers, and where time goes. Not for kernels (program.h, launch.h).
// Feeds host/device. Users may bring their own context and queue: they are retained, never destroyed, and
// blocking calls wait for their own events only; but who lends memory (share) waits for all that was
// enqueued.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gnomon/cl/device.h"
#include "gnomon/cl/handle.h"

namespace gnomon::cl {

// A buffer with its name, so that errors can say which one did not fit.
struct Buffer {
  Handle<cl_mem> mem;
  std::string name;
  std::size_t bytes = 0;
};

struct ContextOptions {
  bool profiling = true;  // event times per stage; adopted queues keep what they have
  bool use_cache = true;  // keep compiled programs on disk, in a folder of gnomon's own
  // Large buffers of CPU devices leave their memory for later ones, up to so many bytes. 0: none. Default:
  // 512 MiB, but no more than an eighth of the device's memory.
  std::optional<std::size_t> spare_bytes;
  // Which. Default: $XDG_CACHE_HOME/gnomon, else ~/.cache/gnomon; none on devices whose driver keeps programs
  // itself (DeviceInfo::keeps_programs).
  std::optional<std::filesystem::path> cache_folder;
};

class LargePages;
class ProgramStore;

class Context {
 public:
  // A context and an in-order queue of our own. Throws Error{kDevice}.
  explicit Context(const DeviceInfo& device, const ContextOptions& options = {});
  // The caller's. The queue must be in-order and belong to context and device.
  Context(cl_context context, cl_device_id device, cl_command_queue queue,
          const ContextOptions& options = {});
  Context(Context&&) noexcept;
  Context& operator=(Context&&) noexcept;
  ~Context();

  [[nodiscard]] const DeviceInfo& device() const { return device_; }
  [[nodiscard]] cl_context context() const { return context_.get(); }
  [[nodiscard]] cl_command_queue queue() const { return queue_.get(); }
  [[nodiscard]] bool profiles() const { return profiles_; }
  [[nodiscard]] ProgramStore& programs() const { return *programs_; }

  // A read-write buffer of at least `bytes` (one byte when 0). Throws Error{kOutOfMemory} naming buffer and
  // size, before asking the driver where the device's limits already rule it out.
  [[nodiscard]] Buffer create_buffer(const std::string& name, std::size_t bytes) const;

  // A buffer of these bytes that kernels only read: where the device is the CPU the caller's own memory,
  // which must stay as it is until nothing enqueued reads it (wait_for_enqueued), elsewhere a copy. Aligned
  // as the numbers in it are: kernels must not read it as vectors. Throws as create_buffer, also for no
  // bytes.
  [[nodiscard]] Buffer share(const std::string& name, std::span<const std::byte> bytes) const;
  // Blocks until all that was enqueued before is complete.
  void wait_for_enqueued() const;

  // Blocking copies by mapping (no copy at all behind it on unified memory). Bytes beyond the buffer are
  // refused.
  void upload(const Buffer& buffer, std::span<const std::byte> bytes, std::size_t offset = 0) const;
  void download(const Buffer& buffer, std::span<std::byte> bytes, std::size_t offset = 0) const;
  // Fills the whole buffer with a repeated word; not blocking.
  void fill(const Buffer& buffer, std::uint32_t word) const;

  template <typename T>
  void upload_values(const Buffer& buffer, std::span<const T> values, std::size_t first = 0) const {
    upload(buffer, std::as_bytes(values), first * sizeof(T));
  }
  template <typename T>
  [[nodiscard]] std::vector<T> download_values(const Buffer& buffer, std::size_t count,
                                               std::size_t first = 0) const {
    std::vector<T> values(count);
    download(buffer, std::as_writable_bytes(std::span<T>(values)), first * sizeof(T));
    return values;
  }

 private:
  void finish_setup(const ContextOptions& options);

  DeviceInfo device_;
  Handle<cl_context> context_;
  Handle<cl_command_queue> queue_;
  bool profiles_ = false;
  std::unique_ptr<ProgramStore> programs_;
  std::unique_ptr<LargePages> large_pages_;
};

// Whether buffers of these sizes can exist on the device together; if not, a sentence naming the first
// culprit.
[[nodiscard]] std::optional<std::string> why_not_fit(const DeviceInfo& device, const std::string& name,
                                                     std::uint64_t bytes);

}  // namespace gnomon::cl
