// SPDX-License-Identifier: Apache-2.0
#include "ingest/streams/packed_stream.h"

#include <bzlib.h>
#include <lzma.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kPackedChunkBytes = std::size_t(1) << 18;
constexpr std::uint64_t kMaxDecoderBytes = std::uint64_t(1) << 29;

// What one call of a codec did; it moves the beginnings of both spans.
struct Step {
  bool ended = false;           // the stream (member, frame) is complete
  const char* error = nullptr;  // static text
};

class Codec {
 public:
  virtual ~Codec() = default;
  virtual Step step(std::span<const std::byte>& in, std::span<std::byte>& out) = 0;
  /// Ready for another stream behind the one that ended.
  virtual void restart() = 0;
};

// The codecs that look like zlib: next_in, avail_in, next_out, avail_out.
template <class Stream>
void give(Stream& stream, std::span<const std::byte> in, std::span<std::byte> out) {
  using In = std::remove_reference_t<decltype(*stream.next_in)>;
  using Out = std::remove_reference_t<decltype(*stream.next_out)>;
  stream.next_in = const_cast<In*>(reinterpret_cast<const std::remove_const_t<In>*>(in.data()));
  stream.next_out = reinterpret_cast<Out*>(out.data());
  stream.avail_in = static_cast<decltype(stream.avail_in)>(in.size());
  stream.avail_out = static_cast<decltype(stream.avail_out)>(std::min(out.size(), std::size_t(1) << 30));
}
template <class Stream>
void take(const Stream& stream, std::span<const std::byte>& in, std::span<std::byte>& out) {
  in = in.last(stream.avail_in);
  out = out.subspan(static_cast<std::size_t>(reinterpret_cast<std::byte*>(stream.next_out) - out.data()));
}

class ZlibCodec : public Codec {
 public:
  /// @param windowBits  15 + 32: gzip as well; -15: deflate without a head or sum of its own
  explicit ZlibCodec(int windowBits = 15 + 32) {
    if (inflateInit2(&stream_, windowBits) != Z_OK) throw IoError("cannot unpack zlib: out of memory");
  }
  ~ZlibCodec() override { inflateEnd(&stream_); }
  ZlibCodec(const ZlibCodec&) = delete;
  ZlibCodec& operator=(const ZlibCodec&) = delete;
  Step step(std::span<const std::byte>& in, std::span<std::byte>& out) override {
    give(stream_, in, out);
    const int status = inflate(&stream_, Z_NO_FLUSH);
    take(stream_, in, out);
    if (status == Z_STREAM_END) return {true};
    if (status == Z_OK || status == Z_BUF_ERROR) return {};
    return {false, stream_.msg ? stream_.msg : "the packed data are damaged"};
  }
  void restart() override { inflateReset(&stream_); }

 private:
  z_stream stream_{};
};

class XzCodec : public Codec {
 public:
  XzCodec() { restart(); }
  ~XzCodec() override { lzma_end(&stream_); }
  XzCodec(const XzCodec&) = delete;
  XzCodec& operator=(const XzCodec&) = delete;
  Step step(std::span<const std::byte>& in, std::span<std::byte>& out) override {
    give(stream_, in, out);
    const lzma_ret status = lzma_code(&stream_, LZMA_RUN);
    take(stream_, in, out);
    switch (status) {
      case LZMA_STREAM_END:
        return {true};
      case LZMA_OK:
      case LZMA_BUF_ERROR:
        return {};
      case LZMA_MEMLIMIT_ERROR:
        return {false, "it needs more than 512 MB to unpack"};
      case LZMA_FORMAT_ERROR:
        return {false, "unknown bytes where a stream begins"};
      default:
        return {false, "the packed data are damaged"};
    }
  }
  void restart() override {
    if (lzma_stream_decoder(&stream_, kMaxDecoderBytes, 0) != LZMA_OK) throw IoError("cannot unpack xz: out of memory");
  }

 private:
  lzma_stream stream_ = LZMA_STREAM_INIT;
};

class ZstdCodec : public Codec {
 public:
  ZstdCodec() : stream_(ZSTD_createDStream()) {
    if (!stream_) throw IoError("cannot unpack zstd: out of memory");
  }
  ~ZstdCodec() override { ZSTD_freeDStream(stream_); }
  ZstdCodec(const ZstdCodec&) = delete;
  ZstdCodec& operator=(const ZstdCodec&) = delete;
  Step step(std::span<const std::byte>& in, std::span<std::byte>& out) override {
    ZSTD_inBuffer from{in.data(), in.size(), 0};
    ZSTD_outBuffer to{out.data(), out.size(), 0};
    const std::size_t left = ZSTD_decompressStream(stream_, &to, &from);
    in = in.subspan(from.pos);
    out = out.subspan(to.pos);
    if (ZSTD_isError(left)) return {false, ZSTD_getErrorName(left)};
    return {left == 0};
  }
  void restart() override { ZSTD_DCtx_reset(stream_, ZSTD_reset_session_only); }

 private:
  ZSTD_DStream* stream_;
};

class Bzip2Codec : public Codec {
 public:
  Bzip2Codec() { begin(); }
  ~Bzip2Codec() override { BZ2_bzDecompressEnd(&stream_); }
  Bzip2Codec(const Bzip2Codec&) = delete;
  Bzip2Codec& operator=(const Bzip2Codec&) = delete;
  Step step(std::span<const std::byte>& in, std::span<std::byte>& out) override {
    give(stream_, in, out);
    const int status = BZ2_bzDecompress(&stream_);
    take(stream_, in, out);
    if (status == BZ_STREAM_END) return {true};
    if (status == BZ_OK) return {};
    return {false,
            status == BZ_DATA_ERROR_MAGIC ? "unknown bytes where a stream begins" : "the packed data are damaged"};
  }
  void restart() override {
    BZ2_bzDecompressEnd(&stream_);
    begin();
  }

 private:
  void begin() {
    stream_ = {};
    if (BZ2_bzDecompressInit(&stream_, 0, 0) != BZ_OK) throw IoError("cannot unpack bzip2: out of memory");
  }
  bz_stream stream_{};
};

std::unique_ptr<Codec> makeCodec(Packing packing) {
  switch (packing) {
    case Packing::xz:
      return std::make_unique<XzCodec>();
    case Packing::zstd:
      return std::make_unique<ZstdCodec>();
    case Packing::bzip2:
      return std::make_unique<Bzip2Codec>();
    case Packing::deflate:
      return std::make_unique<ZlibCodec>(-15);
    default:
      return std::make_unique<ZlibCodec>();
  }
}

class UnpackedStream : public ByteStream {
 public:
  UnpackedStream(std::unique_ptr<ByteStream> packed, Packing packing, std::string name)
      : packed_(std::move(packed)),
        packing_(packing),
        codec_(makeCodec(packing)),
        name_(std::move(name)),
        buffer_(kPackedChunkBytes) {}

  std::size_t read(std::span<std::byte> out) override {
    std::span<std::byte> rest = out;
    while (!rest.empty()) {
      if (in_.empty()) in_ = std::span(buffer_).first(packed_->read(buffer_));
      if (in_.empty() && between_) break;
      if (between_ && begun_ && padding()) break;
      if (between_ && begun_) codec_->restart();
      between_ = false;
      begun_ = true;
      const std::size_t before = rest.size(), left = in_.size();
      const Step step = codec_->step(in_, rest);
      total_ += before - rest.size();
      between_ = step.ended;
      if (step.error) fail(step.error);
      const bool stuck = rest.size() == before && in_.size() == left && !step.ended;
      if (stuck && !in_.empty()) fail("the packed data are damaged");
      if (stuck) fail("the packed data end early");
    }
    return out.size() - rest.size();
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw IoError(name_ + ": cannot unpack " + std::string(packingName(packing_)) + ": " + what + ", after " +
                  std::to_string(total_) + " unpacked bytes");
  }

  // What follows a gzip stream and is none is ignored, as gzip does. Nothing follows a deflated one.
  bool padding() const {
    if (packing_ == Packing::deflate) return true;
    return (packing_ == Packing::gzip || packing_ == Packing::zlib) && in_.front() != std::byte(0x1f);
  }

  std::unique_ptr<ByteStream> packed_;
  Packing packing_;
  std::unique_ptr<Codec> codec_;
  std::string name_;
  std::vector<std::byte> buffer_;
  std::span<const std::byte> in_;
  bool between_ = true, begun_ = false;  // between two streams: the file may end here
  std::uint64_t total_ = 0;
};

}  // namespace

std::string_view packingName(Packing packing) {
  static constexpr std::array<std::string_view, 7> kNames{"plain", "gzip", "zlib", "xz", "zstd", "bzip2", "deflate"};
  return kNames[static_cast<std::size_t>(packing)];
}

Packing packingOf(const fs::path& path, std::int64_t offset) {
  std::array<char, 6> bytes{};
  openPlain(path, offset)->read(std::as_writable_bytes(std::span(bytes)));
  const std::string_view magic(bytes.data(), bytes.size());
  if (magic.starts_with("\x1f\x8b")) return Packing::gzip;
  if (magic == std::string_view("\xfd"
                                "7zXZ\0",
                                6))
    return Packing::xz;
  if (magic.starts_with("\x28\xb5\x2f\xfd")) return Packing::zstd;
  if (magic.starts_with("BZh") && magic[3] >= '1' && magic[3] <= '9') return Packing::bzip2;
  return Packing::none;
}

std::unique_ptr<ByteStream> unpacked(std::unique_ptr<ByteStream> packed, Packing packing, std::string name) {
  return std::make_unique<UnpackedStream>(std::move(packed), packing, std::move(name));
}

std::unique_ptr<ByteStream> openPacked(const fs::path& path, Packing packing, std::int64_t offset) {
  if (packing == Packing::none) return openPlain(path, offset);
  return unpacked(openPlain(path, offset), packing, path.string());
}

}  // namespace umbrick
