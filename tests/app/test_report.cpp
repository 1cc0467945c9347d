// Plots and HTML of the bench's reports: whole documents, nothing outside the panel, every text escaped.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>
#include <set>

#include "app/cli/report_html.h"
#include "app/cli/report_markup.h"
#include "app/cli/report_plot.h"
#include "app/cli/report_plot_labels.h"
#include "core/error.h"

namespace atomesh::cli {
namespace {

// "" where every tag is closed in its turn; else what is wrong. Text and attributes may hold no bare < or &.
std::string complaint(const std::string& markup) {
  static const std::regex tag(R"(^<(/?)([A-Za-z0-9]+)((?:\s+[A-Za-z0-9:-]+="[^"<]*")*)\s*(/?)>)");
  static const std::regex entity("^&(amp|lt|gt|quot|#39);");
  std::vector<std::string> open;
  for (std::size_t at = 0; at < markup.size(); ++at) {
    std::smatch match;
    if (markup[at] == '&') {
      const std::string rest = markup.substr(at, 8);
      if (!std::regex_search(rest, match, entity)) return "bare &: " + markup.substr(at, 30);
    }
    if (markup[at] != '<') continue;
    if (markup.compare(at, 15, "<!DOCTYPE html>") == 0) continue;
    const std::string rest = markup.substr(at, std::min<std::size_t>(markup.find('>', at) + 1 - at, 2000));
    if (!std::regex_search(rest, match, tag)) return "no tag: " + rest.substr(0, 60);
    if (match[4] == "/") continue;
    if (match[1] != "/") {
      open.push_back(match[2]);
    } else if (open.empty() || open.back() != match[2]) {
      return "</" + match[2].str() + "> closes " + (open.empty() ? "nothing" : open.back());
    } else {
      open.pop_back();
    }
  }
  return open.empty() ? "" : "<" + open.back() + "> stays open";
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

// Every coordinate of lines, markers and texts lies within the view box.
void expect_inside(const std::string& svg, const Plot& plot) {
  static const std::regex coordinate(R"re( (x|y|x1|x2|y1|y2|cx|cy)="(-?[0-9.]+)")re");
  static const std::regex corner(R"((-?[0-9.]+),(-?[0-9.]+))");
  const auto check = [&](double value, bool across) {
    EXPECT_GE(value, 0.0);
    EXPECT_LE(value, across ? plot.width : plot.height);
  };
  for (std::sregex_iterator it(svg.begin(), svg.end(), coordinate), end; it != end; ++it) {
    check(std::stod((*it)[2]), std::string((*it)[1]).find('x') != std::string::npos);
  }
  static const std::regex polygon("points=\"([^\"]*)\"");
  for (std::sregex_iterator it(svg.begin(), svg.end(), polygon), end; it != end; ++it) {
    const std::string points = (*it)[1];
    for (std::sregex_iterator p(points.begin(), points.end(), corner); p != end; ++p) {
      check(std::stod((*p)[1]), true);
      check(std::stod((*p)[2]), false);
    }
  }
}

Plot error_over_time() {
  Plot plot{"error-over-time",
            "Comb, 1024×1024: error over time",
            {"time of a frame, ms", AxisScale::logarithmic},
            {"largest error of a channel", AxisScale::logarithmic},
            {}};
  plot.series.push_back(
      {"sampled", {{21, 0.11, "1"}, {24, 0.03, "2"}, {31, 0.007, "4"}, {45, 0.0018, "8"}, {74, 0.0005, "16 samples"}}});
  plot.series.push_back({"exact", {{38, 4e-6, "exact"}}});
  plot.series.push_back({"VTK ray cast", {{900, 0.04}, {1800, 0.011}}, true, true});
  plot.guides.push_back({true, 1.0 / 512.0, "required: 1/512"});
  return plot;
}

TEST(Plot, IsAWholeDocumentWithinItsBox) {
  const Plot plot = error_over_time();
  const std::string svg = plot_svg(plot);
  EXPECT_EQ(complaint(svg), "");
  expect_inside(svg, plot);
  EXPECT_TRUE(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"760\" height=\"460\""));
  EXPECT_NE(svg.find("fill=\"#ffffff\"/>"), std::string::npos) << "no panel";
  for (const char* text : {"16 samples", "required: 1/512", "VTK ray cast", "time of a frame, ms", ">100<", ">10⁻⁴<"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
  EXPECT_EQ(svg, plot_svg(plot));
}

// One marker for each point and one for its name in the legend; a line for each pair of neighbours.
TEST(Plot, ShowsEveryPoint) {
  const std::string svg = plot_svg(error_over_time());
  EXPECT_EQ(count(svg, "<circle"), 6U);        // sampled: circles
  EXPECT_EQ(count(svg, "<polygon"), 2U + 3U);  // exact: a square; VTK: triangles
  EXPECT_EQ(count(svg, "stroke-linecap"), 4U + 1U);
}

// Each marker beside its name in the legend, told apart by colour or shape.
TEST(Plot, ManySeriesLookDifferent) {
  Plot plot{"many", "", {"x"}, {"y"}, {}};
  for (int s = 0; s < 42; ++s) plot.series.push_back({"series", {}, false});
  const std::string svg = plot_svg(plot);
  static const std::regex marker("<(circle|polygon)[^>]*/>");
  static const std::regex corner("[0-9.]+,[0-9.]+");
  std::set<std::string> looks;
  for (std::sregex_iterator it(svg.begin(), svg.end(), marker), end; it != end; ++it) {
    const std::string text = it->str();
    const std::size_t fill = text.find("fill=");
    // Colour, number of corners, and the way the first of them points from their middle.
    std::vector<std::pair<double, double>> corners;
    for (std::sregex_iterator c(text.begin(), text.end(), corner); c != end; ++c) {
      const std::string pair = c->str();
      corners.emplace_back(std::stod(pair), std::stod(pair.substr(pair.find(',') + 1)));
    }
    std::string direction;
    if (!corners.empty()) {
      double x = 0.0, y = 0.0;
      for (const auto& [cx, cy] : corners) {
        x += cx / static_cast<double>(corners.size());
        y += cy / static_cast<double>(corners.size());
      }
      direction =
          std::to_string(std::lround(corners[0].first - x)) + " " + std::to_string(std::lround(corners[0].second - y));
    }
    looks.insert(text.substr(fill, 14) + std::to_string(corners.size()) + " " + direction);
  }
  EXPECT_EQ(looks.size(), 42U);
}

TEST(Plot, ZeroOnALogarithmicAxisIsHollowAndSaid) {
  Plot plot = error_over_time();
  EXPECT_EQ(plot_svg(plot).find("Hollow"), std::string::npos);
  plot.series[1].points.push_back({50, 0.0, "equal"});
  const std::string svg = plot_svg(plot);
  EXPECT_NE(svg.find("Hollow"), std::string::npos);
  EXPECT_NE(svg.find(">equal</text>"), std::string::npos);
  EXPECT_EQ(count(svg, "<polygon"), 6U);
  expect_inside(svg, plot);
}

TEST(Plot, WhatIsNotFiniteIsLeftOut) {
  Plot plot = error_over_time();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  plot.series[0].points[2].y = nan;
  plot.series[0].points[4].x = std::numeric_limits<double>::infinity();
  const std::string svg = plot_svg(plot);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_EQ(count(svg, "<circle"), 4U);
  EXPECT_EQ(count(svg, "stroke-linecap"), 1U + 1U) << "the line breaks where a point is missing";
}

TEST(Plot, EmptyPlotsSaySo) {
  Plot plot = error_over_time();
  for (PlotSeries& series : plot.series) series.points.clear();
  plot.guides.clear();
  const std::string svg = plot_svg(plot);
  EXPECT_EQ(complaint(svg), "");
  expect_inside(svg, plot);
  EXPECT_NE(svg.find("Nothing was measured"), std::string::npos);
}

TEST(Plot, GivenEndsCutLinesAndLeaveOutPoints) {
  Plot plot{"scaling", "", {"threads"}, {"times one thread"}, {}};
  plot.x.min = 0.0;
  plot.x.max = 4.0;
  plot.y.min = 0.0;
  plot.y.max = 2.0;
  plot.series.push_back({"ours", {{-1, -1, "outside"}, {1, 1, "inside"}, {8, 8, "far"}}});
  const std::string svg = plot_svg(plot);
  expect_inside(svg, plot);
  EXPECT_EQ(svg.find("outside"), std::string::npos);
  EXPECT_NE(svg.find("inside"), std::string::npos);
  EXPECT_EQ(count(svg, "<circle"), 2U);
  EXPECT_EQ(count(svg, "stroke-linecap"), 2U);
}

TEST(Plot, RefusesAxesThatCannotBe) {
  Plot plot = error_over_time();
  plot.y.min = 0.0;
  EXPECT_THROW(plot_svg(plot), UsageError);
  plot = error_over_time();
  plot.x.min = 10.0;
  plot.x.max = 10.0;
  EXPECT_THROW(plot_svg(plot), UsageError);
  plot = error_over_time();
  plot.height = 100;
  EXPECT_THROW(plot_svg(plot), UsageError);
}

// Any sizes and values: whole, inside, and no label over another where there is room for all.
TEST(Plot, AnyValuesStayInside) {
  for (int seed = 0; seed < 60; ++seed) {
    Plot plot{"any", "any", {"x"}, {"y"}, {}};
    plot.x.scale = seed % 2 == 0 ? AxisScale::linear : AxisScale::logarithmic;
    plot.y.scale = seed % 3 == 0 ? AxisScale::linear : AxisScale::logarithmic;
    plot.width = 320 + 37 * seed;
    plot.height = 240 + 11 * seed;
    for (int s = 0; s < seed % 9; ++s) {
      PlotSeries series{"series " + std::string(static_cast<std::size_t>(s), 'x'), {}};
      for (int i = 0; i < 5; ++i) {
        const double value = std::sin(12.9898 * seed + 78.233 * s + 37.719 * i) * std::pow(10.0, seed % 7 - 3);
        series.points.push_back({value * (i + 1), value * value - 0.1, std::to_string(i)});
      }
      plot.series.push_back(series);
    }
    const std::string svg = plot_svg(plot);
    EXPECT_EQ(complaint(svg), "") << seed;
    expect_inside(svg, plot);
  }
}

TEST(PlotLabels, DoNotCoverOneAnother) {
  LabelPlacer placer({0, 0, 400, 300});
  std::vector<PlotBox> boxes;
  for (int i = 0; i < 5; ++i) boxes.push_back(placer.place({200.0 + 3.0 * i, 150.0}, 40.0, 12.0));
  for (std::size_t a = 0; a < boxes.size(); ++a) {
    EXPECT_GE(boxes[a].left, 0.0);
    EXPECT_LE(boxes[a].right, 400.0);
    for (std::size_t b = 0; b < a; ++b) {
      const bool apart = boxes[a].right <= boxes[b].left || boxes[b].right <= boxes[a].left ||
                         boxes[a].bottom <= boxes[b].top || boxes[b].bottom <= boxes[a].top;
      EXPECT_TRUE(apart) << a << " and " << b;
    }
  }
}

TEST(PlotLabels, LinesAreCutToTheBox) {
  const PlotBox box{0, 0, 10, 10};
  PlotPixel from{-5, 5};
  PlotPixel to{15, 5};
  ASSERT_TRUE(clip_line(box, from, to));
  EXPECT_DOUBLE_EQ(from.x, 0.0);
  EXPECT_DOUBLE_EQ(to.x, 10.0);
  from = {-5, 0};
  to = {0, 20};
  EXPECT_FALSE(clip_line(box, from, to)) << "passes the corner by";
  from = {3, 20};
  to = {3, 11};
  EXPECT_FALSE(clip_line(box, from, to));
}

TEST(Markup, EscapesWhatWouldBeMarkup) {
  EXPECT_EQ(escape_markup("a < b & \"c\" > 'd'"), "a &lt; b &amp; &quot;c&quot; &gt; &#39;d&#39;");
  EXPECT_EQ(escape_markup("Å×⁻¹ 𝑇"), "Å×⁻¹ 𝑇");
  EXPECT_EQ(escape_markup(std::string("a\0b\x1b", 4)), "ab");
  // Cut short, spelt too long, half a pair, a byte alone.
  EXPECT_EQ(escape_markup("\xC3"), "\uFFFD");
  EXPECT_EQ(escape_markup("\xC0\x80"), "\uFFFD\uFFFD");
  EXPECT_EQ(escape_markup("\xED\xA0\x80"), "\uFFFD\uFFFD\uFFFD");
  EXPECT_EQ(escape_markup("\xFFz"), "\uFFFDz");
}

TEST(Html, HoldsEverySectionEscaped) {
  TextTable requirements({"what", "required", "met"});
  requirements.row({"<script>alert(1)</script>", "at least 8 ×", "yes"});
  requirements.row({"memory & time", "at most 24", "NO"});
  requirements.row({"ten million", "", "not measured: --full"});
  TextTable times({"case", "ms"});
  times.row({"comb", "12.5"});
  const std::vector<BenchTable> sections{{"Requirements", requirements, "1 of 2 met."},
                                         {"Error < time", times, "Lower is \"better\".", {error_over_time()}},
                                         {"", TextTable({}), "only a caption"}};
  const std::string html = report_html("bench <error>", sections, {"A & B, 2 threads", "abc123+", "2026-01-02"});
  EXPECT_EQ(complaint(html), "");
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_EQ(html.find("http://"), html.find("http://www.w3.org/2000/svg")) << "nothing is fetched from elsewhere";
  EXPECT_EQ(html.find("https://"), std::string::npos);
  for (const char* part : {"<h1>bench &lt;error&gt;</h1>", "A &amp; B, 2 threads · commit abc123+ · 2026-01-02",
                           "<td class=\"met\">yes</td>", "<td class=\"missed\">NO</td>",
                           "<td>not measured: --full</td>", "<td class=\"number\">12.5</td>",
                           "<h2>Error &lt; time</h2>", "Lower is &quot;better&quot;.", "only a caption"}) {
    EXPECT_NE(html.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(count(html, "<svg"), 1U);
  EXPECT_EQ(count(html, "<table>"), 2U);
}

TEST(Html, OriginIsThisMachineAndNow) {
  const ReportOrigin origin = report_origin();
  EXPECT_FALSE(origin.machine.empty());
  EXPECT_FALSE(origin.commit.empty());
  EXPECT_TRUE(std::regex_match(origin.date, std::regex(R"(\d{4}-\d\d-\d\d \d\d:\d\d UTC)"))) << origin.date;
}

}  // namespace
}  // namespace atomesh::cli
