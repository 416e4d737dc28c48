// A transfer function as one value of a larger JSON document.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "umbrick/optics/transfer_function.h"

namespace umbrick {
class JsonValue;  // of the room core, which keeps it to the library

/// Our own object or ParaView's array. @throw IoError
TransferFunction readTransferFunction(const JsonValue& value);
/// [low, high], low < high. @throw IoError
TransferFunction windowedBy(const TransferFunction& transfer, const JsonValue& window);
/// A number >= 0. @throw IoError
TransferFunction scaledBy(const TransferFunction& transfer, const JsonValue& factor);

}  // namespace umbrick
