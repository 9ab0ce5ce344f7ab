#include "console.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "interrupt.h"

namespace gnomon::app {
namespace {

constexpr std::chrono::milliseconds kRedraw{80};

// no-color.org: set and not empty means no, whatever its value.
bool environment_refuses_color() {
  const char* const value = std::getenv("NO_COLOR");
  return value != nullptr && *value != '\0';
}

bool is_terminal(int descriptor) {
  const char* const kind = std::getenv("TERM");
  return isatty(descriptor) == 1 && kind != nullptr && std::string_view(kind) != "dumb";
}

bool wants_color(const std::string& choice, int descriptor) {
  if (choice == "auto") return is_terminal(descriptor) && !environment_refuses_color();
  return choice == "always";
}

std::string painted(const char* code, std::string_view text) {
  return "\033[" + std::string(code) + "m" + std::string(text) + "\033[0m";
}

const char* code_of(Paint paint) {
  switch (paint) {
    case Paint::kBold:
      return "1";
    case Paint::kGood:
      return "32";
    case Paint::kBad:
      return "1;31";
  }
  return "0";
}

void write_out(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    throw Error(ErrorCode::kIo, "cannot write the result to standard output");
  }
}

}  // namespace

Console::Console(const OutputOptions& options)
    : options_(options),
      color_out_(wants_color(options.color, STDOUT_FILENO)),
      color_err_(wants_color(options.color, STDERR_FILENO)),
      draws_progress_(!options.quiet && is_terminal(STDERR_FILENO)) {}

void Console::print(const std::string& text) {
  if (options_.json) return;
  clear_line();
  write_out(text);
}

void Console::print(const Json& document) {
  if (!options_.json) return;
  clear_line();
  write_out(document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void Console::note(std::string_view text) {
  if (options_.quiet) return;
  clear_line();
  std::fprintf(stderr, "gnomon: note: %.*s\n", static_cast<int>(text.size()), text.data());
}

void Console::error(std::string_view text) {
  clear_line();
  while (text.ends_with('\n')) text.remove_suffix(1);
  const std::string label = color_err_ ? painted(code_of(Paint::kBad), "error:") : "error:";
  std::fprintf(stderr, "gnomon: %s %.*s\n", label.c_str(), static_cast<int>(text.size()), text.data());
}

Progress Console::progress() {
  return [this](std::string_view stage, double done) {
    if (draws_progress_) draw(stage, done);
    return !interrupted();
  };
}

std::string Console::paint(Paint paint, const std::string& text) const {
  return color_out_ ? painted(code_of(paint), text) : text;
}

void Console::draw(std::string_view stage, double done) {
  const auto now = std::chrono::steady_clock::now();
  if (line_drawn_ && now - last_drawn_ < kRedraw) return;
  std::fprintf(stderr, "\r\033[K%.*s %3.0f %%", static_cast<int>(stage.size()), stage.data(), 100.0 * done);
  std::fflush(stderr);
  line_drawn_ = true;
  last_drawn_ = now;
}

void Console::clear_line() {
  if (!line_drawn_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  line_drawn_ = false;
}

}  // namespace gnomon::app
