// SPDX-License-Identifier: Apache-2.0
#include "ingest/dicom/dicom_elements.h"

#include <gdcmUIDs.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <iterator>
#include <limits>
#include <sstream>
#include <string_view>
#include <utility>

#include "ingest/dicom/dicom_dictionary.h"
#include "ingest/header_text.h"
#include "ingest/streams/packed_stream.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

constexpr std::uint32_t kUndefined = 0xffffffff;
constexpr std::uint32_t kItem = 0xfffee000, kItemEnd = 0xfffee00d, kSequenceEnd = 0xfffee0dd, kPixels = 0x7fe00010,
                        kTransferSyntax = 0x00020010;
// Sequences that say where frames lie: shared and per-frame functional groups, and detectors of nuclear medicine.
constexpr std::array<std::uint32_t, 3> kKnown{0x52009229, 0x52009230, 0x00540022};
constexpr int kMaxDepth = 32;
constexpr std::uint32_t kLongestValue = 1 << 20;
constexpr const char* kImplicit = "1.2.840.10008.1.2";
constexpr const char* kExplicit = "1.2.840.10008.1.2.1";
constexpr const char* kDeflated = "1.2.840.10008.1.2.1.99";

// Value representations whose length has 16 bits, and those with 32.
constexpr std::string_view kShort = "AE AS AT CS DA DS DT FL FD IS LO LT PN SH SL SS ST TM UI UL US ";
constexpr std::string_view kLong = "OB OD OF OL OV OW SQ SV UC UN UR UT UV ";

bool among(std::string_view list, const std::array<char, 2>& kind) {
  const std::size_t at = list.find(std::string{kind[0], kind[1], ' '});
  return at != list.npos && at % 3 == 0;
}

// Reads a stream on, and knows where it is.
class Input {
 public:
  Input(std::unique_ptr<ByteStream> stream, std::int64_t at) : stream_(std::move(stream)), end_(at) {}

  std::int64_t at() const { return end_ - static_cast<std::int64_t>(left_.size()); }
  /// Fills `out`, or less of it at the end. @return bytes read
  std::size_t read(std::span<char> out) {
    std::size_t done = 0;
    while (done < out.size() && fill()) {
      const std::size_t part = std::min(out.size() - done, left_.size());
      std::copy_n(left_.begin(), part, out.begin() + static_cast<std::ptrdiff_t>(done));
      left_ = left_.subspan(part);
      done += part;
    }
    return done;
  }
  /// @return false where the end comes first
  bool skip(std::int64_t count) {
    const auto held = std::min<std::int64_t>(count, std::ssize(left_));
    left_ = left_.subspan(static_cast<std::size_t>(held));
    if (held == count) return true;
    const std::int64_t skipped = stream_->skip(count - held);
    end_ += skipped;
    return skipped == count - held;
  }
  bool atEnd() { return !fill(); }

 private:
  bool fill() {
    if (!left_.empty()) return true;
    const std::size_t got = stream_->read(std::as_writable_bytes(std::span(buffer_)));
    left_ = std::span<const char>(buffer_).first(got);
    end_ += static_cast<std::int64_t>(got);
    return got > 0;
  }

  std::unique_ptr<ByteStream> stream_;
  std::array<char, 8192> buffer_;  // most headers fit
  std::span<const char> left_;
  std::int64_t end_;  // where the stream is
};

class Walker {
 public:
  Walker(const fs::path& path, std::unique_ptr<ByteStream> stream, std::int64_t at, std::int64_t size)
      : path_(path), in_(std::move(stream), at), size_(size) {}

  /// The file meta information: group 2, always explicit and little endian. @return the bytes behind it
  std::int64_t walkMeta(DicomHeader& header) {
    explicit_ = true;
    for (;;) {
      const std::int64_t start = in_.at();
      if (in_.atEnd()) return start;
      Element element;
      element.tag = tag();
      if (element.tag >> 16 != 2) return start;
      head(element);
      if (element.tag == kTransferSyntax) {
        header.transferSyntax = std::string(value(element, size_));
        std::string& text = header.transferSyntax;
        while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) text.pop_back();
      } else {
        DicomElements ignored;
        finish(element, size_, 0, ignored, nullptr);
      }
    }
  }

  void walkData(DicomHeader& header) {
    explicit_ = header.transferSyntax != kImplicit;
    big_ = header.bigEndian;
    walkElements(size_, false, 0, header.elements, &header);
  }

 private:
  struct Element {
    std::uint32_t tag = 0;
    std::array<char, 2> kind{};
    std::uint32_t length = 0;
  };

  [[noreturn]] void fail(const std::string& expected, const std::string& found) const {
    throw IoError(path_.string() + ": expected " + expected + ", found " + found + " before byte " +
                  std::to_string(in_.at()));
  }

  template <std::size_t count>
  std::array<char, count> bytes() {
    std::array<char, count> out{};
    if (in_.read(out) < count) fail("more of a DICOM file", "its end");
    return out;
  }
  template <std::size_t count>
  std::uint32_t unsignedNumber() {
    auto raw = bytes<count>();
    if (big_) std::reverse(raw.begin(), raw.end());
    std::uint32_t value = 0;
    for (std::size_t i = count; i-- > 0;) value = value << 8 | static_cast<unsigned char>(raw[i]);
    return value;
  }
  std::uint32_t tag() {
    const std::uint32_t group = unsignedNumber<2>();
    return group << 16 | unsignedNumber<2>();
  }

  // What follows the tag of an element.
  void head(Element& element) {
    if (element.tag >> 16 == 0xfffe || !explicit_) {  // items and their ends have no kind
      element.length = unsignedNumber<4>();
      if (element.tag >> 16 != 0xfffe) element.kind = dicomKind(element.tag);
      return;
    }
    element.kind = bytes<2>();
    if (among(kLong, element.kind)) {
      bytes<2>();
      element.length = unsignedNumber<4>();
    } else if (among(kShort, element.kind)) {
      element.length = unsignedNumber<2>();
    } else {
      fail("a value representation", "bytes that are none");
    }
  }
  Element next() {
    Element element;
    element.tag = tag();
    head(element);
    return element;
  }

  void checkLength(const Element& element, std::int64_t end) {
    if (element.length > end - in_.at())
      fail("at most " + std::to_string(end - in_.at()) + " bytes of a value", std::to_string(element.length));
  }
  void skip(std::int64_t count) {
    if (!in_.skip(count)) fail("more of a DICOM file", "its end");
  }
  // The bytes of a value, or none of a long one, from behind its head to behind its end.
  std::string value(const Element& element, std::int64_t end) {
    checkLength(element, end);
    if (element.length > kLongestValue) {
      skip(element.length);
      return {};
    }
    std::string out(element.length, '\0');
    if (in_.read(out) < out.size()) fail("more of a DICOM file", "its end");
    return out;
  }

  // From behind the head of an element to behind its value.
  void finish(const Element& element, std::int64_t end, int depth, DicomElements& out, DicomHeader* top) {
    const std::string_view kind(element.kind.data(), 2);
    const bool sequence = kind == "SQ";
    const bool delimited = element.length == kUndefined;
    if (top && element.tag == kPixels) return finishPixels(element, end, *top);
    if (delimited && explicit_ && !sequence && kind != "UN" && kind != "OB" && kind != "OW")
      fail("a length, which SQ, UN, OB and OW alone can do without", "none for " + std::string(kind));
    // What says how frames lie may have lost its kind on the way through a program that did not know it.
    const bool known = kind == "UN" && std::find(kKnown.begin(), kKnown.end(), element.tag) != kKnown.end();
    DicomElement kept;
    kept.tag = element.tag;
    kept.kind = element.kind;
    kept.big = big_;
    // An unknown kind holds a sequence without kinds, in little endian.
    const bool wasExplicit = explicit_, wasBig = big_;
    if (kind == "UN" && explicit_) explicit_ = big_ = false;
    if (delimited || sequence || known) {
      if (!delimited) checkLength(element, end);
      walkItems(delimited ? end : in_.at() + element.length, delimited, depth + 1, kept);
    } else if (element.tag == kPixels) {  // of an icon
      checkLength(element, end);
      skip(element.length);
    } else {
      kept.value = value(element, end);
    }
    explicit_ = wasExplicit;
    big_ = wasBig;
    out.push_back(std::move(kept));
  }

  void walkItems(std::int64_t end, bool delimited, int depth, DicomElement& sequence) {
    if (depth > kMaxDepth) fail("sequences at most " + std::to_string(kMaxDepth) + " deep", "more");
    while (delimited || in_.at() < end) {
      const Element element = next();
      if (element.tag == kSequenceEnd && delimited) return;
      if (element.tag != kItem) fail("an item of a sequence", "another element");
      DicomElements& item = sequence.items.emplace_back();
      if (element.length != kUndefined) checkLength(element, end);
      const bool open = element.length == kUndefined;
      walkElements(open ? end : in_.at() + element.length, open, depth + 1, item, nullptr);
    }
  }

  void finishPixels(const Element& element, std::int64_t end, DicomHeader& header) {
    header.encapsulated = element.length == kUndefined;
    header.pixelOffset = in_.at();
    if (!header.encapsulated) {
      checkLength(element, end);
      header.pixelBytes = element.length;
      return skip(element.length);
    }
    for (bool table = true;; table = false) {
      const Element item = next();
      if (item.tag == kSequenceEnd) return;
      if (item.tag != kItem) fail("an item of a sequence", "another element");
      checkLength(item, end);
      if (table)
        header.fragmentTable = value(item, end);
      else
        header.fragments.push_back({in_.at(), item.length}), skip(item.length);
    }
  }

  // Copies in blocks leave zeros behind the end of a file.
  bool onlyZerosLeft() {
    std::array<char, 4096> block{};
    while (!in_.atEnd()) {
      const std::size_t got = in_.read(block);
      if (std::any_of(block.begin(), block.begin() + static_cast<std::ptrdiff_t>(got), [](char c) { return c != 0; }))
        return false;
    }
    return true;
  }

  void walkElements(std::int64_t end, bool delimited, int depth, DicomElements& out, DicomHeader* top) {
    if (depth > kMaxDepth) fail("sequences at most " + std::to_string(kMaxDepth) + " deep", "more");
    std::uint32_t last = 0;
    while (delimited || in_.at() < end) {
      if (top && in_.atEnd()) return;  // how long unpacked data are, only their end tells
      Element element;
      if (top && top->pixelOffset >= 0) {
        // The tag of what follows the pixels, or zeros, of which there may be fewer than a tag has bytes.
        std::array<char, 4> raw{};
        const std::size_t got = in_.read(raw);
        if (raw == std::array<char, 4>{} && onlyZerosLeft()) return;
        if (got < raw.size()) fail("more of a DICOM file", "its end");
        element.tag = tagOf(raw);
        if (element.tag == 0) fail("a data element", "zeros, and other bytes behind them");
      } else {
        element.tag = tag();
      }
      head(element);
      if (element.tag == kItemEnd && delimited) return;
      if (element.tag >> 16 == 0xfffe) fail("a data element", "an item outside of a sequence");
      if (element.tag <= last && last != 0) fail("tags in ascending order", "one that is not");
      last = element.tag;
      finish(element, end, depth, out, top);
    }
  }

  std::uint32_t tagOf(std::array<char, 4> raw) const {
    if (big_) std::swap(raw[0], raw[1]), std::swap(raw[2], raw[3]);
    const auto byte = [&](int i) { return std::uint32_t(static_cast<unsigned char>(raw[std::size_t(i)])); };
    return (byte(1) << 8 | byte(0)) << 16 | byte(3) << 8 | byte(2);
  }

  const fs::path& path_;
  Input in_;
  std::int64_t size_;
  bool explicit_ = true, big_ = false;
};

// Whether a file without preamble begins with an element as data sets do. Sets the transfer syntax of one that has no
// file meta information either.
bool beginsAsDataSet(std::string_view bytes, DicomHeader& header) {
  if (bytes.size() < 12) return false;
  const auto at = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  const unsigned group = at(0) | unsigned(at(1)) << 8, element = at(2) | unsigned(at(3)) << 8;
  const bool kind = among(kShort, {bytes[4], bytes[5]}) || among(kLong, {bytes[4], bytes[5]});
  if (group == 2) return element <= 0x10 && kind;
  if (group != 8 || element > 0x70) return false;
  header.transferSyntax = kind ? kExplicit : kImplicit;
  const std::uint32_t length = at(4) | unsigned(at(5)) << 8 | unsigned(at(6)) << 16 | unsigned(at(7)) << 24;
  return kind || length <= 1024;
}

void checkSyntax(const fs::path& path, DicomHeader& header) {
  const std::string& syntax = header.transferSyntax;
  if (syntax.empty()) failField(path, "TransferSyntaxUID (0002,0010)", "a transfer syntax", "");
  if (!syntax.starts_with(kImplicit))
    failField(path, "TransferSyntaxUID (0002,0010)", "a transfer syntax of the standard", transferSyntaxName(syntax));
  header.deflated = syntax == kDeflated;
  header.bigEndian = syntax == "1.2.840.10008.1.2.2";
}

template <class Number>
void appendNumbers(const DicomElement& element, std::ostringstream& out) {
  for (std::size_t at = 0; at + sizeof(Number) <= element.value.size(); at += sizeof(Number)) {
    std::array<char, sizeof(Number)> raw;
    std::memcpy(raw.data(), element.value.data() + at, sizeof(Number));
    if (element.big != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.end());
    out << (at > 0 ? "\\" : "") << std::bit_cast<Number>(raw);
  }
}

}  // namespace

std::unique_ptr<ByteStream> openDicomBytes(const fs::path& path, bool deflated, std::int64_t dataOffset,
                                           std::int64_t offset) {
  if (!deflated) return openPlain(path, offset);
  auto stream = openPacked(path, Packing::deflate, dataOffset);
  stream->skip(offset);
  return stream;
}

std::optional<DicomHeader> readDicomHeader(const fs::path& path, DicomHeader* begun) {
  DicomHeader own;
  DicomHeader& header = begun ? *begun : own;
  header = {};
  const std::int64_t size = checkedFileSize(path);
  std::array<char, 132> bytes{};
  const std::size_t got = openPlain(path)->read(std::as_writable_bytes(std::span(bytes)));
  const std::string_view first(bytes.data(), got);
  header.preamble = first.size() == bytes.size() && first.substr(128) == "DICM";
  if (!header.preamble && !beginsAsDataSet(first, header)) return std::nullopt;
  const std::int64_t start = header.preamble ? 132 : 0;
  if (header.transferSyntax.empty())
    header.dataOffset = Walker(path, openPlain(path, start), start, size).walkMeta(header);
  checkSyntax(path, header);
  const std::int64_t end = header.deflated ? std::numeric_limits<std::int64_t>::max() : size;
  const std::int64_t at = header.deflated ? 0 : header.dataOffset;
  Walker(path, openDicomBytes(path, header.deflated, header.dataOffset, at), at, end).walkData(header);
  return header;
}

const DicomElement* findElement(const DicomElements& elements, std::uint32_t tag) {
  const auto found = std::lower_bound(elements.begin(), elements.end(), tag,
                                      [](const DicomElement& each, std::uint32_t value) { return each.tag < value; });
  return found != elements.end() && found->tag == tag ? &*found : nullptr;
}

std::string elementText(const DicomElement& element) {
  const std::string_view kind(element.kind.data(), 2);
  std::ostringstream out;
  out.precision(9);
  if (kind == "US" || kind == "AT") {
    appendNumbers<std::uint16_t>(element, out);
  } else if (kind == "SS") {
    appendNumbers<std::int16_t>(element, out);
  } else if (kind == "UL") {
    appendNumbers<std::uint32_t>(element, out);
  } else if (kind == "SL") {
    appendNumbers<std::int32_t>(element, out);
  } else if (kind == "FL") {
    appendNumbers<float>(element, out);
  } else if (kind == "FD") {
    appendNumbers<double>(element, out);
  } else if (kind[0] != 'O' && kind != "SQ") {
    std::string text = element.value;
    while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) text.pop_back();
    return std::string(trimmed(text));
  }
  return out.str();
}

std::string transferSyntaxName(const std::string& uid) {
  gdcm::UIDs known;
  const bool found = known.SetFromUID(uid.c_str()) && known.GetName();
  return found ? std::string(known.GetName()) + " (" + uid + ")" : uid;
}

}  // namespace umbrick
