// SPDX-License-Identifier: Apache-2.0
#include "ingest/streams/text_stream.h"

#include <half.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "umbrick/core/error.h"

namespace umbrick {
namespace {

// One character at a time out of a stream.
class Characters {
 public:
  explicit Characters(std::unique_ptr<ByteStream> stream) : stream_(std::move(stream)), buffer_(1 << 16) {}
  /// @return -1 at the end
  int next() {
    if (at_ == end_) {
      end_ = stream_->read(buffer_);
      at_ = 0;
      if (end_ == 0) return -1;
    }
    return static_cast<int>(buffer_[at_++]);
  }

 private:
  std::unique_ptr<ByteStream> stream_;
  std::vector<std::byte> buffer_;
  std::size_t at_ = 0, end_ = 0;
};

bool isBlank(int c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }

template <class T>
bool parse(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

template <class T>
bool store(std::string_view text, std::byte* to) {
  T typed{};
  bool exact = false;
  if constexpr (std::is_integral_v<T>) exact = parse(text, typed);
  if (!exact) {  // integers may be written as 3e4 or 7.0
    double value = 0;
    if (!parse(text, value)) return false;
    // 2^63 and 2^64 are doubles, but the largest integers below them are not.
    if constexpr (std::is_integral_v<T>)
      if (!(value >= static_cast<double>(std::numeric_limits<T>::min()) &&
            (sizeof(T) < 8 ? value <= static_cast<double>(std::numeric_limits<T>::max())
                           : value < static_cast<double>(std::numeric_limits<T>::max()))) ||
          value != std::floor(value))
        return false;
    typed = static_cast<T>(value);
  }
  std::memcpy(to, &typed, sizeof typed);
  return true;
}

bool storeAs(VoxelType type, std::string_view value, std::byte* to) {
  switch (type) {
    case VoxelType::u8:
      return store<std::uint8_t>(value, to);
    case VoxelType::i8:
      return store<std::int8_t>(value, to);
    case VoxelType::u16:
      return store<std::uint16_t>(value, to);
    case VoxelType::i16:
      return store<std::int16_t>(value, to);
    case VoxelType::u32:
      return store<std::uint32_t>(value, to);
    case VoxelType::i32:
      return store<std::int32_t>(value, to);
    case VoxelType::i64:
      return store<std::int64_t>(value, to);
    case VoxelType::u64:
      return store<std::uint64_t>(value, to);
    case VoxelType::f16:
      return store<half>(value, to);
    case VoxelType::f32:
      return store<float>(value, to);
    case VoxelType::f64:
      return store<double>(value, to);
  }
  return false;
}

class DecimalStream : public ByteStream {
 public:
  DecimalStream(std::unique_ptr<ByteStream> text, VoxelType type, std::string name)
      : text_(std::move(text)), type_(type), name_(std::move(name)) {}

  std::size_t read(std::span<std::byte> out) override {
    const auto bytes = static_cast<std::size_t>(voxelBytes(type_));
    std::size_t done = 0;
    for (; done + bytes <= out.size() && word(); done += bytes) {
      const bool plus = word_.front() == '+' && !word_.starts_with("+-");  // from_chars takes none
      if (!storeAs(type_, std::string_view(word_).substr(plus), out.data() + done))
        throw IoError(name_ + ": voxel " + std::to_string(voxel_) + ": expected a number that " +
                      std::string(voxelTypeName(type_)) + " can hold, found " + foundWord());
      ++voxel_;
    }
    return done;
  }

 private:
  // Text that is no number is not quoted: a header may name any file.
  std::string foundWord() const {
    if (word_.find_first_not_of("+-.0123456789eE") != std::string::npos) return "other text";
    return '"' + word_.substr(0, 40) + '"';
  }

  bool word() {
    word_.clear();
    int c = text_.next();
    while (isBlank(c) || c == ',') c = text_.next();
    for (; c >= 0 && !isBlank(c) && c != ',' && word_.size() < 400; c = text_.next())
      word_.push_back(static_cast<char>(c));
    return !word_.empty();
  }

  Characters text_;
  VoxelType type_;
  std::string name_, word_;
  std::int64_t voxel_ = 0;
};

class HexStream : public ByteStream {
 public:
  HexStream(std::unique_ptr<ByteStream> text, std::string name) : text_(std::move(text)), name_(std::move(name)) {}

  std::size_t read(std::span<std::byte> out) override {
    std::size_t done = 0;
    for (; done < out.size(); ++done) {
      const int high = digit();
      if (high < 0) break;
      const int low = digit();
      if (low < 0) throw IoError(name_ + ": hex: expected pairs of digits, found an odd one at the end");
      out[done] = static_cast<std::byte>(high * 16 + low);
    }
    return done;
  }

 private:
  int digit() {
    int c = text_.next();
    while (isBlank(c)) c = text_.next();
    if (c < 0) return -1;
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    throw IoError(name_ + ": hex: expected digits 0 to f, found another character");
  }

  Characters text_;
  std::string name_;
};

class Base64Stream : public ByteStream {
 public:
  Base64Stream(std::unique_ptr<ByteStream> text, std::string name) : text_(std::move(text)), name_(std::move(name)) {}

  std::size_t read(std::span<std::byte> out) override {
    std::size_t done = 0;
    while (done < out.size() && (at_ < count_ || decode())) out[done++] = group_[at_++];
    return done;
  }

 private:
  static constexpr int kPadding = 64, kEnd = -1;

  int digit() {
    if (ended_) return kEnd;
    int c = text_.next();
    while (isBlank(c)) c = text_.next();
    ended_ = c < 0 || c == '<';
    if (ended_) return kEnd;
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+') return 62;
    if (c == '/') return 63;
    if (c == '=') return kPadding;
    throw IoError(name_ + ": base64: expected A to Z, a to z, 0 to 9, + or /, found another character");
  }

  // Four digits to three bytes, or fewer where the group is padded. @return false at the end
  bool decode() {
    unsigned bits = 0;
    int digits = 0;
    for (int i = 0; i < 4; ++i) {
      const int d = digit();
      if (d == kEnd && i == 0) return false;
      if (d == kEnd || (d == kPadding && i < 2) || (d != kPadding && digits < i))
        throw IoError(name_ + ": base64: expected groups of four characters, found " + std::to_string(i) +
                      " before the end or padding");
      bits = bits << 6 | static_cast<unsigned>(d & 63);
      if (d != kPadding) ++digits;
    }
    for (std::size_t i = 0; i < 3; ++i) group_[i] = static_cast<std::byte>(bits >> (16 - 8 * i) & 255);
    count_ = static_cast<std::size_t>(digits - 1);
    at_ = 0;
    return true;
  }

  Characters text_;
  std::string name_;
  std::array<std::byte, 3> group_{};
  std::size_t at_ = 0, count_ = 0;
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<ByteStream> decimalStream(std::unique_ptr<ByteStream> text, VoxelType type, std::string name) {
  return std::make_unique<DecimalStream>(std::move(text), type, std::move(name));
}

std::unique_ptr<ByteStream> hexStream(std::unique_ptr<ByteStream> text, std::string name) {
  return std::make_unique<HexStream>(std::move(text), std::move(name));
}

std::unique_ptr<ByteStream> base64Stream(std::unique_ptr<ByteStream> text, std::string name) {
  return std::make_unique<Base64Stream>(std::move(text), std::move(name));
}

}  // namespace umbrick
