// SPDX-License-Identifier: Apache-2.0
#include "umbrick/image/exr.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>

#include "support/files.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"

using namespace umbrick;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {
Image randomImage(int width, int height, int channels, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-2, 40);
  Image image(width, height, channels);
  for (float& value : image.pixels) value = uniform(random);
  return image;
}

}  // namespace

TEST_CASE("Float EXR files return every bit, layer and attribute", "[image]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.exr";
  Image colour = randomImage(13, 7, 4, 1);
  colour.at(3, 2)[0] = std::numeric_limits<float>::infinity();
  colour.at(4, 2)[0] = std::numeric_limits<float>::denorm_min();
  const std::vector<ImageLayer> layers{{"", colour},
                                       {"V", randomImage(13, 7, 1, 2)},
                                       {"Z", randomImage(13, 7, 1, 3)},
                                       {"light", randomImage(13, 7, 3, 4)}};
  const std::map<std::string, std::string> metadata{{"umbrick.scene", "{\"a\": \"\xC3\xA4\"}"}, {"comments", ""}};
  writeExr(path, layers, {ExrPixel::float32, metadata});
  const ExrFile file = readExr(path);
  CHECK(file.metadata == metadata);
  REQUIRE(file.layers.size() == layers.size());
  for (std::size_t i = 0; i < layers.size(); ++i) {
    CHECK(file.layers[i].name == layers[i].name);
    REQUIRE(file.layers[i].image.channels == layers[i].image.channels);
    CHECK(std::memcmp(file.layers[i].image.pixels.data(), layers[i].image.pixels.data(),
                      layers[i].image.pixels.size() * sizeof(float)) == 0);
  }
}

TEST_CASE("Half EXR files round to 11 bits, clamp what is finite and keep depth as float", "[image]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.exr";
  Image colour = randomImage(9, 5, 4, 5);
  colour.at(0, 0)[0] = 1e6f;
  colour.at(1, 0)[0] = -1e6f;
  colour.at(2, 0)[0] = std::numeric_limits<float>::infinity();
  colour.at(3, 0)[0] = std::numeric_limits<float>::quiet_NaN();
  Image depth(9, 5, 1);
  depth.at(4, 4)[0] = 100'000.125f;
  writeExr(path, {{"", colour}, {"Z", depth}});
  const ExrFile file = readExr(path);
  const Image& read = file.layers.at(0).image;
  CHECK(read.at(0, 0)[0] == 65504);
  CHECK(read.at(1, 0)[0] == -65504);
  CHECK(std::isinf(read.at(2, 0)[0]));
  CHECK(std::isnan(read.at(3, 0)[0]));
  for (int x = 4; x < 9; ++x)  // half a unit in the last of 11 bits
    CHECK(read.at(x, 3)[1] == Approx(colour.at(x, 3)[1]).epsilon(1.0 / 2048));
  CHECK(file.layers.at(1).name == "Z");
  CHECK(file.layers.at(1).image.at(4, 4)[0] == 100'000.125f);
}

// The bytes of the file are read, since writer and reader could agree on a mirrored file.
TEST_CASE("The bottom row of an image is the last scan line of the file", "[image]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.exr";
  Image image(1, 2, 1);
  image.at(0, 0)[0] = 1.5f;  // bottom row
  image.at(0, 1)[0] = 2.5f;
  writeExr(path, {{"V", image}}, {ExrPixel::float32, {}});
  const std::string bytes = readBytes(path);
  // Both lines are one block, which is stored as it is where compression would not make it smaller.
  float pixels[2];
  std::memcpy(pixels, bytes.data() + bytes.size() - sizeof(pixels), sizeof(pixels));
  CHECK(pixels[0] == 2.5f);
  CHECK(pixels[1] == 1.5f);
}

TEST_CASE("EXR files that cannot be written are refused and leave nothing", "[image]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.exr";
  const Image image(2, 2, 4), small(1, 2, 4), single(2, 2, 1);
  CHECK_THROWS_WITH(writeExr(path, {}), Contains("no layers"));
  CHECK_THROWS_WITH(writeExr(path, {{"", image}, {"b", small}}), Contains("layer 'b': 1 x 2 beside 2 x 2"));
  CHECK_THROWS_WITH(writeExr(path, {{"a", image}, {"a", image}}), Contains("channel 'a.R' already"));
  CHECK_THROWS_WITH(writeExr(path, {{"", image}, {"R", single}}), Contains("channel 'R' already"));
  CHECK_THROWS_WITH(writeExr(path, {{"a.b", single}}), Contains("dot"));
  CHECK_THROWS_WITH(writeExr(path, {{"", Image()}}), Contains("0 x 0"));
  CHECK_THROWS_AS(writeExr(folder.path() / "none" / "a.exr", {{"", image}}), IoError);
  CHECK(fs::is_empty(folder.path()));
}

TEST_CASE("Missing, truncated and foreign EXR files are named", "[image]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.exr", cut = folder.path() / "cut.exr";
  CHECK_THROWS_WITH(readExr(path), Contains("a.exr: cannot read: No such file"));
  CHECK_THROWS_WITH(readExr(folder.path()), Contains("is a directory"));
  std::ofstream(path) << "P6 2 2 255 nothing of the kind";
  CHECK_THROWS_WITH(readExr(path), Contains("a.exr: not an EXR file"));
  fs::remove(path);
  writeExr(path, {{"", randomImage(40, 60, 4, 9)}}, {ExrPixel::float32, {{"key", "text"}}});
  const std::string bytes = readBytes(path);
  for (std::size_t length = 0; length < bytes.size(); length += length < 700 ? 7 : 997) {
    std::ofstream(cut, std::ios::binary) << bytes.substr(0, length);
    CHECK_THROWS_AS(readExr(cut), IoError);
  }
  // A damaged file gives an error of ours or other pixels, never anything else.
  std::mt19937 random(4);
  for (int i = 0; i < 300; ++i) {
    std::string damaged = bytes;
    damaged[random() % (i % 2 ? 500 : damaged.size())] = static_cast<char>(random());
    std::ofstream(cut, std::ios::binary) << damaged;
    try {
      readExr(cut);
    } catch (const IoError&) {
    }
  }
}
