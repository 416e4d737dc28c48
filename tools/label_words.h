// The words of --labels.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "umbrick/grid/label_grids.h"

namespace umbrick::tools {

/// The labels of "3,5,liver", or all for "all". @throw UsageError  an empty word
LabelChoice labelChoice(const std::string& text);

/// Returns the arguments of a program with "all" behind a --labels that is followed by no list: by nothing, by an
/// option or by the name of a file.
std::vector<std::string> completeLabels(std::vector<std::string> arguments);

}  // namespace umbrick::tools
