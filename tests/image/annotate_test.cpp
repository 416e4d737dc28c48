// What is drawn into a picture: that it is there, where it should be, and stands out from any background.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/image/annotate.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/common.hpp>
#include <vector>

#include "umbrick/core/error.h"
#include "umbrick/core/srgb.h"
#include "umbrick/image/text.h"

using namespace umbrick;

namespace {

Image filled(int width, int height, float value, float alpha = 1) {
  Image image(width, height, 4);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = i % 4 == 3 ? alpha : value * alpha;
  return image;
}

double luminance(const float* p) { return 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]; }

Annotations everything(double barPixels) {
  Annotations all;
  all.triad = {
      {{1, 0}, 0, "x", "", {1, 0.2, 0.2}}, {{0, 1}, 0, "y", "", {0.2, 1, 0.2}}, {{0, 0}, -1, "z", "", {0.2, 0.2, 1}}};
  all.scale = ScaleBar{barPixels, "20 mm"};
  ColourBar bar;
  for (int i = 0; i < 256; ++i) {
    bar.colours.push_back(i < 128 ? glm::dvec3(0.8, 0, 0) : glm::dvec3(0, 0, 0.8));
    bar.opacities.push_back(i / 255.0);
  }
  bar.low = "-1000 HU";
  bar.high = "3000 HU";
  all.colours = bar;
  return all;
}

// Returns the sum of a mask's pixels.
double area(const TextMask& mask) {
  double sum = 0;
  for (const float covered : mask.coverage.pixels) sum += covered;
  return sum;
}

}  // namespace

// Letters are shapes: their area grows with the square of the font, their width with the font.
TEST_CASE("Text grows with its font and has its letters side by side", "[image]") {
  for (const double em : {11.0, 24.0, 100.0}) {
    INFO("em " << em);
    const TextMask one = textMask("H", em), two = textMask("HH", em);
    // A capital letter of Vera is 0.73 em high and stands on the line.
    CHECK(one.coverage.height == Approx(0.73 * em).margin(1.5));
    CHECK(one.bottom == 0);
    CHECK(two.width == Approx(2 * one.width).epsilon(0.01));
    CHECK(area(two) == Approx(2 * area(one)).epsilon(0.06));
    CHECK(area(one) / (em * em) == Approx(area(textMask("H", 200)) / 4e4).epsilon(0.06));
    CHECK(textMask("y", em).bottom < 0);  // it reaches below the line
  }
  CHECK(textMask("", 12).coverage.pixels.empty());
  CHECK(textMask(" ", 12).width > 2);
  CHECK_THROWS_AS(textMask("a", 0), InvalidArgument);
  CHECK_THROWS_AS(textMask("a", std::nan("")), InvalidArgument);
}

TEST_CASE("Units with letters beyond ASCII have these letters, and broken text has boxes", "[image]") {
  const auto pixels = [](const std::string& text) { return textMask(text, 32).coverage.pixels; };
  const std::vector<float> box = pixels("\xf0\x9f\xa6\xb4");  // a bone, which the font does not have
  CHECK_FALSE(box.empty());
  for (const char* letter :
       {"\xc2\xb5", "\xc2\xb0", "\xc2\xb2", "\xc2\xb3", "\xc3\x85"}) {  // micro, degree, 2, 3, angstrom
    INFO(letter);
    CHECK_FALSE(pixels(letter).empty());
    CHECK(pixels(letter) != box);
  }
  CHECK(pixels("\xff") == box);
  CHECK(pixels("\xc2") == box);  // cut off in the middle
}

TEST_CASE("The scale bar is as long as it says", "[image]") {
  for (const int size : {256, 700}) {
    const double length = 0.2 * size + 0.3;
    Image image = filled(size, size, 0);
    Annotations only;
    only.scale = ScaleBar{length, "5"};
    REQUIRE(annotate(image, only).empty());
    // The row with most light is that of the bar.
    double longest = 0;
    for (int y = 0; y < size / 2; ++y) {
      double sum = 0;
      for (int x = 0; x < size; ++x) sum += image.at(x, y)[1] / 0.92;
      longest = std::max(longest, sum);
    }
    // The ticks at its ends are as thick as the line, and half a pixel of each edge is smooth.
    const double thickness = std::max(1.4, 0.1 * annotationEm(size, size));
    CHECK(longest == Approx(length).margin(thickness + 1));
  }
}

TEST_CASE("The triad's arms end where its axes do", "[image]") {
  const int size = 512;
  Image image = filled(size, size, 0);
  Annotations only;
  const glm::dvec2 end(0.6, 0.8);
  only.triad = {{end, 0, "", "", {1, 0, 0}}};
  REQUIRE(annotate(image, only).empty());
  // Red pixels are the arm. Its ends are the origin and the origin plus the arm's length along the axis.
  glm::dvec2 low(size), high(0);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      if (image.at(x, y)[0] > 0.5f && image.at(x, y)[1] < 0.2f) {
        low = glm::min(low, glm::dvec2(x, y));
        high = glm::max(high, glm::dvec2(x + 1, y + 1));
      }
  const glm::dvec2 extent = high - low;
  // Within the thickness of the line and of the dot at the origin.
  CHECK(extent.y / extent.x == Approx(end.y / end.x).epsilon(0.2));
  CHECK(std::hypot(extent.x, extent.y) == Approx(2.3 * annotationEm(size, size)).epsilon(0.2));
}

TEST_CASE("The colour bar has the first colour below, the last one above, and is as wide as it is opaque", "[image]") {
  const int size = 512;
  Image image = filled(size, size, 0.2f);
  Annotations only;
  only.colours = everything(0).colours;
  REQUIRE(annotate(image, only).empty());
  int red = 0, blue = 0, highestRed = 0, lowestBlue = size;
  std::vector<int> widths;
  for (int y = 0; y < size; ++y) {
    int here = 0;
    for (int x = 0; x < size; ++x) {
      const float* p = image.at(x, y);
      const bool isRed = p[0] > 0.7f && p[1] < 0.05f && p[2]<0.05f, isBlue = p[2]> 0.7f && p[0] < 0.05f;
      here += isRed || isBlue;
      red += isRed;
      blue += isBlue;
      if (isRed) highestRed = std::max(highestRed, y);
      if (isBlue) lowestBlue = std::min(lowestBlue, y);
    }
    if (here > 0) widths.push_back(here);
  }
  CHECK(red > 500);
  CHECK(blue > red);
  CHECK(highestRed < lowestBlue);
  CHECK(widths.size() == Approx(0.5 * size).margin(2));
  CHECK(widths.back() > 2 * widths.front());
}

// Over a background of its own lightness a letter would vanish. Between the letters' ink and the rim around them there
// is a contrast of at least 7 to 1, the better grade of WCAG 2.1.
TEST_CASE("Annotations stand out from any background, at any size", "[image]") {
  for (const int size : {256, 512, 2048})
    for (const float value : {0.0f, 0.18f, 0.5f, 1.0f})
      for (const float alpha : {0.0f, 1.0f}) {
        Image image = filled(size, size, value, alpha);
        const Annotations all = everything(0.2 * size);
        INFO(size << " pixels, background " << value << ", alpha " << alpha);
        CHECK(annotate(image, all).empty());
        // The labels of the scale bar: a box in the lower right corner.
        double darkest = 1, lightest = 0;
        const int em = static_cast<int>(annotationEm(size, size));
        for (int y = em; y < 3 * em; ++y)
          for (int x = size - 5 * em; x < size - em; ++x) {
            darkest = std::min(darkest, luminance(image.at(x, y)));
            lightest = std::max(lightest, luminance(image.at(x, y)));
          }
        CHECK((lightest + 0.05) / (darkest + 0.05) > 7);
      }
}

TEST_CASE("What does not fit is left out and named, and the rest of the picture is untouched", "[image]") {
  Image small = filled(40, 30, 0.5f);
  const std::vector<float> before = small.pixels;
  CHECK(annotate(small, everything(10)) == std::vector<std::string>{"triad", "scale", "colours"});
  CHECK(small.pixels == before);
  Image one = filled(1, 1, 0.5f);
  CHECK(annotate(one, everything(1)).size() == 3);

  Image large = filled(512, 512, 0.5f);
  CHECK(annotate(large, everything(100)).empty());
  for (int y = 150; y < 350; ++y)
    for (int x = 150; x < 350; ++x) CHECK(large.at(x, y)[0] == 0.5f);
  CHECK(annotate(large, {}).empty());

  Image grey(64, 64, 1);
  CHECK_THROWS_AS(annotate(grey, everything(10)), InvalidArgument);
  Annotations broken = everything(10);
  broken.colours->opacities.pop_back();
  CHECK_THROWS_AS(annotate(large, broken), InvalidArgument);
}
