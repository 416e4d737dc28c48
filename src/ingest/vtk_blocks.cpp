// SPDX-License-Identifier: Apache-2.0
#include "ingest/vtk_blocks.h"

#include <lz4.h>
#include <lzma.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "umbrick/core/error.h"

namespace umbrick {
namespace {

constexpr std::uint64_t kMaxBlock = std::uint64_t(1) << 30;  // VTK writes 4 MB at most unless told otherwise

class BlockStream : public ByteStream {
 public:
  BlockStream(std::unique_ptr<ByteStream> bytes, const VtkBlocks& blocks, std::uint64_t expected, std::string name)
      : bytes_(std::move(bytes)), format_(blocks), left_(expected), name_(std::move(name)) {
    if (format_.compressor == VtkCompressor::none) {
      expect("bytes of the array", expected, number());
      return;
    }
    blocks_ = number();
    blockBytes_ = number();
    const std::uint64_t last = number();
    if (blockBytes_ < 1 || blockBytes_ > kMaxBlock)
      fail("bytes of a block", "1 to " + std::to_string(kMaxBlock), std::to_string(blockBytes_));
    expect("number of blocks", (expected + blockBytes_ - 1) / blockBytes_, blocks_);
    if (last != 0 || expected % blockBytes_ != 0) expect("bytes of the last block", expected % blockBytes_, last);
    // Sizes are read one at a time, so that a false number of blocks ends with the file and not with the memory.
    for (std::uint64_t i = 0; i < blocks_; ++i) packedSizes_.push_back(number());
  }

  std::size_t read(std::span<std::byte> out) override {
    std::size_t done = 0;
    while (done < out.size() && left_ > 0) {
      std::size_t got = 0;
      const auto want = static_cast<std::size_t>(std::min<std::uint64_t>(out.size() - done, left_));
      if (format_.compressor == VtkCompressor::none) {
        got = bytes_->read(out.subspan(done, want));
        if (got == 0) break;
      } else {
        if (at_ == block_.size()) unpackNext();
        got = std::min(want, block_.size() - at_);
        std::memcpy(out.data() + done, block_.data() + at_, got);
        at_ += got;
      }
      left_ -= got;
      done += got;
    }
    return done;
  }

 private:
  [[noreturn]] void fail(const std::string& field, const std::string& expected, const std::string& found) const {
    throw IoError(name_ + ": " + field + ": expected " + expected + ", found " + found);
  }
  void expect(const std::string& field, std::uint64_t expected, std::uint64_t found) const {
    if (expected != found) fail(field, std::to_string(expected), std::to_string(found));
  }

  std::uint64_t number() {
    std::array<std::byte, 8> in{};
    const std::size_t width = format_.wide ? 8 : 4;
    if (bytes_->read(std::span(in).first(width)) < width)
      fail("numbers in front of the data", "one of " + std::to_string(width) + " bytes", "the end of the data");
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < width; ++i)
      value = value << 8 | std::to_integer<std::uint64_t>(in[format_.endian == std::endian::big ? i : width - 1 - i]);
    return value;
  }

  void unpackNext() {
    const std::string field = "block " + std::to_string(next_ + 1);
    const std::uint64_t packedSize = packedSizes_[next_++];
    // No packer needs more than this for data that cannot be packed.
    if (packedSize > blockBytes_ + blockBytes_ / 8 + 4096)
      fail(field, "packed bytes for " + std::to_string(blockBytes_), std::to_string(packedSize));
    packed_.resize(static_cast<std::size_t>(packedSize));
    if (const std::size_t got = bytes_->read(packed_); got < packed_.size())
      fail(field, std::to_string(packedSize) + " packed bytes", std::to_string(got));
    block_.resize(static_cast<std::size_t>(std::min(left_, blockBytes_)));
    at_ = 0;
    const auto got = unpack();
    if (got != block_.size())
      fail(field, std::to_string(block_.size()) + " bytes after unpacking",
           got == 0 ? "corrupt data" : std::to_string(got));
  }

  // @return the bytes of the block, 0 when it is corrupt
  std::size_t unpack() {
    const auto* from = reinterpret_cast<const unsigned char*>(packed_.data());
    auto* to = reinterpret_cast<unsigned char*>(block_.data());
    if (format_.compressor == VtkCompressor::zlib) {
      uLongf size = block_.size();
      return uncompress(to, &size, from, packed_.size()) == Z_OK ? size : 0;
    }
    if (format_.compressor == VtkCompressor::lz4) {
      const int size = LZ4_decompress_safe(reinterpret_cast<const char*>(from), reinterpret_cast<char*>(to),
                                           static_cast<int>(packed_.size()), static_cast<int>(block_.size()));
      return size < 0 ? 0 : static_cast<std::size_t>(size);
    }
    std::uint64_t memory = kMaxBlock;
    std::size_t in = 0, out = 0;
    return lzma_stream_buffer_decode(&memory, 0, nullptr, from, &in, packed_.size(), to, &out, block_.size()) == LZMA_OK
               ? out
               : 0;
  }

  std::unique_ptr<ByteStream> bytes_;
  VtkBlocks format_;
  std::uint64_t left_, blocks_ = 0, blockBytes_ = 0;
  std::string name_;
  std::vector<std::uint64_t> packedSizes_;
  std::size_t next_ = 0, at_ = 0;
  std::vector<std::byte> packed_, block_;
};

}  // namespace

std::unique_ptr<ByteStream> vtkBlockStream(std::unique_ptr<ByteStream> bytes, const VtkBlocks& blocks,
                                           std::int64_t expected, std::string name) {
  return std::make_unique<BlockStream>(std::move(bytes), blocks, static_cast<std::uint64_t>(expected), std::move(name));
}

}  // namespace umbrick
