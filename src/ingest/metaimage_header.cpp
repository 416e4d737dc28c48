// SPDX-License-Identifier: Apache-2.0
#include "ingest/metaimage_header.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "ingest/data_files.h"
#include "ingest/header_fields.h"
#include "ingest/header_lines.h"
#include "ingest/header_text.h"
#include "ingest/length_unit.h"
#include "ingest/other_text.h"
#include "ingest/parts.h"
#include "ingest/place.h"
#include "ingest/streams/dense_source.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

using enum VoxelType;

constexpr std::int64_t kMetaImageMaxAxes = 10;

constexpr std::array<std::pair<std::string_view, VoxelType>, 12> kMetaTypes{{
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

class MetaHeaderReader {
 public:
  explicit MetaHeaderReader(const fs::path& path) : lines_(path), fields_(path) { header_.info.name = path.string(); }

  MetaHeader read() {
    readLines();
    if (const std::string type = lower(fields_.value("ObjectType")); type != "" && type != "image")
      fields_.fail("ObjectType", "Image", type);
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
    for (std::string text; lines_.next(text);) {
      if (trimmed(text).empty()) continue;
      const std::size_t sign = text.find_first_of("=:");
      if (sign == text.npos) failText(fields_.path(), "header", "lines \"Key = value\"");
      const std::string key(trimmed(std::string_view(text).substr(0, sign)));
      fields_.set(key, trimmed(std::string_view(text).substr(sign + 1)));
      if (key != "ElementDataFile") continue;
      if (announcesList(fields_.value(key))) list_ = lines_.rest();
      header_.headerBytes = lines_.bytes();
      return;
    }
    fields_.fail("ElementDataFile", "the field", "");
  }

  // The first of several names for one thing.
  std::string anyOf(std::initializer_list<const char*> keys, std::string& used) const {
    for (const char* key : keys)
      if (fields_.has(key)) {
        used = key;
        return fields_.value(key);
      }
    return {};
  }
  bool flag(const std::string& key, bool otherwise) const {
    if (!fields_.has(key)) return otherwise;
    const std::string text = lower(fields_.value(key));
    if (text != "true" && text != "false" && text != "1" && text != "0") fields_.fail(key, "True or False", text);
    return text == "true" || text == "1";
  }
  std::vector<double> numbers(const std::string& key, std::size_t count) const {
    const std::vector<std::string> texts = words(fields_.value(key));
    std::vector<double> out;
    for (const std::string& text : texts)
      if (const auto parsed = number(text); parsed && std::isfinite(*parsed)) out.push_back(*parsed);
    if (out.size() != count || texts.size() != count)
      fields_.fail(key, std::to_string(count) + " finite numbers", fields_.value(key));
    return out;
  }

  void readAxes() {
    const auto count = integer(fields_.value("NDims"));
    if (!count || *count < 2 || *count > kMetaImageMaxAxes) fields_.fail("NDims", "2 to 10", fields_.value("NDims"));
    axes_ = static_cast<std::size_t>(*count);
    const std::vector<double> sizes = numbers("DimSize", axes_);
    header_.info.dims = glm::i64vec3(1);
    for (std::size_t i = 0; i < axes_; ++i) {
      if (!(sizes[i] >= 1 && sizes[i] < 2147483648.0) || sizes[i] != std::floor(sizes[i]))
        fields_.fail("DimSize", "numbers from 1 to 2147483647", fields_.value("DimSize"));
      if (i < 3) header_.info.dims[static_cast<int>(i)] = static_cast<std::int64_t>(sizes[i]);
      if (i == 3) header_.info.frames = static_cast<std::int64_t>(sizes[i]);
      if (i > 3 && sizes[i] != 1)
        fields_.fail("DimSize", "a volume of two or three axes, and one of frames", fields_.value("DimSize"));
    }
    if (!fields_.has("ElementNumberOfChannels")) return;
    const auto channels = integer(fields_.value("ElementNumberOfChannels"));
    if (!channels || *channels < 1 || *channels > 65536)
      fields_.fail("ElementNumberOfChannels", "1 to 65536", fields_.value("ElementNumberOfChannels"));
    header_.info.components = *channels;
  }

  void readLayout() {
    const std::string type = fields_.value("ElementType");
    const auto typeFound = valueNamed(kMetaTypes, type);
    if (!typeFound) fields_.fail("ElementType", "a scalar type from MET_CHAR to MET_DOUBLE", type);
    header_.info.type = header_.layout.type = *typeFound;
    if (!arrayBytes(header_.info)) fields_.fail("DimSize", "less than 2^63 bytes in all", fields_.value("DimSize"));
    guessMeaning(header_.info);
    header_.ascii = !flag("BinaryData", false) && fields_.has("BinaryData");
    header_.compressed = flag("CompressedData", false);
    if (header_.ascii && header_.compressed) fields_.fail("CompressedData", "False with BinaryData = False", "True");
    std::string used = "BinaryDataByteOrderMSB";
    anyOf({"BinaryDataByteOrderMSB", "ElementByteOrderMSB"}, used);
    header_.layout.endian = flag(used, false) ? std::endian::big : std::endian::little;
    if (header_.ascii) header_.layout.endian = std::endian::native;
    if (fields_.has("ElementToIntensityFunctionSlope"))
      header_.layout.slope = numbers("ElementToIntensityFunctionSlope", 1)[0];
    if (fields_.has("ElementToIntensityFunctionOffset"))
      header_.layout.intercept = numbers("ElementToIntensityFunctionOffset", 1)[0];
    if (header_.layout.slope == 0) fields_.fail("ElementToIntensityFunctionSlope", "a number other than 0", "0");
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
      if (!(spacing[i] != 0)) fields_.fail(spacingKey, "numbers other than 0", fields_.value(spacingKey));
      for (int row = 0; row < count; ++row)
        m[axis][row] = matrix[i * axes_ + static_cast<std::size_t>(row)] * spacing[i];
      m[3][axis] = origin[i];
    }
    const std::string unit = fields_.value("DistanceUnits");
    checkPlace(header_.info, "TransformMatrix, ElementSpacing and Offset");
    if (const auto millimetres = millimetresPer(unit)) useLengthUnit(header_.info, *millimetres);
  }

  void readFiles() {
    if (const std::string name = fields_.value("ElementDataFile"); lower(name) != "local") {
      header_.files = dataFiles(fields_, {"ElementDataFile", "ElementDataFile", true}, list_);
      if (header_.files.empty()) fields_.fail("ElementDataFile", "the name of a file", name);
    }
    if (!fields_.has("HeaderSize")) return;
    const auto skip = integer(fields_.value("HeaderSize"));
    if (!skip || *skip < -1) fields_.fail("HeaderSize", "a number from -1", fields_.value("HeaderSize"));
    header_.skip = *skip;
    if (*skip < 0 && (header_.compressed || header_.ascii))
      fields_.fail("HeaderSize", "0 or more with compressed or ASCII voxels", fields_.value("HeaderSize"));
  }

  void collectMetadata() {
    header_.info.metadata["space"] = "LPS";
    for (const char* key : {"AnatomicalOrientation", "CenterOfRotation", "Comment"})
      if (fields_.has(key)) header_.info.metadata[std::string("metaimage_") + key] = fields_.value(key);
    if (std::string modality = fields_.value("Modality"); !modality.empty()) {
      if (modality.starts_with("MET_MOD_")) modality.erase(0, 8);
      if (modality != "UNKNOWN") header_.info.metadata["modality"] = modality;
    }
  }

  HeaderLines lines_;
  HeaderFields fields_;
  std::vector<std::string> list_;
  std::size_t axes_ = 3;
  MetaHeader header_;
};

}  // namespace

MetaHeader readMetaHeader(const fs::path& path) { return MetaHeaderReader(path).read(); }

}  // namespace umbrick
