// The forms of chart that a report has. Feeds charts.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gnomon/compare/axis.h"
#include "gnomon/compare/svg.h"

namespace gnomon::compare {

inline constexpr double kChartWidth = 400.0;

// Where letters go that would cover each other: beside their point, joined to it by a line, and inside
// left..right and top..bottom. The page's script does the same.
struct Place {
  double x = 0.0;
  double y = 0.0;
  double top = 0.0;  // its letter goes no higher
};
struct Frame {
  double left, right, bottom;
};
[[nodiscard]] std::vector<Place> place_letters(const std::vector<Place>& points, const Frame& frame);

// Points with a letter each, both axes logarithmic.
struct Scatter {
  struct Dot {
    std::string letter;
    unsigned group = 0;  // shape and colour
    double x = 0.0;
    double y = 0.0;  // 0: on the row below the axis, where there is one
    std::string tip;
  };
  std::string x_label, y_label;
  std::vector<Dot> dots;
  std::vector<double> x_range;            // values that the axis must hold besides
  bool diagonal = false;                  // x = y, one scale for both
  bool front = false;                     // join the dots that no other beats
  std::optional<double> even;             // a dashed line at this x
  std::optional<std::string> zero_label;  // of the row for y = 0
};
// attributes: data that the page's script needs to move the dots along x.
[[nodiscard]] Svg draw(const Scatter& scatter, std::string* attributes = nullptr);

// A block for each method, with a mark for each series.
struct RowPlot {
  struct Mark {
    std::size_t series = 0;
    double value = 0.0;
    double lo = 0.0, hi = 0.0;  // equal: no span is drawn
    std::string tip;
  };
  struct Row {
    std::string name;
    std::vector<Mark> marks;
    std::string remark;  // right of the name
  };
  std::string x_label;
  std::vector<std::string> series;
  std::vector<Row> rows;
  bool spans = false;          // each series on a line of its own
  std::optional<double> even;  // a dashed line at this x
};
[[nodiscard]] Svg draw(const RowPlot& plot);

// Curves, both axes logarithmic: steps, or straight from point to point, each marked.
struct CurvePlot {
  struct Curve {
    std::string name;
    std::vector<std::pair<double, double>> points;
  };
  std::string x_label, y_label;
  std::vector<Curve> curves;
  bool straight = false;
  std::vector<std::pair<double, double>> guide;  // a dashed line from the first to the last
};
[[nodiscard]] Svg draw(const CurvePlot& plot);

}  // namespace gnomon::compare
