// A sub-command of the umbrick program declares its options, then runs.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <utility>

#include "command_line.h"
#include "usage_error.h"

namespace umbrick::tools {

class Ranks;

/// Does the work of a sub-command once its options are parsed; returns the exit status.
using Run = std::function<int()>;

/// A sub-command and what it does.
using Command = std::pair<CLI::App*, Run>;

// Each of these is in the file of its name. It adds a sub-command with its options to `app`.
Command addCheck(CLI::App& app);
Command addCompare(CLI::App& app);
Command addCompletion(CLI::App& app);
Command addConvert(CLI::App& app);
Command addInfo(CLI::App& app);
Command addManual(CLI::App& app);
Command addReference(CLI::App& app);
/// @param ranks  share the work; outlive the command
Command addRender(CLI::App& app, Ranks& ranks);
Command addStudy(CLI::App& app);
Command addTf(CLI::App& app);
Command addView(CLI::App& app);

}  // namespace umbrick::tools
