// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/instructions.h"

#include "core/baseline_instructions.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/instructions.cpp"
#include "core/simd_targets.h"

HWY_BEFORE_NAMESPACE();
namespace umbrick::HWY_NAMESPACE {
namespace {
const char* instructions() { return hwy::TargetName(HWY_TARGET); }
}  // namespace
}  // namespace umbrick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace umbrick {
HWY_EXPORT(instructions);

std::string cpuInstructions() { return HWY_DYNAMIC_DISPATCH(instructions)(); }

void useBaselineInstructions(bool baseline) {
  hwy::SetSupportedTargetsForTest(baseline ? HWY_STATIC_TARGET : 0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace umbrick
#endif
