// Turns voxels that are written as text into the bytes that they stand for.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "ingest/streams/byte_stream.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Decimal numbers between blanks or commas, as voxels of `type` in this machine's byte order.
/// @param name  for messages
std::unique_ptr<ByteStream> decimalStream(std::unique_ptr<ByteStream> text, VoxelType type, std::string name);

/// Pairs of hexadecimal digits, blanks ignored.
std::unique_ptr<ByteStream> hexStream(std::unique_ptr<ByteStream> text, std::string name);

/// Base64 (RFC 4648), blanks ignored. Pieces that were padded each by itself may follow each other. Ends at the first
/// character that is none of its alphabet only if that is '<', which ends the text of an XML element.
std::unique_ptr<ByteStream> base64Stream(std::unique_ptr<ByteStream> text, std::string name);

}  // namespace umbrick
