// SPDX-License-Identifier: Apache-2.0
#include "convert_report.h"

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <set>
#include <sstream>

#include "umbrick/core/printable.h"

namespace umbrick::tools {
namespace {

using Count = unsigned long long;

// A line of a report: the field, and what std::snprintf makes of the values.
template <class... Values>
void print(const char* field, const char* format, Values... values) {
  char line[256];
  std::snprintf(line, sizeof line, format, values...);
  std::cout << "  " << field << line << '\n';
}

// Errors of one step after the other add up to a bound.
void printErrors(const BuildReport& report) {
  const bool before = report.tolerance.max > 0 || report.rounding.max > 0, then = report.quantising.max > 0;
  print("maximum error   ", "%.9g%s", report.maxError + report.conversionError,
        int(before) + int(then) + int(report.conversionError > 0) > 1 ? " at most" : "");
  if (report.rmsError > 0)
    print("RMS error       ", "%.9g over all voxels, %.9g over the active ones%s", report.rmsError,
          report.activeRmsError, before && then ? ", at most" : "");
  if (report.tolerance.max > 0) print("  tolerance     ", "%.9g, RMS %.9g", report.tolerance.max, report.tolerance.rms);
  if (report.rounding.max > 0) print("  rounding      ", "%.9g, RMS %.9g", report.rounding.max, report.rounding.rms);
  if (then) print("  quantising    ", "%.9g, RMS %.9g", report.quantising.max, report.quantising.rms);
  if (report.conversionError > 0) print("  to float      ", "%.9g", report.conversionError);
}

void printBuild(const BuildReport& report, bool dense) {
  const auto share = report.voxels > 0 ? 100.0 * double(report.activeVoxels) / double(report.voxels) : 0.0;
  print("active voxels   ", "%llu of %llu%s (%.2f %%)", Count(report.activeVoxels), Count(report.voxels),
        dense ? "" : " that were active", share);
  print("leaves, tiles   ", "%llu, %llu", Count(report.leaves), Count(report.activeTiles));
  print("stored as       ", "%s", report.storage.c_str());
  printErrors(report);
  if (report.clippedVoxels > 0)
    print("clipped         ", "%llu voxels, by up to %.9g", Count(report.clippedVoxels), report.maxClipChange);
  if (report.nonFinite > 0) print("not finite      ", "%llu voxels, stored as background", Count(report.nonFinite));
  if (report.backgroundChange > 0) print("background moved", " by %.9g", report.backgroundChange);
}

void printIsosurface(const IsosurfaceReport& report, float value) {
  print("level set       ", "at %.9g, voxels %.9g apart; %llu active, %llu leaves", double(value), report.voxelSize,
        Count(report.activeVoxels), Count(report.leaves));
  print("off by          ", "%.3g voxels at most, RMS %.3g, where %llu edges of the volume cross the value",
        report.maxError, report.rmsError, Count(report.crossings));
}

void printResampled(const ResampleReport& report) {
  const glm::dvec3& s = report.spacing;
  const auto count = [](std::int64_t voxels) { return static_cast<long long>(voxels); };
  print("resampled       ", "%lld x %lld x %lld voxels to %lld x %lld x %lld, %.9g x %.9g x %.9g apart",
        count(report.dimsBefore.x), count(report.dimsBefore.y), count(report.dimsBefore.z), count(report.dimsAfter.x),
        count(report.dimsAfter.y), count(report.dimsAfter.z), s.x, s.y, s.z);
  print("  changes       ", "%.9g at most, RMS %.9g; integral %.9g before, %.9g after", report.max, report.rms,
        report.integralBefore, report.integralAfter);
}

void printGrid(const ConvertedGrid& grid, const ConvertOptions& options) {
  std::cout << "grid \"" << printable(grid.label) << "\"\n";
  if (grid.isosurface)
    printIsosurface(*grid.isosurface, options.isosurface->value);
  else
    printBuild(grid.build, grid.volumeType.has_value());
  if (grid.volumeLabel) print("label           ", "%lld", static_cast<long long>(grid.volumeLabel->value));
  if (grid.masked) print("masked          ", "%llu voxels", Count(*grid.masked));
  if (grid.resampled) printResampled(*grid.resampled);
  if (grid.verified)
    print("verified        ", "%llu voxels read back, maximum error %.9g, RMS %.9g", Count(grid.verified->voxels),
          grid.verified->error.max, grid.verified->error.rms);
}

}  // namespace

void printBackground(const BorderMode& mode) {
  char line[128];
  std::snprintf(line, sizeof line, "background %.9g, the value of %.2f %% of %llu voxels on the border",
                static_cast<double>(mode.value), 100.0 * double(mode.voxels) / double(mode.border), Count(mode.border));
  std::cout << line << '\n';
}

void printReport(const ConvertReport& report, const ConvertOptions& options) {
  for (const ConvertedGrid& grid : report.grids)
    if (grid.background) printBackground(*grid.background);
  for (const ConvertedGrid& grid : report.grids) printGrid(grid, options);
}

void printFrame(const ConvertReport& report) {
  std::uint64_t active = 0, voxels = 0;
  double error = 0;
  std::optional<double> levelSetError;  // voxels; counts in place of that of values
  for (const ConvertedGrid& grid : report.grids) {
    active += grid.build.activeVoxels;
    voxels += grid.build.voxels;
    error = std::max(error, grid.build.maxError + grid.build.conversionError);
    if (grid.isosurface) levelSetError = std::max(levelSetError.value_or(0), grid.isosurface->maxError);
  }
  char line[192];
  std::snprintf(line, sizeof line, "%llu of %llu voxels active, %s %.9g%s, %lld bytes", Count(active), Count(voxels),
                levelSetError ? "level set off by" : "maximum error", levelSetError.value_or(error),
                levelSetError ? " voxels at most" : "", static_cast<long long>(report.bytesOut));
  std::ostringstream extras;
  extras.precision(9);
  const ConvertedGrid& first = report.grids.front();
  if (first.background) extras << ", background " << first.background->value;
  if (first.verified) extras << ", verified";
  std::cout << printable(report.output.string()) << ": " << line << extras.str() << std::endl;
}

void printNotes(const ConvertReport& report, std::set<std::string>* said) {
  for (const ConvertedGrid& grid : report.grids)
    for (const std::string& note : grid.notes)
      if (!said || said->insert(note).second) std::cerr << printable(grid.input.string() + ": " + note) << '\n';
  for (const std::string& note : report.notes)
    if (!said || said->insert(note).second) std::cerr << printable(report.output.string() + ": " + note) << '\n';
}

std::string usualLine(const ConvertedGrid& grid) {
  char line[256];
  const double all = double(grid.build.voxels);
  const char* name = grid.label.c_str();
  if (grid.build.activeVoxels == 0 && !grid.isosurface)
    std::snprintf(line, sizeof line,
                  "grid \"%.64s\": nothing is left: each voxel is background, or left out by what was asked for", name);
  else if (grid.usual)
    std::snprintf(line, sizeof line,
                  "grid \"%.64s\": %.1f %% of its voxels are %.9g and active, since the background is another value: "
                  "--background auto or %.9g leaves them out",
                  name, 100.0 * double(grid.usual->voxels) / all, double(grid.usual->value), double(grid.usual->value));
  else if (grid.border)
    std::snprintf(line, sizeof line,
                  "grid \"%.64s\": %.1f %% of its voxels are active, and its border is mostly %.9g: --background auto, "
                  "--threshold or --tolerance leave out what is of no interest",
                  name, 100.0 * double(grid.build.activeVoxels) / all, double(*grid.border));
  else
    return {};
  return line;
}

std::string keptLine(const ConvertedGrid& grid) {
  if (!grid.keptLevelSet) return {};
  return "grid \"" + grid.label +
         "\" is a level set: --background, --tolerance, --threshold and --range do not apply to it";
}

void printWarnings(const ConvertReport& report) {
  const auto print = [](const ConvertedGrid& grid, const std::string& line) {
    if (!line.empty()) std::cerr << printable(grid.input.string() + ": " + line) << '\n';
  };
  for (const ConvertedGrid& grid : report.grids) print(grid, usualLine(grid));
  for (const LeftOutGrid& grid : report.leftOut)
    std::cerr << printable(report.grids.front().input.string()) << ": grid \"" << printable(grid.label)
              << "\" is left out: expected a scalar grid, found " << grid.type << '\n';
  for (const ConvertedGrid& grid : report.grids) print(grid, keptLine(grid));
}

}  // namespace umbrick::tools
