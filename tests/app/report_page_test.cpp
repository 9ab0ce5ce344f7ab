// The page of gnomon compare in a browser: every chart is there, the slider moves points, nothing is reported
// to the console, and it is legible on a phone and in the dark.
#include <array>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "compared_methods.h"
#include "run_program.h"

using Catch::Contains;
using nlohmann::json;
using program::Folder;

namespace {

// Runs inside the page, after its own script, and tells the page around it what it found. Errors are caught
// from before the page's script on.
const char* const kWatch = R"(<script>
window.problems = [];
window.addEventListener('error', event => problems.push(event.message));
const told = console.error;
console.error = (...words) => { problems.push(words.join(' ')); told(...words); };
</script>)";

const char* const kProbe = R"(<script>
(() => {
  const all = selector => [...document.querySelectorAll(selector)];
  const luminance = color => {
    const part = c => (c /= 255) <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
    const [r, g, b] = color.match(/\d+/g).map(Number).map(part);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const contrast = (a, b) => (Math.max(luminance(a), luminance(b)) + 0.05) / (Math.min(luminance(a), luminance(b)) + 0.05);
  const paper = getComputedStyle(document.documentElement).backgroundColor;
  const places = () => all('#pareto-accuracy .dot > g').map(g => g.getAttribute('transform'));
  const state = () => ({
    places: places(),
    points: all('#pareto-accuracy .stem > line').map(l => ['x1', 'y1'].map(name => parseFloat(l.getAttribute(name)))),
    times: all('tbody .time').map(cell => cell.textContent),
    letters: all('tbody tr').map(row => row.dataset.letter),
    words: document.querySelector('output').textContent,
    front: document.querySelector('#pareto-accuracy .front').getAttribute('d'),
  });
  const slider = document.querySelector('input[type=range]');
  const at = value => {
    slider.value = value;
    slider.dispatchEvent(new Event('input'));
    return state();
  };
  const found = {
    problems,
    charts: Object.fromEntries(all('figure[id]').map(figure =>
        [figure.id, figure.querySelectorAll('svg .mark, svg .curve').length])),
    marks_outside: all('figure[id] svg .mark').filter(mark => {
      const box = mark.getBoundingClientRect(), svg = mark.ownerSVGElement.getBoundingClientRect();
      return box.left < svg.left - 1 || box.right > svg.right + 1 || box.top < svg.top - 1 || box.bottom > svg.bottom + 1;
    }).length,
    texts_outside: all('figure[id] svg text').filter(text => {
      const box = text.getBoundingClientRect(), svg = text.ownerSVGElement.getBoundingClientRect();
      return box.left < svg.left - 2 || box.right > svg.right + 2;
    }).map(text => text.textContent),
    texts_crossing: all('figure[id] svg').flatMap(svg => {
      const texts = [...svg.querySelectorAll('text:not(.letter)')].map(text => [text.textContent, text.getBoundingClientRect()]);
      return texts.flatMap(([a, p], i) => texts.slice(i + 1).filter(([b, q]) =>
          Math.min(p.right, q.right) - Math.max(p.left, q.left) > 1 && Math.min(p.bottom, q.bottom) - Math.max(p.top, q.top) > 4)
          .map(([b]) => a + ' / ' + b));
    }),
    words_broken: all('code .whole, pre .whole').filter(part => part.getClientRects().length > 1).length,
    commands: all('code .whole, pre .whole').length,
    tables_cut: all('.wide').filter(box => box.scrollWidth > box.clientWidth + 1).length,
    slider_shown: slider.getClientRects().length > 0,
    tallest_figure: Math.max(...all('figure[id]').map(figure => figure.getBoundingClientRect().height)),
    pictures: all('img').map(img => img.naturalWidth),
    first: state(),
    few: at(3),
    many: at(12),
    back: at(7),
    too_wide: document.documentElement.scrollWidth - window.innerWidth,
    smallest_text: Math.min(...all('figure[id] svg text').map(t =>
        parseFloat(getComputedStyle(t).fontSize) * t.ownerSVGElement.getScreenCTM().a)),
    dark: matchMedia('(prefers-color-scheme: dark)').matches,
    paper_luminance: luminance(paper),
    ink_contrast: contrast(paper, getComputedStyle(document.body).color),
    text_contrast: Math.min(...all('figure[id] svg text:not(.letter)').map(t => contrast(paper, getComputedStyle(t).fill))),
    mark_contrast: Math.min(...all('figure[id] svg .mark').map(m => contrast(paper, getComputedStyle(m).fill))),
  };
  // As a chart of more rows than any paper holds would be.
  const gain = document.querySelector('#gain svg');
  gain.setAttribute('viewBox', '0 0 400 2000');
  found.endless_chart = gain.getBoundingClientRect().height;
  parent.postMessage(JSON.stringify(found), '*');
})();
</script>)";

// The page with watch and probe, in a frame of this width.
json look_at(const Folder& folder, const std::string& page, int width, const std::string& flags = "") {
  std::string watched = page;
  watched.insert(watched.find("<style>"), kWatch);
  watched.insert(watched.rfind("</body>"), kProbe);
  program::write_text(folder.file("watched.html"), watched);
  program::write_text(
      folder.file("frame.html"),
      "<!DOCTYPE html><meta charset=utf-8><script>onmessage = e => { const pre = "
      "document.createElement('pre'); pre.textContent = e.data; document.body.append(pre); };</script>"
      "<body><iframe src=\"watched.html\" width=\"" +
          std::to_string(width) + "\" height=\"900\"></iframe></body>");
  const std::string command =
      std::string(GNOMON_CHROMIUM) +
      " --headless --no-sandbox --disable-gpu --hide-scrollbars --window-size=1400,1000 "
      "--enable-logging=stderr --virtual-time-budget=5000 " +
      flags + " --user-data-dir='" + folder.file("profile") + "' --dump-dom 'file://" +
      folder.file("frame.html") + "' >'" + folder.file("dom") + "' 2>'" + folder.file("log") + "'";
  const int status = std::system(command.c_str());
  const std::string log = program::read_text(folder.file("log"));
  CAPTURE(command, log);
  REQUIRE(status == 0);
  REQUIRE_THAT(log, !Contains("CONSOLE"));
  const std::string dom = program::read_text(folder.file("dom"));
  const std::size_t from = dom.find("<pre>");
  REQUIRE(from != std::string::npos);
  std::string text = dom.substr(from + 5, dom.find("</pre>") - from - 5);
  for (const auto& [entity, plain] :
       {std::pair{"&lt;", "<"}, std::pair{"&gt;", ">"}, std::pair{"&amp;", "&"}})
    for (std::size_t at = 0; (at = text.find(entity, at)) != std::string::npos; at += 1)
      text.replace(at, std::string(entity).size(), plain);
  return json::parse(text);
}

// Where the page's text has the points of the first chart.
std::vector<std::array<double, 2>> points_of(const std::string& page) {
  std::vector<std::array<double, 2>> points;
  const std::size_t end = page.find("</svg>", page.find("<figure id=\"pareto-accuracy\""));
  const auto number_after = [&](const std::string& name, std::size_t from) {
    return std::stod(page.substr(page.find(name, from) + name.size(), 12));
  };
  for (std::size_t at = 0; (at = page.find("<g class=\"stem", at)) < end; ++at)
    points.push_back({number_after(" x1=\"", at), number_after(" y1=\"", at)});
  return points;
}

void check_all(const json& seen) {
  CAPTURE(seen.at("texts_outside").dump(), seen.at("texts_crossing").dump(), seen.dump(1));
  REQUIRE(seen.at("problems").empty());
  for (const char* chart : {"pareto-accuracy", "pareto-memory", "gain", "build-trace", "break-even", "boxes",
                            "triangles", "prediction-primary", "prediction-shadow", "prediction-light",
                            "errors", "size-build", "size-trace", "areas"}) {
    CAPTURE(chart);
    REQUIRE(seen.at("charts").contains(chart));
    if (chart != std::string("break-even")) REQUIRE(seen.at("charts").at(chart) > 0);
  }
  REQUIRE(seen.at("marks_outside") == 0);
  REQUIRE(seen.at("texts_outside").empty());
  REQUIRE(seen.at("texts_crossing").empty());
  REQUIRE(seen.at("pictures").size() >= 2);
  for (const json& width : seen.at("pictures")) REQUIRE(width == 320);
  REQUIRE(seen.at("too_wide") <= 0);
  REQUIRE(seen.at("commands") > 10);
  REQUIRE(seen.at("words_broken") == 0);
  // WCAG 2.1: 4.5 for text, 3 for what is drawn.
  REQUIRE(seen.at("ink_contrast") > 7.0);
  REQUIRE(seen.at("text_contrast") > 4.5);
  REQUIRE(seen.at("mark_contrast") > 3.0);
}

}  // namespace

TEST_CASE("the page works in a browser: wide, on a phone, and in the dark") {
  const Folder folder;
  const auto outcome = program::run({"compare", "gen:cottage:7k", "--methods", program::kComparedMethods,
                                     "--rays", "primary,shadow,light", "--ray-count", "2k", "--judged-rays",
                                     "300", "--rounds", "3", "-o", folder.file("r.html"), "--quiet"});
  CAPTURE(outcome.err);
  REQUIRE(outcome.status == 0);
  const std::string page = program::read_text(folder.file("r.html"));

  const json wide = look_at(folder, page, 1200);
  check_all(wide);
  REQUIRE(wide.at("dark") == false);
  REQUIRE(wide.at("paper_luminance") > 0.9);
  REQUIRE(wide.at("smallest_text") >= 10.0);
  // The slider moves points, sorts the table, and comes back.
  for (const char* part : {"places", "times", "words", "front"}) {
    CAPTURE(part);
    REQUIRE(wide.at("few").at(part) != wide.at("many").at(part));
    REQUIRE(wide.at("back").at(part) == wide.at("first").at(part));
  }
  REQUIRE_THAT(wide.at("few").at("words").get<std::string>(), Contains("1000 rays"));
  REQUIRE_THAT(wide.at("many").at("words").get<std::string>(), Contains("1.0 trillion rays"));
  // What the program drew is what the script draws for the same number of rays.
  const auto drawn = points_of(page);
  REQUIRE(drawn.size() == wide.at("first").at("points").size());
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      CAPTURE(i, k);
      REQUIRE(drawn[i][k] == Approx(wide.at("first").at("points").at(i).at(k).get<double>()).margin(0.11));
    }
  }

  const json phone = look_at(folder, page, 360);
  check_all(phone);
  REQUIRE(phone.at("smallest_text") >= 9.0);

  REQUIRE(wide.at("slider_shown") == true);

  // Its rules for paper, on a page of A4: 19 cm between margins are 718 pixels, 27.7 cm 1047.
  std::string printed = page;
  const std::string rule = "@media print{";
  REQUIRE(printed.find(rule) != std::string::npos);
  printed.replace(printed.find(rule), rule.size(), "@media all{");
  const json paper = look_at(folder, printed, 718);
  check_all(paper);
  REQUIRE(paper.at("tables_cut") == 0);
  REQUIRE(paper.at("slider_shown") == false);
  // Letter, the shorter paper, has 979 pixels between margins: a heading and the tallest chart share a page.
  REQUIRE(paper.at("tallest_figure") < 920);
  REQUIRE(paper.at("endless_chart") < 760);
  REQUIRE(paper.at("smallest_text") >= 8.0);  // 6 pt

  const json dark = look_at(folder, page, 1200, "--blink-settings=preferredColorScheme=0");
  check_all(dark);
  REQUIRE(dark.at("dark") == true);
  REQUIRE(dark.at("paper_luminance") < 0.05);
}
