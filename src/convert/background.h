// Backgrounds that the limits of a conversion would keep.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "umbrick/grid/build_grid.h"

namespace umbrick {

/// Whether limits leave out what lies below some value and give it a background above that value: air would become
/// denser than the tissue that stays.
bool keepsBackground(const BuildOptions& build, float background);

/// @throw OptionsError  the limits keep this background
/// @param whose  where the background comes from
void refuseKept(const std::filesystem::path& input, const BuildOptions& build, float background, const char* whose);

}  // namespace umbrick
