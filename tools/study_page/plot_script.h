// Writes a plot as gnuplot's script and data, from which anyone can draw it again.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace umbrick::tools {

struct PlotPoint {
  double x = 0, y = 0;
  double low = 0, high = 0;  // range of x, where a series has bars
  std::string label;         // text beside the point; empty: none
};

enum class PlotStyle {
  line,     // points that are joined
  points,   // small grey points
  earlier,  // grey points that are joined: an earlier study
  front,    // a grey staircase under everything else
};

struct PlotSeries {
  std::string title;
  PlotStyle style = PlotStyle::line;
  std::vector<PlotPoint> points;  // in the order in which they are joined
  bool bars = false;              // draw low to high
  int family = -1;                // lines of a family share a colour and differ in symbols; -1: a colour of its own
};

/// A dashed horizontal line.
struct PlotLevel {
  std::string title;
  double y = 0;
};

struct Plot {
  std::string name;  // name of its files: letters, digits and '-'
  std::string xLabel, yLabel;
  bool wholeX = false;  // x counts something, on a linear axis with its values as tics; else both axes are logarithmic
  std::vector<PlotSeries> series;
  std::vector<PlotLevel> levels;
};

/// Returns the tics of a logarithmic axis: seven in each decade, or 1, 2 and 5, or only powers of ten, by how many
/// decades the axis spans.
std::vector<double> logarithmicTics(double low, double high);

/// Returns a text in single quotes: in double quotes gnuplot would run what stands between backquotes.
std::string gnuplotString(const std::string& text);

/// Writes NAME.dat and NAME.gp and draws NAME.svg. Points that a logarithmic axis does not have are left out.
/// @return false: there is nothing to draw, and nothing was written
/// @throw IoError
bool drawPlot(const std::filesystem::path& folder, const Plot& plot);

}  // namespace umbrick::tools
