// The charts' colours, told apart by eyes of all kinds and legible on their paper.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <regex>
#include <string>
#include <vector>

#include "gnomon/compare/svg.h"

namespace {

using Color = std::array<double, 3>;  // linear red, green, blue

Color color_from(const std::string& hex) {
  Color color{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string digits = hex.size() == 3 ? std::string(2, hex[i]) : hex.substr(2 * i, 2);
    const double c = std::stoi(digits, nullptr, 16) / 255.0;
    color[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  return color;
}

Color times(const double (&matrix)[3][3], const Color& c) {
  Color out{};
  for (std::size_t i = 0; i < 3; ++i)
    out[i] = matrix[i][0] * c[0] + matrix[i][1] * c[1] + matrix[i][2] * c[2];
  return out;
}

// CIE 1976 L*a*b*, D65.
Color lab(const Color& rgb) {
  constexpr double kToXyz[3][3] = {{0.4124564, 0.3575761, 0.1804375},
                                   {0.2126729, 0.7151522, 0.0721750},
                                   {0.0193339, 0.1191920, 0.9503041}};
  const Color xyz = times(kToXyz, rgb);
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116.0; };
  const double x = f(xyz[0] / 0.95047);
  const double y = f(xyz[1]);
  const double z = f(xyz[2] / 1.08883);
  return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

// WCAG 2.1.
double contrast(const Color& a, const Color& b) {
  const auto light = [](const Color& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2] + 0.05; };
  return std::max(light(a), light(b)) / std::min(light(a), light(b));
}

// Machado, Oliveira and Fernandes 2009, complete deficiency; the first is everybody else.
struct Eyes {
  const char* name;
  double matrix[3][3];
  double least;  // distance of two colours
};
const Eyes kEyes[] = {
    {"all cones", {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 30.0},
    {"no red",
     {{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}},
     18.0},
    {"no green",
     {{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}},
     18.0},
    {"no blue",
     {{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}},
     15.0}};

// --c0 to --c5 and --paper, by rule: first for light paper, then for dark.
std::vector<Color> colors(const std::string& style, const std::string& name) {
  std::vector<Color> found;
  const std::regex rule("--" + name + ":#([0-9a-f]{6}|[0-9a-f]{3})\\b");
  for (std::sregex_iterator it(style.begin(), style.end(), rule), end; it != end; ++it)
    found.push_back(color_from((*it)[1]));
  return found;
}

}  // namespace

TEST_CASE("eyes of all kinds tell the charts' colours apart, on light paper and on dark") {
  const std::string style = gnomon::compare::chart_style();
  for (std::size_t scheme = 0; scheme < 2; ++scheme) {
    std::vector<Color> palette;
    for (int i = 0; i < 6; ++i) {
      const auto found = colors(style, std::string("c").append(std::to_string(i)));
      REQUIRE(found.size() == 2);
      palette.push_back(found[scheme]);
    }
    for (const Eyes& eyes : kEyes) {
      std::vector<Color> seen;
      for (const Color& color : palette) {
        Color c = times(eyes.matrix, color);
        for (double& part : c) part = std::min(1.0, std::max(0.0, part));
        seen.push_back(lab(c));
      }
      for (std::size_t i = 0; i < seen.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
          CAPTURE(scheme, eyes.name, i, k);
          REQUIRE(std::hypot(seen[i][0] - seen[k][0], seen[i][1] - seen[k][1], seen[i][2] - seen[k][2]) >=
                  eyes.least);
        }
      }
    }
  }
}

TEST_CASE("marks stand out from their paper, and paper-coloured letters on the first four can be read") {
  const std::string style = gnomon::compare::chart_style();
  const auto paper = colors(style, "paper");
  REQUIRE(paper.size() == 2);
  for (std::size_t scheme = 0; scheme < 2; ++scheme) {
    for (int i = 0; i < 6; ++i) {
      const Color color = colors(style, std::string("c").append(std::to_string(i))).at(scheme);
      CAPTURE(scheme, i);
      REQUIRE(contrast(color, paper[scheme]) >= (i < 4 ? 4.5 : 3.0));
    }
  }
}
