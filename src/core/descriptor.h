// An open file, and a stream that writes to it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <exception>
#include <filesystem>
#include <ostream>
#include <streambuf>
#include <string>
#include <utility>
#include <vector>

namespace umbrick {

/// Owns a file descriptor.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  int number() const { return number_; }
  explicit operator bool() const { return number_ >= 0; }
  /// Returns 0, or errno of what the system could not write until now.
  int close();
  /// Returns a name of the open file, whether or not a folder has one.
  std::filesystem::path procPath() const { return "/proc/self/fd/" + std::to_string(number_); }

 private:
  int number_ = -1;
};

/// Writes all of the bytes, however many calls that takes. @param name  of the file, for messages
/// @throw PipeClosed  nobody reads any more  @throw IoError
void writeAll(int descriptor, const char* bytes, std::size_t count, const std::string& name);

/// Copies a file from its beginning to another one. @throw IoError, PipeClosed  as writeAll
void copyAll(int from, int to, const std::string& name);

/// Collects what a stream writes, in large pieces. Errors are thrown as IoError with their reason.
class DescriptorBuffer : public std::streambuf {
 public:
  DescriptorBuffer(int descriptor, std::string name);
  /// Throws again what was thrown first, if anything, in case that somebody has swallowed it.
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 protected:
  int_type overflow(int_type c) override;
  std::streamsize xsputn(const char* bytes, std::streamsize count) override;
  int sync() override;
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode which) override;
  pos_type seekpos(pos_type to, std::ios_base::openmode which) override;

 private:
  void put(const char* bytes, std::size_t count);

  int descriptor_;
  std::string name_;
  std::exception_ptr failure_;
  std::vector<char> buffer_;
};

}  // namespace umbrick
