// SPDX-License-Identifier: Apache-2.0
#include "grid/disc_kernel.h"

#include <cmath>

// The loop is compiled for several sets of instructions, and the machine picks one when the program starts. Results
// are the same to the bit, since products and sums are not contracted.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define UMBRICK_WIDE __attribute__((target_clones("arch=skylake-avx512", "avx2", "default")))
#else
#define UMBRICK_WIDE
#endif

namespace umbrick {

UMBRICK_WIDE void addDiscs(std::span<const Disc> discs, const std::array<int, 3>& shift, float reach,
                           NearestDiscs& nearest) {
  constexpr int kEdge = 8;
  for (const Disc& disc : discs) {
    const float x = disc.centre[0] + static_cast<float>(shift[0]), y = disc.centre[1] + static_cast<float>(shift[1]),
                z = disc.centre[2] + static_cast<float>(shift[2]);
    if (z < -reach || z > kEdge - 1 + reach) continue;
    const float nx = disc.normal[0], ny = disc.normal[1], nz = disc.normal[2];
    for (int i = 0; i < kEdge; ++i) {
      const float dx = static_cast<float>(i) - x, wide = reach * reach - dx * dx;
      if (wide < 0) continue;
      const float half = std::sqrt(wide);
      const int first = y - half > 0 ? static_cast<int>(y - half) : 0;
      const int last = y + half < kEdge - 1 ? static_cast<int>(y + half + 1) : kEdge - 1;
      float* plane = nearest.data() + i * kEdge * kEdge;
      // The rows of a plane are one loop, which compilers vectorise.
      for (int at = first * kEdge; at < (last + 1) * kEdge; ++at) {
        const float dy = static_cast<float>(at / kEdge) - y, dz = static_cast<float>(at % kEdge) - z;
        const float height = dx * nx + dy * ny + dz * nz, square = height * height;
        const float along = dx * dx + dy * dy + dz * dz - square;
        const float beside = std::sqrt(along > 0 ? along : 0) - kDiscRadius;
        const float outside = beside > 0 ? beside : 0;
        const float distance = square + outside * outside;
        plane[at] = distance < plane[at] ? distance : plane[at];
      }
    }
  }
}

}  // namespace umbrick
