// SPDX-License-Identifier: Apache-2.0
#include "study_page/plot_script.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "core/json_writer.h"
#include "study_page/gnuplot.h"
#include "umbrick/core/pending_file.h"

namespace umbrick::tools {
namespace {

// These are the colours of Okabe and Ito 2008, which colour-blind readers tell apart. Their yellow is too pale
// for a line.
constexpr const char* kColours[]{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000"};
constexpr int kSymbols[]{7, 5, 9, 13, 11, 6, 4};
constexpr double kLevelReach = 30;  // a level so many times below the least error is only in the text

struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  bool empty() const { return !(low <= high); }
  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

bool drawable(const Plot& plot, const PlotPoint& point) {
  return std::isfinite(point.x) && std::isfinite(point.y) && point.y > 0 && (plot.wholeX || point.x > 0);
}

// Returns a plot without what cannot be drawn.
Plot cleaned(Plot plot) {
  for (PlotSeries& series : plot.series)
    std::erase_if(series.points, [&](const PlotPoint& point) { return !drawable(plot, point); });
  std::erase_if(plot.series, [](const PlotSeries& series) { return series.points.empty(); });
  Extent y;
  for (const PlotSeries& series : plot.series)
    for (const PlotPoint& point : series.points) y.include(point.y);
  std::erase_if(plot.levels, [&](const PlotLevel& level) { return !(level.y * kLevelReach > y.low); });
  return plot;
}

std::string ticList(const std::vector<double>& tics) {
  std::string text;
  for (const double tic : tics) text += (text.empty() ? "" : ", ") + jsonNumber(tic);
  return "(" + text + ")";
}

// Returns range with a margin and tics of one axis.
std::string logarithmicAxis(const std::string& axis, const Extent& extent) {
  const double low = extent.low / 1.3, high = extent.high * 1.3;
  return "set logscale " + axis + "\nset " + axis + "range [" + jsonNumber(low) + ":" + jsonNumber(high) + "]\nset " +
         axis + "tics " + ticList(logarithmicTics(low, high)) + "\n";
}

std::string wholeAxis(const Extent& extent, const std::set<double>& values) {
  const double margin = 0.05 * std::max(1.0, extent.high - extent.low);
  return "set xrange [" + jsonNumber(extent.low - margin) + ":" + jsonNumber(extent.high + margin) + "]\nset xtics " +
         ticList({values.begin(), values.end()}) + "\n";
}

std::string axes(const Plot& plot) {
  Extent x, y;
  std::set<double> values;
  for (const PlotSeries& series : plot.series)
    for (const PlotPoint& point : series.points) {
      x.include(point.x);
      if (series.bars && point.low > 0 && std::isfinite(point.high)) {
        x.include(point.low);
        x.include(point.high);
      }
      y.include(point.y);
      values.insert(point.x);
    }
  for (const PlotLevel& level : plot.levels) y.include(level.y);
  return (plot.wholeX ? wholeAxis(x, values) : logarithmicAxis("x", x)) + logarithmicAxis("y", y) + "set xlabel " +
         gnuplotString(plot.xLabel) + "\nset ylabel " + gnuplotString(plot.yLabel) + "\n";
}

// Returns a text as a data file holds it: in double quotes, which it cannot contain itself.
std::string dataString(std::string text) {
  std::erase_if(text, [](char c) { return c == '"' || c == '\n'; });
  return '"' + text + '"';
}

std::string dataOf(const Plot& plot) {
  std::string text = "# x  y  x low  x high  label; a block per series, two empty lines between blocks\n";
  for (const PlotSeries& series : plot.series) {
    text += "# " + series.title + "\n";
    for (const PlotPoint& point : series.points)
      text += jsonNumber(point.x) + " " + jsonNumber(point.y) + " " + jsonNumber(series.bars ? point.low : point.x) +
              " " + jsonNumber(series.bars ? point.high : point.x) + " " + dataString(point.label) + "\n";
    text += "\n\n";
  }
  return text;
}

// The place of a line in the lists of colours and symbols.
struct LineLook {
  std::size_t colour = 0, symbol = 0;
};

// Returns a look for each series; those that are not lines have none of their own.
std::vector<LineLook> linesOf(const Plot& plot) {
  std::vector<LineLook> looks;
  std::map<int, std::size_t> members;  // number of lines so far, by family
  std::size_t alone = 0;
  for (const PlotSeries& series : plot.series) {
    if (series.style != PlotStyle::line)
      looks.push_back({});
    else if (series.family < 0)
      looks.push_back({alone, alone});
    else
      looks.push_back({static_cast<std::size_t>(series.family), members[series.family]++});
    if (series.style == PlotStyle::line && series.family < 0) ++alone;
  }
  return looks;
}

// Appends what is drawn of one series: its own entry, then bars and labels without an entry in the key.
void appendSeries(std::vector<std::string>& parts, const Plot& plot, std::size_t index, const LineLook& look) {
  const PlotSeries& series = plot.series[index];
  const std::string data = gnuplotString(plot.name + ".dat") + " index " + std::to_string(index);
  const std::string title = " title " + gnuplotString(series.title) + " noenhanced";
  if (series.style == PlotStyle::front) {
    parts.push_back(data + " using 1:2 with steps lw 7 lc rgb \"#d9d9d9\"" + title);
    return;
  }
  if (series.style == PlotStyle::earlier) {
    parts.push_back(data + " using 1:2 with linespoints pt 4 ps 0.8 lw 1.2 dt 3 lc rgb \"#777777\"" + title);
    return;
  }
  if (series.style == PlotStyle::points) {
    parts.push_back(data + " using 1:2 with points pt 7 ps 0.45 lc rgb \"#999999\"" + title);
    return;
  }
  const std::string colour = " lc rgb \"" + std::string(kColours[look.colour % std::size(kColours)]) + "\"";
  const std::string symbol = " pt " + std::to_string(kSymbols[look.symbol % std::size(kSymbols)]);
  // Lines of a second round of colours are dashed.
  const std::string dashes = std::max(look.colour, look.symbol) < std::size(kColours) ? "" : " dt 2";
  if (series.bars) parts.push_back(data + " using 1:2:3:4 with xerrorbars pt 0 lw 1" + colour + " notitle");
  parts.push_back(data + " using 1:2 with linespoints lw 1.6 ps 0.8" + symbol + dashes + colour + title);
  const bool labels = std::any_of(series.points.begin(), series.points.end(),
                                  [](const PlotPoint& point) { return !point.label.empty(); });
  if (labels)
    parts.push_back(data + " using 1:2:5 with labels left offset 0.7,0.7 font \",10\"" +
                    " tc rgb \"#555555\" noenhanced notitle");
}

std::string scriptOf(const Plot& plot) {
  std::string text = "# gnuplot " + plot.name + ".gp draws " + plot.name + ".svg from " + plot.name + ".dat\n" +
                     "set terminal svg size 860,470 dynamic font \"Helvetica,13\"" + "\nset output " +
                     gnuplotString(plot.name + ".svg") +
                     "\nset encoding utf8\nset format \"%g\"\nset border 3 lw 0.8\nset tics nomirror out scale 0.6\n"
                     "set grid lc rgb \"#e6e6e6\" lw 0.6\nset key outside right center vertical Left reverse samplen 2 "
                     "spacing 1.25\n" +
                     axes(plot);
  std::vector<std::string> parts;
  const std::vector<LineLook> looks = linesOf(plot);
  // The staircase lies under everything else.
  for (const bool front : {true, false})
    for (std::size_t i = 0; i < plot.series.size(); ++i)
      if ((plot.series[i].style == PlotStyle::front) == front) appendSeries(parts, plot, i, looks[i]);
  for (const PlotLevel& level : plot.levels)
    parts.push_back(jsonNumber(level.y) + " with lines dt 2 lw 1.2 lc rgb \"#666666\" title " +
                    gnuplotString(level.title) + " noenhanced");
  text += "plot ";
  for (std::size_t i = 0; i < parts.size(); ++i) text += (i > 0 ? ", \\\n     " : "") + parts[i];
  return text + "\n";
}

}  // namespace

std::vector<double> logarithmicTics(double low, double high) {
  const double decades = std::log10(high / low);
  const std::vector<double> steps = decades <= 1.2   ? std::vector<double>{1, 1.5, 2, 3, 4, 5, 7}
                                    : decades <= 3.2 ? std::vector<double>{1, 2, 5}
                                                     : std::vector<double>{1};
  std::vector<double> tics;
  const int first = static_cast<int>(std::floor(std::log10(low)));
  const int last = static_cast<int>(std::ceil(std::log10(high)));
  for (int decade = first; decade <= last; ++decade)
    for (const double step : steps) {
      // 10^-3 is a quotient, which gives 0.002 and not 0.0020000000000000001.
      const double tic = decade < 0 ? step / std::pow(10, -decade) : step * std::pow(10, decade);
      if (tic >= low && tic <= high) tics.push_back(tic);
    }
  return tics;
}

std::string gnuplotString(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') quoted += c;
    quoted += c == '\n' ? ' ' : c;
  }
  return quoted + "'";
}

bool drawPlot(const std::filesystem::path& folder, const Plot& given) {
  const Plot plot = cleaned(given);
  if (plot.series.empty()) return false;
  writeTextFile(folder / (plot.name + ".dat"), dataOf(plot));
  writeTextFile(folder / (plot.name + ".gp"), scriptOf(plot));
  runGnuplot(folder / (plot.name + ".gp"));
  return true;
}

}  // namespace umbrick::tools
