// SPDX-License-Identifier: Apache-2.0
#include "transfer_sheet.h"

#include <algorithm>
#include <cmath>

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
      setPixel(image, kMargin + x, top + y, y >= kCurve - height ? medium.albedo : glm::dvec3(0.9));
    for (int y = 0; y < kRamp; ++y) setPixel(image, kMargin + x, top + kCurve + 4 + y, medium.albedo);
  }
}

}  // namespace

Image drawTransferSheet(const std::vector<std::string>& presets) {
  constexpr int kRow = kGap + kCurve + 4 + kRamp;
  Image image(kWidth + 2 * kMargin, static_cast<int>(presets.size()) * kRow + kMargin, 4);
  std::fill(image.pixels.begin(), image.pixels.end(), 1.0f);
  for (std::size_t i = 0; i < presets.size(); ++i)
    drawFunction(image, static_cast<int>(i) * kRow + kGap, loadTransferFunction(presets[i]));
  return image;
}

}  // namespace umbrick::tools
