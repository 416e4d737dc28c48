// Converts a volume of any format into a sparse .vdb, and says what that did to it:
//   convert_a_scan INPUT OUTPUT.vdb            formats that say what is in them
//   convert_a_scan INPUT OUTPUT.vdb X Y Z      so many voxels of 16 bits without a header, packed or not
// SPDX-License-Identifier: Apache-2.0
#include <umbrick/convert/convert.h>

#include <cstdio>
#include <cstdlib>
#include <exception>

int main(int count, char** arguments) try {
  if (count != 3 && count != 6) {
    std::fprintf(stderr, "usage: convert_a_scan INPUT OUTPUT.vdb [X Y Z]\n");
    return 2;
  }
  umbrick::ConvertOptions options;
  if (count == 6)
    options.source.open.raw =
        umbrick::RawOptions{.dims = {std::atoi(arguments[3]), std::atoi(arguments[4]), std::atoi(arguments[5])},
                            .type = umbrick::VoxelType::u16};
  options.build.maxError = 1.0f;  // no voxel is off by more than one grid unit
  options.verify = true;          // the file is read back and compared before it takes its name
  const umbrick::ConvertReport report = umbrick::convert({arguments[1]}, arguments[2], options);

  for (const umbrick::ConvertedGrid& grid : report.grids)
    std::printf("%s: grid \"%s\", %.1f %% of %llu voxels active, no voxel off by more than %g, stored as %s\n",
                report.output.c_str(), grid.label.c_str(),
                100.0 * static_cast<double>(grid.build.activeVoxels) / static_cast<double>(grid.build.voxels),
                static_cast<unsigned long long>(grid.build.voxels), grid.build.maxError, grid.build.storage.c_str());
  std::printf("%lld bytes became %lld\n", static_cast<long long>(report.bytesIn),
              static_cast<long long>(report.bytesOut));
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "convert_a_scan: %s\n", error.what());
  return 1;
}
