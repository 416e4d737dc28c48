// SPDX-License-Identifier: Apache-2.0
#include "ingest/dicom/dicom_structure.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

#include "ingest/streams/byte_stream.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

constexpr std::uint32_t kUndefined = 0xffffffff;
constexpr std::uint32_t kItem = 0xfffee000, kItemEnd = 0xfffee00d, kSequenceEnd = 0xfffee0dd, kRows = 0x00280010,
                        kPixels = 0x7fe00010;
constexpr int kMaxDepth = 32;
constexpr std::int64_t kShortSeek = 4096;

// Value representations whose length has 16 bits, and those with 32.
constexpr std::string_view kShort = "AE AS AT CS DA DS DT FL FD IS LO LT PN SH SL SS ST TM UI UL US ";
constexpr std::string_view kLong = "OB OD OF OL OV OW SQ SV UC UN UR UT UV ";

class Walker {
 public:
  Walker(const std::filesystem::path& path, std::istream& in) : path_(path), size_(checkedFileSize(path)), in_(in) {}

  DicomStructure walk() {
    seek(128);
    if (bytes<4>() != std::array<char, 4>{'D', 'I', 'C', 'M'}) fail("DICM at byte 128", "other bytes");
    // Group 2 says in which way all others are written.
    explicit_ = true;
    while (at_ < size_ && peekGroup() == 2) {
      const Element element = next();
      if (element.tag == 0x00020010) found_.transferSyntax = text(element);
      skip(element, size_, 0);
    }
    const std::string& syntax = found_.transferSyntax;
    if (syntax.empty()) fail("TransferSyntaxUID (0002,0010)", "none");
    if (!syntax.starts_with("1.2.840.10008.1.2") || syntax == "1.2.840.10008.1.2.1.99")
      fail("a transfer syntax that is read", syntax);
    explicit_ = syntax != "1.2.840.10008.1.2";
    found_.bigEndian = big_ = syntax == "1.2.840.10008.1.2.2";
    walkElements(size_, false, 0);
    return found_;
  }

 private:
  struct Element {
    std::uint32_t tag = 0;
    std::array<char, 2> kind{};  // value representation, of explicit ones
    std::uint32_t length = 0;
  };

  [[noreturn]] void fail(const std::string& expected, const std::string& found) const {
    throw IoError(path_.string() + ": expected " + expected + ", found " + found + " before byte " +
                  std::to_string(at_));
  }

  template <std::size_t count>
  std::array<char, count> bytes() {
    std::array<char, count> out{};
    if (!in_.read(out.data(), count)) fail("more of a DICOM file", "its end");
    at_ += static_cast<std::int64_t>(count);
    return out;
  }
  std::uint32_t unsignedNumber(std::size_t count) {
    std::array<char, 4> raw{};
    const auto two = bytes<2>();
    std::copy(two.begin(), two.end(), raw.begin());
    if (count == 4) {
      const auto more = bytes<2>();
      std::copy(more.begin(), more.end(), raw.begin() + 2);
    }
    if (big_) std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(count));
    std::uint32_t value = 0;
    for (std::size_t i = count; i-- > 0;) value = value << 8 | static_cast<unsigned char>(raw[i]);
    return value;
  }
  std::uint32_t tag() {
    const std::uint32_t group = unsignedNumber(2);
    return group << 16 | unsignedNumber(2);
  }
  std::uint32_t peekGroup() {
    const std::uint32_t group = unsignedNumber(2);
    seek(at_ - 2);
    return group;
  }
  // Over short values by reading on: a stream that seeks drops what it holds.
  void seek(std::int64_t to) {
    if (to >= at_ && to - at_ < kShortSeek)
      in_.ignore(to - at_);
    else
      in_.seekg(to);
    at_ = to;
  }

  Element next() {
    Element element;
    element.tag = tag();
    if (element.tag >> 16 == 0xfffe || !explicit_) {  // items and their ends have no kind
      element.length = unsignedNumber(4);
      return element;
    }
    element.kind = bytes<2>();
    const std::string name = std::string(element.kind.data(), 2) + ' ';
    const auto among = [&](std::string_view list) {
      const std::size_t at = list.find(name);
      return at != list.npos && at % 3 == 0;
    };
    if (among(kLong)) {
      bytes<2>();
      element.length = unsignedNumber(4);
    } else if (among(kShort)) {
      element.length = unsignedNumber(2);
    } else {
      fail("a value representation", "bytes that are none");
    }
    return element;
  }

  std::string text(const Element& element) {
    std::string out(std::min<std::uint32_t>(element.length, 256), '\0');
    const std::int64_t start = at_;
    in_.read(out.data(), static_cast<std::streamsize>(out.size()));
    in_.clear();
    in_.seekg(start);
    while (!out.empty() && (out.back() == '\0' || out.back() == ' ')) out.pop_back();
    return out;
  }

  // From behind the head of an element to behind its value.
  void skip(const Element& element, std::int64_t end, int depth) {
    const std::string_view kind(element.kind.data(), 2);
    const bool sequence = kind == "SQ";
    if (element.length == kUndefined) {
      if (explicit_ && !sequence && kind != "UN" && kind != "OB" && kind != "OW")
        fail("a length, which SQ, UN, OB and OW alone can do without", "none for " + std::string(kind));
      // Without a kind only sequences may be so; an unknown kind holds a sequence without kinds.
      const bool was = explicit_;
      if (kind == "UN") explicit_ = false;
      walkItems(end, true, depth + 1, element.tag == kPixels);
      explicit_ = was;
      return;
    }
    const std::int64_t to = at_ + element.length;
    if (to > end) fail("at most " + std::to_string(end - at_) + " bytes of a value", std::to_string(element.length));
    if (sequence)
      walkItems(to, false, depth + 1, false);
    else
      seek(to);
  }

  void walkItems(std::int64_t end, bool delimited, int depth, bool fragments) {
    if (depth > kMaxDepth) fail("sequences at most " + std::to_string(kMaxDepth) + " deep", "more");
    while (delimited || at_ < end) {
      const Element element = next();
      if (element.tag == kSequenceEnd && delimited) return;
      if (element.tag != kItem) fail("an item of a sequence", "another element");
      if (element.length == kUndefined && !fragments) {
        walkElements(end, true, depth + 1);
        continue;
      }
      const std::int64_t to = at_ + element.length;
      if (element.length == kUndefined || to > end)
        fail("at most " + std::to_string(end - at_) + " bytes of an item", std::to_string(element.length));
      if (fragments)
        seek(to);
      else
        walkElements(to, false, depth + 1);
    }
  }

  void walkElements(std::int64_t end, bool delimited, int depth) {
    if (depth > kMaxDepth) fail("sequences at most " + std::to_string(kMaxDepth) + " deep", "more");
    std::uint32_t last = 0;
    while (delimited || at_ < end) {
      const Element element = next();
      if (element.tag == kItemEnd && delimited) return;
      if (element.tag >> 16 == 0xfffe) fail("a data element", "an item outside of a sequence");
      if (element.tag <= last && last != 0) fail("tags in ascending order", "one that is not");
      last = element.tag;
      if (depth == 0 && element.tag == kPixels) {
        found_.encapsulated = element.length == kUndefined;
        found_.pixelOffset = at_;
        found_.pixelBytes = found_.encapsulated ? 0 : element.length;
      }
      if (depth == 0 && element.tag == kRows && element.length >= 2 && at_ + 2 <= end) {
        found_.rows = unsignedNumber(2);
        seek(at_ - 2);
      }
      skip(element, end, depth);
    }
  }

  std::filesystem::path path_;
  std::int64_t size_;
  std::istream& in_;
  std::int64_t at_ = 0;
  bool explicit_ = true, big_ = false;
  DicomStructure found_;
};

}  // namespace

DicomStructure readDicomStructure(const std::filesystem::path& path, std::istream& in) {
  in.clear();
  in.seekg(0);
  return Walker(path, in).walk();
}

}  // namespace umbrick
