#include "gnomon/compare/plots.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "gnomon/compare/analysis.h"

namespace gnomon::compare {
namespace {

using Anchor = Svg::Anchor;

constexpr double kLeft = 52.0;
constexpr double kRight = kChartWidth - 12.0;
constexpr double kTop = 30.0;
constexpr double kScatterBottom = 250.0;
constexpr double kZeroRow = 62.0;
constexpr double kLetterRadius = 8.0;
constexpr double kLetterGap = 16.5;
constexpr double kLetterWidth = 8.3;  // of a digit in DejaVu Sans, the widest of the usual fonts

double width_of(const std::string& text) {
  double width = kLetterWidth * static_cast<double>(text.size());
  for (const char c : text) width += c == 'M' ? 3.0 : c == 'G' ? 1.9 : 0.0;  // of millions and billions
  return width;
}

void x_axis(Svg& svg, const LogAxis& axis, double top, double bottom, const std::string& label) {
  double last = -1e9;
  for (const LogAxis::Tick& tick : axis.ticks()) {
    const double x = axis.at(tick.value);
    svg.line(x, top, x, bottom, "grid");
    // Labels that would run into each other are left out, and those at the ends stay inside the picture.
    const double half = 0.5 * width_of(tick.text);
    const double middle = std::clamp(x, half, kChartWidth - half);
    if (middle - last < 2.0 * half + 8.0) continue;
    svg.text(middle, bottom + 16.0, tick.text, Anchor::kMiddle, "soft");
    last = middle;
  }
  svg.line(axis.from(), bottom, axis.to(), bottom, "axis");
  svg.text(axis.to(), bottom + 34.0, label + " →", Anchor::kEnd, "soft");
}

void y_axis(Svg& svg, const LogAxis& axis, double left, double right, const std::string& label) {
  for (const LogAxis::Tick& tick : axis.ticks()) {
    const double y = axis.at(tick.value);
    svg.line(left, y, right, y, "grid");
    // A label of more letters than there is room for begins at the picture's edge.
    svg.text(std::max(left - 6.0, width_of(tick.text)), y + 4.0, tick.text, Anchor::kEnd, "soft");
  }
  svg.text(2.0, 14.0, "↑ " + label, Anchor::kStart, "soft");
}

std::string color_of(std::size_t index) {
  return std::string("k").append(std::to_string(index % 6));
}

// A legend that wraps; returns where the next thing may begin.
double legend(Svg& svg, const std::vector<std::string>& names, double y) {
  double x = 8.0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double width = 28.0 + width_of(names[i]);
    if (x > 8.0 && x + width > kChartWidth) {
      x = 8.0;
      y += 18.0;
    }
    svg.mark(x, y - 4.0, 4.5, static_cast<unsigned>(i), color_of(i));
    svg.text(x + 10.0, y, names[i], Anchor::kStart);
    x += width;
  }
  return y + 10.0;
}

std::string front_path(const std::vector<Place>& at, const std::vector<std::size_t>& front, double right,
                       double top) {
  std::string d;
  double y = top;
  for (const std::size_t i : front) {
    d.append(d.empty() ? "M" : "H").append(coordinate(at[i].x));
    if (d.find('V') == std::string::npos) d.append(" ").append(coordinate(y));
    d.append("V").append(coordinate(at[i].y));
    y = at[i].y;
  }
  return d.empty() ? d : d + "H" + coordinate(right);
}

std::string data(const std::string& name, double value) {
  return " data-" + name + "=\"" + coordinate(value) + "\"";
}

std::vector<double> values_of(const Scatter& s, double Scatter::Dot::*field) {
  std::vector<double> values;
  for (const Scatter::Dot& dot : s.dots) values.push_back(dot.*field);
  return values;
}

}  // namespace

std::vector<Place> place_letters(const std::vector<Place>& points, const Frame& frame) {
  std::vector<Place> placed;
  for (const Place& point : points) {
    Place best = point;
    for (int step = 0; step < 80; ++step) {
      // Rings of eight, each turned against the one inside.
      const int ring = (step + 7) / 8;
      const double angle = 0.25 * 3.14159265358979 * step + 0.4 * ring;
      const Place at{point.x + kLetterGap * ring * std::cos(angle),
                     point.y - kLetterGap * ring * std::sin(angle)};
      const bool inside =
          at.x >= frame.left && at.x <= frame.right && at.y >= point.top && at.y <= frame.bottom;
      const bool free = std::none_of(placed.begin(), placed.end(), [&](const Place& other) {
        return std::hypot(other.x - at.x, other.y - at.y) < kLetterGap;
      });
      if (step != 0 && !inside) continue;
      if (!free) continue;
      best = at;
      break;
    }
    placed.push_back(best);
  }
  return placed;
}

Svg draw(const Scatter& s, std::string* attributes) {
  const bool zero_row = s.zero_label.has_value();
  const double bottom = kScatterBottom + (zero_row ? kZeroRow : 0.0);
  Svg svg(kChartWidth, bottom + 44.0);
  std::vector<double> xs = values_of(s, &Scatter::Dot::x);
  xs.insert(xs.end(), s.x_range.begin(), s.x_range.end());
  if (s.even) xs.push_back(*s.even);
  std::vector<double> ys = values_of(s, &Scatter::Dot::y);
  if (s.diagonal) {
    xs.insert(xs.end(), ys.begin(), ys.end());
    ys = xs;
  }
  const LogAxis x(xs, kLeft, kRight);
  const LogAxis y(ys, kScatterBottom, kTop);
  x_axis(svg, x, kTop, bottom, s.x_label);
  if (std::any_of(ys.begin(), ys.end(), [](double value) { return value > 0.0; })) {
    y_axis(svg, y, kLeft, kRight, s.y_label);
  } else {
    svg.text(2.0, 14.0, "↑ " + s.y_label, Anchor::kStart, "soft");
  }
  const double zero = bottom - 0.5 * kZeroRow;
  if (zero_row) {
    svg.line(kLeft, kScatterBottom, kRight, kScatterBottom, "axis");
    svg.text(kLeft - 6.0, zero + 4.0, *s.zero_label, Anchor::kEnd, "soft");
  }
  if (s.diagonal) svg.line(x.from(), y.from(), x.to(), y.to(), "even");
  if (s.even) svg.line(x.at(*s.even), kTop, x.at(*s.even), bottom, "even");
  std::vector<Place> at;
  std::vector<Point> points;
  for (const Scatter::Dot& dot : s.dots) {
    at.push_back(dot.y > 0.0 ? Place{x.at(dot.x), y.at(dot.y), kTop + 6.0}
                             : Place{x.at(dot.x), zero, kScatterBottom + 10.0});
    points.push_back({dot.x, dot.y});
  }
  if (s.front) svg.path(front_path(at, pareto_front(points), kRight, kTop), "front");
  const auto letters = place_letters(at, {kLeft + 4.0, kRight - 4.0, bottom - 8.0});
  // Letters come last: no line and no point is drawn over them.
  for (std::size_t i = 0; i < at.size(); ++i) {
    svg.raw("<g class=\"stem " + color_of(s.dots[i].group) + "\">");
    svg.line(at[i].x, at[i].y, letters[i].x, letters[i].y, "lead");
    svg.mark(at[i].x, at[i].y, 2.0, 0, "true");
    svg.raw("</g>\n");
  }
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Scatter::Dot& dot = s.dots[i];
    svg.raw("<g class=\"dot " + color_of(dot.group) + "\" data-letter=\"" + dot.letter + "\"" +
            data("y", at[i].y) + data("top", at[i].top) + ">");
    svg.raw("<g transform=\"translate(" + coordinate(letters[i].x) + " " + coordinate(letters[i].y) + ")\">");
    svg.mark(0.0, 0.0, kLetterRadius, dot.group, "", dot.tip);
    svg.text(0.0, 4.0, dot.letter, Anchor::kMiddle, "letter");
    svg.raw("</g></g>\n");
  }
  if (attributes != nullptr) {
    *attributes = "data-lo=\"" + std::to_string(std::log10(x.lo())) + "\" data-hi=\"" +
                  std::to_string(std::log10(x.hi())) + "\"" + data("left", kLeft) + data("right", kRight) +
                  data("top", kTop) + data("bottom", bottom);
  }
  return svg;
}

Svg draw(const RowPlot& plot) {
  constexpr double kNameHeight = 19.0;
  const double line_height = plot.spans ? 9.0 : 15.0;
  const double lines = plot.spans ? static_cast<double>(std::max<std::size_t>(1, plot.series.size())) : 1.0;
  const double row_height = kNameHeight + line_height * lines + 4.0;
  Svg key(kChartWidth, 0.0);
  const double top = plot.series.size() > 1 ? legend(key, plot.series, 14.0) : 4.0;
  const double bottom = top + row_height * static_cast<double>(plot.rows.size()) + 4.0;
  Svg svg(kChartWidth, bottom + 44.0);
  if (plot.series.size() > 1) static_cast<void>(legend(svg, plot.series, 14.0));
  std::vector<double> values;
  for (const RowPlot::Row& row : plot.rows) {
    for (const RowPlot::Mark& mark : row.marks) {
      values.push_back(mark.value);
      if (mark.lo != mark.hi) values.insert(values.end(), {mark.lo, mark.hi});
    }
  }
  if (plot.even) values.push_back(*plot.even);
  const LogAxis x(values, 12.0, kRight);
  x_axis(svg, x, top, bottom, plot.x_label);
  if (plot.even) svg.line(x.at(*plot.even), top, x.at(*plot.even), bottom, "even");
  double y = top;
  for (const RowPlot::Row& row : plot.rows) {
    // Marks belong to the name above them, not to the one below.
    if (y > top) svg.line(x.from(), y, x.to(), y, "grid");
    svg.text(12.0, y + 14.0, row.name, Anchor::kStart);
    if (!row.remark.empty()) svg.text(kRight, y + 14.0, row.remark, Anchor::kEnd, "soft");
    for (const RowPlot::Mark& mark : row.marks) {
      const double at =
          y + kNameHeight + line_height * ((plot.spans ? static_cast<double>(mark.series) : 0.0) + 0.5);
      const std::string color = color_of(mark.series);
      if (mark.lo != mark.hi) svg.line(x.at(mark.lo), at, x.at(mark.hi), at, "span " + color);
      svg.mark(x.at(mark.value), at, 4.2, static_cast<unsigned>(mark.series), color, mark.tip);
    }
    y += row_height;
  }
  return svg;
}

Svg draw(const CurvePlot& plot) {
  std::vector<double> xs;
  std::vector<double> ys;
  const auto hold = [&](const std::vector<std::pair<double, double>>& points) {
    for (const auto& [px, py] : points) {
      xs.push_back(px);
      ys.push_back(py);
    }
  };
  for (const CurvePlot::Curve& curve : plot.curves) hold(curve.points);
  hold(plot.guide);
  const double first = kScatterBottom + 58.0;
  Svg svg(kChartWidth, first + 18.0 * static_cast<double>(plot.curves.size()));
  const LogAxis x(xs, kLeft, kRight);
  const LogAxis y(ys, kScatterBottom, kTop);
  x_axis(svg, x, kTop, kScatterBottom, plot.x_label);
  y_axis(svg, y, kLeft, kRight, plot.y_label);
  if (!plot.guide.empty())
    svg.line(x.at(plot.guide.front().first), y.at(plot.guide.front().second), x.at(plot.guide.back().first),
             y.at(plot.guide.back().second), "even");
  for (std::size_t i = 0; i < plot.curves.size(); ++i) {
    const CurvePlot::Curve& curve = plot.curves[i];
    const std::string classes = "curve " + color_of(i) +
                                (i % 4 == 0   ? ""
                                 : i % 4 == 1 ? " d1"
                                 : i % 4 == 2 ? " d2"
                                              : " d3");
    std::string d;
    for (const auto& [px, py] : curve.points) {
      const bool first_point = d.empty();
      d.append(first_point ? "M" : plot.straight ? "L" : "H").append(coordinate(x.at(px)));
      d.append(first_point || plot.straight ? " " : "V").append(coordinate(y.at(py)));
      if (plot.straight) svg.mark(x.at(px), y.at(py), 3.5, static_cast<unsigned>(i), color_of(i));
    }
    if (!d.empty()) svg.path(d, classes);
    const double at = first + 18.0 * static_cast<double>(i);
    svg.line(8.0, at - 4.0, 38.0, at - 4.0, classes);
    svg.text(46.0, at, curve.name, Anchor::kStart);
  }
  return svg;
}

}  // namespace gnomon::compare
