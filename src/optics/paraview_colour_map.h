// ParaView's colour-map JSON.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/json_reader.h"
#include "umbrick/optics/transfer_function.h"

namespace umbrick {

/// Reads a colour map; parseTransferFunction tells what becomes of colours and opacities.
/// @param maps  the array of the file
/// @throw IoError  it is not such an array
TransferFunction readParaViewColourMap(const JsonValue& maps);

}  // namespace umbrick
