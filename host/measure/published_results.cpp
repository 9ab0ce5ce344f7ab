#include "gnomon/measure/published_results.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <vector>

#include "gnomon/base/error.h"
#include "gnomon/scene/read_file.h"

namespace gnomon {
namespace {

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t at = 0;;) {
    const std::size_t end = text.find(separator, at);
    parts.emplace_back(text.substr(at, end - at));
    if (end == std::string_view::npos) return parts;
    at = end + 1;
  }
}

class Table {
 public:
  explicit Table(const std::filesystem::path& file) : file_(file.string()) {
    const auto bytes = read_file(file);
    std::string text(bytes.begin(), bytes.end());
    text.erase(std::remove(text.begin(), text.end(), '\r'), text.end());
    for (const std::string& line : split(text, '\n')) lines_.push_back(split(line, ','));
    heads_ = lines_.front();
  }

  [[nodiscard]] std::size_t size() const { return lines_.size(); }
  [[nodiscard]] bool is_blank(std::size_t line) const {
    return lines_[line].size() == 1 && lines_[line].front().empty();
  }
  [[nodiscard]] std::string text(std::size_t line, std::string_view column) const {
    const auto found = std::find(heads_.begin(), heads_.end(), column);
    if (found == heads_.end()) fail(0, "there is no column " + std::string(column));
    const auto at = static_cast<std::size_t>(found - heads_.begin());
    if (at >= lines_[line].size()) fail(line, "the row ends before column " + std::string(column));
    return lines_[line][at];
  }
  [[nodiscard]] double number(std::size_t line, std::string_view column) const {
    const std::string value = text(line, column);
    double out = 0.0;
    const auto [stop, error] = std::from_chars(value.data(), value.data() + value.size(), out);
    if (error != std::errc{} || stop != value.data() + value.size())
      fail(line, "\"" + value + "\" in column " + std::string(column) + " is not a number");
    return out;
  }

 private:
  [[noreturn]] void fail(std::size_t line, const std::string& what) const {
    throw Error(ErrorCode::kInvalidArgument, file_ + ", line " + std::to_string(line + 1) + ": " + what);
  }

  std::string file_;
  std::vector<std::vector<std::string>> lines_;
  std::vector<std::string> heads_;
};

std::string key(std::string_view scene, std::string_view area, std::string_view orientation,
                std::string_view variant) {
  std::string out(scene);
  for (const std::string_view part : {area, orientation, variant}) out.append("/").append(part);
  return out;
}

}  // namespace

std::string key_of(const SetUp& set_up, std::string_view variant) {
  return key(set_up.scene, set_up.area_name, set_up.orientation, variant);
}

PublishedResults read_published_results(const std::filesystem::path& file) {
  const Table table(file);
  PublishedResults out;
  for (std::size_t line = 1; line < table.size(); ++line) {
    if (table.is_blank(line)) continue;
    const auto text = [&](std::string_view column) { return table.text(line, column); };
    const auto number = [&](std::string_view column) { return table.number(line, column); };
    out[key(text("scene"), text("area"), text("orientation"), text("variant"))] =
        PublishedRow{text("flag"),
                     number("local_cost"),
                     number("total_cost_local_plus_fallback"),
                     number("global_bvh_only_cost"),
                     number("hit_fraction_any"),
                     number("est_pah"),
                     number("est_sah"),
                     number("overlap_to_lvl4"),
                     number("overlap_to_lvl7"),
                     number("overlap_to_lvl10"),
                     number("overlap_to_lvl15"),
                     number("overlap_to_lvl100"),
                     number("max_level"),
                     number("planes_tried_per_internal_node")};
  }
  return out;
}

}  // namespace gnomon
