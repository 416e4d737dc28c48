// The bar of a conversion, and its end by Ctrl-C.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "progress.h"
#include "umbrick/convert/convert_progress.h"

namespace umbrick::tools {

/// What shows how far a conversion is, and ends it when the user wants it to stop.
/// @param bar, stop    outlive it
/// @param interrupted  what is said then
ConvertProgressCallback showProgress(ProgressBar& bar, const StopRequest& stop, std::string interrupted);

}  // namespace umbrick::tools
