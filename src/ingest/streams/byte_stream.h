// A stream of bytes that are read in order, from a file or from another stream.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace umbrick {

class ByteStream {
 public:
  virtual ~ByteStream() = default;
  /// Fills `out`, or less of it only at the end of the stream. @return bytes read  @throw IoError
  virtual std::size_t read(std::span<std::byte> out) = 0;
  /// @return bytes skipped, less than `count` only at the end
  virtual std::int64_t skip(std::int64_t count);
  /// True when skipping many bytes takes no longer than skipping one.
  virtual bool skipsFast() { return false; }
};

/// Checks that `path` exists and is not a directory. @return its size, or -1 for pipes and devices
/// @throw IoError
std::int64_t checkedFileSize(const std::filesystem::path& path);

std::unique_ptr<ByteStream> openPlain(const std::filesystem::path& path, std::int64_t offset = 0);

/// The first `count` bytes of what is left of a stream.
std::unique_ptr<ByteStream> firstBytes(std::unique_ptr<ByteStream> stream, std::int64_t count);

/// Streams one after the other. Each is opened when the one before has ended: a volume may lie in thousands of files.
std::unique_ptr<ByteStream> joinStreams(std::vector<std::function<std::unique_ptr<ByteStream>()>> parts);

}  // namespace umbrick
