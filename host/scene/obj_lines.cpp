#include "gnomon/scene/obj_lines.h"

#include <algorithm>

namespace gnomon {
namespace {

// Only data goes on after a backslash; a comment or a name that ends in one must not swallow the next line.
bool may_continue(char keyword) {
  return keyword == 'f' || keyword == 'v' || keyword == 'l' || keyword == 'p';
}

}  // namespace

ObjLines::ObjLines(std::vector<unsigned char> text) : text_(text.begin(), text.end()) {
  for (std::size_t i = 0; i < text_.size(); ++i) {
    const bool is_pair = i + 1 < text_.size() && text_[i + 1] == '\n';
    // Blanks instead of removals keep every offset valid.
    if (text_[i] == '\r') text_[i] = is_pair ? ' ' : '\n';
  }
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::size_t first = kNone;  // in this line, the first and last character that is not blank
  std::size_t last = kNone;
  for (std::size_t i = 0; i < text_.size(); ++i) {
    const char c = text_[i];
    if (c == ' ' || c == '\t') continue;
    if (c != '\n') {
      if (first == kNone) first = i;
      last = i;
    } else if (first != kNone && may_continue(text_[first]) && text_[last] == '\\') {
      text_[last] = ' ';
      text_[i] = ' ';
      joins_.push_back(i);
    } else {
      first = kNone;
    }
  }
}

std::string_view ObjLines::line() const {
  const std::string_view whole(text_.data() + begin_, end_ - begin_);
  return whole.substr(0, whole.find('\n'));
}

ObjLines::int_type ObjLines::underflow() {
  if (end_ == text_.size()) return traits_type::eof();
  begin_ = end_;
  const auto line_end = std::find(text_.begin() + static_cast<std::ptrdiff_t>(begin_), text_.end(), '\n');
  end_ = static_cast<std::size_t>(line_end - text_.begin()) + (line_end == text_.end() ? 0 : 1);
  ++number_;
  for (; next_join_ < joins_.size() && joins_[next_join_] < begin_; ++next_join_) ++number_;
  const std::string_view trimmed = line().substr(std::min(line().find_first_not_of(" \t"), line().size()));
  if (trimmed.size() > 1 && (trimmed[0] == 'l' || trimmed[0] == 'p') &&
      (trimmed[1] == ' ' || trimmed[1] == '\t')) {
    ++skipped_;
  }
  setg(text_.data() + begin_, text_.data() + begin_, text_.data() + end_);
  return traits_type::to_int_type(text_[begin_]);
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(" \t"); at != line.npos;
       at = line.find_first_not_of(" \t", at)) {
    const std::size_t stop = std::min(line.find_first_of(" \t", at), line.size());
    words.push_back(line.substr(at, stop - at));
    at = stop;
  }
  return words;
}

}  // namespace gnomon
