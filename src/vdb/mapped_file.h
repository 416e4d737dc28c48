// The bytes of a file in memory, and a stream over them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <streambuf>

namespace umbrick {

/// A private mapping of a file: what is written to it never reaches the file.
class MappedFile {
 public:
  /// @throw IoError  the file is missing, a directory, or not readable
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  std::span<char> bytes() const { return bytes_; }

 private:
  std::span<char> bytes_;
};

/// A stream buffer over memory. A read past the end is short, which makes a stream with exceptions throw.
class MemoryStreamBuffer : public std::streambuf {
 public:
  explicit MemoryStreamBuffer(std::span<char> bytes) { setg(bytes.data(), bytes.data(), bytes.data() + bytes.size()); }

 protected:
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override;
  pos_type seekpos(pos_type position, std::ios_base::openmode mode) override {
    return seekoff(off_type(position), std::ios_base::beg, mode);
  }
};

}  // namespace umbrick
