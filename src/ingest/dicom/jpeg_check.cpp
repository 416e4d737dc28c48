// SPDX-License-Identifier: Apache-2.0
#include "ingest/dicom/jpeg_check.h"

#include <array>
#include <cstdint>
#include <vector>

namespace umbrick {
namespace {

struct Damage {
  std::string what;
};
struct NotChecked {};

// A stream cut into bytes, markers and segments.
class JpegBytes {
 public:
  explicit JpegBytes(std::span<const std::byte> stream) : rest_(stream) {}
  int next() {
    if (rest_.empty()) throw Damage{"the data end early"};
    const int value = std::to_integer<int>(rest_.front());
    rest_ = rest_.subspan(1);
    return value;
  }
  int next2() {
    const int high = next();
    return high << 8 | next();
  }
  // Its code, 0xd8 for the start of the image.
  int marker() {
    if (next() != 0xff) throw Damage{"expected a marker, found other bytes"};
    int code = next();
    while (code == 0xff) code = next();
    return code;
  }
  JpegBytes segment() {
    const int length = next2();
    if (length < 2 || static_cast<std::size_t>(length - 2) > rest_.size())
      throw Damage{"a segment of " + std::to_string(length) + " bytes runs past the end"};
    const JpegBytes out(rest_.first(static_cast<std::size_t>(length - 2)));
    rest_ = rest_.subspan(static_cast<std::size_t>(length - 2));
    return out;
  }
  bool empty() const { return rest_.empty(); }
  // -1 behind the end.
  int at(std::size_t i) const { return i < rest_.size() ? std::to_integer<int>(rest_[i]) : -1; }
  void skip(std::size_t count) { rest_ = rest_.subspan(count); }

 private:
  std::span<const std::byte> rest_;
};

// The bits between two markers.
class Bits {
 public:
  explicit Bits(JpegBytes& bytes) : bytes_(bytes) {}
  // The next 16, filled up with zeros at the end.
  std::uint32_t peek() {
    while (count_ < 16 && fill()) {
    }
    return static_cast<std::uint32_t>(count_ >= 16 ? bits_ >> (count_ - 16) : bits_ << (16 - count_)) & 0xffff;
  }
  void drop(int count) {
    peek();
    if (count > count_) throw Damage{"the codes end early"};
    count_ -= count;
    bits_ &= (std::uint64_t(1) << count_) - 1;
  }
  // To the marker, which less than a byte of padding may come before.
  void end() {
    if (count_ >= 8 || fill()) throw Damage{"bytes are left over behind the last code"};
    count_ = 0;
    bits_ = 0;
  }

 private:
  bool fill() {
    const int byte = bytes_.at(0);
    if (byte < 0 || (byte == 0xff && bytes_.at(1) != 0)) return false;
    bytes_.skip(byte == 0xff ? 2 : 1);  // 0xff in the data is followed by 0
    bits_ = bits_ << 8 | static_cast<std::uint64_t>(byte);
    count_ += 8;
    return true;
  }

  JpegBytes& bytes_;
  std::uint64_t bits_ = 0;
  int count_ = 0;
};

// Codes by the 16 bits that begin with them.
class HuffmanTable {
 public:
  void read(JpegBytes& segment) {
    std::array<int, 16> counts;
    for (int& count : counts) count = segment.next();
    codes_.assign(1 << 16, {});
    std::uint32_t first = 0;
    for (int length = 1; length <= 16; ++length)
      for (int i = 0; i < counts[static_cast<std::size_t>(length - 1)]; ++i) {
        const std::uint32_t behind = first + (std::uint32_t(1) << (16 - length));
        if (behind > codes_.size()) throw Damage{"a Huffman table has too many codes"};
        const Code code{static_cast<std::uint8_t>(length), static_cast<std::uint8_t>(segment.next())};
        for (; first < behind; ++first) codes_[first] = code;
      }
  }
  int symbol(Bits& bits) const {
    // DICOM has interchange streams, PS3.5 section 8.2.1: abbreviated ones have their tables elsewhere.
    if (codes_.empty()) throw Damage{"a table of Huffman codes is missing"};
    const Code code = codes_[bits.peek()];
    if (code.length == 0) throw Damage{"expected a Huffman code, found none"};
    bits.drop(code.length);
    return code.symbol;
  }

 private:
  struct Code {
    std::uint8_t length = 0, symbol = 0;
  };
  std::vector<Code> codes_;
};

class JpegCheck {
 public:
  explicit JpegCheck(std::span<const std::byte> stream) : bytes_(stream) {}

  void run() {
    if (bytes_.marker() != 0xd8) throw NotChecked{};
    for (int marker = bytes_.marker(); marker != 0xd9; marker = bytes_.marker()) {
      if (marker >= 0xd0 && marker <= 0xd7) throw Damage{"a restart marker stands outside of the codes"};
      if (marker == 0x01) continue;  // TEM, which has no segment
      if (marker < 0xc0)
        throw Damage{"expected a marker, found other bytes"};  // 0 belongs to codes, 2 to bf are reserved
      JpegBytes segment = bytes_.segment();
      if (marker == 0xc4)
        readTables(segment);
      else if (marker == 0xc0 || marker == 0xc1 || marker == 0xc3)
        readFrame(segment, marker == 0xc3);
      else if (marker == 0xdd)
        restartEvery_ = segment.next2();
      else if (marker == 0xda)
        readScan(segment);
      else if (marker < 0xdb || (marker >= 0xf0 && marker <= 0xfd))
        throw NotChecked{};
    }
    if (scans_ == 0) throw Damage{"there is no scan"};
  }

 private:
  void readTables(JpegBytes& segment) {
    while (!segment.empty()) {
      const int where = segment.next();
      if (where >> 4 > 1 || (where & 15) > 3) throw Damage{"a Huffman table has no such place"};
      tables_[static_cast<std::size_t>((where >> 4) * 4 + (where & 15))].read(segment);
    }
  }

  void readFrame(JpegBytes& segment, bool lossless) {
    lossless_ = lossless;
    segment.next();  // bits of a sample
    rows_ = segment.next2();
    columns_ = segment.next2();
    if (segment.next() != 1 || rows_ == 0) throw NotChecked{};  // of several components; rows stated later
  }

  void readScan(JpegBytes& segment) {
    if (columns_ == 0) throw Damage{"a scan comes before its frame"};
    if (segment.next() != 1) throw Damage{"expected a scan of one component"};
    segment.next();
    const int tables = segment.next();
    const HuffmanTable& dc = tables_[static_cast<std::size_t>(tables >> 4 & 3)];
    const HuffmanTable& ac = tables_[static_cast<std::size_t>(4 + (tables & 3))];
    const std::int64_t units =
        lossless_ ? std::int64_t(rows_) * columns_ : std::int64_t((rows_ + 7) / 8) * ((columns_ + 7) / 8);
    Bits bits(bytes_);
    for (std::int64_t unit = 0; unit < units; ++unit) {
      if (restartEvery_ > 0 && unit > 0 && unit % restartEvery_ == 0) {
        bits.end();
        if (bytes_.marker() != 0xd0 + (unit / restartEvery_ - 1) % 8) throw Damage{"a restart marker is missing"};
      }
      readDifference(bits, dc);
      if (!lossless_) readBlock(bits, ac);
    }
    bits.end();
    ++scans_;
  }

  static void readDifference(Bits& bits, const HuffmanTable& table) {
    const int size = table.symbol(bits);
    if (size > 16) throw Damage{"a difference has " + std::to_string(size) + " bits"};
    if (size < 16) bits.drop(size);  // 16 stands for 32768 alone
  }

  static void readBlock(Bits& bits, const HuffmanTable& table) {
    for (int k = 1; k < 64; ++k) {
      const int symbol = table.symbol(bits), size = symbol & 15;
      k += symbol >> 4;
      if (size == 0 && symbol != 0xf0) return;  // the rest is 0
      if (k > 63) throw Damage{"a block has more than 64 coefficients"};
      bits.drop(size);
    }
  }

  JpegBytes bytes_;
  std::array<HuffmanTable, 8> tables_;  // four of differences, four of coefficients
  bool lossless_ = false;
  int rows_ = 0, columns_ = 0, restartEvery_ = 0, scans_ = 0;
};

}  // namespace

std::optional<std::string> jpegDamage(std::span<const std::byte> stream) {
  try {
    JpegCheck(stream).run();
  } catch (const Damage& damage) {
    return damage.what;
  } catch (const NotChecked&) {
  }
  return std::nullopt;
}

}  // namespace umbrick
