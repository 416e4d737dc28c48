// What is wrong with the options of a conversion.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "umbrick/core/error.h"

namespace umbrick {

/// The options do not go together or do not fit the inputs, which is seen before any voxel is converted. Messages name
/// fields as the caller writes them: "output.codec is for .vdb, not for .nvdb". What openVolume refuses is such an
/// error too; its own error is nested in this one (std::rethrow_if_nested).
struct OptionsError : InvalidArgument {
  using InvalidArgument::InvalidArgument;
};

}  // namespace umbrick
