// SPDX-License-Identifier: Apache-2.0
#include "core/descriptor.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "umbrick/core/output.h"

namespace umbrick {
namespace {

constexpr std::size_t kBufferBytes = std::size_t(1) << 18;

[[noreturn]] void fail(const std::string& name) {
  const std::string message = name + ": cannot write: " + std::strerror(errno);
  if (errno == EPIPE) throw PipeClosed(message);
  throw IoError(message);
}

}  // namespace

int Descriptor::close() {
  const int number = std::exchange(number_, -1);
  return number < 0 || ::close(number) == 0 || errno == EINTR ? 0 : errno;
}

void writeAll(int descriptor, const char* bytes, std::size_t count, const std::string& name) {
  while (count > 0) {
    const ssize_t written = ::write(descriptor, bytes, count);
    if (written >= 0) {
      bytes += written;
      count -= static_cast<std::size_t>(written);
    } else if (errno == EAGAIN) {
      // Whoever made the pipe has it return at once. There is nothing else to do but to wait for its reader.
      pollfd wait{descriptor, POLLOUT, 0};
      poll(&wait, 1, -1);
    } else if (errno != EINTR) {
      fail(name);
    }
  }
}

void copyAll(int from, int to, const std::string& name) {
  std::vector<char> block(kBufferBytes);
  for (off_t at = 0;;) {
    const ssize_t count = pread(from, block.data(), block.size(), at);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(name);
    if (count == 0) return;
    writeAll(to, block.data(), static_cast<std::size_t>(count), name);
    at += count;
  }
}

DescriptorBuffer::DescriptorBuffer(int descriptor, std::string name)
    : descriptor_(descriptor), name_(std::move(name)), buffer_(kBufferBytes) {
  setp(buffer_.data(), buffer_.data() + buffer_.size());
}

void DescriptorBuffer::put(const char* bytes, std::size_t count) try {
  writeAll(descriptor_, bytes, count, name_);
} catch (const IoError&) {
  if (!failure_) failure_ = std::current_exception();
  throw;
}

int DescriptorBuffer::sync() {
  const auto count = static_cast<std::size_t>(pptr() - pbase());
  // What could not be written is not tried again.
  setp(buffer_.data(), buffer_.data() + buffer_.size());
  put(buffer_.data(), count);
  return 0;
}

DescriptorBuffer::int_type DescriptorBuffer::overflow(int_type c) {
  sync();
  if (!traits_type::eq_int_type(c, traits_type::eof())) {
    *pptr() = traits_type::to_char_type(c);
    pbump(1);
  }
  return traits_type::not_eof(c);
}

std::streamsize DescriptorBuffer::xsputn(const char* bytes, std::streamsize count) {
  if (count >= epptr() - pptr()) sync();  // what came before is written before
  if (count >= epptr() - pptr()) {
    put(bytes, static_cast<std::size_t>(count));
  } else {
    std::memcpy(pptr(), bytes, static_cast<std::size_t>(count));
    pbump(static_cast<int>(count));
  }
  return count;
}

DescriptorBuffer::pos_type DescriptorBuffer::seekoff(off_type offset, std::ios_base::seekdir from,
                                                     std::ios_base::openmode) {
  const int whence = from == std::ios_base::beg ? SEEK_SET : from == std::ios_base::cur ? SEEK_CUR : SEEK_END;
  const off_t pending = pptr() - pbase();
  // To ask where the stream is writes nothing.
  if (from == std::ios_base::cur && offset == 0) {
    const off_t at = lseek(descriptor_, 0, SEEK_CUR);
    return at < 0 ? pos_type(off_type(-1)) : pos_type(at + pending);
  }
  sync();
  return pos_type(lseek(descriptor_, offset, whence));
}

DescriptorBuffer::pos_type DescriptorBuffer::seekpos(pos_type to, std::ios_base::openmode which) {
  return seekoff(off_type(to), std::ios_base::beg, which);
}

}  // namespace umbrick
