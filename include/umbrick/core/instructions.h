// The SIMD instructions that loops on the CPU are run with.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace umbrick {

/// Returns the name of the set of instructions, as Highway calls it: "AVX3" (AVX-512), "AVX2", "SSE4" or "SCALAR".
std::string cpuInstructions();

}  // namespace umbrick
