// SPDX-License-Identifier: Apache-2.0
#include "ingest/streams/byte_stream.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMostReadBytes = std::size_t(1) << 30;  // read() takes no more than 2 GB at once

IoError systemError(const fs::path& path, const char* what) {
  return IoError(path.string() + ": " + what + ": " + std::strerror(errno));
}

// An open file, closed with its owner.
class Descriptor {
 public:
  Descriptor(const fs::path& path, std::int64_t offset) : file_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (file_ < 0) throw systemError(path, "cannot read");
    if (offset > 0 && lseek(file_, offset, SEEK_SET) < 0) {
      close(file_);
      throw systemError(path, "cannot read");
    }
  }
  ~Descriptor() { close(file_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return file_; }

 private:
  int file_;
};

class PlainStream : public ByteStream {
 public:
  PlainStream(const fs::path& path, std::int64_t offset) : path_(path), file_(path, offset) {}
  std::size_t read(std::span<std::byte> out) override {
    std::size_t done = 0;
    while (done < out.size()) {
      const ssize_t got = ::read(file_.get(), out.data() + done, std::min(out.size() - done, kMostReadBytes));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) throw systemError(path_, "cannot read");
      if (got == 0) break;
      done += static_cast<std::size_t>(got);
    }
    return done;
  }
  std::int64_t skip(std::int64_t count) override {
    const std::int64_t left = regularBytesLeft();
    if (left < 0) return ByteStream::skip(count);
    const std::int64_t skipped = std::min(count, left);
    if (lseek(file_.get(), skipped, SEEK_CUR) < 0) throw systemError(path_, "cannot read");
    return skipped;
  }
  bool skipsFast() override { return regularBytesLeft() >= 0; }

 private:
  // -1 for pipes and devices.
  std::int64_t regularBytesLeft() const {
    struct stat status {};
    if (fstat(file_.get(), &status) != 0 || !S_ISREG(status.st_mode)) return -1;
    return std::max<std::int64_t>(status.st_size - lseek(file_.get(), 0, SEEK_CUR), 0);
  }

  fs::path path_;
  Descriptor file_;
};

class JoinedStream : public ByteStream {
 public:
  explicit JoinedStream(std::vector<std::function<std::unique_ptr<ByteStream>()>> parts) : parts_(std::move(parts)) {}
  std::size_t read(std::span<std::byte> out) override {
    std::size_t done = 0;
    while (done < out.size() && openNext()) {
      done += open_->read(out.subspan(done));
      if (done < out.size()) open_.reset();
    }
    return done;
  }
  std::int64_t skip(std::int64_t count) override {
    std::int64_t done = 0;
    while (done < count && openNext()) {
      done += open_->skip(count - done);
      if (done < count) open_.reset();
    }
    return done;
  }
  bool skipsFast() override { return openNext() && open_->skipsFast(); }

 private:
  // @return false behind the last one
  bool openNext() {
    if (!open_ && next_ < parts_.size()) open_ = parts_[next_++]();
    return open_ != nullptr;
  }

  std::vector<std::function<std::unique_ptr<ByteStream>()>> parts_;
  std::unique_ptr<ByteStream> open_;
  std::size_t next_ = 0;
};

class FirstBytes : public ByteStream {
 public:
  FirstBytes(std::unique_ptr<ByteStream> stream, std::int64_t count) : stream_(std::move(stream)), left_(count) {}
  std::size_t read(std::span<std::byte> out) override {
    const auto want = static_cast<std::size_t>(std::min<std::int64_t>(std::ssize(out), left_));
    const std::size_t got = stream_->read(out.first(want));
    left_ -= static_cast<std::int64_t>(got);
    return got;
  }
  std::int64_t skip(std::int64_t count) override {
    const std::int64_t done = stream_->skip(std::min(count, left_));
    left_ -= done;
    return done;
  }
  bool skipsFast() override { return stream_->skipsFast(); }

 private:
  std::unique_ptr<ByteStream> stream_;
  std::int64_t left_;
};

}  // namespace

std::int64_t ByteStream::skip(std::int64_t count) {
  std::vector<std::byte> scratch(static_cast<std::size_t>(std::clamp<std::int64_t>(count, 0, 1 << 20)));
  std::int64_t done = 0;
  while (done < count) {
    const auto want = static_cast<std::size_t>(std::min<std::int64_t>(count - done, 1 << 20));
    const std::size_t got = read(std::span(scratch).first(want));
    done += static_cast<std::int64_t>(got);
    if (got < want) break;
  }
  return done;
}

std::int64_t checkedFileSize(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) throw IoError(path.string() + ": no such file");
  if (status.type() == fs::file_type::directory) throw IoError(path.string() + ": expected a file, found a directory");
  if (error) throw IoError(path.string() + ": cannot read: " + error.message());
  if (status.type() != fs::file_type::regular) return -1;
  const auto size = fs::file_size(path, error);
  if (error) throw IoError(path.string() + ": cannot read: " + error.message());
  return static_cast<std::int64_t>(size);
}

std::unique_ptr<ByteStream> openPlain(const fs::path& path, std::int64_t offset) {
  return std::make_unique<PlainStream>(path, offset);
}

std::unique_ptr<ByteStream> firstBytes(std::unique_ptr<ByteStream> stream, std::int64_t count) {
  return std::make_unique<FirstBytes>(std::move(stream), count);
}

std::unique_ptr<ByteStream> joinStreams(std::vector<std::function<std::unique_ptr<ByteStream>()>> parts) {
  return std::make_unique<JoinedStream>(std::move(parts));
}

}  // namespace umbrick
