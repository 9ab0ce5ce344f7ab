// Runs the program gnomon as a process, the way a shell would. Feeds the tests of host/app.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace program {

struct Outcome {
  int status = -1;  // exit status; 1000 + the signal's number when one ended it
  std::string out;  // stdout
  std::string err;  // stderr
};

struct Setup {
  std::map<std::string, std::optional<std::string>> environment;  // set, or removed where empty
  bool terminal = false;                                          // stderr is a terminal, not a pipe
  std::optional<std::string> interrupt_at;                        // send SIGINT once, when stderr holds this
  std::optional<std::string> stdout_file;  // where stdout goes instead of into the outcome
};

// Throws std::runtime_error when it cannot be started, or runs for more than two minutes. Kernels are cached
// in a folder of the build tree.
[[nodiscard]] Outcome run(const std::vector<std::string>& arguments, const Setup& setup = {});

// A fresh folder, gone with everything in it at the end.
class Folder {
 public:
  Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder();
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }
  [[nodiscard]] std::vector<std::string> names() const;  // of what is in it

 private:
  std::filesystem::path path_;
};

[[nodiscard]] std::string read_text(const std::filesystem::path& file);
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace program
