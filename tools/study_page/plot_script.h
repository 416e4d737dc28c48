// A plot as gnuplot's script and data, from which anyone can draw it again.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace umbrick::tools {

struct PlotPoint {
  double x = 0, y = 0;
  double low = 0, high = 0;  // of x, where a series has bars
  std::string label;         // beside the point; empty: none
};

enum class PlotStyle {
  line,     // points, joined
  points,   // small grey points
  earlier,  // grey, joined: what was before
  front,    // a grey staircase under everything else
};

struct PlotSeries {
  std::string title;
  PlotStyle style = PlotStyle::line;
  std::vector<PlotPoint> points;  // in the order in which they are joined
  bool bars = false;              // draw low to high
  int family = -1;                // lines of a family share a colour and differ in symbols; -1: a colour of its own
};

/// A horizontal line, dashed.
struct PlotLevel {
  std::string title;
  double y = 0;
};

struct Plot {
  std::string name;  // of its files: letters, digits and '-'
  std::string xLabel, yLabel;
  bool wholeX = false;  // x counts something: a linear axis with its values as tics; else both axes are logarithmic
  std::vector<PlotSeries> series;
  std::vector<PlotLevel> levels;
};

/// Tics of a logarithmic axis: seven of each decade, 1, 2 and 5, or powers of ten alone, by how many decades it spans.
std::vector<double> logarithmicTics(double low, double high);

/// A text in single quotes: in double ones gnuplot would run what stands between backquotes.
std::string gnuplotString(const std::string& text);

/// Writes NAME.dat and NAME.gp and draws NAME.svg. Points that a logarithmic axis does not have are left out.
/// @return false: nothing to draw, nothing written
/// @throw IoError
bool drawPlot(const std::filesystem::path& folder, const Plot& plot);

}  // namespace umbrick::tools
