// The bytes of a file in memory, and a stream over them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <streambuf>
#include <utility>

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

  /// Calls `told` every mebibyte or so that is read, with the position in the memory. What it throws leaves the read
  /// that met it, through a stream with exceptions too. Empty: nothing is told.
  void tell(std::function<void(std::size_t position)> told) {
    told_ = std::move(told);
    toldAt_ = 0;
  }

 protected:
  std::streamsize xsgetn(char* to, std::streamsize count) override;
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override;
  pos_type seekpos(pos_type position, std::ios_base::openmode mode) override {
    return seekoff(off_type(position), std::ios_base::beg, mode);
  }

 private:
  std::function<void(std::size_t)> told_;
  std::size_t toldAt_ = 0;
};

}  // namespace umbrick
