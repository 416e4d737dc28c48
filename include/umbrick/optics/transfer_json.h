// A transfer function as one value of a larger JSON document.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "umbrick/optics/transfer_function.h"

namespace umbrick {
class JsonValue;  // of the room core, which keeps it to the library

/// Reads our own object or ParaView's array. @throw IoError  it is neither
TransferFunction readTransferFunction(const JsonValue& value);
/// Applies a window [low, high] with low < high. @throw IoError  it is no such window
TransferFunction windowedBy(const TransferFunction& transfer, const JsonValue& window);
/// Scales sigma_t by a number >= 0. @throw IoError  it is no such number
TransferFunction scaledBy(const TransferFunction& transfer, const JsonValue& factor);

}  // namespace umbrick
