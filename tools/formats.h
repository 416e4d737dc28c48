// Prints the list of formats that are read.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "command_line.h"

namespace umbrick::tools {

/// Adds --list-formats, which prints the list and ends the program, and --list-formats-json, which does so as JSON.
void addListFormats(CLI::App& command);

}  // namespace umbrick::tools
