// SPDX-License-Identifier: Apache-2.0
#include "vdb/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "umbrick/core/error.h"

namespace umbrick {

MappedFile::MappedFile(const std::filesystem::path& path) {
  // Of a pipe nobody may ever open the other end.
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0 && errno == ENOENT) throw IoError(path.string() + ": no such file");
  if (file < 0) throw IoError(path.string() + ": cannot read: " + std::strerror(errno));
  struct stat status {};
  const bool known = fstat(file, &status) == 0;
  if (known && S_ISREG(status.st_mode) && status.st_size > 0) {
    const auto size = static_cast<std::size_t>(status.st_size);
    void* memory = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_NORESERVE, file, 0);
    if (memory != MAP_FAILED) bytes_ = {static_cast<char*>(memory), size};
  }
  const int error = errno;
  close(file);
  if (known && S_ISDIR(status.st_mode)) throw IoError(path.string() + ": expected a file, found a directory");
  if (known && !S_ISREG(status.st_mode)) throw IoError(path.string() + ": expected a file, found a pipe or device");
  if (!known || (status.st_size > 0 && bytes_.empty()))
    throw IoError(path.string() + ": cannot read: " + std::strerror(error));
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) munmap(bytes_.data(), bytes_.size());
}

std::streamsize MemoryStreamBuffer::xsgetn(char* to, std::streamsize count) {
  constexpr std::size_t kTellEvery = 1 << 20;
  const auto position = static_cast<std::size_t>(gptr() - eback());
  if (told_ && position >= toldAt_ + kTellEvery) {
    toldAt_ = position;
    told_(position);
  }
  return std::streambuf::xsgetn(to, count);
}

MemoryStreamBuffer::pos_type MemoryStreamBuffer::seekoff(off_type offset, std::ios_base::seekdir from,
                                                         std::ios_base::openmode) {
  const off_type size = egptr() - eback();
  const off_type base = from == std::ios_base::beg ? 0 : from == std::ios_base::cur ? gptr() - eback() : size;
  if (offset < -base || offset > size - base) return pos_type(off_type(-1));
  setg(eback(), eback() + base + offset, egptr());
  return pos_type(base + offset);
}

}  // namespace umbrick
