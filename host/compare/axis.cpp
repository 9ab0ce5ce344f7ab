#include "gnomon/compare/axis.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace gnomon::compare {
namespace {

constexpr double kRoom = 1.08;        // factor beyond the outermost values
constexpr double kLeastRange = 1.25;  // of hi / lo: less would blow noise up
constexpr int kMostTicks = 7;

std::string in_form(double value, std::chars_format form) {
  std::array<char, 40> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value, form, 4);
  return {text.data(), end};
}

// Of four digits and without zeros before or behind that say nothing: 0.0015, 1.5e-4. A label beside an
// axis has room for six letters.
std::string shortest(double value) {
  std::string text = in_form(value, std::chars_format::general);
  if (value >= 1e-3 || value <= 0.0) return text;
  const int power = static_cast<int>(std::floor(std::log10(value) + 1e-9));
  return in_form(value / std::pow(10.0, power), std::chars_format::general) + "e" + std::to_string(power);
}

}  // namespace

std::string tick_text(double value) {
  for (const auto& [scale, suffix] :
       {std::pair{1e12, "T"}, std::pair{1e9, "G"}, std::pair{1e6, "M"}, std::pair{1e3, "k"}})
    if (value >= scale) return shortest(value / scale) + suffix;
  return shortest(value);
}

LogAxis::LogAxis(const std::vector<double>& values, double from, double to)
    : lo_(0.0), hi_(0.0), from_(from), to_(to) {
  for (const double value : values) {
    if (!(value > 0.0) || !std::isfinite(value)) continue;
    lo_ = lo_ == 0.0 ? value : std::min(lo_, value);
    hi_ = std::max(hi_, value);
  }
  if (lo_ == 0.0) lo_ = hi_ = 1.0;
  lo_ /= kRoom;
  hi_ *= kRoom;
  if (hi_ / lo_ < kLeastRange) {
    const double widen = std::sqrt(kLeastRange * lo_ / hi_);
    lo_ /= widen;
    hi_ *= widen;
  }
}

double LogAxis::at(double value) const {
  return from_ + (to_ - from_) * std::log(value / lo_) / std::log(hi_ / lo_);
}

std::vector<LogAxis::Tick> LogAxis::ticks() const {
  std::vector<double> values;
  const auto keep = [&](double value) {
    if (value >= lo_ && value <= hi_) values.push_back(value);
  };
  if (hi_ / lo_ < 3.5) {
    // Close together: even steps, as on a plain axis.
    const double rough = (hi_ - lo_) / 5.0;
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    const double step = power * (rough / power < 1.5   ? 1.0
                                 : rough / power < 3.5 ? 2.0
                                 : rough / power < 7.5 ? 5.0
                                                       : 10.0);
    for (double k = std::ceil(lo_ / step); k * step <= hi_; k += 1.0) keep(k * step);
  } else {
    const int first = static_cast<int>(std::floor(std::log10(lo_)));
    const int last = static_cast<int>(std::ceil(std::log10(hi_)));
    std::vector<double> steps{1.0};
    if (hi_ / lo_ < 150.0) steps = {1.0, 2.0, 5.0};
    if (hi_ / lo_ < 12.0) steps = {1.0, 1.5, 2.0, 3.0, 5.0, 7.0};
    const int stride = std::max(1, (last - first + kMostTicks - 1) / kMostTicks);
    for (int k = first; k <= last; ++k) {
      if (k % stride != 0) continue;
      for (const double step : steps) keep(step * std::pow(10.0, k));
    }
  }
  std::vector<Tick> ticks;
  for (const double value : values) ticks.push_back({value, tick_text(value)});
  return ticks;
}

}  // namespace gnomon::compare
