// A logarithmic axis: where values are, in pixels, and which to label. Feeds charts.
#pragma once

#include <string>
#include <vector>

namespace gnomon::compare {

class LogAxis {
 public:
  // Holds all values above zero with some room at both ends, over pixels from..to (to may be less). No such
  // value: 1.
  LogAxis(const std::vector<double>& values, double from, double to);

  [[nodiscard]] double at(double value) const;  // value > 0
  [[nodiscard]] double lo() const { return lo_; }
  [[nodiscard]] double hi() const { return hi_; }
  [[nodiscard]] double from() const { return from_; }
  [[nodiscard]] double to() const { return to_; }

  struct Tick {
    double value;
    std::string text;
  };
  // Two to about seven, round numbers.
  [[nodiscard]] std::vector<Tick> ticks() const;

 private:
  double lo_, hi_, from_, to_;
};

// "0.5", "20", "3k", "1.5M", "10G", "1e-6".
[[nodiscard]] std::string tick_text(double value);

}  // namespace gnomon::compare
