// Marks of a chart as SVG 1.1. Colours are classes, so that one style serves light, dark and paper. Feeds
// charts.
#pragma once

#include <string>
#include <string_view>

namespace gnomon::compare {

// Coordinates are written with one digit after the point: the same chart, the same bytes.
class Svg {
 public:
  Svg(double width, double height) : width_(width), height_(height) {}

  enum class Anchor { kStart, kMiddle, kEnd };
  void text(double x, double y, const std::string& text, Anchor anchor, std::string_view classes = "");
  // Reads upwards.
  void upright_text(double x, double y, const std::string& text, std::string_view classes = "");
  void line(double x0, double y0, double x1, double y1, std::string_view classes);
  void path(const std::string& d, std::string_view classes);
  // Shape `index` of six, about (x, y): circle, square, diamond, triangle up and down, cross.
  void mark(double x, double y, double radius, unsigned index, std::string_view classes,
            const std::string& tip = "");
  void raw(const std::string& markup) { body_ += markup; }

  // As part of a page, whose style has chart_style(); or as a file of its own.
  [[nodiscard]] std::string inside(const std::string& title, const std::string& attributes = "") const;
  [[nodiscard]] std::string file(const std::string& title) const;

 private:
  double width_, height_;
  std::string body_;
};

[[nodiscard]] std::string coordinate(double value);
// The outline of Svg::mark.
[[nodiscard]] std::string mark_path(double x, double y, double radius, unsigned index);
// CSS of all charts. Every two of the six colours differ by 15 and more (CIE 1976 in L*a*b*) for eyes of all
// kinds, and white letters on the first four can be read; shapes and dashes say the same without colour.
[[nodiscard]] std::string chart_style();

}  // namespace gnomon::compare
