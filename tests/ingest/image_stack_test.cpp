// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/image_stack.h"

#include <png.h>

#include <catch2/catch.hpp>
#include <map>

#include "ingest/write_tiff.h"
#include "support/files.h"
#include "support/read_volume.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/ingest/open_volume.h"

using namespace umbrick;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

void writePng(const fs::path& path, int width, int height, int bits, int colour, std::string pixels) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  std::FILE* file = std::fopen(path.c_str(), "wb");
  png_init_io(png, file);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits, colour,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  const std::size_t rowBytes = pixels.size() / static_cast<std::size_t>(height);
  for (std::size_t row = 0; row < static_cast<std::size_t>(height); ++row)
    png_write_row(png, reinterpret_cast<png_bytep>(pixels.data()) + row * rowBytes);
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
}

struct Stack {
  TemporaryFolder folder;
  fs::path path = folder.path() / "v.tif";
  std::vector<float> read() const { return readVolume(*openImageStack(path)); }
  void refused(const fs::path& what, const std::string& message) const {
    CHECK_THROWS_AS(readVolume(*openImageStack(what)), IoError);
    CHECK_THROWS_WITH(readVolume(*openImageStack(what)), Contains(message) && Contains(folder.path().string()));
  }
};

template <class T>
void checkTiff(const Stack& stack, VoxelType type) {
  const std::vector<std::vector<T>> pages{{1, 2, 3, 4, 5, 6}, {7, 8, 9, T(-10), 11, 12}};
  std::vector<float> expected;
  for (const auto& page : pages) expected.insert(expected.end(), page.begin(), page.end());
  for (const char* mode : {"wl", "wb", "w8"})
    for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE}) {
      writeTiff(
          stack.path, pages, [&](TIFF* t) { TIFFSetField(t, TIFFTAG_COMPRESSION, compression); }, mode);
      CHECK(openImageStack(stack.path)->info().type == type);
      CHECK(stack.read() == expected);
    }
}

}  // namespace

TEST_CASE("Pages of a TIFF are slices, in every type, byte order and packing", "[ingest]") {
  const Stack stack;
  checkTiff<std::uint8_t>(stack, VoxelType::u8);
  checkTiff<std::uint16_t>(stack, VoxelType::u16);
  checkTiff<std::int16_t>(stack, VoxelType::i16);
  checkTiff<std::int32_t>(stack, VoxelType::i32);
  checkTiff<float>(stack, VoxelType::f32);
  checkTiff<double>(stack, VoxelType::f64);
  const auto source = openVolume(stack.path);
  CHECK(source->info().dims == glm::i64vec3(3, 2, 2));
  CHECK(source->info().metadata.at("source_format") == "TIFF");
}

TEST_CASE("Tiles of a TIFF are cut at the edge of the image", "[ingest]") {
  const Stack stack;
  const int width = 20, height = 18;  // of tiles of 16 x 16
  TIFF* tiff = TIFFOpen(stack.path.c_str(), "w");
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 16);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_TILEWIDTH, 16);
  TIFFSetField(tiff, TIFFTAG_TILELENGTH, 16);
  for (std::uint32_t y = 0; y < height; y += 16)
    for (std::uint32_t x = 0; x < width; x += 16) {
      std::vector<std::uint16_t> tile(16 * 16);
      for (std::uint32_t i = 0; i < 256; ++i) tile[i] = static_cast<std::uint16_t>(x + i % 16 + 100 * (y + i / 16));
      TIFFWriteTile(tiff, tile.data(), x, y, 0, 0);
    }
  TIFFClose(tiff);
  const std::vector<float> voxels = stack.read();
  REQUIRE(voxels.size() == width * height);
  for (int i = 0; i < width * height; ++i)
    CHECK(voxels[static_cast<std::size_t>(i)] == static_cast<float>(i % width + 100 * (i / width)));
}

TEST_CASE("Files are slices in the order of their numbers: pattern, glob and folder agree", "[ingest]") {
  const Stack stack;
  const auto at = [&](const char* name) { return stack.folder.path() / name; };
  writePng(at("s9.png"), 2, 1, 16, PNG_COLOR_TYPE_GRAY, std::string("\1\2\0\3", 4));
  writePng(at("s10.png"), 2, 1, 16, PNG_COLOR_TYPE_GRAY, std::string("\0\4\0\5", 4));
  const std::vector<float> expected{258, 3, 4, 5};
  for (const fs::path& path : {at("s%d.png"), at("s*.png"), stack.folder.path()}) {
    const auto source = openVolume(path);
    CHECK(source->info().dims == glm::i64vec3(2, 1, 2));
    CHECK(readVolume(*source) == expected);
  }
  writePng(at("s12.png"), 2, 1, 16, PNG_COLOR_TYPE_GRAY, std::string("\0\4\0\5", 4));
  stack.refused(at("s%d.png"), "expected a file for each number from 9 to 12, found no s11.png");
  writePng(at("s11.png"), 1, 2, 16, PNG_COLOR_TYPE_GRAY, std::string("\0\4\0\5", 4));
  stack.refused(at("s%d.png"), "s11.png: expected 2 x 1 u16 as in s9.png, found 1 x 2 u16");
  stack.refused(at("t%d.png"), "expected files of that pattern, found none");
  writeTiff<std::uint8_t>(at("s13.tif"), {{1, 2, 3}});
  stack.refused(stack.folder.path(), "expected images of one kind, found s9.png and s13.tif");
  fs::remove(at("s13.tif"));
  fs::remove(at("s11.png"));
  writeBytes(at("._s10.png"), "what macOS leaves on other disks");
  writeBytes(at(".hidden.tif"), "no image");
  CHECK(openVolume(stack.folder.path())->info().dims.z == 3);
}

TEST_CASE("Bits of a PNG become values as they are stored", "[ingest]") {
  const Stack stack;
  writePng(stack.path, 4, 2, 1, PNG_COLOR_TYPE_GRAY, "\xA0\x50");
  CHECK(stack.read() == std::vector<float>{1, 0, 1, 0, 0, 1, 0, 1});
}

// ImageJ: "unit" is that of the resolution, "spacing" the distance of pages.
TEST_CASE("ImageJ's TIFF states spacing in its unit", "[ingest]") {
  const Stack stack;
  writeTiff<std::uint8_t>(stack.path, {{1, 2, 3}, {4, 5, 6}}, [](TIFF* t) {
    TIFFSetField(t, TIFFTAG_IMAGEDESCRIPTION, "ImageJ=1.53\nimages=2\nslices=2\nunit=micron\nspacing=3.5\n");
    TIFFSetField(t, TIFFTAG_XRESOLUTION, 4.0);
    TIFFSetField(t, TIFFTAG_YRESOLUTION, 2.0);
  });
  const VolumeInfo info = openImageStack(stack.path)->info();
  CHECK(info.indexToWorld[0][0] == Approx(0.25e-3));
  CHECK(info.indexToWorld[1][1] == Approx(0.5e-3));
  CHECK(info.indexToWorld[2][2] == Approx(3.5e-3));
  CHECK(info.metadata.at("length_unit") == "mm");
}

TEST_CASE("Images of several numbers a pixel give them side by side, however they lie in the file", "[ingest]") {
  const Stack stack;
  const auto all = [&] {
    PartChoice parts;
    parts.allComponents = true;
    const auto source = openImageStack(stack.path, parts);
    CHECK(source->info().meaning == VoxelMeaning::colour);
    std::vector<float> out(static_cast<std::size_t>(source->info().dims.x * source->info().valuesPerVoxel));
    source->readSlab(1, out);
    return out;
  };
  const std::vector<float> colours{1, 2, 3, 4, 5, 6};
  writePng(stack.path, 2, 1, 8, PNG_COLOR_TYPE_RGB, "\1\2\3\4\5\6");
  CHECK(all() == colours);
  writePng(stack.path, 1, 1, 8, PNG_COLOR_TYPE_RGB_ALPHA, "\1\2\3\4");
  CHECK(all() == std::vector<float>{1, 2, 3, 4});
  writePng(stack.path, 1, 1, 16, PNG_COLOR_TYPE_GRAY_ALPHA, std::string("\1\0\0\2", 4));
  CHECK(all() == std::vector<float>{256, 2});
  for (const int planes : {PLANARCONFIG_CONTIG, PLANARCONFIG_SEPARATE}) {
    TIFF* tiff = TIFFOpen(stack.path.c_str(), "w");
    for (const auto& [tag, value] : std::map<std::uint32_t, int>{{TIFFTAG_IMAGEWIDTH, 2},
                                                                 {TIFFTAG_IMAGELENGTH, 1},
                                                                 {TIFFTAG_BITSPERSAMPLE, 16},
                                                                 {TIFFTAG_SAMPLESPERPIXEL, 3},
                                                                 {TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB},
                                                                 {TIFFTAG_PLANARCONFIG, planes}})
      TIFFSetField(tiff, tag, value);
    std::vector<std::uint16_t> pixels{1, 2, 3, 4, 5, 6};
    if (planes == PLANARCONFIG_CONTIG)
      TIFFWriteScanline(tiff, pixels.data(), 0, 0);
    else
      for (std::uint16_t k = 0; k < 3; ++k) {
        std::vector<std::uint16_t> plane{std::uint16_t(1 + k), std::uint16_t(4 + k)};
        TIFFWriteScanline(tiff, plane.data(), 0, k);
      }
    TIFFClose(tiff);
    CHECK(all() == colours);
    PartChoice green;
    green.component = 1;
    CHECK(readVolume(*openImageStack(stack.path, green)) == std::vector<float>{2, 5});
  }
  CHECK_THROWS_AS(openImageStack(stack.path), SeveralParts);
}

TEST_CASE("Palettes and YCbCr of TIFF become RGB", "[ingest]") {
  const Stack stack;
  const auto colours = [&](std::int64_t page) {
    PartChoice parts;
    parts.allComponents = true;
    const auto source = openImageStack(stack.path, parts);
    CHECK(source->info().components == 3);
    CHECK(source->info().meaning == VoxelMeaning::colour);
    CHECK(source->info().type == VoxelType::u8);
    std::vector<float> out(static_cast<std::size_t>(source->info().dims.x * source->info().dims.y * 3));
    source->skipSlices(page);
    source->readSlab(1, out);
    return out;
  };
  // Entries of a palette have 16 bits, of which the upper ones count; 257 times a byte is the same byte twice.
  for (const int bits : {4, 8}) {
    std::vector<std::uint16_t> red(1u << bits), green(red.size()), blue(red.size());
    for (std::size_t i = 0; i < red.size(); ++i) {
      red[i] = static_cast<std::uint16_t>(257 * i);
      green[i] = static_cast<std::uint16_t>(257 * (255 - i));
      blue[i] = 257 * 7;
    }
    const auto tags = [&](TIFF* tiff) {
      TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_PALETTE);
      TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
      if (bits == 4) TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 2);
      if (bits == 4) TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 3);
      TIFFSetField(tiff, TIFFTAG_COLORMAP, red.data(), green.data(), blue.data());
    };
    if (bits == 8) {
      writeTiff<std::uint8_t>(stack.path, {{0, 1, 2, 3, 254, 255}, {9, 8, 7, 6, 5, 4}}, tags);
      CHECK(colours(1) == std::vector<float>{9, 246, 7, 8, 247, 7, 7, 248, 7, 6, 249, 7, 5, 250, 7, 4, 251, 7});
    } else {
      writeTiff<std::uint8_t>(stack.path, {{0x01, 0x23, 0xef}}, tags);  // two pixels a byte, the upper one first
      CHECK(colours(0) == std::vector<float>{0, 255, 7, 1, 254, 7, 2, 253, 7, 3, 252, 7, 14, 241, 7, 15, 240, 7});
    }
  }
  // Grey, and what CCIR 601 makes of red: Y = 0.299 * 255, Cb = 128 - 0.1687 * 255, Cr = 255.
  writeTiff<std::uint8_t>(stack.path, {{100, 128, 128, 76, 85, 255}}, [](TIFF* tiff) {
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 2);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 1);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 3);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_YCBCR);
    TIFFSetField(tiff, TIFFTAG_YCBCRSUBSAMPLING, 1, 1);
  });
  const std::vector<float> converted = colours(0), expected{100, 100, 100, 255, 0, 0};
  for (std::size_t i = 0; i < expected.size(); ++i)
    CHECK(converted[i] == Approx(expected[i]).margin(1.5));  // three roundings to whole numbers
  PartChoice green;
  green.component = 1;
  CHECK(readVolume(*openImageStack(stack.path, green))[0] == Approx(100).margin(1.5));
}

TEST_CASE("Images that are no slices are refused with both values", "[ingest]") {
  const Stack stack;
  writeTiff<std::uint8_t>(stack.path, {{1, 2, 3}, {1, 2, 3, 4, 5, 6}});
  stack.refused(stack.path, "page 2: expected 3 x 1 u8 as on the first, found \"3 x 2 u8\"");
  writeBytes(stack.path, "no image");
  stack.refused(stack.path, "expected a TIFF or PNG image, found other first bytes");
}

// libtiff takes a cut link to the next page for the end: nothing is missing then from what is left of the file.
TEST_CASE("Cut images are refused, wherever they end within pixels or heads", "[ingest]") {
  const Stack stack;
  writeTiff<std::uint8_t>(stack.path, {{1, 2, 3, 4, 5, 6}});
  const std::string tiff = readBytes(stack.path);
  writePng(stack.path, 2, 1, 8, PNG_COLOR_TYPE_GRAY, "ab");
  for (const std::string& good : {tiff, readBytes(stack.path)})
    for (std::size_t length = 0; length < good.size() - 4; ++length) {  // the last four are no pixels
      writeBytes(stack.path, good.substr(0, length));
      INFO(good.size() << " bytes cut to " << length);
      CHECK_THROWS_AS(stack.read(), IoError);
    }
}
