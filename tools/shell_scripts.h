// Completion of the command line, as scripts that bash, zsh and fish read.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "command_tree.h"

namespace umbrick::tools {

/// Each of these returns a script that holds all that it offers, so that no program runs while somebody types.
std::string bashScript(const CommandNode& program);
std::string zshScript(const CommandNode& program);
std::string fishScript(const CommandNode& program);

}  // namespace umbrick::tools
