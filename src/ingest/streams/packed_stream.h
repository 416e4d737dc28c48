// Unpacks files of gzip, zlib, xz, zstd or bzip2 while they are read.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

#include "ingest/streams/byte_stream.h"

namespace umbrick {

enum class Packing { none, gzip, zlib, xz, zstd, bzip2, deflate };

/// The packing that the first bytes at `offset` tell. zlib and deflate are never found, since
/// their streams have no magic bytes.
Packing packingOf(const std::filesystem::path& path, std::int64_t offset = 0);

/// "gzip" ... "deflate"; "plain" for none
std::string_view packingName(Packing packing);

/// Members or frames that follow each other are one stream. Needs some MB whatever the size; streams that need more
/// than half a GB to unpack are refused. `zlib` takes gzip as well.
std::unique_ptr<ByteStream> openPacked(const std::filesystem::path& path, Packing packing, std::int64_t offset = 0);

/// The same for packed bytes out of another stream. @param name  for messages
std::unique_ptr<ByteStream> unpacked(std::unique_ptr<ByteStream> packed, Packing packing, std::string name);

}  // namespace umbrick
