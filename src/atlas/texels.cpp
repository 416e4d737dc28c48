// SPDX-License-Identifier: Apache-2.0
#include "atlas/texels.h"

#include <Imath/half.h>
#include <algorithm>
#include <cmath>
#include <type_traits>

#include "umbrick/atlas/brick_atlas.h"

namespace umbrick {
namespace {

// Whole numbers are stored as they are when they fit; otherwise the range is spread over the codes.
TexelScale unormScale(const Bricks& volume, VoxelFormat format) {
  const double codes = format == VoxelFormat::unorm8 ? 255 : 65535;
  const double extent = static_cast<double>(volume.value.max) - static_cast<double>(volume.value.min);
  const bool wholeNumbers = volume.exactFormat == VoxelFormat::unorm8 || volume.exactFormat == VoxelFormat::unorm16;
  const bool exact = wholeNumbers && extent <= codes;
  const double step = exact ? 1 : extent > 0 ? extent / codes : 1;
  return {step * codes, static_cast<double>(volume.value.min), exact ? 0 : step};
}

// Turns values into the codes of a fixed-point format, 0 to `most`.
class UnormCodes {
 public:
  UnormCodes(const TexelScale& scale, double most)
      : offset_(scale.offset), perUnit_(1 / (scale.scale / most)), most_(most) {}
  /// Returns a number that becomes the nearest code when the caller cuts it to a whole number.
  double operator()(float value) const {
    return std::clamp((static_cast<double>(value) - offset_) * perUnit_ + 0.5, 0.0, most_);
  }

 private:
  double offset_, perUnit_, most_;
};

Imath::half halfOf(float value) { return Imath::half(std::clamp(value, -65504.0f, 65504.0f)); }

}  // namespace

TexelScale texelScale(const Bricks& volume, VoxelFormat format) {
  const double largest =
      std::max(std::abs(static_cast<double>(volume.value.min)), std::abs(static_cast<double>(volume.value.max)));
  switch (format) {
    case VoxelFormat::unorm8:
    case VoxelFormat::unorm16:
      return unormScale(volume, format);
    case VoxelFormat::half:
      // The error is half of a unit in the last of 11 places, and half of 2^-24 near zero. Values beyond
      // 65504 are cut off.
      return {1, 0,
              volume.exactFormat == VoxelFormat::half ? 0 : std::max({largest * 0x1p-11, 0x1p-25, largest - 65504})};
    case VoxelFormat::float32:
      break;
  }
  const double anchor = volume.anchor;
  return {1, anchor, anchor != 0 ? (largest + std::abs(anchor)) * 0x1p-24 : 0};
}

double texelOf(float value, const TexelScale& scale, VoxelFormat format) {
  const auto unorm = [&](double most) { return std::floor(UnormCodes(scale, most)(value)) / most; };
  switch (format) {
    case VoxelFormat::unorm8:
      return unorm(255);
    case VoxelFormat::unorm16:
      return unorm(65535);
    case VoxelFormat::half:
      return gradientTexelOf(value, format);
    case VoxelFormat::float32:
      break;
  }
  return static_cast<float>(scale.toTexel(value));
}

double gradientTexelOf(float gradient, VoxelFormat format) {
  if (format != VoxelFormat::half) return gradient;
  return static_cast<float>(halfOf(gradient));
}

double encodeTexels(std::span<const float> values, std::span<const float> gradients, const TexelScale& scale,
                    VoxelFormat format, std::byte* texels, std::span<const float> emission) {
  const bool exact = scale.rounding == 0;
  double error = 0;
  const auto store = [&](auto codeOf, auto gradientCodeOf, auto valueOf) {
    using Code = decltype(codeOf(0.0f));
    auto* out = reinterpret_cast<Code*>(texels);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Code code = codeOf(values[i]);
      *out++ = code;
      if (!gradients.empty()) *out++ = gradientCodeOf(gradients[i]);
      if constexpr (std::is_same_v<Code, float>)
        if (!emission.empty()) {
          if (gradients.empty()) *out++ = 0;
          *out++ = emission[i];
        }
      if (!exact) error = std::max(error, std::abs(valueOf(code) - static_cast<double>(values[i])));
    }
  };
  const auto storeUnorm = [&]<class Code>(Code most) {
    const double step = scale.scale / most;
    const UnormCodes codes(scale, most);
    const auto codeOf = [codes](float v) { return static_cast<Code>(codes(v)); };
    store(codeOf, codeOf, [&](Code code) { return scale.offset + code * step; });
  };
  const double anchor = scale.offset;
  switch (format) {
    case VoxelFormat::unorm8:
      storeUnorm(std::uint8_t{255});
      break;
    case VoxelFormat::unorm16:
      storeUnorm(std::uint16_t{65535});
      break;
    case VoxelFormat::half:
      store(halfOf, halfOf, [](Imath::half code) { return static_cast<double>(static_cast<float>(code)); });
      break;
    case VoxelFormat::float32:
      store([&](float v) { return static_cast<float>(v - anchor); }, [](float gradient) { return gradient; },
            [&](float code) { return code + anchor; });
      break;
  }
  return error;
}

}  // namespace umbrick
