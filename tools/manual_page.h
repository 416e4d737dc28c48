// Pages of the manual, as man reads them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "command_tree.h"

namespace umbrick::tools {

/// Returns the page of a command in the macros of man(7).
/// @param program  the program, of which `node` is a command or the program itself
/// @param version  "umbrick 0.1.0"
std::string manualPage(const CommandNode& node, const CommandNode& program, const std::string& version);

}  // namespace umbrick::tools
