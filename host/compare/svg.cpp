#include "gnomon/compare/svg.h"

#include <cmath>

#include "gnomon/compare/words.h"

namespace gnomon::compare {
namespace {

const char* const kAnchors[] = {"start", "middle", "end"};

// Lightness differs as well as hue, for paper without colour; shapes tell the rest.
const char* const kStyle = R"(
.chart{font:13px system-ui,sans-serif;--ink:#1a1a1a;--soft:#5c5c5c;--rule:#dcdcdc;--paper:#fff;
--c0:#0072b2;--c1:#c84e00;--c2:#005a45;--c3:#7b2a78;--c4:#1f1f1f;--c5:#8f8a6a}
.chart text{fill:var(--ink);stroke:var(--paper);stroke-width:3;stroke-linejoin:round;paint-order:stroke}
.chart .soft{fill:var(--soft)}
.chart .head{font-weight:600}
.chart .grid{stroke:var(--rule);stroke-width:1}
.chart .even{stroke:var(--soft);stroke-width:1.2;stroke-dasharray:4 3}
.chart .axis{stroke:var(--soft);stroke-width:1}
.chart .lead{stroke:var(--soft);stroke-width:.8}
.chart .front{fill:none;stroke:var(--soft);stroke-width:1.5}
.chart .letter{font-size:12px;font-weight:600;fill:var(--paper);stroke:none}
.chart .mark{stroke:var(--paper);stroke-width:1}
.chart .span{stroke-width:2.5;opacity:.6}
.chart .curve{fill:none;stroke-width:2}
.chart .d1{stroke-dasharray:7 3}.chart .d2{stroke-dasharray:2 3}.chart .d3{stroke-dasharray:9 3 2 3}
.chart .k0{--c:var(--c0)}.chart .k1{--c:var(--c1)}.chart .k2{--c:var(--c2)}
.chart .k3{--c:var(--c3)}.chart .k4{--c:var(--c4)}.chart .k5{--c:var(--c5)}
.chart .mark{fill:var(--c)}.chart .span,.chart .curve{stroke:var(--c)}
@media screen and (prefers-color-scheme:dark){.chart{--ink:#e8e8e8;--soft:#a8a8a8;--rule:#3a3a3a;--paper:#16181b;
--c0:#4a90f5;--c1:#f07a2a;--c2:#9ef0a0;--c3:#e5a1de;--c4:#fff;--c5:#838374}}
)";

}  // namespace

std::string coordinate(double value) {
  std::string text = fixed(value, 1);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text == "-0" ? "0" : text;
}

std::string chart_style() {
  return kStyle;
}

std::string mark_path(double x, double y, double r, unsigned index) {
  const auto at = [&](double dx, double dy) { return coordinate(x + dx) + " " + coordinate(y + dy); };
  switch (index % 6) {
    case 0:
      return "M" + at(-r, 0) + "a" + coordinate(r) + " " + coordinate(r) + " 0 1 0 " + coordinate(2 * r) +
             " 0a" + coordinate(r) + " " + coordinate(r) + " 0 1 0 " + coordinate(-2 * r) + " 0z";
    case 1:
      return "M" + at(-0.9 * r, -0.9 * r) + "h" + coordinate(1.8 * r) + "v" + coordinate(1.8 * r) + "h" +
             coordinate(-1.8 * r) + "z";
    case 2:
      return "M" + at(0, -1.3 * r) + "L" + at(1.3 * r, 0) + "L" + at(0, 1.3 * r) + "L" + at(-1.3 * r, 0) +
             "z";
    case 3:
      return "M" + at(0, -1.4 * r) + "L" + at(1.35 * r, 1.0 * r) + "L" + at(-1.35 * r, 1.0 * r) + "z";
    case 4:
      return "M" + at(0, 1.4 * r) + "L" + at(1.35 * r, -1.0 * r) + "L" + at(-1.35 * r, -1.0 * r) + "z";
    default:
      return "M" + at(-0.4 * r, -1.1 * r) + "h" + coordinate(0.8 * r) + "v" + coordinate(0.7 * r) + "h" +
             coordinate(0.7 * r) + "v" + coordinate(0.8 * r) + "h" + coordinate(-0.7 * r) + "v" +
             coordinate(0.7 * r) + "h" + coordinate(-0.8 * r) + "v" + coordinate(-0.7 * r) + "h" +
             coordinate(-0.7 * r) + "v" + coordinate(-0.8 * r) + "h" + coordinate(0.7 * r) + "z";
  }
}

void Svg::text(double x, double y, const std::string& text, Anchor anchor, std::string_view classes) {
  body_ += "<text x=\"" + coordinate(x) + "\" y=\"" + coordinate(y) + "\"";
  if (anchor != Anchor::kStart)
    body_ += std::string(" text-anchor=\"") + kAnchors[static_cast<int>(anchor)] + "\"";
  if (!classes.empty()) body_ += " class=\"" + std::string(classes) + "\"";
  body_ += ">" + escaped(text) + "</text>\n";
}

void Svg::upright_text(double x, double y, const std::string& text, std::string_view classes) {
  body_ += "<text text-anchor=\"middle\" transform=\"translate(" + coordinate(x) + " " + coordinate(y) +
           ") rotate(-90)\" class=\"" + std::string(classes) + "\">" + escaped(text) + "</text>\n";
}

void Svg::line(double x0, double y0, double x1, double y1, std::string_view classes) {
  body_ += "<line x1=\"" + coordinate(x0) + "\" y1=\"" + coordinate(y0) + "\" x2=\"" + coordinate(x1) +
           "\" y2=\"" + coordinate(y1) + "\" class=\"" + std::string(classes) + "\"/>\n";
}

void Svg::path(const std::string& d, std::string_view classes) {
  body_ += "<path d=\"" + d + "\" class=\"" + std::string(classes) + "\"/>\n";
}

void Svg::mark(double x, double y, double radius, unsigned index, std::string_view classes,
               const std::string& tip) {
  body_ += "<path d=\"" + mark_path(x, y, radius, index) + "\" class=\"mark " + std::string(classes) + "\"";
  body_ += tip.empty() ? "/>\n" : "><title>" + escaped(tip) + "</title></path>\n";
}

std::string Svg::inside(const std::string& title, const std::string& attributes) const {
  return "<svg class=\"chart\" role=\"img\" aria-label=\"" + escaped(title) + "\" viewBox=\"0 0 " +
         coordinate(width_) + " " + coordinate(height_) + "\"" +
         (attributes.empty() ? "" : " " + attributes) + ">\n" + body_ + "</svg>\n";
}

std::string Svg::file(const std::string& title) const {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"chart\" width=\"" + coordinate(width_) +
         "\" height=\"" + coordinate(height_) + "\" viewBox=\"0 0 " + coordinate(width_) + " " +
         coordinate(height_) + "\">\n<title>" + escaped(title) + "</title>\n<style>" + kStyle +
         "</style>\n<rect width=\"100%\" height=\"100%\" style=\"fill:var(--paper)\"/>\n" + body_ +
         "</svg>\n";
}

}  // namespace gnomon::compare
