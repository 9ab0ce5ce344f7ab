// Compiled programs: kept on disk, rebuilt when damaged, foreign or unwanted; build failures show the log.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>

#include "gnomon/cl/program.h"
#include "support/device.h"

namespace cl = gnomon::cl;
namespace fs = std::filesystem;

namespace {

// A folder of its own for one test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "gnomon-test-XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path_ = name;
  }
  ~TemporaryFolder() { fs::remove_all(path_); }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// Every context compiles loop_limit.cl for itself, and use() one more.
constexpr std::uint32_t kPrograms = 2;

// Compiles a small program in a fresh context and says what the store did.
cl::ProgramStoreStats use(const fs::path& folder, bool cache = true) {
  cl::ContextOptions options;
  options.use_cache = cache;
  options.cache_folder = folder;
  const cl::Context context(gnomon::test::chosen_device(), options);
  static_cast<void>(context.programs().get({"loop_limit.cl"}, "-DGN_CACHE_TEST=1"));
  static_cast<void>(
      context.programs().get({"loop_limit.cl"}, "-DGN_CACHE_TEST=1"));  // the second is in memory
  return context.programs().stats();
}

std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> out;
  for (const auto& entry : fs::directory_iterator(folder)) out.push_back(entry.path());
  return out;
}

// Sets an environment variable for one scope.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    setenv(name, value.c_str(), 1);
  }
  ~Environment() { before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_); }

 private:
  const char* name_;
  std::optional<std::string> before_;
};

}  // namespace

TEST_CASE("the second run takes the program from disk") {
  const TemporaryFolder folder;
  REQUIRE(use(folder.path()).compiled == kPrograms);
  REQUIRE(entries(folder.path()).size() == kPrograms);
  const auto again = use(folder.path());
  REQUIRE(again.compiled == 0);
  REQUIRE(again.from_disk == kPrograms);
}

TEST_CASE("without the cache nothing is read or written") {
  const TemporaryFolder folder;
  REQUIRE(use(folder.path(), false).compiled == kPrograms);
  REQUIRE(entries(folder.path()).empty());
}

TEST_CASE("truncated, altered, foreign and empty entries are rebuilt silently") {
  const TemporaryFolder folder;
  static_cast<void>(use(folder.path()));
  const fs::path entry = entries(folder.path()).front();
  const auto damage = GENERATE(0, 1, 2, 3, 4);
  CAPTURE(damage);
  if (damage == 0) fs::resize_file(entry, fs::file_size(entry) / 2);
  if (damage == 1) {
    std::fstream file(entry, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(static_cast<std::streamoff>(fs::file_size(entry)) - 20);
    file.put('!');
  }
  if (damage == 2) std::ofstream(entry, std::ios::trunc) << "somebody else's file\n";
  if (damage == 3) fs::resize_file(entry, 0);
  if (damage == 4) {
    // Well-formed, but not a program of this driver.
    std::ofstream(entry, std::ios::trunc) << "gnomon-program-1\n"
                                          << "not the hash of what follows\nELF";
  }
  const auto stats = use(folder.path());
  REQUIRE(stats.rejected == 1);
  REQUIRE(stats.compiled == 1);
  REQUIRE(use(folder.path()).from_disk == kPrograms);  // and the entry is good again
}

TEST_CASE("a cache folder that cannot be written is no error") {
  REQUIRE(use("/proc/gnomon-cannot-write-here").compiled == kPrograms);
}

TEST_CASE("the folder that nobody named is used where the driver keeps nothing itself") {
  const TemporaryFolder folder;
  const Environment xdg("XDG_CACHE_HOME", folder.path().string());
  const cl::DeviceInfo device = gnomon::test::chosen_device();
  const cl::Context context(device);
  REQUIRE(fs::exists(folder.path() / "gnomon") == !device.keeps_programs);
}

TEST_CASE("the cache lives under XDG_CACHE_HOME, else under HOME") {
  const Environment xdg("XDG_CACHE_HOME", "/somewhere/cache");
  REQUIRE(cl::default_cache_folder() == "/somewhere/cache/gnomon");
}

TEST_CASE("a kernel that does not compile shows its file, line and the compiler's log") {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "shared");
  std::ofstream(folder.path() / "shared" / "broken.h") << "\n\nint f(void) { return undeclared_name; }\n";
  std::ofstream(folder.path() / "broken.cl") << "#include \"shared/broken.h\"\n__kernel void k(void) {}\n";
  cl::ContextOptions options;
  options.use_cache = false;
  const cl::Context context(gnomon::test::chosen_device(), options);
  const Environment kernels("GNOMON_KERNELS", folder.path().string());
  REQUIRE_THROWS_WITH(static_cast<void>(context.programs().get({"broken.cl"}, "")),
                      Catch::Contains("undeclared_name") && Catch::Contains("broken.h"));
  REQUIRE_THROWS_WITH(static_cast<void>(context.programs().get({"absent.cl"}, "")),
                      Catch::Contains("absent.cl"));
}

TEST_CASE("flattening includes each file once and keeps line numbers") {
  const std::string text = cl::flatten_kernel("trace.cl");
  REQUIRE(text.find("#line 1 \"shared/layout.h\"") != std::string::npos);
  REQUIRE(text.find("#line 1 \"shared/layout.h\"") == text.rfind("#line 1 \"shared/layout.h\""));
  REQUIRE(text.find("#include \"") == std::string::npos);
}
