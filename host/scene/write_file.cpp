#include "gnomon/scene/write_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>

#include "gnomon/base/error.h"

namespace gnomon {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, int reason) {
  throw Error(ErrorCode::kIo,
              "cannot write " + file.string() + ": " + std::generic_category().message(reason));
}

// Deletes the temporary on every way out but the good one.
class Temporary {
 public:
  // The process id keeps two programs that write the same file apart.
  explicit Temporary(const std::filesystem::path& file)
      : path_(file.string() + "." + std::to_string(::getpid()) + ".partial") {}
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove(path_, ignored);
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  void keep() { path_.clear(); }

 private:
  std::filesystem::path path_;
};

}  // namespace

void write_file(const std::filesystem::path& file, std::span<const std::byte> bytes) {
  Temporary temporary(file);
  std::FILE* const stream = std::fopen(temporary.path().c_str(), "wb");
  if (stream == nullptr) fail(file, errno);
  // fwrite may not be handed the null pointer that an empty span has.
  const bool taken = bytes.empty() || std::fwrite(bytes.data(), 1, bytes.size(), stream) == bytes.size();
  const bool written = taken && std::fflush(stream) == 0;
  const int reason = written ? 0 : errno;
  const bool closed = std::fclose(stream) == 0;
  if (!written || !closed) fail(file, written ? errno : reason);
  std::error_code error;
  std::filesystem::rename(temporary.path(), file, error);
  if (error) fail(file, error.value());
  temporary.keep();
}

}  // namespace gnomon
