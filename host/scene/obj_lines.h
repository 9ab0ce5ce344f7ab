// The text of an OBJ file, handed to tinyobj line by line. Because tinyobj reads one line, then reports what
// it found, we know at every report which line it is about. Not for interpreting lines. Feeds obj_import.
#pragma once

#include <cstddef>
#include <cstdint>
#include <streambuf>
#include <string_view>
#include <vector>

namespace gnomon {

// Makes every kind of line end one '\n' and joins lines that end in a backslash, as the format allows.
class ObjLines : public std::streambuf {
 public:
  explicit ObjLines(std::vector<unsigned char> text);

  // The line read last, without its end; its number in the file counts from 1.
  [[nodiscard]] std::string_view line() const;
  [[nodiscard]] std::uint64_t number() const { return number_; }
  // Lines so far that draw points or lines, which tinyobj does not report.
  [[nodiscard]] std::uint64_t skipped() const { return skipped_; }

 protected:
  int_type underflow() override;

 private:
  std::vector<char> text_;
  std::vector<std::size_t> joins_;  // where in text_ a line end was removed
  std::size_t next_join_ = 0;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::uint64_t number_ = 0;
  std::uint64_t skipped_ = 0;
};

// The words of a line: split at blanks and tabs.
[[nodiscard]] std::vector<std::string_view> words_of(std::string_view line);

}  // namespace gnomon
