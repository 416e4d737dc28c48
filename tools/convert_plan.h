// What umbrick convert --plan prints.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "umbrick/grid/plan.h"

namespace umbrick::tools {

/// On stdout.
/// @param codec  of the .vdb
void printPlan(const std::filesystem::path& input, const GridPlan& plan, const char* codec);

}  // namespace umbrick::tools
