// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <fstream>
#include <map>
#include <utility>
#include <vector>

#include "ingest/header_text.h"
#include "ingest/place.h"
#include "ingest/provenance.h"
#include "ingest/streams/dense_source.h"
#include "ingest/streams/text_stream.h"
#include "umbrick/core/error.h"
// Own code for legacy VTK files, since VTK's vtkStructuredPointsReader reads whole arrays and not slabs.
#include "umbrick/ingest/vtk_volume.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxVtkLine = 4096;

struct LegacyHead {
  bool ascii = false, cells = false;
  std::array<std::int64_t, 3> points{};
  std::array<double, 3> origin{0, 0, 0}, spacing{1, 1, 1};
  VoxelType type = VoxelType::u8;
  std::string array;
  std::int64_t bytes = 0;  // where the voxels begin
};

VoxelType legacyTypeOf(const fs::path& path, const std::string& text) {
  using enum VoxelType;
  static const std::map<std::string, VoxelType> types{
      {"unsigned_char", u8}, {"char", i8},           {"unsigned_short", u16}, {"short", i16},
      {"unsigned_int", u32}, {"int", i32},           {"unsigned_long", u64},  {"long", i64},
      {"vtktypeint64", i64}, {"vtktypeuint64", u64}, {"float", f32},          {"double", f64}};
  const auto found = types.find(lower(text));
  if (found == types.end()) failField(path, "type of the scalars", "unsigned_char to double", text);
  return found->second;
}

// Reads the lines of the head up to the first scalars. What lies behind the values of these is left alone.
class LegacyHeadReader {
 public:
  explicit LegacyHeadReader(const fs::path& path) : path_(path), in_(path, std::ios::binary) {}

  LegacyHead read() {
    if (!line().starts_with("# vtk DataFile Version")) failField(path_, "first line", "# vtk DataFile Version", line_);
    line();  // the title
    const std::string form = lower(trimmed(line()));
    if (form != "ascii" && form != "binary") failField(path_, "third line", "ASCII or BINARY", form);
    head_.ascii = form == "ascii";
    while (!atVoxels()) {
    }
    head_.bytes = static_cast<std::int64_t>(in_.tellg());
    return head_;
  }

 private:
  const std::string& line() {
    line_.clear();
    char c = 0;
    while (in_.get(c) && c != '\n')
      if (line_.push_back(c); line_.size() > kMaxVtkLine) failField(path_, "head", "lines of text", line_);
    if (!in_) failField(path_, "head", "SCALARS of points or cells", "the end of the file");
    return line_;
  }

  template <class T, class Parse>
  std::array<T, 3> three(const std::vector<std::string>& parts, const Parse& parse) const {
    std::array<T, 3> out{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto value = parts.size() == 4 ? parse(parts[i + 1]) : std::nullopt;
      if (!value) failField(path_, parts[0], "three numbers", line_);
      out[i] = *value;
    }
    return out;
  }

  // Takes in one line. @return true when voxels follow
  bool atVoxels() {
    const std::vector<std::string> parts = words(line());
    const std::string key = parts.empty() ? "" : lower(parts[0]);
    if (key == "dataset") {
      if (parts.size() != 2 || lower(parts[1]) != "structured_points")
        failField(path_, "DATASET", "STRUCTURED_POINTS", parts.size() > 1 ? parts[1] : "");
    } else if (key == "dimensions") {
      head_.points = three<std::int64_t>(parts, integer);
    } else if (key == "origin") {
      head_.origin = three<double>(parts, number);
    } else if (key == "spacing" || key == "aspect_ratio") {
      head_.spacing = three<double>(parts, number);
    } else if (key == "point_data" || key == "cell_data") {
      head_.cells = key == "cell_data";
    } else if (key == "scalars") {
      if (parts.size() < 3 || (parts.size() > 3 && parts[3] != "1"))
        failField(path_, "SCALARS", "a name, a type and one component", line_);
      head_.array = parts[1];
      head_.type = legacyTypeOf(path_, parts[2]);
      if (!lower(line()).starts_with("lookup_table")) failField(path_, "line after SCALARS", "LOOKUP_TABLE", line_);
      return true;
    } else if (key == "field") {
      return fieldAtVoxels(parts);
    } else if (!key.empty() && key != "metadata") {
      failField(path_, "head", "a keyword of structured points, then SCALARS or FIELD", line_);
    }
    return false;
  }

  // "FIELD name arrays", then "name components tuples type" and the values of the first.
  bool fieldAtVoxels(const std::vector<std::string>& field) {
    const std::vector<std::string> parts = words(line());
    if (field.size() != 3 || parts.size() != 4 || parts[1] != "1")
      failField(path_, "FIELD", "a first array of one component", line_);
    head_.array = parts[0];
    head_.type = legacyTypeOf(path_, parts[3]);
    return true;
  }

  fs::path path_;
  std::ifstream in_;
  std::string line_;
  LegacyHead head_;
};

}  // namespace

std::unique_ptr<VoxelSource> openLegacyVtk(const fs::path& path) {
  VolumeInfo info;
  info.name = path.string();
  info.fileBytes = checkedFileSize(path);
  if (info.fileBytes < 0) throw IoError(path.string() + ": expected a file, found a pipe or device");
  const LegacyHead head = LegacyHeadReader(path).read();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis);
    info.dims[a] = head.points[axis] - (head.cells ? 1 : 0);
    info.indexToWorld[a][a] = head.spacing[axis];
    info.indexToWorld[3][a] = head.origin[axis] + (head.cells ? 0.5 * head.spacing[axis] : 0.0);
  }
  info.type = head.type;
  const auto bytes = volumeBytes(info.dims, info.type);
  if (!bytes)
    failField(
        path, "DIMENSIONS", "1 to 2147483647 voxels along each axis and less than 2^63 bytes in all",
        std::to_string(head.points[0]) + ' ' + std::to_string(head.points[1]) + ' ' + std::to_string(head.points[2]));
  checkPlace(info, "ORIGIN and SPACING");
  addProvenance(info, path, "VTK structured points");
  if (!head.array.empty()) info.metadata["array_name"] = head.array;
  VoxelLayout layout;
  layout.type = info.type;
  layout.endian = head.ascii ? std::endian::native : std::endian::big;
  const std::int64_t left = info.fileBytes - head.bytes;
  // Text has at least a digit and a blank for each voxel, but for the last blank.
  if (const std::int64_t least = head.ascii ? *bytes / voxelBytes(info.type) * 2 - 1 : *bytes; left < least)
    throw IoError(path.string() + ": expected " + describeBytes(info) + " after a header of " +
                  std::to_string(head.bytes) + ", found " + std::to_string(left) + (head.ascii ? " of text" : ""));
  auto rest = openPlain(path, head.bytes);
  auto voxels = head.ascii ? decimalStream(std::move(rest), info.type, path.string()) : std::move(rest);
  return std::make_unique<DenseSource>(std::move(info), layout, firstBytes(std::move(voxels), *bytes), "");
}

}  // namespace umbrick
