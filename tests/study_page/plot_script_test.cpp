// SPDX-License-Identifier: Apache-2.0
#include "study_page/plot_script.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>

#include "study_page/gnuplot.h"
#include "support/complaint.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"

using namespace umbrick;
using namespace umbrick::tools;
using Catch::Contains;

TEST_CASE("A logarithmic axis has between 3 and 10 tics, inside its range", "[study_page]") {
  for (const double low : {3e-7, 0.04, 1.0, 70.0})
    for (const double factor : {3.0, 12.0, 90.0, 900.0, 1e5}) {
      CAPTURE(low, factor);
      const std::vector<double> tics = logarithmicTics(low, low * factor);
      CHECK(tics.size() >= 3);
      CHECK(tics.size() <= 10);
      for (const double tic : tics) CHECK((tic >= low && tic <= low * factor));
      CHECK(std::is_sorted(tics.begin(), tics.end()));
    }
}

TEST_CASE("Texts reach the plot as they are", "[study_page]") {
  const TemporaryFolder folder;
  Plot plot;
  plot.name = "names";
  plot.xLabel = "d";
  plot.yLabel = "error";
  plot.series.push_back(
      {"a \"b\" \\c {/d} x_y^2 $e `f` <g> & 'h'", PlotStyle::line, {{1, 2, 0, 0, "at"}, {2, 3, 0, 0, {}}}});
  REQUIRE(drawPlot(folder.path(), plot));
  CHECK_THAT(readBytes(folder.path() / "names.svg"), Contains("a \"b\" \\c {/d} x_y^2 $e `f` &lt;g> &amp; 'h'"));
}

TEST_CASE("Points that a logarithmic axis does not have are left out, and an empty plot is none", "[study_page]") {
  const TemporaryFolder folder;
  Plot plot;
  plot.name = "zeros";
  plot.series.push_back({"s", PlotStyle::line, {{1, 0, 0, 0, {}}, {0, 1, 0, 0, {}}, {2, std::nan(""), 0, 0, {}}}});
  CHECK(!drawPlot(folder.path(), plot));
  CHECK(std::filesystem::is_empty(folder.path()));
  plot.series[0].points.push_back({3, 0.25, 0, 0, {}});
  CHECK(drawPlot(folder.path(), plot));
  CHECK_THAT(readBytes(folder.path() / "zeros.dat"), Contains("\n3 0.25 ") && !Contains("nan") && !Contains("\n1 0 "));
}

TEST_CASE("Lines of a family share their colour and differ in symbols, and families differ in colour", "[study_page]") {
  const TemporaryFolder folder;
  Plot plot;
  plot.name = "families";
  for (const int family : {0, 0, 1})
    plot.series.push_back({"s", PlotStyle::line, {{1, 1, 0, 0, {}}, {2, 2, 0, 0, {}}}, false, family});
  REQUIRE(drawPlot(folder.path(), plot));
  const std::string script = readBytes(folder.path() / "families.gp");
  std::vector<std::string> colours, symbols;
  for (std::size_t at = 0; (at = script.find(" pt ", at)) != std::string::npos; ++at) {
    symbols.push_back(script.substr(at + 4, script.find(' ', at + 4) - at - 4));
    colours.push_back(script.substr(script.find("rgb", at), 13));
  }
  REQUIRE(colours.size() == 3);
  CHECK(colours[0] == colours[1]);
  CHECK(colours[0] != colours[2]);
  CHECK(symbols[0] != symbols[1]);
  CHECK(symbols[0] == symbols[2]);
}

TEST_CASE("A script that gnuplot cannot read is reported with what it says", "[study_page]") {
  const TemporaryFolder folder;
  writeBytes(folder.path() / "bad.gp", "set terminal svg\nset nonsense 3\n");
  const std::string message = complaint<IoError>([&] { runGnuplot(folder.path() / "bad.gp"); });
  CHECK_THAT(message, Contains("bad.gp: gnuplot failed: ") && Contains("line 2"));
  CHECK_THAT(gnuplotVersion(), Contains("gnuplot 5") || Contains("gnuplot 6"));
}
