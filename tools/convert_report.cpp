// SPDX-License-Identifier: Apache-2.0
#include "convert_report.h"

#include <cstdio>
#include <iostream>

#include "umbrick/core/error.h"
#include "umbrick/grid/float_grid.h"

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
  // Errors of one step after the other add up to a bound.
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

void printResampled(const ResampleReport& report) {
  char line[256];
  const glm::dvec3& s = report.spacing;
  const auto count = [](std::int64_t voxels) { return static_cast<long long>(voxels); };
  std::snprintf(line, sizeof line, "%lld x %lld x %lld voxels to %lld x %lld x %lld, %.9g x %.9g x %.9g apart",
                count(report.dimsBefore.x), count(report.dimsBefore.y), count(report.dimsBefore.z),
                count(report.dimsAfter.x), count(report.dimsAfter.y), count(report.dimsAfter.z), s.x, s.y, s.z);
  std::cout << "  resampled       " << line << '\n';
  std::snprintf(line, sizeof line, "%.9g at most, RMS %.9g; integral %.9g before, %.9g after", report.max, report.rms,
                report.integralBefore, report.integralAfter);
  std::cout << "    changes       " << line << '\n';
}

void describeResampling(openvdb::FloatGrid& grid, const ResampleReport& report) {
  const glm::dvec3& s = report.spacing;
  grid.insertMeta("resample_spacing", openvdb::Vec3DMetadata({s.x, s.y, s.z}));
  grid.insertMeta("resample_error_max", openvdb::DoubleMetadata(report.max));
  grid.insertMeta("resample_error_rms", openvdb::DoubleMetadata(report.rms));
  grid.insertMeta("resample_integral_before", openvdb::DoubleMetadata(report.integralBefore));
  grid.insertMeta("resample_integral_after", openvdb::DoubleMetadata(report.integralAfter));
}

void printVerified(const VerifyReport& seen) {
  char line[256];
  std::snprintf(line, sizeof line, "%llu voxels read back, maximum error %.9g, RMS %.9g",
                static_cast<unsigned long long>(seen.voxels), seen.error.max, seen.error.rms);
  std::cout << "  verified        " << line << '\n';
}

void checkVerified(const std::filesystem::path& output, const std::string& label, const VerifyReport& seen,
                   const BuildReport& stated) {
  if (seen.honours(stated)) return;
  char line[320];
  std::snprintf(line, sizeof line,
                "expected at most a maximum error of %.9g and an RMS of %.9g, found %.9g and %.9g; %llu voxels that "
                "should be background are not, %llu are beyond the volume; nothing was written",
                stated.maxError, stated.rmsError, seen.error.max, seen.error.rms,
                static_cast<unsigned long long>(seen.wrongly), static_cast<unsigned long long>(seen.beyond));
  throw Error(output.string() + ": grid \"" + label + "\": verification failed: " + line);
}

}  // namespace umbrick::tools
