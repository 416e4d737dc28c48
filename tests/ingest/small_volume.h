// The voxels of a small volume, 2 x 3 x 2, that tests of formats write and read.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

namespace umbrick {

inline const std::vector<std::int16_t> kValues{0, 1, 2, 3, 4, 5, -6, -7, -8, -9, -300, 32767};
inline const std::vector<float> kFloats(kValues.begin(), kValues.end());

}  // namespace umbrick
