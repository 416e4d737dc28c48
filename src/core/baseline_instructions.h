// A switch for tests: all sets of SIMD instructions have to give the same results.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace umbrick {

/// Uses no instructions better than the baseline of the machine's kind in any loop, or all of them again.
void useBaselineInstructions(bool baseline);

}  // namespace umbrick
