// Sizes of memory, as messages print them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

namespace umbrick {

/// Returns "2 MiB" or "1.1 MiB". The size is rounded up to a tenth, so that what is more than a budget of whole
/// mebibytes also reads as more.
inline std::string mebibytes(std::uint64_t bytes) {
  constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;
  const std::uint64_t whole = bytes / kMebibyte, rest = bytes % kMebibyte;
  const std::uint64_t tenths = 10 * whole + (10 * rest + kMebibyte - 1) / kMebibyte;
  return std::to_string(tenths / 10) + (tenths % 10 > 0 ? "." + std::to_string(tenths % 10) : "") + " MiB";
}

}  // namespace umbrick
