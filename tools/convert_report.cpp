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
  print("stored as       ", "%s", report.storage.c_str());
  print("maximum error   ", "%.9g%s", report.maxError + report.conversionError,
        report.maxError > 0 && report.conversionError > 0 ? " at most" : "");
  if (report.rmsError > 0)
    print("RMS error       ", "%.9g over all voxels, %.9g over the active ones", report.rmsError,
          report.activeRmsError);
  if (report.tolerance.max > 0) print("  tolerance     ", "%.9g, RMS %.9g", report.tolerance.max, report.tolerance.rms);
  if (report.rounding.max > 0) print("  rounding      ", "%.9g, RMS %.9g", report.rounding.max, report.rounding.rms);
  if (report.conversionError > 0) print("  to float      ", "%.9g", report.conversionError);
  if (report.clippedVoxels > 0)
    print("clipped         ", "%llu voxels, by up to %.9g", Count(report.clippedVoxels), report.maxClipChange);
  if (report.nonFinite > 0) print("not finite      ", "%llu voxels, stored as background", Count(report.nonFinite));
  if (report.backgroundChange > 0) print("background moved", " by %.9g", report.backgroundChange);
}

void printBackground(const BorderMode& mode) {
  char line[128];
  std::snprintf(line, sizeof line, "background %.9g, the value of %.2f %% of %llu voxels on the border",
                static_cast<double>(mode.value), 100.0 * double(mode.voxels) / double(mode.border),
                static_cast<unsigned long long>(mode.border));
  std::cout << line << '\n';
}

void printMasked(std::uint64_t voxels) { std::cout << "  masked          " << voxels << " voxels\n"; }

bool printVerified(const VerifyReport& seen, const BuildReport& stated) {
  char line[256];
  std::snprintf(line, sizeof line, "%llu voxels read back, maximum error %.9g, RMS %.9g",
                static_cast<unsigned long long>(seen.voxels), seen.error.max, seen.error.rms);
  std::cout << "  verified        " << line << '\n';
  if (seen.honours(stated)) return true;
  std::snprintf(line, sizeof line,
                "expected at most a maximum error of %.9g and an RMS of %.9g, found %.9g and %.9g; %llu voxels that "
                "should be background are not, %llu are beyond the volume",
                stated.maxError, stated.rmsError, seen.error.max, seen.error.rms,
                static_cast<unsigned long long>(seen.wrongly), static_cast<unsigned long long>(seen.beyond));
  std::cerr << "umbrick: verification failed: " << line << '\n';
  return false;
}

}  // namespace umbrick::tools
