// SPDX-License-Identifier: Apache-2.0
#include "umbrick/image/png.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>

#include "support/files.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/core/srgb.h"

using namespace umbrick;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {
// Writes one pixel and reads it back.
Image roundTrip(std::initializer_list<float> rgba, const PngOptions& options = {}) {
  const TemporaryFolder folder;
  Image image(1, 1, 4);
  std::copy(rgba.begin(), rgba.end(), image.pixels.begin());
  writePng(folder.path() / "a.png", image, options);
  return readPng(folder.path() / "a.png");
}
}  // namespace

// The values of IEC 61966-2-1 are those that are in every table.
TEST_CASE("The sRGB curve has its standard's values and is its own inverse", "[image]") {
  CHECK(linearToSrgb(0) == 0);
  CHECK(linearToSrgb(1) == Approx(1).epsilon(1e-15));
  CHECK(linearToSrgb(0.0031308) == Approx(0.04045).epsilon(1e-5));
  CHECK(linearToSrgb(0.18) == Approx(0.461356).epsilon(1e-5));
  CHECK(srgbToLinear(0.5) == Approx(0.214041).epsilon(1e-5));
  for (int i = 0; i <= 255; ++i) CHECK(linearToSrgb(srgbToLinear(i / 255.0)) == Approx(i / 255.0).epsilon(1e-6));
}

// Every image that 8 bits can hold must survive, alpha and colour together.
TEST_CASE("A PNG read and written again is the same", "[image]") {
  const TemporaryFolder folder;
  std::mt19937 random(2);
  Image image(64, 31, 4);
  for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
    const double alpha = (random() % 256) / 255.0;
    for (std::size_t c = 0; c < 3; ++c)
      image.pixels[i + c] = static_cast<float>(alpha * srgbToLinear((random() % 256) / 255.0));
    image.pixels[i + 3] = static_cast<float>(alpha);
  }
  writePng(folder.path() / "a.png", image);
  const Image read = readPng(folder.path() / "a.png");
  REQUIRE(read.pixels.size() == image.pixels.size());
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    REQUIRE(read.pixels[i] == Approx(image.pixels[i]).margin(1e-6));  // rounding of float
}

TEST_CASE("Row 0 of an image is the bottom of the picture", "[image]") {
  const TemporaryFolder folder;
  Image image(1, 2, 4);
  for (int c = 0; c < 4; ++c) image.at(0, 1)[c] = 1;  // the upper pixel is white, the lower one transparent
  writePng(folder.path() / "a.png", image);
  const Image read = readPng(folder.path() / "a.png");
  CHECK(read.at(0, 1)[3] == 1);
  CHECK(read.at(0, 0)[3] == 0);
}

TEST_CASE("Colours over alpha are un-premultiplied before they are encoded", "[image]") {
  const Image read = roundTrip({0.1f, 0.2f, 0.0f, 0.5f});
  const double alpha = 128 / 255.0;              // nearest of 8 bits
  const double level = 1 / 255.0 * 2.4 / 1.055;  // half a level of the steepest part of the curve, and of alpha
  CHECK(read.pixels[3] == Approx(alpha));
  CHECK(read.pixels[0] == Approx(alpha * 0.2).margin(level / 2));
  CHECK(read.pixels[1] == Approx(alpha * 0.4).margin(level / 2));
  CHECK(read.pixels[2] == 0);
}

TEST_CASE("Exposure and tone maps act on linear colour over its own alpha", "[image]") {
  const auto level = 1.2 / 255;  // half a level where the curve is steepest
  CHECK(roundTrip({0.1f, 0.1f, 0.1f, 1}, {ToneMap::none, 1, {}}).pixels[0] == Approx(0.2).margin(level));
  CHECK(roundTrip({3, 3, 3, 1}).pixels[0] == 1);
  CHECK(roundTrip({3, 3, 3, 1}, {ToneMap::reinhard, 0, {}}).pixels[0] == Approx(0.75).margin(level));
  CHECK(roundTrip({1.5f, 1.5f, 1.5f, 0.5f}, {ToneMap::reinhard, 0, {}}).pixels[0] ==
        Approx(0.75 * 128 / 255).margin(level));
  const auto filmic = [](float c) { return roundTrip({c, c, c, 1}, {ToneMap::filmic, 0, {}}).pixels[0]; };
  CHECK(filmic(0.0f) == 0);
  CHECK(filmic(1.0f) == Approx(2.54 / 3.16).margin(level));
  CHECK(filmic(1e30f) == 1);
  CHECK(filmic(0.5f) < filmic(0.8f));
}

TEST_CASE("Values that no picture should hold are written as something that a picture can hold", "[image]") {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  const Image read = roundTrip({nan, infinity, -1, 2});
  CHECK(read.pixels[0] == 0);
  CHECK(read.pixels[1] == 1);
  CHECK(read.pixels[2] == 0);
  CHECK(read.pixels[3] == 1);
  CHECK(roundTrip({1, 1, 1, nan}).pixels[3] == 0);
  for (const ToneMap toneMap : {ToneMap::reinhard, ToneMap::filmic})
    CHECK(roundTrip({infinity, 0, 0, 1e-30f}, {toneMap, 20, {}}).pixels[3] == 0);
}

TEST_CASE("Metadata and the sRGB chunk are in the file", "[image]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.png";
  writePng(path, Image(2, 2, 4), {ToneMap::none, 0, {{"scene", "{\"a\": 1}"}, {"author", "J\xC3\xBC"}}});
  const std::string bytes = readBytes(path);
  CHECK_THAT(bytes, Contains(std::string("tEXtscene\0{\"a\": 1}", 18)));
  CHECK_THAT(bytes, Contains("iTXtauthor") && Contains("J\xC3\xBC"));
  CHECK_THAT(bytes, Contains(std::string("\0\0\0\1sRGB\0", 9)));
}

TEST_CASE("PNG files that cannot be written are refused and leave nothing", "[image]") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(writePng(folder.path() / "a.png", Image(1, 1, 3)), Contains("4 channels, found 3"));
  CHECK_THROWS_WITH(writePng(folder.path() / "a.png", Image()), Contains("0 x 0"));
  CHECK_THROWS_WITH(writePng(folder.path() / "a.png", Image(1, 1), {ToneMap::none, 0, {{"", "x"}}}), Contains("key"));
  CHECK_THROWS_AS(writePng(folder.path() / "none" / "a.png", Image(1, 1)), IoError);
  CHECK(fs::is_empty(folder.path()));
}

TEST_CASE("Missing, truncated and foreign PNG files are named", "[image]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.png", cut = folder.path() / "cut.png";
  CHECK_THROWS_WITH(readPng(path), Contains("a.png: cannot read: No such file"));
  CHECK_THROWS_WITH(readPng(folder.path()), Contains("is a directory"));
  std::ofstream(path) << "GIF89a";
  CHECK_THROWS_WITH(readPng(path), Contains("a.png: not a PNG file"));
  Image image(50, 40, 4);
  std::mt19937 random(3);
  for (float& value : image.pixels) value = static_cast<float>(random() % 1000) / 999;
  writePng(path, image);
  const std::string bytes = readBytes(path);
  for (std::size_t length = 0; length < bytes.size(); length += length < 100 ? 7 : 97) {
    std::ofstream(cut, std::ios::binary) << bytes.substr(0, length);
    CHECK_THROWS_AS(readPng(cut), IoError);
  }
  for (int i = 0; i < 300; ++i) {
    std::string damaged = bytes;
    damaged[random() % (i % 2 ? 60 : damaged.size())] = static_cast<char>(random());
    std::ofstream(cut, std::ios::binary) << damaged;
    try {
      readPng(cut);
    } catch (const IoError&) {
    }
  }
}
