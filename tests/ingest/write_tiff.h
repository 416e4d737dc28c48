// TIFF files that tests write with libtiff.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <tiffio.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <type_traits>
#include <vector>

namespace umbrick {

using Tag = std::function<void(TIFF*)>;

// Pages of 3 x 2 pixels, unless `tags` says otherwise, written by libtiff.
template <class T>
void writeTiff(const std::filesystem::path& path, const std::vector<std::vector<T>>& pages, const Tag& tags = {},
               const char* mode = "w") {
  TIFF* tiff = TIFFOpen(path.c_str(), mode);
  for (const std::vector<T>& page : pages) {
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 3);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, static_cast<int>(page.size() / 3));
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, static_cast<int>(8 * sizeof(T)));
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT,
                 std::is_floating_point_v<T> ? SAMPLEFORMAT_IEEEFP
                 : std::is_signed_v<T>       ? SAMPLEFORMAT_INT
                                             : SAMPLEFORMAT_UINT);
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 1);
    if (tags) tags(tiff);
    std::vector<T> rows = page;
    const std::size_t rowValues = static_cast<std::size_t>(TIFFScanlineSize(tiff)) / sizeof(T);
    for (std::size_t row = 0; row * rowValues < rows.size(); ++row)
      TIFFWriteScanline(tiff, rows.data() + row * rowValues, static_cast<std::uint32_t>(row), 0);
    TIFFWriteDirectory(tiff);
  }
  TIFFClose(tiff);
}

}  // namespace umbrick
