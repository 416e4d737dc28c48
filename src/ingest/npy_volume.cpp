// Own code for the header of a NumPy array, which is one line of text: the libraries for it, such as cnpy, give the
// array as one piece and not as slabs.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/npy_volume.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "ingest/header_text.h"
#include "ingest/parts.h"
#include "ingest/provenance.h"
#include "ingest/streams/dense_source.h"
#include "ingest/streams/packed_stream.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kNpyMaxHeader = 1 << 16, kNpyMaxAxes = 32;
constexpr std::int64_t kNpyMostComponents = 4;

struct NpyHeader {
  VoxelLayout layout;
  bool fortran = false;
  std::vector<std::int64_t> shape;
  std::int64_t bytes = 0;  // where the voxels begin
};

// The header is the text of a Python dictionary of three entries, written by a program in a fixed way.
class Dictionary {
 public:
  Dictionary(const fs::path& path, std::string text) : path_(path), text_(std::move(text)) {}

  /// What stands behind 'key':, up to the comma outside of brackets and quotes that ends it.
  std::string value(const std::string& key) const {
    const std::string quoted = "'" + key + "':";
    const std::size_t at = text_.find(quoted);
    if (at == std::string::npos) failField(path_, key, "the entry", "");
    std::size_t end = at + quoted.size();
    for (int depth = 0; end < text_.size(); ++end) {
      const char c = text_[end];
      depth += (c == '(' || c == '[') - (c == ')' || c == ']');
      if (depth < 0 || (depth == 0 && (c == ',' || c == '}'))) break;
    }
    return std::string(trimmed(std::string_view(text_).substr(at + quoted.size(), end - at - quoted.size())));
  }

 private:
  fs::path path_;
  std::string text_;
};

VoxelLayout layoutOf(const fs::path& path, const std::string& descr) {
  using enum VoxelType;
  static constexpr std::array<std::pair<std::string_view, VoxelType>, 12> kTypes{{{"b1", u8},
                                                                                  {"u1", u8},
                                                                                  {"i1", i8},
                                                                                  {"u2", u16},
                                                                                  {"i2", i16},
                                                                                  {"u4", u32},
                                                                                  {"i4", i32},
                                                                                  {"u8", u64},
                                                                                  {"i8", i64},
                                                                                  {"f2", f16},
                                                                                  {"f4", f32},
                                                                                  {"f8", f64}}};
  if (descr.size() == 5 && descr.front() == '\'' && descr.back() == '\'') {
    const std::string_view type = std::string_view(descr).substr(2, 2);
    const char order = descr[1];
    const auto row = std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& each) { return each.first == type; });
    const bool known = order == '<' || order == '>' || (order == '|' && type.ends_with('1'));
    if (row != kTypes.end() && known) return {row->second, order == '>' ? std::endian::big : std::endian::little};
  }
  failField(path, "descr", "bool, an integer of 8 to 64 bits or a float of 16 to 64", descr);
}

std::vector<std::int64_t> shapeOf(const fs::path& path, const std::string& text) {
  std::vector<std::int64_t> shape;
  std::string_view rest = text;
  const bool tuple = rest.size() >= 2 && rest.front() == '(' && rest.back() == ')';
  if (tuple) rest = rest.substr(1, rest.size() - 2);
  while (tuple && !trimmed(rest).empty() && shape.size() < kNpyMaxAxes) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    std::string_view digits = trimmed(rest.substr(0, comma));
    if (digits.ends_with('L')) digits.remove_suffix(1);  // of Python 2
    const auto size = integer(digits);
    if (!size || *size < 1) failField(path, "shape", "a tuple of positive integers", text);
    shape.push_back(*size);
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  if (!tuple || !trimmed(rest).empty()) failField(path, "shape", "a tuple of positive integers", text);
  for (std::size_t i = shape.size(); i-- > 0 && shape.size() > 3;)
    if (shape[i] == 1) shape.erase(shape.begin() + static_cast<std::ptrdiff_t>(i));
  const bool components = shape.size() > 3 && shape.back() <= kNpyMostComponents;
  if (shape.size() < 2 || shape.size() > 4 + (components ? 1 : 0))
    failField(path, "shape",
              "an array of two or three axes, beside which may stand one of frames and a last one of 1 to 4 "
              "components",
              text);
  return shape;
}

NpyHeader readHeader(const fs::path& path) {
  const auto bytes = openPacked(path, packingOf(path));
  std::array<unsigned char, 12> start{};
  const auto part = [&](std::size_t from, std::size_t count) {
    if (bytes->read(std::as_writable_bytes(std::span(start)).subspan(from, count)) < count)
      failField(path, "header", "a NumPy array", "the end of the file");
  };
  part(0, 8);
  if (std::string_view(reinterpret_cast<const char*>(start.data()), 6) != "\x93NUMPY" || start[6] < 1 || start[6] > 3)
    failField(path, "first bytes", "\\x93NUMPY and version 1 to 3", "others");
  const std::size_t width = start[6] == 1 ? 2 : 4;  // of the header's length, little endian
  part(8, width);
  std::size_t length = 0;
  for (std::size_t i = width; i-- > 0;) length = length << 8 | start[8 + i];
  if (length > kNpyMaxHeader)
    failField(path, "header", "at most " + std::to_string(kNpyMaxHeader) + " bytes", std::to_string(length));
  std::string text(length, '\0');
  if (bytes->read(std::as_writable_bytes(std::span(text))) < length)
    failField(path, "header", std::to_string(length) + " bytes", "the end of the file");
  const Dictionary dictionary(path, std::move(text));

  NpyHeader header;
  header.bytes = static_cast<std::int64_t>(8 + width + length);
  header.layout = layoutOf(path, dictionary.value("descr"));
  const std::string order = dictionary.value("fortran_order");
  if (order != "True" && order != "False") failField(path, "fortran_order", "True or False", order);
  header.fortran = order == "True";
  header.shape = shapeOf(path, dictionary.value("shape"));
  return header;
}

// Takes the axes that are not of space out of the shape.
PartAxes takeParts(NpyHeader& header, VolumeInfo& info) {
  std::vector<std::int64_t>& shape = header.shape;
  PartAxes axes;
  if (shape.size() > 3 && shape.back() <= kNpyMostComponents) {
    info.components = shape.back();
    shape.pop_back();
    axes.components = header.fortran ? 3 : 0;
  }
  if (shape.size() > 3) {
    info.frames = header.fortran ? shape.back() : shape.front();
    shape.erase(header.fortran ? shape.end() - 1 : shape.begin());
    axes.framesFirst = true;  // in Fortran order components are the slowest axis of all
  }
  return axes;
}

}  // namespace

std::unique_ptr<VoxelSource> openNpy(const fs::path& path, const PartChoice& parts, bool strict) {
  const std::int64_t size = checkedFileSize(path);
  if (size < 0) throw IoError(path.string() + ": expected a file, found a pipe or device");
  NpyHeader header = readHeader(path);
  VolumeInfo info;
  info.name = path.string();
  const PartAxes axes = takeParts(header, info);
  if (!header.fortran) std::reverse(header.shape.begin(), header.shape.end());
  info.dims = glm::i64vec3(header.shape[0], header.shape[1], header.shape.size() > 2 ? header.shape[2] : 1);
  info.type = header.layout.type;
  info.fileBytes = size;
  addProvenance(info, path, "NumPy");
  info.metadata["numpy_order"] = header.fortran ? "Fortran: indexed [x, y, z]" : "C: indexed [z, y, x]";
  if (!arrayBytes(info)) failField(path, "shape", "each from 1 to 2147483647 and less than 2^63 bytes in all", "more");
  guessMeaning(info);
  if (info.frames > 1)
    info.notes.push_back("the " + std::string(header.fortran ? "last" : "first") + " axis, of " +
                         std::to_string(info.frames) + ", is taken for one of frames");
  if (!strict) noteExcess(info, path, header.bytes);
  const auto again = [info, path, strict, bytes = header.bytes] { return openVoxels(info, path, bytes, strict); };
  auto open = openOnceMore(again(), again);
  return openParts(std::move(info), axes, header.layout, parts, open);
}

}  // namespace umbrick
