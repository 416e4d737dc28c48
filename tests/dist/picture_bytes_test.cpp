// SPDX-License-Identifier: Apache-2.0
#include "dist/picture_bytes.h"

#include <catch2/catch.hpp>
#include <limits>

#include "umbrick/core/error.h"

using namespace umbrick;
using namespace umbrick::tools;

TEST_CASE("A picture survives its way through bytes to the last bit", "[dist]") {
  Picture picture;
  picture.colour = Image(3, 2, 4);
  for (std::size_t i = 0; i < picture.colour.pixels.size(); ++i)
    picture.colour.pixels[i] = 0.1f * static_cast<float>(i);
  picture.depth = Image(3, 2, 1);
  picture.depth.pixels[4] = std::numeric_limits<float>::infinity();
  picture.layers.push_back({"normal", Image(1, 1, 3), true});
  picture.stats.slices = 7;
  picture.stats.lightNote = "a note";
  picture.stats.passes.eyeMs = 1.5;
  picture.stats.readMs = 2.5;
  const std::string bytes = bytesOfPicture(picture);
  const Picture back = pictureOfBytes(bytes);
  CHECK((back.colour.pixels == picture.colour.pixels));
  CHECK(back.colour.width == 3);
  CHECK(back.colour.height == 2);
  CHECK((back.depth.pixels == picture.depth.pixels));
  CHECK(back.visibility.pixels.empty());
  REQUIRE(back.layers.size() == 1);
  CHECK(back.layers[0].name == "normal");
  CHECK(back.layers[0].image.channels == 3);
  CHECK(back.layers[0].exact);
  CHECK(back.stats.slices == 7);
  CHECK(back.stats.lightNote == "a note");
  CHECK(back.stats.passes.eyeMs == 1.5);
  CHECK(back.stats.readMs == 2.5);
  // All bytes are used, and none is missing.
  CHECK(bytesOfPicture(back) == bytes);
  for (const std::size_t length : {std::size_t(0), bytes.size() / 2, bytes.size() - 1})
    CHECK_THROWS_AS(pictureOfBytes(bytes.substr(0, length)), Error);
  CHECK_THROWS_AS(pictureOfBytes(bytes + "x"), Error);
}
