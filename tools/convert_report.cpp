#include "convert_report.h"

#include <cstdio>
#include <iostream>

namespace umbrick::tools {

void printReport(const std::string& label, const BuildReport& report, bool dense) {
  const auto share = report.voxels > 0 ? 100.0 * double(report.activeVoxels) / double(report.voxels) : 0.0;
  char line[256];
  const auto print = [&](const char* field, const char* format, auto... values) {
    std::snprintf(line, sizeof line, format, values...);
    std::cout << "  " << field << line << '\n';
  };
  using Count = unsigned long long;
  std::cout << "grid \"" << label << "\"\n";
  print("active voxels   ", "%llu of %llu%s (%.2f %%)", Count(report.activeVoxels), Count(report.voxels),
        dense ? "" : " that were active", share);
  print("leaves, tiles   ", "%llu, %llu", Count(report.leaves), Count(report.activeTiles));
  print("maximum error   ", "%.9g%s", report.maxError + report.conversionError,
        report.maxError > 0 && report.conversionError > 0 ? " at most" : "");
  if (report.conversionError > 0) print("  to float      ", "%.9g", report.conversionError);
  if (report.clippedVoxels > 0)
    print("clipped         ", "%llu voxels, by up to %.9g", Count(report.clippedVoxels), report.maxClipChange);
  if (report.nonFinite > 0) print("not finite      ", "%llu voxels, stored as background", Count(report.nonFinite));
  if (report.backgroundChange > 0) print("background moved", " by %.9g", report.backgroundChange);
}

}  // namespace umbrick::tools
