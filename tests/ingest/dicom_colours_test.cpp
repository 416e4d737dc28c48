// Coloured slices of DICOM: RGB, YBR_FULL and palettes.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <string>
#include <vector>

#include "ingest/dicom_files.h"
#include "umbrick/ingest/dicom_volume.h"

using namespace umbrick;
using namespace umbrick::dicom_files;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

constexpr std::size_t kPixels = kColumns * kRows;

// Another colour in each pixel of each slice.
int sample(int z, std::size_t pixel, int colour) {
  return static_cast<int>((37 * pixel + 85 * static_cast<std::size_t>(colour) + 11 * static_cast<std::size_t>(z)) %
                          256);
}

std::string samples(int z, bool planes) {
  std::string out(3 * kPixels, '\0');
  for (std::size_t i = 0; i < kPixels; ++i)
    for (int colour = 0; colour < 3; ++colour)
      out[planes ? static_cast<std::size_t>(colour) * kPixels + i : 3 * i + static_cast<std::size_t>(colour)] =
          static_cast<char>(sample(z, i, colour));
  return out;
}

Elements coloured(int z, const std::string& photometric, std::uint16_t samplesPerPixel, bool big = false) {
  Elements out = slice(z, glm::dvec3(1, 2, 3) + 2.0 * z * kNormal, big);
  out.text(0x28, 4, "CS", photometric).number(0x28, 2, samplesPerPixel);
  out.number(0x28, 0x100, 8).number(0x28, 0x101, 8).number(0x28, 0x102, 7).number(0x28, 0x103, 0);
  return out.remove(0x28, 0x1052).remove(0x28, 0x1053);
}

std::vector<float> all(const DicomFolder& files) {
  OpenOptions options;
  options.parts.allComponents = true;
  const auto source = openVolume(files.folder.path(), options);
  CHECK(source->info().valuesPerVoxel == 3);
  CHECK(source->info().meaning == VoxelMeaning::colour);
  std::vector<float> out(3 * kPixels * static_cast<std::size_t>(source->info().dims.z));
  source->readSlab(source->info().dims.z, out);
  return out;
}

// A run-length segment that repeats nothing: counts of up to 128 bytes as they are.
std::string literalRuns(const std::string& bytes) {
  std::string out;
  for (std::size_t at = 0; at < bytes.size(); at += 128) {
    const std::string part = bytes.substr(at, 128);
    out += static_cast<char>(part.size() - 1) + part;
  }
  return out.size() % 2 ? out + '\0' : out;
}

// The file with its pixels in one fragment behind an empty table of offsets (PS3.5 A.4).
std::string packedFile(Elements elements, const char* syntax, const std::string& fragment) {
  const auto whole = [](std::size_t value) { return bytesOf<std::uint32_t>({std::uint32_t(value)}); };
  const std::string item("\xfe\xff\x00\xe0", 4), end("\xfe\xff\xdd\xe0\0\0\0\0", 8);
  const std::string data = elements.remove(0x7fe0, 0x10).bytes() +
                           std::string("\xe0\x7f\x10\x00OB\0\0\xff\xff\xff\xff", 12) + item + whole(0) + item +
                           whole(fragment.size()) + fragment + end;
  return elements.file(syntax, data);
}

}  // namespace

TEST_CASE("RGB of DICOM is red, green and blue side by side, in planes or not", "[ingest]") {
  for (const bool planes : {false, true}) {
    const DicomFolder files;
    for (int z = 0; z < 3; ++z)
      files.write(DicomFolder::name(z),
                  coloured(z, "RGB", 3).number(0x28, 6, planes).put(0x7fe0, 0x10, "OW", samples(z, planes)));
    const std::vector<float> values = all(files);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
      wrong += values[i] != float(sample(int(i / (3 * kPixels)), i / 3 % kPixels, int(i % 3)));
    CHECK(wrong == 0);
    CHECK_THROWS_AS(files.open(), SeveralParts);
    OpenOptions green;
    green.parts.component = 1;
    const auto source = openVolume(files.folder.path(), green);
    CHECK(source->info().metadata.at("photometric") == "RGB");
    CHECK(readVolume(*source)[kPixels + 5] == float(sample(1, 5, 1)));
    CHECK(source->info().indexToWorld[3][0] == Approx(1));
    CHECK(glm::length(glm::dvec3(source->info().indexToWorld[2])) == Approx(2));
  }
}

// The equations of CCIR 601 the other way round, as DICOM gives them for RGB to YBR (PS3.3 C.7.6.3.1.2).
TEST_CASE("YBR_FULL becomes the RGB that it was made of", "[ingest]") {
  const DicomFolder files;
  std::string stored(3 * kPixels, '\0');
  for (std::size_t i = 0; i < kPixels; ++i) {
    const double r = sample(0, i, 0), g = sample(0, i, 1), b = sample(0, i, 2);
    const double ybr[]{0.299 * r + 0.587 * g + 0.114 * b, -0.1687 * r - 0.3313 * g + 0.5 * b + 128,
                       0.5 * r - 0.4187 * g - 0.0813 * b + 128};
    for (std::size_t k = 0; k < 3; ++k) stored[3 * i + k] = static_cast<char>(std::lround(std::min(ybr[k], 255.0)));
  }
  files.write("a.dcm", coloured(0, "YBR_FULL", 3).put(0x7fe0, 0x10, "OW", stored));
  const std::vector<float> values = all(files);
  float most = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    most = std::max(most, std::abs(values[i] - float(sample(0, i / 3, int(i % 3)))));
  CHECK(most <= 2);  // each of the three is rounded to whole numbers, by up to a half times 1.77
}

TEST_CASE("A palette of DICOM gives colours of 8 or 16 bits, also at its ends", "[ingest]") {
  for (const int bits : {8, 16})
    for (const bool big : {false, true}) {
      CAPTURE(bits, big);
      const DicomFolder files;
      Elements file = coloured(0, "PALETTE COLOR", 1, big);
      // Four entries from pixel 10 on. Those of 8 bits lie two in a word.
      for (unsigned colour = 0; colour < 3; ++colour) {
        std::vector<std::uint16_t> words;
        std::string bytes;
        for (unsigned i = 0; i < 4; ++i) {
          words.push_back(static_cast<std::uint16_t>(1000 * i + colour + 1));
          bytes += static_cast<char>(50 * i + colour + 1);
        }
        file.put(0x28, 0x1101 + colour, "US", bytesOf<std::uint16_t>({4, 10, std::uint16_t(bits)}, big));
        file.put(0x28, 0x1201 + colour, "OW", bits == 8 ? bytes : bytesOf(words, big));
      }
      std::string stored(kPixels, '\0');
      for (std::size_t i = 0; i < kPixels; ++i) stored[i] = static_cast<char>(i % 20);
      files.write("a.dcm", file.put(0x7fe0, 0x10, "OW", stored));
      const std::vector<float> values = all(files);
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < values.size(); ++i) {
        const int entry = std::clamp(int(i / 3 % 20) - 10, 0, 3);
        wrong += values[i] != float((bits == 8 ? 50 : 1000) * entry + int(i % 3) + 1);
      }
      CHECK(wrong == 0);
    }
}

TEST_CASE("Run lengths of colours have a segment for each of them", "[ingest]") {
  const DicomFolder files;
  const std::string planes = samples(0, true);
  std::string head = bytesOf<std::uint32_t>({3}), body;
  for (std::size_t colour = 0; colour < 3; ++colour) {
    head += bytesOf<std::uint32_t>({std::uint32_t(64 + body.size())});
    body += literalRuns(planes.substr(colour * kPixels, kPixels));
  }
  head.resize(64, '\0');
  writeBytes(files.folder.path() / "a.dcm", packedFile(coloured(0, "RGB", 3), "1.2.840.10008.1.2.5", head + body));
  const std::vector<float> values = all(files);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < values.size(); ++i) wrong += values[i] != float(sample(0, i / 3, int(i % 3)));
  CHECK(wrong == 0);
}

TEST_CASE("Colours that are not read are refused by their names", "[ingest]") {
  const DicomFolder files;
  const auto refused = [&](const Elements& file, const std::string& what) {
    files.write("a.dcm", file);
    files.refused(what);
  };
  const std::string pixels = samples(0, false);
  refused(coloured(0, "YBR_FULL_422", 3).put(0x7fe0, 0x10, "OW", pixels),
          "RGB or YBR_FULL with three, found \"YBR_FULL_422, 3 samples\"");
  refused(coloured(0, "RGB", 3).put(0x7fe0, 0x10, "OW", pixels.substr(1)), "x 3 samples u8 = 360 bytes, found 359");
  writeBytes(files.folder.path() / "a.dcm", packedFile(coloured(0, "RGB", 3), "1.2.840.10008.1.2.4.50", "\xff\xd8"));
  files.refused("TransferSyntaxUID: expected one of colours that are not packed");
  refused(coloured(0, "PALETTE COLOR", 1).put(0x7fe0, 0x10, "OW", pixels), "RedPaletteColorLookupTableData");
  // A coloured picture among grey slices is the odd one.
  files.series(3, 2.0 * kNormal);
  files.write("a.dcm", coloured(5, "RGB", 3).put(0x7fe0, 0x10, "OW", pixels));
  CHECK_THROWS_AS(files.open(), OddSlices);
  CHECK_THROWS_WITH(files.open(), Contains("PhotometricInterpretation: expected MONOCHROME2 as in"));
}

TEST_CASE("Coloured DICOM with flipped or missing bytes ends in colours or an Error", "[ingest]") {
  const DicomFolder files;
  const fs::path path = files.folder.path() / "a.dcm";
  OpenOptions options;
  options.parts.allComponents = true;
  std::mt19937 random(11);
  for (const char* seed : {"seed-rgb", "seed-palette", "seed-rgb-rle"}) {
    const std::string good = readBytes(std::string(UMBRICK_FUZZ_CORPUS "/dicom/") + seed);
    for (int trial = 0; trial < 400; ++trial) {
      std::string bytes = good;
      for (int i = 0; i <= trial % 3; ++i) bytes[random() % bytes.size()] = static_cast<char>(random());
      if (trial % 5 == 0) bytes.resize(random() % bytes.size());
      writeBytes(path, bytes);
      try {
        const auto source = openVolume(path, options);
        const VolumeInfo& info = source->info();
        std::vector<float> slice(static_cast<std::size_t>(info.dims.x * info.dims.y * info.valuesPerVoxel));
        source->readSlab(1, slice);
      } catch (const Error&) {
      }
    }
  }
}
