// A file is replaced whole or not at all; a link, a pipe and a device stay what they are.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "gnomon/base/error.h"
#include "gnomon/scene/write_file.h"

namespace fs = std::filesystem;

namespace {

class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("gnomon_write_" + std::to_string(::getpid()))) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { fs::remove_all(path_); }
  [[nodiscard]] fs::path operator/(const char* name) const { return path_ / name; }
  [[nodiscard]] std::ptrdiff_t files() const {
    return std::distance(fs::directory_iterator(path_), fs::directory_iterator());
  }

 private:
  fs::path path_;
};

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("a file is made, replaced and added to, and nothing is left beside it") {
  const Folder folder;
  gnomon::write_file(folder / "a", bytes_of("a long first text"));
  gnomon::write_file(folder / "a", bytes_of("short"));
  CHECK(text_of(folder / "a") == "short");
  gnomon::append_to_file(folder / "a", bytes_of(" and more"));
  gnomon::append_to_file(folder / "b", {});
  CHECK(text_of(folder / "a") == "short and more");
  CHECK(fs::exists(folder / "b"));
  CHECK(folder.files() == 2);
}

TEST_CASE("the file behind a link is replaced, and the link stays") {
  const Folder folder;
  gnomon::write_file(folder / "file", bytes_of("old"));
  fs::create_symlink("file", folder / "link");
  gnomon::write_file(folder / "link", bytes_of("new"));
  CHECK(fs::is_symlink(folder / "link"));
  CHECK(text_of(folder / "file") == "new");
  fs::create_symlink("not yet", folder / "early");
  gnomon::write_file(folder / "early", bytes_of("now"));
  CHECK(fs::is_symlink(folder / "early"));
  CHECK(text_of(folder / "not yet") == "now");
  CHECK(folder.files() == 4);
}

// As a device stays one: a program of root's that renames a file to /dev/null takes it from everybody.
TEST_CASE("a pipe is written into and stays a pipe") {
  const Folder folder;
  const fs::path pipe = folder / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  const int end = ::open(pipe.c_str(), O_RDWR | O_NONBLOCK);
  REQUIRE(end >= 0);
  gnomon::write_file(pipe, bytes_of("through"));
  CHECK(fs::is_fifo(pipe));
  std::array<char, 16> read{};
  CHECK(::read(end, read.data(), read.size()) == 7);
  CHECK(std::string(read.data()) == "through");
  ::close(end);
  CHECK(folder.files() == 1);
}

TEST_CASE("what cannot be written says why, and what was there is untouched") {
  const Folder folder;
  const auto reason = [](const auto& write) {
    try {
      write();
    } catch (const gnomon::Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  using Catch::Matchers::Contains;
  CHECK_THAT(reason([&] { gnomon::write_file(folder / "nowhere/a", {}); }), Contains("No such file"));
  CHECK_THAT(reason([&] { gnomon::append_to_file(folder / "nowhere/a", {}); }), Contains("No such file"));
  fs::create_directory(folder / "taken");
  CHECK_THAT(reason([&] { gnomon::write_file(folder / "taken", bytes_of("x")); }), Contains("directory"));
  CHECK(fs::is_directory(folder / "taken"));
  CHECK(folder.files() == 1);
  // Only to add to: a writer that is at fault would replace it.
  if (fs::is_character_file("/dev/full"))
    CHECK_THAT(reason([&] { gnomon::append_to_file("/dev/full", bytes_of("x")); }),
               Contains("No space left"));
}
