// Highway, for the sets of SIMD instructions that loops are compiled for. What lies between HWY_BEFORE_NAMESPACE and
// HWY_AFTER_NAMESPACE is compiled once for each set, by including the file again and again, so that this has no guard:
//
//   #undef HWY_TARGET_INCLUDE
//   #define HWY_TARGET_INCLUDE "<room>/<file>.cpp"
//   #include "core/simd_targets.h"
//
// Sets that give little over the next lower one are left out. Sanitizers look at the code for AVX2 and at the baseline:
// it is the same source for all, and each set takes as long to compile as all other files of its room together.
// SPDX-License-Identifier: Apache-2.0
#ifndef HWY_DISABLED_TARGETS
#ifdef __SANITIZE_ADDRESS__
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3 | HWY_AVX3_DL)
#else
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#endif
#endif
// Highway's own order.
// clang-format off
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on
