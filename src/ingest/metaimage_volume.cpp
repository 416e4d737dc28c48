// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/metaimage_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <map>
#include <utility>
#include <vector>

#include "ingest/header_text.h"
#include "ingest/length_unit.h"
#include "ingest/provenance.h"
#include "ingest/streams/dense_source.h"
#include "ingest/streams/packed_stream.h"
#include "ingest/streams/text_stream.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMetaImageMaxHeader = 1 << 22;
constexpr std::int64_t kMetaImageMaxAxes = 10;

// Where the voxels are and how they lie there.
struct MetaHeader {
  VolumeInfo info;
  VoxelLayout layout;
  bool ascii = false, compressed = false;
  std::int64_t skip = 0;        // of each file; -1: the voxels are the last bytes of it
  std::vector<fs::path> files;  // empty: the voxels follow the header
  std::int64_t headerBytes = 0;
};

class MetaHeaderReader {
 public:
  explicit MetaHeaderReader(const fs::path& path) : path_(path), in_(path, std::ios::binary) {
    if (!in_) throw IoError(path.string() + ": cannot read");
  }

  MetaHeader read() {
    readLines();
    if (const std::string type = lower(value("ObjectType")); type != "" && type != "image")
      failField(path_, "ObjectType", "Image", type);
    header_.info.name = path_.string();
    readAxes();
    readLayout();
    place();
    readFiles();
    collectMetadata();
    return std::move(header_);
  }

 private:
  // "Key = value" up to ElementDataFile, which is the last; the names of LIST follow it.
  void readLines() {
    std::string text;
    while (line(text)) {
      if (trimmed(text).empty()) continue;
      const std::size_t sign = text.find_first_of("=:");
      if (sign == text.npos) failField(path_, "header", "\"Key = value\"", text);
      const std::string key(trimmed(std::string_view(text).substr(0, sign)));
      fields_[key] = std::string(trimmed(std::string_view(text).substr(sign + 1)));
      if (key != "ElementDataFile") continue;
      if (!announcesList(fields_[key])) return;
      while (line(text))
        if (!trimmed(text).empty()) list_.emplace_back(trimmed(text));
      return;
    }
    failField(path_, "ElementDataFile", "the field", "");
  }

  bool line(std::string& text) {
    text.clear();
    for (int c; (c = in_.get()) != std::ifstream::traits_type::eof();) {
      if (static_cast<std::size_t>(++header_.headerBytes) > kMetaImageMaxHeader)
        failField(path_, "header", "lines of text", std::to_string(kMetaImageMaxHeader) + " bytes without an end");
      if (c == '\n') return true;
      text.push_back(static_cast<char>(c));
    }
    return !text.empty();
  }

  std::string value(const std::string& key) const {
    const auto found = fields_.find(key);
    return found == fields_.end() ? std::string() : found->second;
  }
  // The first of several names for one thing.
  std::string anyOf(std::initializer_list<const char*> keys, std::string& used) const {
    for (const char* key : keys)
      if (fields_.contains(key)) {
        used = key;
        return value(key);
      }
    return {};
  }
  bool flag(const std::string& key, bool otherwise) const {
    if (!fields_.contains(key)) return otherwise;
    const std::string text = lower(value(key));
    if (text != "true" && text != "false" && text != "1" && text != "0") failField(path_, key, "True or False", text);
    return text == "true" || text == "1";
  }
  std::vector<double> numbers(const std::string& key, std::size_t count) const {
    const std::vector<std::string> texts = words(value(key));
    std::vector<double> out;
    for (const std::string& text : texts)
      if (const auto parsed = number(text); parsed && std::isfinite(*parsed)) out.push_back(*parsed);
    if (out.size() != count || texts.size() != count)
      failField(path_, key, std::to_string(count) + " finite numbers", value(key));
    return out;
  }

  void readAxes() {
    const auto count = integer(value("NDims"));
    if (!count || *count < 2 || *count > kMetaImageMaxAxes) failField(path_, "NDims", "2 to 10", value("NDims"));
    axes_ = static_cast<std::size_t>(*count);
    const std::vector<double> sizes = numbers("DimSize", axes_);
    header_.info.dims = glm::i64vec3(1);
    for (std::size_t i = 0; i < axes_; ++i) {
      if (!(sizes[i] >= 1 && sizes[i] < 2147483648.0) || sizes[i] != std::floor(sizes[i]))
        failField(path_, "DimSize", "numbers from 1 to 2147483647", value("DimSize"));
      if (i < 3) header_.info.dims[static_cast<int>(i)] = static_cast<std::int64_t>(sizes[i]);
      if (i >= 3 && sizes[i] != 1) failField(path_, "DimSize", "a volume of two or three axes", value("DimSize"));
    }
    if (fields_.contains("ElementNumberOfChannels") && value("ElementNumberOfChannels") != "1")
      failField(path_, "ElementNumberOfChannels", "1", value("ElementNumberOfChannels"));
  }

  void readLayout() {
    using enum VoxelType;
    static constexpr std::array<std::pair<std::string_view, VoxelType>, 12> kTypes{{
        {"MET_UCHAR", u8},
        {"MET_CHAR", i8},
        {"MET_USHORT", u16},
        {"MET_SHORT", i16},
        {"MET_UINT", u32},
        {"MET_INT", i32},
        {"MET_ULONG", u32},
        {"MET_LONG", i32},
        {"MET_LONG_LONG", i64},
        {"MET_ULONG_LONG", u64},
        {"MET_FLOAT", f32},
        {"MET_DOUBLE", f64},
    }};
    const std::string type = value("ElementType");
    const auto row = std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& each) { return each.first == type; });
    if (row == kTypes.end()) failField(path_, "ElementType", "a scalar type from MET_CHAR to MET_DOUBLE", type);
    header_.info.type = header_.layout.type = row->second;
    if (!volumeBytes(header_.info.dims, header_.info.type))
      failField(path_, "DimSize", "less than 2^63 bytes in all", value("DimSize"));
    header_.ascii = !flag("BinaryData", false) && fields_.contains("BinaryData");
    header_.compressed = flag("CompressedData", false);
    if (header_.ascii && header_.compressed)
      failField(path_, "CompressedData", "False with BinaryData = False", "True");
    std::string used = "BinaryDataByteOrderMSB";
    anyOf({"BinaryDataByteOrderMSB", "ElementByteOrderMSB"}, used);
    header_.layout.endian = flag(used, false) ? std::endian::big : std::endian::little;
    if (header_.ascii) header_.layout.endian = std::endian::native;
    if (fields_.contains("ElementToIntensityFunctionSlope"))
      header_.layout.slope = numbers("ElementToIntensityFunctionSlope", 1)[0];
    if (fields_.contains("ElementToIntensityFunctionOffset"))
      header_.layout.intercept = numbers("ElementToIntensityFunctionOffset", 1)[0];
    if (header_.layout.slope == 0) failField(path_, "ElementToIntensityFunctionSlope", "a number other than 0", "0");
  }

  void place() {
    std::string spacingKey, originKey, matrixKey;
    std::vector<double> spacing(axes_, 1), origin(axes_, 0), matrix(axes_ * axes_, 0);
    for (std::size_t i = 0; i < axes_; ++i) matrix[i * axes_ + i] = 1;
    if (!anyOf({"ElementSpacing", "ElementSize"}, spacingKey).empty()) spacing = numbers(spacingKey, axes_);
    if (!anyOf({"Offset", "Position", "Origin"}, originKey).empty()) origin = numbers(originKey, axes_);
    if (!anyOf({"TransformMatrix", "Rotation", "Orientation"}, matrixKey).empty())
      matrix = numbers(matrixKey, axes_ * axes_);
    glm::dmat4& m = header_.info.indexToWorld;
    const auto count = static_cast<int>(std::min<std::size_t>(axes_, 3));
    for (int axis = 0; axis < count; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      if (!(spacing[i] != 0)) failField(path_, spacingKey, "numbers other than 0", value(spacingKey));
      for (int row = 0; row < count; ++row)
        m[axis][row] = matrix[i * axes_ + static_cast<std::size_t>(row)] * spacing[i];
      m[3][axis] = origin[i];
    }
    const std::string unit = value("DistanceUnits");
    if (const auto millimetres = millimetresPer(unit)) {
      for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row) m[column][row] *= *millimetres;
      header_.info.metadata["length_unit"] = "mm";
    }
    checkPlace(header_.info, "TransformMatrix, ElementSpacing and Offset");
  }

  void readFiles() {
    const std::string name = value("ElementDataFile");
    const std::vector<std::string> parts = words(name);
    std::vector<std::string> names;
    if (announcesList(name)) {
      names = list_;
    } else if (parts.size() >= 3 && parts[0].find('%') != std::string::npos) {
      names = numberedNames(parts[0], parts[1], parts[2], parts.size() > 3 ? parts[3] : "1");
      if (names.empty())
        failField(path_, "ElementDataFile", "a pattern with one %d or %03d, then first, last and step", name);
    } else if (lower(name) != "local") {
      names = {name};
    }
    if (lower(name) != "local" && (names.empty() || names.front().empty()))
      failField(path_, "ElementDataFile", "the name of a file", name);
    for (const std::string& each : names) header_.files.push_back(path_.parent_path() / each);
    if (!fields_.contains("HeaderSize")) return;
    const auto skip = integer(value("HeaderSize"));
    if (!skip || *skip < -1) failField(path_, "HeaderSize", "a number from -1", value("HeaderSize"));
    header_.skip = *skip;
    if (*skip < 0 && (header_.compressed || header_.ascii))
      failField(path_, "HeaderSize", "0 or more with compressed or ASCII voxels", value("HeaderSize"));
  }

  void collectMetadata() {
    header_.info.metadata["space"] = "LPS";
    for (const char* key : {"AnatomicalOrientation", "CenterOfRotation", "Comment"})
      if (fields_.contains(key)) header_.info.metadata[std::string("metaimage_") + key] = value(key);
    if (std::string modality = value("Modality"); !modality.empty()) {
      if (modality.starts_with("MET_MOD_")) modality.erase(0, 8);
      if (modality != "UNKNOWN") header_.info.metadata["modality"] = modality;
    }
  }

  fs::path path_;
  std::ifstream in_;
  std::map<std::string, std::string> fields_;
  std::vector<std::string> list_;
  std::size_t axes_ = 3;
  MetaHeader header_;
};

// The voxels of one file, a share of all, as plain bytes.
std::unique_ptr<ByteStream> openPart(const MetaHeader& header, const fs::path& path, std::int64_t offset,
                                     std::int64_t shareBytes) {
  const std::int64_t size = checkedFileSize(path);
  if (size < 0) throw IoError(path.string() + ": expected a file, found a pipe or device");
  if (header.skip > 0) offset += std::min(header.skip, size);
  if (header.ascii) return decimalStream(openPlain(path, offset), header.layout.type, path.string());
  if (header.compressed) {
    if (header.files.size() <= 1) checkDeflateRatio(path, header.info, size);
    return openPacked(path, Packing::zlib, offset);
  }
  if (header.skip < 0) offset = std::max(offset, size - shareBytes);
  if (size - offset != shareBytes)
    throw IoError(path.string() + ": expected " + std::to_string(shareBytes) + " bytes of " +
                  std::string(voxelTypeName(header.layout.type)) + " voxels, found " +
                  std::to_string(std::max<std::int64_t>(size - offset, 0)));
  return openPlain(path, offset);
}

}  // namespace

std::unique_ptr<VoxelSource> openMetaImage(const fs::path& path) {
  const std::int64_t ownBytes = checkedFileSize(path);
  const auto shared = std::make_shared<const MetaHeader>(MetaHeaderReader(path).read());
  const MetaHeader& header = *shared;
  VolumeInfo info = header.info;
  info.fileBytes = std::max<std::int64_t>(ownBytes, 0);
  addProvenance(info, path, "MetaImage");

  const std::int64_t total = *volumeBytes(info.dims, info.type);
  const auto count = static_cast<std::int64_t>(std::max<std::size_t>(header.files.size(), 1));
  if (total / voxelBytes(info.type) % count != 0)
    throw IoError(info.name + ": ElementDataFile: expected files of equal size, found " + std::to_string(count) +
                  " files for " + describeBytes(info));
  std::vector<std::function<std::unique_ptr<ByteStream>()>> parts;
  const auto addPart = [&](const fs::path& file, std::int64_t offset) {
    const auto open = [shared, file, offset, share = total / count] { return openPart(*shared, file, offset, share); };
    open();  // a missing or short file is told before the first voxel is read
    parts.push_back(open);
  };
  if (header.files.empty()) addPart(path, header.headerBytes);
  for (const fs::path& file : header.files) {
    addPart(file, 0);
    info.fileBytes += checkedFileSize(file);
  }
  const VoxelLayout layout = header.layout;
  return std::make_unique<DenseSource>(std::move(info), layout, joinStreams(std::move(parts)), "");
}

}  // namespace umbrick
