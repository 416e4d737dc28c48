// How umbrick convert reads its inputs.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "convert_options.h"

namespace umbrick::tools {

/// What of the options says how inputs are read, as the library takes it.
/// @throw UsageError  options of headerless raw that are not whole, or are for inputs of another format
SourceOptions sourceOptions(const ConvertCommand& command);

}  // namespace umbrick::tools
