// What reading the written grid back has shown, against what was stated.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/verify.h"

namespace umbrick {

/// @throw Error  that is worse than stated
void checkVerified(const std::filesystem::path& output, const std::string& label, const VerifyReport& seen,
                   const BuildReport& stated);

}  // namespace umbrick
