// What options of several forms come to.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "umbrick/convert/convert_options.h"

namespace umbrick {

/// The options with build.maxError shared out where the output quantises too.
/// @throw OptionsError  options that do not go together
ConvertOptions settled(ConvertOptions options);

}  // namespace umbrick
