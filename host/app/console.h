// Where words go: data to stdout, everything else to stderr. Feeds every subcommand and main.
#pragma once

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "gnomon/base/progress.h"

namespace gnomon::app {

// Keys stay in the order they were given.
using Json = nlohmann::ordered_json;

struct OutputOptions {
  bool json = false;
  bool quiet = false;
  std::string color = "auto";  // auto, always, never
};

enum class Paint { kBold, kGood, kBad };

class Console {
 public:
  explicit Console(const OutputOptions& options);
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  [[nodiscard]] bool json() const { return options_.json; }

  // The result, on stdout: text for people, or the one document under --json. Throws Error{kIo} when stdout
  // is full or closed.
  void print(const std::string& text);
  void print(const Json& document);

  // On stderr: a note unless --quiet, an error always.
  void note(std::string_view text);
  void error(std::string_view text);

  // Draws a line on stderr when that is a terminal and not --quiet; stops the work after Ctrl-C.
  [[nodiscard]] Progress progress();

  // For stdout; plain text unless colour is wanted there.
  [[nodiscard]] std::string paint(Paint paint, const std::string& text) const;

 private:
  void draw(std::string_view stage, double done);
  void clear_line();

  OutputOptions options_;
  bool color_out_;
  bool color_err_;
  bool draws_progress_;
  bool line_drawn_ = false;
  std::chrono::steady_clock::time_point last_drawn_;
};

}  // namespace gnomon::app
