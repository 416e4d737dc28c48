// SPDX-License-Identifier: Apache-2.0
#include "ingest/streams/decode.h"

#include <half.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <type_traits>

namespace umbrick {
namespace {

template <class T>
T load(const std::byte* from, bool swap) {
  std::array<std::byte, sizeof(T)> bytes;
  std::memcpy(bytes.data(), from, sizeof(T));
  if (swap) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

// Moves the stored bits to the top and back: the flags fall off, and a signed type fills with its sign.
template <class T>
T onlyStoredBits(T value, int flagBits) {
  using Unsigned = std::make_unsigned_t<T>;
  const auto raised = static_cast<T>(static_cast<Unsigned>(static_cast<Unsigned>(value) << flagBits));
  return static_cast<T>(raised >> flagBits);
}

template <class T>
float toFloat(T value, double& error) {
  if constexpr (std::is_same_v<T, double>) {
    if (!std::isfinite(value)) return static_cast<float>(value);
    constexpr double kLargest = std::numeric_limits<float>::max();
    const auto stored = static_cast<float>(std::clamp(value, -kLargest, kLargest));
    error = std::max(error, std::abs(value - static_cast<double>(stored)));
    return stored;
  } else {
    const auto stored = static_cast<float>(value);
    // The others fit into the 24 bits of a float. A long double holds all 64 bits.
    if constexpr (std::is_integral_v<T> && sizeof(T) >= 4)
      error = std::max(
          error, static_cast<double>(std::abs(static_cast<long double>(value) - static_cast<long double>(stored))));
    return stored;
  }
}

template <class T>
double decodeAs(const VoxelLayout& layout, std::span<const std::byte> in, std::span<float> out) {
  const bool swap = layout.endian != std::endian::native;
  const int flagBits = layout.bitsStored > 0 ? 8 * static_cast<int>(sizeof(T)) - layout.bitsStored : 0;
  const bool rescaled = layout.slope != 1 || layout.intercept != 0;
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, out.size(), 1 << 16), 0.0,
      [&](const tbb::blocked_range<std::size_t>& range, double error) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          T value = load<T>(in.data() + i * sizeof(T), swap);
          if constexpr (std::is_integral_v<T>) value = onlyStoredBits(value, flagBits);
          out[i] = rescaled ? toFloat(layout.slope * static_cast<double>(value) + layout.intercept, error)
                            : toFloat(value, error);
        }
        return error;
      },
      [](double a, double b) { return std::max(a, b); });
}

template <class T>
void normaliseAs(const VoxelLayout& layout, std::span<std::byte> voxels) {
  const bool swap = layout.endian != std::endian::native;
  const int flagBits = layout.bitsStored > 0 ? 8 * static_cast<int>(sizeof(T)) - layout.bitsStored : 0;
  if (!(swap && sizeof(T) > 1) && flagBits == 0) return;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, voxels.size() / sizeof(T), 1 << 16),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i != range.end(); ++i) {
                        std::byte* at = voxels.data() + i * sizeof(T);
                        T value = load<T>(at, swap);
                        if constexpr (std::is_integral_v<T>) value = onlyStoredBits(value, flagBits);
                        std::memcpy(at, &value, sizeof(T));
                      }
                    });
}

}  // namespace

void normaliseVoxels(const VoxelLayout& layout, std::span<std::byte> voxels) {
  switch (voxelBytes(layout.type)) {
    case 1:
      return layout.type == VoxelType::u8 ? normaliseAs<std::uint8_t>(layout, voxels)
                                          : normaliseAs<std::int8_t>(layout, voxels);
    case 2:
      return layout.type == VoxelType::u16 ? normaliseAs<std::uint16_t>(layout, voxels)
                                           : normaliseAs<std::int16_t>(layout, voxels);
    case 4:
      assert(layout.type == VoxelType::f32);
      return normaliseAs<float>(layout, voxels);
    default:
      assert(layout.type == VoxelType::f64);
      return normaliseAs<double>(layout, voxels);
  }
}

double decodeVoxels(const VoxelLayout& layout, std::span<const std::byte> in, std::span<float> out) {
  assert(in.size() == out.size() * static_cast<std::size_t>(voxelBytes(layout.type)));
  switch (layout.type) {
    case VoxelType::u8:
      return decodeAs<std::uint8_t>(layout, in, out);
    case VoxelType::i8:
      return decodeAs<std::int8_t>(layout, in, out);
    case VoxelType::u16:
      return decodeAs<std::uint16_t>(layout, in, out);
    case VoxelType::i16:
      return decodeAs<std::int16_t>(layout, in, out);
    case VoxelType::u32:
      return decodeAs<std::uint32_t>(layout, in, out);
    case VoxelType::i32:
      return decodeAs<std::int32_t>(layout, in, out);
    case VoxelType::i64:
      return decodeAs<std::int64_t>(layout, in, out);
    case VoxelType::u64:
      return decodeAs<std::uint64_t>(layout, in, out);
    case VoxelType::f16:
      return decodeAs<half>(layout, in, out);
    case VoxelType::f32:
      return decodeAs<float>(layout, in, out);
    case VoxelType::f64:
      return decodeAs<double>(layout, in, out);
  }
  return 0;
}

}  // namespace umbrick
