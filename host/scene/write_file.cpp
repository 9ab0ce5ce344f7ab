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

void write_into(const std::filesystem::path& path, const char* mode, const std::filesystem::path& file,
                std::span<const std::byte> bytes) {
  std::FILE* const stream = std::fopen(path.c_str(), mode);
  if (stream == nullptr) fail(file, errno);
  // fwrite may not be handed the null pointer that an empty span has.
  const bool taken = bytes.empty() || std::fwrite(bytes.data(), 1, bytes.size(), stream) == bytes.size();
  const bool written = taken && std::fflush(stream) == 0;
  const int reason = written ? 0 : errno;
  const bool closed = std::fclose(stream) == 0;
  if (!written || !closed) fail(file, written ? errno : reason);
}

// The file that a link leads to, there or not yet.
std::filesystem::path behind_links(std::filesystem::path file) {
  constexpr int kMostLinks = 40;  // as the system follows
  for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(file); ++i)
    file = file.parent_path() / std::filesystem::read_symlink(file);
  return file;
}

}  // namespace

void write_file(const std::filesystem::path& file, std::span<const std::byte> bytes) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  // A device or a pipe must stay what it is: a file with its name would take its place.
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
      !std::filesystem::is_directory(status))
    return write_into(file, "wb", file, bytes);
  const std::filesystem::path target = behind_links(file);
  Temporary temporary(target);
  write_into(temporary.path(), "wb", file, bytes);
  std::filesystem::rename(temporary.path(), target, error);
  if (error) fail(file, error.value());
  temporary.keep();
}

void append_to_file(const std::filesystem::path& file, std::span<const std::byte> bytes) {
  write_into(file, "ab", file, bytes);
}

}  // namespace gnomon
