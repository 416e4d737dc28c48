// SPDX-License-Identifier: Apache-2.0
#include "umbrick/convert/target.h"

namespace umbrick {

const TargetTraits& traitsOf(Target target) {
  constexpr std::int64_t kGiB = std::int64_t(1) << 30;
  static constexpr TargetTraits kBlender{.name = "Blender",
                                         .metresPerUnit = 1,
                                         .unit = "m",
                                         .up = Axis::z,
                                         .unitValues = true,
                                         .longest = 2048,
                                         .mostBytes = 2 * kGiB,
                                         .dense = true};
  static constexpr TargetTraits kHoudini{
      .name = "Houdini", .metresPerUnit = 1, .unit = "m", .up = Axis::y, .velocity = "vel", .colour = "Cd"};
  static constexpr TargetTraits kUnreal{.name = "Unreal Engine",
                                        .metresPerUnit = 0.01,
                                        .unit = "cm",
                                        .up = Axis::z,
                                        .leftHanded = true,
                                        .unitValues = true,
                                        .longest = 2048,
                                        .mostBytes = 2 * kGiB};
  static constexpr TargetTraits kOmniverse{
      .name = "Omniverse", .metresPerUnit = 0.01, .unit = "cm", .up = Axis::y, .unitValues = true};
  switch (target) {
    case Target::houdini:
      return kHoudini;
    case Target::unreal:
      return kUnreal;
    case Target::omniverse:
      return kOmniverse;
    case Target::blender:
      break;
  }
  return kBlender;
}

}  // namespace umbrick
