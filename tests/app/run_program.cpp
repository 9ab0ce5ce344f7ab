#include "run_program.h"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

extern char** environ;

namespace program {
namespace {

constexpr std::chrono::seconds kLimit{120};

// An open file descriptor, closed at the end.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }
  void close() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }
  [[nodiscard]] int get() const { return number_; }

 private:
  int number_;
};

struct Channel {
  Descriptor ours;
  Descriptor theirs;
};

// The ends stay with us: the program gets its copies by spawn's own actions.
Channel open_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

Channel open_terminal() {
  int ours = -1;
  int theirs = -1;
  if (openpty(&ours, &theirs, nullptr, nullptr, nullptr) != 0) throw std::runtime_error("no pseudo terminal");
  fcntl(ours, F_SETFD, FD_CLOEXEC);
  fcntl(theirs, F_SETFD, FD_CLOEXEC);
  return {Descriptor(ours), Descriptor(theirs)};
}

std::vector<std::string> environment_of(const Setup& setup) {
  std::map<std::string, std::string> values;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    values[text.substr(0, text.find('='))] = text.substr(text.find('=') + 1);
  }
  values["XDG_CACHE_HOME"] = GNOMON_TEST_CACHE;
  values["POCL_CACHE_DIR"] = std::string(GNOMON_TEST_CACHE) + "/pocl";
  values["MESA_SHADER_CACHE_DIR"] = std::string(GNOMON_TEST_CACHE) + "/mesa";
  values["TERM"] = "xterm";
  values.erase("NO_COLOR");
  values.erase("GNOMON_KERNELS");
  for (const auto& [name, value] : setup.environment) {
    values.erase(name);
    if (value) values[name] = *value;
  }
  std::vector<std::string> entries;
  for (const auto& [name, value] : values) entries.push_back(name + "=" + value);
  return entries;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

pid_t start(const std::vector<std::string>& arguments, const Setup& setup, const Channel& out,
            const Channel& err) {
  std::vector<std::string> words{GNOMON_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> entries = environment_of(setup);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  if (setup.stdout_file) {
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, setup.stdout_file->c_str(), O_WRONLY, 0);
  } else {
    posix_spawn_file_actions_adddup2(&actions, out.theirs.get(), STDOUT_FILENO);
  }
  posix_spawn_file_actions_adddup2(&actions, err.theirs.get(), STDERR_FILENO);
  // A test run in the background may have SIGINT ignored, and children would inherit that.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t interrupt;
  sigemptyset(&interrupt);
  sigaddset(&interrupt, SIGINT);
  posix_spawnattr_setsigdefault(&attributes, &interrupt);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  pid_t child = -1;
  const int failed = posix_spawn(&child, GNOMON_PROGRAM, &actions, &attributes, pointers_to(words).data(),
                                 pointers_to(entries).data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw std::runtime_error(std::string("cannot start ") + GNOMON_PROGRAM);
  return child;
}

// Takes what is there; closes the channel at its end.
void take(Descriptor& from, std::string& into) {
  std::array<char, 4096> bytes{};
  const ssize_t count = read(from.get(), bytes.data(), bytes.size());
  if (count > 0) {
    into.append(bytes.data(), static_cast<std::size_t>(count));
  } else {
    from.close();  // also a terminal whose other side is gone, which reads as an error
  }
}

}  // namespace

Outcome run(const std::vector<std::string>& arguments, const Setup& setup) {
  Channel out = open_pipe();
  Channel err = setup.terminal ? open_terminal() : open_pipe();
  const pid_t child = start(arguments, setup, out, err);
  out.theirs.close();
  err.theirs.close();
  Outcome outcome;
  bool interrupted = false;
  const auto deadline = std::chrono::steady_clock::now() + kLimit;
  while (out.ours.get() >= 0 || err.ours.get() >= 0) {
    std::array<pollfd, 2> ends{{{out.ours.get(), POLLIN, 0}, {err.ours.get(), POLLIN, 0}}};
    poll(ends.data(), ends.size(), 200);
    if (ends[0].revents != 0) take(out.ours, outcome.out);
    if (ends[1].revents != 0) take(err.ours, outcome.err);
    if (setup.interrupt_at && !interrupted && outcome.err.find(*setup.interrupt_at) != std::string::npos) {
      interrupted = true;
      kill(child, SIGINT);
    }
    if (std::chrono::steady_clock::now() > deadline) kill(child, SIGKILL);
  }
  int status = 0;
  waitpid(child, &status, 0);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  if (outcome.status == 1000 + SIGKILL)
    throw std::runtime_error("gnomon took too long; stderr: " + outcome.err);
  return outcome;
}

Folder::Folder() {
  std::string name = (std::filesystem::temp_directory_path() / "gnomon-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = name;
}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::vector<std::string> Folder::names() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(path_))
    names.push_back(entry.path().filename().string());
  return names;
}

std::string read_text(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace program
