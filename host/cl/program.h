// Programs from embedded kernel sources: flattened, compiled with options that are also the cache key, kept
// in memory and on disk. Not for launching (launch.h). Feeds host/device.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "gnomon/cl/context.h"

namespace gnomon::cl {

// One embedded file of kernels/, by its path there ("trace.cl", "shared/layout.h"). Generated at build time.
struct EmbeddedFile {
  std::string_view path;
  std::string_view text;
};
[[nodiscard]] std::span<const EmbeddedFile> embedded_kernels();

// The file with its #include "..." lines replaced by the files' texts, each once, with #line directives so
// that build logs name the right file. The environment variable GNOMON_KERNELS may name a folder to read from
// instead of the embedded copies (development). Throws Error{kIo} for a file that is not there.
[[nodiscard]] std::string flatten_kernel(std::string_view path);

// What the store did, for tests and curious users.
struct ProgramStoreStats {
  std::uint32_t compiled = 0;   // from source
  std::uint32_t from_disk = 0;  // from the binary cache
  std::uint32_t rejected = 0;   // cache entries that were damaged or foreign
};

class ProgramStore {
 public:
  ProgramStore(cl_context context, const DeviceInfo& device, const ContextOptions& options);

  // The program of these files (flattened together) and options, compiled on first use. Options should be
  // plain
  // "-DNAME=VALUE" words; -cl-std=CL1.2 is added. Throws Error{kDevice} with the build log.
  [[nodiscard]] cl_program get(const std::vector<std::string>& files, const std::string& options);
  // One kernel of it.
  [[nodiscard]] Handle<cl_kernel> kernel(const std::vector<std::string>& files, const std::string& options,
                                         const char* name);
  [[nodiscard]] const ProgramStoreStats& stats() const { return stats_; }

 private:
  [[nodiscard]] cl_program put_together(const std::vector<std::string>& files, const std::string& options);
  [[nodiscard]] Handle<cl_program> load_binary(const std::filesystem::path& entry,
                                               const std::string& options);
  [[nodiscard]] Handle<cl_program> compile(const std::string& source, const std::string& options);
  void save_binary(const std::filesystem::path& entry, cl_program program) const;
  [[nodiscard]] std::string build_log(cl_program program) const;

  cl_context context_;
  DeviceInfo device_;
  std::filesystem::path cache_folder_;                  // empty: no cache on disk
  std::map<std::string, Handle<cl_program>> programs_;  // by what they are made of
  std::map<std::string, cl_program> asked_for_;         // by embedded files' names and options
  ProgramStoreStats stats_;
};

// $XDG_CACHE_HOME/gnomon, else $HOME/.cache/gnomon, else empty.
[[nodiscard]] std::filesystem::path default_cache_folder();

}  // namespace gnomon::cl
