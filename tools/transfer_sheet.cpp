// SPDX-License-Identifier: Apache-2.0
#include "transfer_sheet.h"

#include <algorithm>
#include <cmath>

#include "umbrick/core/short_number.h"
#include "umbrick/image/text.h"
#include "umbrick/optics/transfer_function.h"

namespace umbrick::tools {
namespace {

constexpr int kWidth = 512, kCurve = 72, kRamp = 16, kGap = 24, kMargin = 12;

void setPixel(Image& image, int x, int y, const glm::dvec3& colour) {
  const auto at = 4 * (static_cast<std::size_t>(image.height - 1 - y) * std::size_t(image.width) + std::size_t(x));
  for (std::size_t c = 0; c < 3; ++c) image.pixels[at + c] = static_cast<float>(colour[static_cast<int>(c)]);
  image.pixels[at + 3] = 1;
}

// Draws one function below a row of pixels.
void drawFunction(Image& image, int top, const TransferFunction& transfer) {
  const Range domain = transfer.valueDomain();
  const double gradient = transfer.is2d() ? transfer.gradientDomain().max : 0;
  const double most = transfer.majorant(domain, {0, static_cast<float>(gradient)});
  for (int x = 0; x < kWidth; ++x) {
    const double value = domain.min + (x + 0.5) / kWidth * (double(domain.max) - domain.min);
    const Medium medium = transfer(value, gradient);
    const int height = most > 0 ? static_cast<int>(std::lround(kCurve * medium.sigma_t / most)) : 0;
    for (int y = 0; y < kCurve; ++y)
      setPixel(image, kMargin + x, top + y, y >= kCurve - height ? medium.albedo : glm::dvec3(0.12));
    for (int y = 0; y < kRamp; ++y) setPixel(image, kMargin + x, top + kCurve + 4 + y, medium.albedo);
  }
}

// Writes black letters over white. @param x,y  where the line begins, on its base line, from the upper left corner
void drawText(Image& image, int x, int y, const std::string& text) {
  constexpr double kEm = 13;
  const TextMask mask = textMask(text, kEm);
  for (int row = 0; row < mask.coverage.height; ++row)
    for (int column = 0; column < mask.coverage.width; ++column) {
      const int to = x + mask.left + column, up = y - mask.bottom - row;
      if (to < 0 || to >= image.width || up < 0 || up >= image.height) continue;
      setPixel(image, to, up, glm::dvec3(1 - double(*mask.coverage.at(column, row))));
    }
}

}  // namespace

Image drawTransferSheet(const std::vector<std::string>& presets) {
  constexpr int kRow = kGap + kCurve + 4 + kRamp;
  Image image(kWidth + 2 * kMargin, static_cast<int>(presets.size()) * kRow + kMargin, 4);
  std::fill(image.pixels.begin(), image.pixels.end(), 1.0f);
  for (std::size_t i = 0; i < presets.size(); ++i) {
    const TransferFunction transfer = loadTransferFunction(presets[i]);
    const int top = static_cast<int>(i) * kRow + kGap;
    drawFunction(image, top, transfer);
    const Range domain = transfer.valueDomain();
    drawText(image, kMargin, top - 6,
             presets[i] + ": " + shortNumber(domain.min, 4) + " to " + shortNumber(domain.max, 4) +
                 (transfer.unit().empty() ? "" : ", " + transfer.unit()));
  }
  return image;
}

}  // namespace umbrick::tools
