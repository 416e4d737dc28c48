// Bytes in order, plain or unpacked on the way.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

namespace umbrick {

class ByteStream {
 public:
  virtual ~ByteStream() = default;
  /// Fills `out`; less only at the end. @return bytes read  @throw IoError
  virtual std::size_t read(std::span<std::byte> out) = 0;
  /// @return bytes skipped, less than `count` only at the end
  std::int64_t skip(std::int64_t count);
};

/// Checks that `path` can be opened and is not a directory. @return its size, or -1 for pipes and devices @throw
/// IoError
std::int64_t checkedFileSize(const std::filesystem::path& path);

/// True when the file at `offset` starts with the magic bytes of gzip.
bool isGzip(const std::filesystem::path& path, std::int64_t offset = 0);

std::unique_ptr<ByteStream> openPlain(const std::filesystem::path& path, std::int64_t offset = 0);
std::unique_ptr<ByteStream> openGzip(const std::filesystem::path& path, std::int64_t offset = 0);

/// One after the other.
std::unique_ptr<ByteStream> joinStreams(std::vector<std::unique_ptr<ByteStream>> parts);

/// Up to `count` bytes of a stream.
std::unique_ptr<ByteStream> limitStream(std::unique_ptr<ByteStream> stream, std::int64_t count);

}  // namespace umbrick
