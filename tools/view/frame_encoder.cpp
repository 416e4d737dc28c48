// SPDX-License-Identifier: Apache-2.0
#include "view/frame_encoder.h"

#include <png.h>
#include <turbojpeg.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "umbrick/core/error.h"
#include "umbrick/core/srgb.h"

namespace umbrick::view {
namespace {

// The colour of the page behind a picture, sRGB; view.css has the same.
constexpr std::array<std::uint8_t, 3> kGround{0x16, 0x19, 0x1d};

// Linear colour in so many steps to sRGB bytes: finer than the steepest part of the curve needs.
class SrgbTable {
 public:
  SrgbTable() {
    for (std::size_t i = 0; i < bytes_.size(); ++i)
      bytes_[i] = static_cast<std::uint8_t>(std::lround(255 * linearToSrgb(static_cast<double>(i) / kSteps)));
  }
  std::uint8_t operator()(double linear) const {
    if (!(linear > 0)) return 0;  // not a number counts as 0, too
    return bytes_[static_cast<std::size_t>(std::lround(kSteps * std::min(linear, 1.0)))];
  }

 private:
  static constexpr int kSteps = 16384;
  std::array<std::uint8_t, kSteps + 1> bytes_;
};

// Returns RGB bytes with rows from the top.
std::vector<std::uint8_t> onGround(const Image& picture) {
  if (picture.channels != 4) throw InvalidArgument("frame: needs 4 channels");
  static const SrgbTable toSrgb;
  std::array<double, 3> ground{};
  for (std::size_t c = 0; c < 3; ++c) ground[c] = srgbToLinear(kGround[c] / 255.0);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(picture.pixels.size() / 4 * 3);
  for (int y = picture.height - 1; y >= 0; --y)
    for (int x = 0; x < picture.width; ++x) {
      const float* p = picture.at(x, y);
      const double through = 1 - std::clamp(static_cast<double>(p[3]), 0.0, 1.0);
      for (std::size_t c = 0; c < 3; ++c) bytes.push_back(toSrgb(p[c] + through * ground[c]));
    }
  return bytes;
}

}  // namespace

std::string encodeJpeg(const Image& picture, int quality) {
  const std::vector<std::uint8_t> bytes = onGround(picture);
  const std::unique_ptr<void, int (*)(tjhandle)> codec(tjInitCompress(), tjDestroy);
  if (!codec) throw InvalidArgument("JPEG: no encoder");
  unsigned char* out = nullptr;
  unsigned long size = 0;
  const int status = tjCompress2(codec.get(), bytes.data(), picture.width, 0, picture.height, TJPF_RGB, &out, &size,
                                 TJSAMP_444, quality, 0);
  const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owned(out, tjFree);
  if (status != 0) throw InvalidArgument(std::string("JPEG: ") + tjGetErrorStr2(codec.get()));
  return std::string(reinterpret_cast<const char*>(out), size);
}

std::string encodePng(const Image& picture) {
  const std::vector<std::uint8_t> bytes = onGround(picture);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGB;
  image.flags = PNG_IMAGE_FLAG_FAST;
  std::string out(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
  png_alloc_size_t size = out.size();
  if (!png_image_write_to_memory(&image, out.data(), &size, 0, bytes.data(), 0, nullptr))
    throw InvalidArgument(std::string("PNG: ") + image.message);
  out.resize(size);
  return out;
}

}  // namespace umbrick::view
