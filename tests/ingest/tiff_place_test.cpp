// What TIFF files say of their slices: OME-XML, ImageJ's lines, tifffile's shape and the tags.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "fuzz/described_tiff.h"
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

using Pages = std::vector<std::vector<std::uint8_t>>;

struct DescribedTiff {
  TemporaryFolder folder;
  fs::path path = folder.path() / "v.ome.tif";
  void write(const std::string& description, int pages, float perUnit = 0, int unit = 0, const char* name = nullptr,
             int first = 0) const {
    Pages all;
    for (int i = 0; i < pages; ++i) all.push_back({std::uint8_t(first + i), 1, 2});
    writeTiff<std::uint8_t>(name ? folder.path() / name : path, all, [&](TIFF* t) {
      if (!description.empty()) TIFFSetField(t, TIFFTAG_IMAGEDESCRIPTION, description.c_str());
      if (perUnit > 0) {
        TIFFSetField(t, TIFFTAG_XRESOLUTION, perUnit);
        TIFFSetField(t, TIFFTAG_YRESOLUTION, perUnit);
      }
      if (unit > 0) TIFFSetField(t, TIFFTAG_RESOLUTIONUNIT, unit);
    });
  }
  VolumeInfo info() const { return openVolume(path)->info(); }
  // The first voxel of each slice, which is the number of its page.
  std::vector<int> order() const {
    const auto source = openVolume(path);
    const std::vector<float> voxels = readVolume(*source);
    std::vector<int> out;
    for (std::size_t i = 0; i < voxels.size(); i += 3) out.push_back(static_cast<int>(voxels[i]));
    return out;
  }
  void refused(const std::string& message) const {
    CHECK_THROWS_AS(order(), IoError);
    CHECK_THROWS_WITH(order(), Contains(message) && Contains(folder.path().string()));
  }
  glm::dvec3 spacing(const fs::path& of = {}) const {
    const glm::dmat4 m = openVolume(of.empty() ? path : of)->info().indexToWorld;
    return {m[0][0], m[1][1], m[2][2]};
  }
};

void checkSpacing(const glm::dvec3& found, const glm::dvec3& expected) {
  for (int axis = 0; axis < 3; ++axis) CHECK(found[axis] == Approx(expected[axis]).epsilon(1e-6));
}

std::string ome(int z, const std::string& more, const std::string& inside = "<Channel Name=\"DAPI\"/>", int c = 1,
                int t = 1) {
  return "<?xml version=\"1.0\"?>\n<OME xmlns=\"http://www.openmicroscopy.org/Schemas/OME/2016-06\">"
         "<Image ID=\"Image:0\"><Pixels DimensionOrder=\"XYCZT\" SizeX=\"3\" SizeY=\"1\" SizeZ=\"" +
         std::to_string(z) + "\" SizeC=\"" + std::to_string(c) + "\" SizeT=\"" + std::to_string(t) + "\" " + more +
         ">" + inside + "</Pixels></Image></OME>";
}

const std::string kSizes = "PhysicalSizeX=\"0.5\" PhysicalSizeY=\"0.25\" PhysicalSizeZ=\"2\" ";

}  // namespace

TEST_CASE("OME-XML states sizes of voxels in its units, which are micrometres unless it says", "[ingest]") {
  const DescribedTiff file;
  file.write(ome(3, kSizes), 3);
  checkSpacing(file.spacing(), {0.5e-3, 0.25e-3, 2e-3});
  CHECK(file.info().metadata.at("length_unit") == "mm");
  CHECK(file.order() == std::vector<int>{0, 1, 2});
  file.write(ome(3, kSizes + "PhysicalSizeXUnit=\"mm\" PhysicalSizeYUnit=\"cm\" PhysicalSizeZUnit=\"nm\""), 3);
  checkSpacing(file.spacing(), {0.5, 2.5, 2e-6});
  file.write(ome(3, "PhysicalSizeX=\"0.5\" PhysicalSizeY=\"0.5\" "), 3);
  checkSpacing(file.spacing(), {0.5e-3, 0.5e-3, 0.5e-3});
  CHECK_THAT(file.info().notes.at(0), Contains("the distance of slices is not stated"));
  file.write(ome(3, kSizes + "PhysicalSizeXUnit=\"reference frame\""), 3);
  CHECK_THAT(file.info().notes.at(0), Contains("\"reference frame\" is no known unit of length"));
  file.write(ome(3, "PhysicalSizeX=\"-1\""), 3);
  file.refused("OME-XML PhysicalSizeX: expected a positive number, found \"-1\"");
}

TEST_CASE("Pages of OME-TIFF come in the order that its TiffData state, from other files too", "[ingest]") {
  const DescribedTiff file;
  std::string data;
  for (const int z : {0, 1, 2, 3})
    data += "<TiffData FirstZ=\"" + std::to_string(z) + "\" IFD=\"" + std::to_string(3 - z) + "\"/>";
  file.write(ome(4, kSizes, data), 4);
  CHECK(file.order() == std::vector<int>{3, 2, 1, 0});
  file.write(ome(4, kSizes, "<TiffData FirstZ=\"2\" PlaneCount=\"2\"/><TiffData IFD=\"2\" PlaneCount=\"2\"/>"), 4);
  CHECK(file.order() == std::vector<int>{2, 3, 0, 1});
  file.write(ome(4, kSizes, "<TiffData/>"), 4);
  CHECK(file.order() == std::vector<int>{0, 1, 2, 3});
  file.write(ome(4, kSizes, "<TiffData IFD=\"0\"/>"), 4);
  file.refused("OME-XML TiffData: expected a page for each z, found \"none for z = 1\"");
  file.write(ome(4, kSizes, "<TiffData PlaneCount=\"4\"/>"), 3);
  file.refused("OME-XML TiffData: expected pages up to 3, found \"4 for z = 3\"");
  const std::string two = ome(2, kSizes,
                              "<TiffData FirstZ=\"0\" IFD=\"0\"><UUID FileName=\"b.tif\"/></TiffData>"
                              "<TiffData FirstZ=\"1\" IFD=\"0\"><UUID FileName=\"v.ome.tif\"/></TiffData>");
  file.write(two, 1, 0, 0, nullptr, 10);
  file.refused("b.tif");
  file.write(two, 1, 0, 0, "b.tif", 20);
  CHECK(file.order() == std::vector<int>{20, 10});
  CHECK(openVolume(file.folder.path())->info().dims.z == 2);
}

TEST_CASE("Channels, times and several images of a TIFF are no slices, whoever wrote it", "[ingest]") {
  const DescribedTiff file;
  file.write(ome(2, kSizes, "<Channel Name=\"DAPI\"/><Channel ID=\"Channel:0:1\"/>", 2), 4);
  file.refused("number of channels: expected 1, a file for each channel, found \"2: DAPI, Channel:0:1\"");
  file.write(ome(2, kSizes, "", 1, 2), 4);
  file.refused("number of times: expected 1, a file for each time, found \"2\"");
  const std::string one = ome(2, kSizes);
  file.write(
      one.substr(0, one.size() - 6) + one.substr(one.find("<Image"), one.size() - 6 - one.find("<Image")) + "</OME>",
      2);
  file.refused("OME-XML images: expected 1, found \"2\"");
  file.write(ome(5, kSizes), 4);
  file.refused("OME-XML SizeZ: expected 4, one for each page, found \"5\"");
  file.write("<OME><Image>", 1);
  file.refused("OME-XML: line 1: expected XML, found: ");
  file.write("<!DOCTYPE OME [<!ENTITY a \"b\">]>" + one.substr(one.find("<OME")), 2);
  file.refused("OME-XML: line 1: expected XML");
  file.write("ImageJ=1.53t\nimages=4\nchannels=2\nslices=2\n", 4);
  file.refused("ImageJ channels: expected 1, a file for each, found \"2\"");
  file.write("{\"shape\": [2, 2, 1, 3]}", 4);
  file.refused("shape: expected an array of three axes, found \"2 x 2 x 1 x 3\"");
  file.write("{\"shape\": [4, 1, 3], \"axes\": \"CYX\"}", 4);
  file.refused("shape: expected slices, which channels and times are not, found \"4 x 1 x 3 of axes CYX\"");
  file.write("{\"shape\": [4, 1, 3]}", 4);
  CHECK(file.order() == std::vector<int>{0, 1, 2, 3});
}

TEST_CASE("ImageJ's numbers keep their ratio without a unit and with an unknown one", "[ingest]") {
  const DescribedTiff file;
  file.write("ImageJ=1.53t\nimages=2\nspacing=3.5\n", 2, 4.0f, RESUNIT_NONE);
  checkSpacing(file.spacing(), {0.25, 0.25, 3.5});
  CHECK_FALSE(file.info().metadata.contains("length_unit"));
  file.write("ImageJ=1.53t\nimages=2\nunit=parsec\nspacing=-3.5\n", 2, 4.0f, RESUNIT_NONE);
  checkSpacing(file.spacing(), {0.25, 0.25, 3.5});
  CHECK(file.info().metadata.at("length_unit") == "parsec");
  CHECK_THAT(file.info().notes.at(0), Contains("\"parsec\" is no known unit of length"));
  file.write("ImageJ=1.53t\nimages=2\n", 2, 400.0f, RESUNIT_CENTIMETER);
  checkSpacing(file.spacing(), {0.025, 0.025, 10});
  // Where ImageJ writes no spacing, it is 1 in the unit of the pixels.
  file.write("ImageJ=1.53t\nimages=2\nunit=\\u00B5m\n", 2, 4.0f, RESUNIT_NONE);
  checkSpacing(file.spacing(), {0.25e-3, 0.25e-3, 1e-3});
}

TEST_CASE("A sequence of single pages has the size of pixels that the first one states", "[ingest]") {
  const DescribedTiff file;
  for (int i = 0; i < 3; ++i)
    file.write("ImageJ=1.53t\nunit=um\n", 1, 4.0f, RESUNIT_NONE, ("s" + std::to_string(i) + ".tif").c_str(), i);
  const fs::path pattern = file.folder.path() / "s%d.tif";
  checkSpacing(file.spacing(pattern), {0.25e-3, 0.25e-3, 0.25e-3});
  CHECK_THAT(openVolume(pattern)->info().notes.at(0), Contains("the distance of slices is not stated"));
  for (int i = 0; i < 3; ++i)
    file.write("", 1, 20000.0f, RESUNIT_CENTIMETER, ("t" + std::to_string(i) + ".tif").c_str(), i);
  checkSpacing(file.spacing(file.folder.path() / "t*.tif"), {0.5e-3, 0.5e-3, 0.5e-3});
  file.write("", 1, 72.0f, RESUNIT_INCH);  // of a screen
  checkSpacing(file.spacing(), {1, 1, 1});
  for (const char* name : {"n-1.tif", "n-2.tif"}) file.write("", 1, 0, 0, name);
  CHECK_THROWS_WITH(openVolume(file.folder.path() / "n%d.tif"), Contains("found only negative ones, from -2 to -1"));
}

// Above 4 GB ImageJ writes one directory, and all slices behind each other.
TEST_CASE("Slices of ImageJ that have no directories lie behind the first one", "[ingest]") {
  const DescribedTiff file;
  const std::string text = "ImageJ=1.53t\nimages=3\nslices=3\nunit=mm\nspacing=2\n";
  writeBytes(file.path, describedTiff(text, "abcdefghijkl"));
  const auto source = openVolume(file.path);
  CHECK(source->info().dims == glm::i64vec3(2, 2, 3));
  source->skipSlices(1);
  std::vector<float> slice(4);
  source->readSlab(1, slice);
  CHECK(slice == std::vector<float>{'e', 'f', 'g', 'h'});
  const std::vector<float> all = readVolume(*openVolume(file.path));
  CHECK(all.back() == 'l');
  writeBytes(file.path, describedTiff(text, "abcdefghijk"));
  file.refused("slices: expected 3 of 4 bytes behind each other, found \"11 bytes\"");
  file.write(text, 2);
  file.refused("ImageJ images: expected 2, one for each page, found \"3\"");
}

TEST_CASE("Pixels of one, two and four bits become numbers, in strips and tiles", "[ingest]") {
  const DescribedTiff file;
  for (const int bits : {1, 2, 4})
    for (const bool tiled : {false, true}) {
      const std::uint32_t width = 19, height = 17;
      const auto value = [&](std::uint32_t x, std::uint32_t y) { return (x * 7 + y * 3) % 5 % (1u << bits); };
      TIFF* t = TIFFOpen(file.path.c_str(), "w");
      TIFFSetField(t, TIFFTAG_IMAGEWIDTH, width);
      TIFFSetField(t, TIFFTAG_IMAGELENGTH, height);
      TIFFSetField(t, TIFFTAG_BITSPERSAMPLE, bits);
      TIFFSetField(t, TIFFTAG_SAMPLESPERPIXEL, 1);
      TIFFSetField(t, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
      TIFFSetField(t, TIFFTAG_COMPRESSION, tiled ? COMPRESSION_LZW : COMPRESSION_PACKBITS);
      if (tiled) {
        TIFFSetField(t, TIFFTAG_TILEWIDTH, 16);
        TIFFSetField(t, TIFFTAG_TILELENGTH, 16);
      } else {
        TIFFSetField(t, TIFFTAG_ROWSPERSTRIP, 3);
      }
      const auto row = [&](std::uint32_t x0, std::uint32_t y, std::uint32_t count) {
        std::vector<std::uint8_t> out((count * static_cast<std::uint32_t>(bits) + 7) / 8);
        for (std::uint32_t x = 0; x < count; ++x) {
          const std::uint32_t at = x * static_cast<std::uint32_t>(bits);
          out[at / 8] = static_cast<std::uint8_t>(out[at / 8] | value(x0 + x, y)
                                                                    << (8 - static_cast<std::uint32_t>(bits) - at % 8));
        }
        return out;
      };
      if (!tiled)
        for (std::uint32_t y = 0; y < height; ++y) {
          auto line = row(0, y, width);
          TIFFWriteScanline(t, line.data(), y, 0);
        }
      else
        for (std::uint32_t y0 = 0; y0 < height; y0 += 16)
          for (std::uint32_t x0 = 0; x0 < width; x0 += 16) {
            std::vector<std::uint8_t> tile;
            for (std::uint32_t y = 0; y < 16; ++y) {
              const auto line = row(x0, y0 + y, 16);
              tile.insert(tile.end(), line.begin(), line.end());
            }
            TIFFWriteTile(t, tile.data(), x0, y0, 0, 0);
          }
      TIFFClose(t);
      INFO(bits << " bits, tiled " << tiled);
      const std::vector<float> voxels = readVolume(*openVolume(file.path));
      REQUIRE(voxels.size() == width * height);
      std::size_t wrong = 0;
      for (std::uint32_t i = 0; i < width * height; ++i)
        wrong += voxels[i] != static_cast<float>(value(i % width, i / width));
      CHECK(wrong == 0);
    }
}
