// SPDX-License-Identifier: Apache-2.0
#include <expat.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "ingest/array_lists.h"
#include "ingest/array_name.h"
#include "ingest/header_text.h"
#include "ingest/parts.h"
#include "ingest/place.h"
#include "ingest/provenance.h"
#include "ingest/streams/dense_source.h"
#include "ingest/streams/text_stream.h"
#include "ingest/volume_time.h"
#include "ingest/vtk_blocks.h"
#include "umbrick/core/error.h"
// Expat parses the XML; what it says and the blocks of the arrays are read by own code. VTK's vtkXMLImageDataReader can
// read a part of an extent too, but the Debian package libvtk9-dev brings about 170 others.
#include "umbrick/ingest/vtk_volume.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

using Attributes = std::map<std::string, std::string>;

std::string get(const Attributes& attributes, const std::string& key, const std::string& otherwise = {}) {
  const auto found = attributes.find(key);
  return found == attributes.end() ? otherwise : found->second;
}

struct VtiArray {
  Attributes attributes;
  bool cells = false;
  std::int64_t begin = 0, end = 0;  // bytes of its text in the file
};

// What the elements say, and where in the file the data lie. The data may be large, so they stay in the file.
struct VtiHead {
  Attributes file, image;
  std::vector<Attributes> pieces;
  std::vector<VtiArray> arrays;
  std::optional<VtiArray> time;        // the number TimeValue of the whole
  std::string scalars[2], vectors[2];  // names of the scalars and vectors of points and cells
  std::optional<std::int64_t> appended;
  bool appendedIsRaw = false;
};

class VtiHeadReader {
 public:
  explicit VtiHeadReader(const fs::path& path) : path_(path) {
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), onStart, onEnd);
  }

  VtiHead read() {
    const auto stream = openPlain(path_);
    std::vector<char> chunk(1 << 16);
    for (bool last = false; !last;) {
      const std::size_t got = stream->read(std::as_writable_bytes(std::span(chunk)));
      last = got < chunk.size();
      if (XML_Parse(parser_.get(), chunk.data(), static_cast<int>(got), last) == XML_STATUS_OK) continue;
      if (head_.appended) break;  // what follows is no XML, so the parser was stopped
      throw IoError(path_.string() + ": line " + std::to_string(XML_GetCurrentLineNumber(parser_.get())) +
                    ": expected XML, found: " + XML_ErrorString(XML_GetErrorCode(parser_.get())));
    }
    return std::move(head_);
  }

 private:
  std::int64_t here() const { return XML_GetCurrentByteIndex(parser_.get()); }

  static void onStart(void* self, const XML_Char* name, const XML_Char** pairs) {
    Attributes attributes;
    for (; pairs[0]; pairs += 2) attributes[pairs[0]] = pairs[1];
    static_cast<VtiHeadReader*>(self)->start(name, std::move(attributes));
  }
  static void onEnd(void* self, const XML_Char* name) { static_cast<VtiHeadReader*>(self)->end(name); }

  void start(const std::string& name, Attributes attributes) {
    const std::int64_t behind = here() + XML_GetCurrentByteCount(parser_.get());
    if (name == "VTKFile") head_.file = std::move(attributes);
    if (name == "ImageData") head_.image = std::move(attributes);
    if (name == "Piece") head_.pieces.push_back(std::move(attributes));
    if (name == "PointData" || name == "CellData") {
      section_ = name == "CellData" ? 1 : 0;
      head_.scalars[*section_] = get(attributes, "Scalars");
      head_.vectors[*section_] = get(attributes, "Vectors");
    }
    if (name == "DataArray" && section_ && !get(attributes, "type").empty())
      head_.arrays.push_back({std::move(attributes), *section_ == 1, behind, behind});
    else if (name == "DataArray" && fieldData_ && get(attributes, "Name") == "TimeValue")
      head_.time = VtiArray{std::move(attributes), false, behind, behind};
    if (name == "FieldData") fieldData_ = true;
    if (name == "AppendedData") {
      head_.appended = behind;
      head_.appendedIsRaw = get(attributes, "encoding") == "raw";
      XML_StopParser(parser_.get(), XML_FALSE);
    }
  }

  void end(const std::string& name) {
    if (name == "DataArray" && section_ && !head_.arrays.empty()) head_.arrays.back().end = here();
    if (name == "DataArray" && fieldData_ && head_.time && head_.time->end == head_.time->begin)
      head_.time->end = here();
    if (name == "FieldData") fieldData_ = false;
    if (name == "PointData" || name == "CellData") section_.reset();
  }

  struct Free {
    void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
  };
  fs::path path_;
  std::unique_ptr<std::remove_pointer_t<XML_Parser>, Free> parser_{XML_ParserCreate(nullptr)};
  VtiHead head_;
  std::optional<std::size_t> section_;  // of point or cell data, when inside one
  bool fieldData_ = false;
};

using enum VoxelType;
constexpr std::array<std::pair<std::string_view, VoxelType>, 10> kVtiTypes{{{"Int8", i8},
                                                                            {"UInt8", u8},
                                                                            {"Int16", i16},
                                                                            {"UInt16", u16},
                                                                            {"Int32", i32},
                                                                            {"UInt32", u32},
                                                                            {"Int64", i64},
                                                                            {"UInt64", u64},
                                                                            {"Float32", f32},
                                                                            {"Float64", f64}}};

VoxelType vtiTypeOf(const fs::path& path, const std::string& text) {
  const auto found = valueNamed(kVtiTypes, text);
  if (!found) failField(path, "type of the array", "Int8 to UInt64, Float32 or Float64", text);
  return *found;
}

// Marks of points that another piece holds too, or that are blank.
bool isGhost(const std::string& name) { return name == "vtkGhostType" || name == "vtkGhostLevels"; }

std::int64_t componentsOf(const fs::path& path, const VtiArray& array) {
  const std::string text = get(array.attributes, "NumberOfComponents", "1");
  const auto components = integer(text);
  if (!components || *components < 1 || *components > 65536) failField(path, "NumberOfComponents", "1 to 65536", text);
  return *components;
}

// The array of that name; else the one that the file names as its scalars, the only one of one component, or the only
// one there is.
const VtiArray& arrayOf(const fs::path& path, const VtiHead& head, const std::string& wanted) {
  const VtiArray *only = nullptr, *several = nullptr;
  std::string names;
  int count = 0, severalCount = 0;
  for (const VtiArray& array : head.arrays) {
    const std::string name = get(array.attributes, "Name");
    if (isGhost(name)) continue;
    if (wanted.empty() ? !name.empty() && name == head.scalars[array.cells ? 1 : 0] : name == wanted) return array;
    const std::int64_t components = componentsOf(path, array);
    names += (names.empty() ? "" : ", ") + name;
    if (components > 1) names += " of " + std::to_string(components) + " components";
    (components > 1 ? several : only) = &array;
    ++(components > 1 ? severalCount : count);
  }
  if (!wanted.empty()) failField(path, "arrays", "one called " + wanted, names);
  if (count == 1) return *only;
  if (count == 0 && severalCount == 1) return *several;
  failField(path, "arrays",
            "one of one component, one named by Scalars, or its name as in " + path.filename().string() + ":name",
            names);
}

template <std::size_t n>
std::array<double, n> numbers(const fs::path& path, const Attributes& of, const std::string& key,
                              const std::string& otherwise) {
  std::string text = get(of, key, otherwise);
  for (char& c : text)
    if (c == '\n' || c == '\r') c = ' ';
  const std::vector<std::string> parts = words(text);
  std::array<double, n> out{};
  bool good = parts.size() == n;
  for (std::size_t i = 0; good && i < n; ++i) {
    const auto value = number(parts[i]);
    good = value.has_value();
    if (good) out[i] = *value;
  }
  if (!good) failField(path, key, std::to_string(n) + " numbers", text);
  return out;
}

// The numbers are checked to be integers of 32 bits, so that their differences and doubles are exact.
std::array<std::int64_t, 6> extentOf(const fs::path& path, const VtiHead& head) {
  if (head.pieces.size() != 1) failField(path, "pieces", "1", std::to_string(head.pieces.size()));
  const auto whole = numbers<6>(path, head.image, "WholeExtent", "");
  const auto piece = numbers<6>(path, head.pieces.front(), "Extent", get(head.image, "WholeExtent"));
  std::array<std::int64_t, 6> out{};
  for (std::size_t i = 0; i < 6; ++i) {
    if (piece[i] != whole[i])
      failField(path, "Extent of the piece", get(head.image, "WholeExtent"), get(head.pieces.front(), "Extent"));
    if (!(std::abs(whole[i]) <= std::numeric_limits<std::int32_t>::max()) || whole[i] != double(std::int64_t(whole[i])))
      failField(path, "WholeExtent", "six integers of 32 bits", get(head.image, "WholeExtent"));
    out[i] = static_cast<std::int64_t>(whole[i]);
  }
  return out;
}

void placeImage(const fs::path& path, const VtiHead& head, const std::array<std::int64_t, 6>& extent, bool cells,
                VolumeInfo& info) {
  const auto origin = numbers<3>(path, head.image, "Origin", "0 0 0");
  const auto spacing = numbers<3>(path, head.image, "Spacing", "1 1 1");
  const auto direction = numbers<9>(path, head.image, "Direction", "1 0 0 0 1 0 0 0 1");  // by rows
  for (int row = 0; row < 3; ++row) {
    double start = origin[static_cast<std::size_t>(row)];
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const double step = direction[static_cast<std::size_t>(3 * row + axis)] * spacing[a];
      info.indexToWorld[axis][row] = step;
      start += step * (static_cast<double>(extent[2 * a]) + (cells ? 0.5 : 0.0));
    }
    info.indexToWorld[3][row] = start;
  }
  checkPlace(info, "Origin, Spacing and Direction");
}

VtkBlocks blocksOf(const fs::path& path, const VtiHead& head) {
  VtkBlocks blocks;
  const std::string order = get(head.file, "byte_order", "LittleEndian");
  if (order != "LittleEndian" && order != "BigEndian")
    failField(path, "byte_order", "LittleEndian or BigEndian", order);
  if (order == "BigEndian") blocks.endian = std::endian::big;
  const std::string width = get(head.file, "header_type", "UInt32");
  if (width != "UInt32" && width != "UInt64") failField(path, "header_type", "UInt32 or UInt64", width);
  blocks.wide = width == "UInt64";
  const std::string compressor = get(head.file, "compressor");
  if (compressor == "vtkZLibDataCompressor")
    blocks.compressor = VtkCompressor::zlib;
  else if (compressor == "vtkLZ4DataCompressor")
    blocks.compressor = VtkCompressor::lz4;
  else if (compressor == "vtkLZMADataCompressor")
    blocks.compressor = VtkCompressor::lzma;
  else if (!compressor.empty())
    failField(path, "compressor", "vtkZLibDataCompressor, vtkLZ4DataCompressor or vtkLZMADataCompressor", compressor);
  return blocks;
}

// Appended data begin behind the first underscore.
std::int64_t appendedStart(const fs::path& path, const VtiHead& head, const VtiArray& array) {
  const auto offset = integer(get(array.attributes, "offset", "0"));
  if (!head.appended) failField(path, "AppendedData", "an element", "");
  if (!offset || *offset < 0 || *offset > checkedFileSize(path))
    failField(path, "offset", "a number of bytes within the file", get(array.attributes, "offset"));
  std::array<char, 256> text{};
  const std::size_t got = openPlain(path, *head.appended)->read(std::as_writable_bytes(std::span(text)));
  const std::size_t mark = std::string_view(text.data(), got).find('_');
  if (mark == std::string_view::npos) failField(path, "AppendedData", "an underscore", "");
  return *head.appended + static_cast<std::int64_t>(mark) + 1 + *offset;
}

std::unique_ptr<ByteStream> voxelsOf(const fs::path& path, const VtiHead& head, const VtiArray& array,
                                     const VolumeInfo& info, VoxelLayout& layout) {
  const VtkBlocks blocks = blocksOf(path, head);
  layout.endian = blocks.endian;
  const std::string format = get(array.attributes, "format", "ascii");
  const auto inlined = [&] { return firstBytes(openPlain(path, array.begin), array.end - array.begin); };
  if (format == "ascii") {
    layout.endian = std::endian::native;
    return decimalStream(inlined(), info.type, path.string());
  }
  std::unique_ptr<ByteStream> bytes;
  if (format == "binary")
    bytes = base64Stream(inlined(), path.string());
  else if (format != "appended")
    failField(path, "format", "ascii, binary or appended", format);
  else if (bytes = openPlain(path, appendedStart(path, head, array)); !head.appendedIsRaw)
    bytes = base64Stream(std::move(bytes), path.string());
  return vtkBlockStream(std::move(bytes), blocks, *arrayBytes(info), path.string());
}

// Reads TimeValue, which VTK's writers give to what they write of a step. The file is good without: where it cannot be
// read, there is no time.
VolumeTimes vtiTime(const fs::path& path, const VtiHead& head) {
  if (!head.time) return {};
  try {
    VolumeInfo one;
    one.dims = glm::i64vec3(1);
    VoxelLayout layout;
    layout.type = one.type = vtiTypeOf(path, get(head.time->attributes, "type"));
    if (one.type != VoxelType::f64 && one.type != VoxelType::f32) return {};
    std::array<std::byte, 8> bytes{};
    const std::span<std::byte> stored(bytes.data(), static_cast<std::size_t>(voxelBytes(one.type)));
    if (voxelsOf(path, head, *head.time, one, layout)->read(stored) < stored.size()) return {};
    normaliseVoxels(layout, stored);
    if (one.type == VoxelType::f64) return {.first = std::bit_cast<double>(bytes)};
    std::array<std::byte, 4> half{};
    std::copy(stored.begin(), stored.end(), half.begin());
    return {.first = static_cast<double>(std::bit_cast<float>(half))};
  } catch (const Error&) {
    return {};
  }
}

}  // namespace

std::vector<ArrayRow> listVtiArrays(const fs::path& path) {
  std::vector<ArrayRow> rows;
  for (const VtiArray& array : VtiHeadReader(path).read().arrays) {
    const std::string components = get(array.attributes, "NumberOfComponents", "1");
    const std::string name = get(array.attributes, "Name"), type = get(array.attributes, "type");
    const bool known =
        std::any_of(std::begin(kVtiTypes), std::end(kVtiTypes), [&](const auto& row) { return row.first == type; });
    rows.push_back({name, array.cells ? "cells" : "points",
                    (components == "1" ? "" : components + " x ") +
                        (known ? std::string(voxelTypeName(vtiTypeOf(path, type))) : type),
                    known && !isGhost(name)});
  }
  return rows;
}

std::unique_ptr<VoxelSource> openVti(const fs::path& named, const PartChoice& parts) {
  const auto [path, wanted] = splitArrayName(named, ".vti");
  VolumeInfo info;
  info.name = named.string();
  info.fileBytes = checkedFileSize(path);
  if (info.fileBytes < 0) throw IoError(path.string() + ": expected a file, found a pipe or device");
  const VtiHead head = VtiHeadReader(path).read();
  if (const std::string type = get(head.file, "type"); type != "ImageData") failField(path, "type", "ImageData", type);
  const auto extent = extentOf(path, head);
  const VtiArray& array = arrayOf(path, head, wanted);
  for (std::size_t axis = 0; axis < 3; ++axis)
    info.dims[static_cast<int>(axis)] = extent[2 * axis + 1] - extent[2 * axis] + (array.cells ? 0 : 1);
  VoxelLayout layout;
  layout.type = info.type = vtiTypeOf(path, get(array.attributes, "type"));
  info.components = componentsOf(path, array);
  if (!arrayBytes(info))
    failField(path, "WholeExtent", "1 to 2147483647 voxels along each axis and less than 2^63 bytes in all",
              get(head.image, "WholeExtent"));
  placeImage(path, head, extent, array.cells, info);
  addProvenance(info, path, "VTK ImageData");
  stateTime(info, vtiTime(path, head), {});
  if (const std::string name = get(array.attributes, "Name"); !name.empty()) info.metadata["array_name"] = name;
  if (info.components == 3 && head.vectors[array.cells ? 1 : 0] == get(array.attributes, "Name"))
    info.meaning = VoxelMeaning::vector;
  guessMeaning(info);
  auto first = voxelsOf(path, head, array, info, layout);
  auto open = openOnceMore(std::move(first), [head, array, info, path = path]() {
    VoxelLayout again;
    return voxelsOf(path, head, array, info, again);
  });
  return openParts(std::move(info), PartAxes{}, layout, parts, open);
}

}  // namespace umbrick
