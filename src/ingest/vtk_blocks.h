// The bytes of an array of a VTK XML file: a length and plain bytes, or blocks that are packed one by one.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstdint>
#include <memory>
#include <string>

#include "ingest/streams/byte_stream.h"

namespace umbrick {

enum class VtkCompressor { none, zlib, lz4, lzma };

struct VtkBlocks {
  VtkCompressor compressor = VtkCompressor::none;
  std::endian endian = std::endian::little;  // of the numbers in front of the blocks
  bool wide = false;                         // those have 64 bits, not 32
};

/// The unpacked bytes, of which the array must have `expected`. What stands in front of the blocks is checked against
/// that before anything is allocated; one block is held at a time.
/// Format: https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html
/// @param bytes  stands at the first of these numbers
/// @param name   for messages
/// @throw IoError
std::unique_ptr<ByteStream> vtkBlockStream(std::unique_ptr<ByteStream> bytes, const VtkBlocks& blocks,
                                           std::int64_t expected, std::string name);

}  // namespace umbrick
