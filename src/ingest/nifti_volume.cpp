// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/nifti_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "core/input_file.h"
#include "ingest/header_text.h"
#include "ingest/length_unit.h"
#include "ingest/nifti_header.h"
#include "ingest/parts.h"
#include "ingest/place.h"
#include "ingest/provenance.h"
#include "ingest/streams/dense_source.h"
#include "ingest/volume_time.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

// How one voxel is stored.
struct NiftiType {
  int code = 0;
  VoxelType type = VoxelType::u8;
  std::int64_t components = 1;  // side by side
};

std::optional<NiftiType> niftiType(int datatype) {
  using enum VoxelType;
  static constexpr std::array<NiftiType, 14> kTypes{{{2, u8},
                                                     {4, i16},
                                                     {8, i32},
                                                     {16, f32},
                                                     {32, f32, 2},
                                                     {64, f64},
                                                     {128, u8, 3},
                                                     {256, i8},
                                                     {512, u16},
                                                     {768, u32},
                                                     {1024, i64},
                                                     {1280, u64},
                                                     {1792, f64, 2},
                                                     {2304, u8, 4}}};
  for (const NiftiType& type : kTypes)
    if (type.code == datatype) return type;
  return std::nullopt;
}

// Names a type that is not read, with its code.
std::string datatypeName(int datatype) {
  static constexpr std::array<std::pair<int, const char*>, 4> kNames{
      {{0, "none"}, {1, "bits"}, {1536, "floats of 128 bits"}, {2048, "complex numbers of 256 bits"}}};
  std::string name = "an unknown type";
  for (const auto& [code, known] : kNames)
    if (code == datatype) name = known;
  return name + " (code " + std::to_string(datatype) + ")";
}

// "a.img.gz" for "a.hdr" and the other way round: the same name with the other ending, packed or not.
fs::path partner(const fs::path& path, const std::string& ending) {
  fs::path stem = path;
  if (lower(stem.extension().string()) == ".gz") stem.replace_extension();
  if (lower(stem.extension().string()) == ending) return path;
  for (const std::string& each : {ending, ending + ".gz"}) {
    fs::path other = stem;
    other.replace_extension(each);
    std::error_code ignored;
    if (fs::exists(other, ignored)) return other;
  }
  throw IoError(path.string() + ": expected a file of that name with " + ending + " or " + ending +
                ".gz beside it, found none");
}

bool isPairName(const fs::path& path) {
  const std::string name = lower(path.filename().string());
  return name.ends_with(".img") || name.ends_with(".img.gz");
}

void checkDistances(const VolumeInfo& info, const NiftiHeader& header) {
  for (std::size_t axis = 1; axis <= 3 && static_cast<std::int64_t>(axis) <= header.dim[0]; ++axis)
    if (!(header.pixdim[axis] > 0) || !std::isfinite(header.pixdim[axis]))
      throw IoError(info.name + ": pixdim[" + std::to_string(axis) + "]: expected a positive finite number, found " +
                    std::to_string(header.pixdim[axis]));
}

// The rotation of the unit quaternion (a, b, c, d), of which b, c and d are stored, after the scale; nifti1.h,
// method 2.
glm::dmat4 qform(const NiftiHeader& header) {
  auto [b, c, d] = header.quatern;
  double a = 1 - (b * b + c * c + d * d);
  if (a < 0) {  // by rounding: the angle is half a turn
    const double length = std::sqrt(1 - a);
    a = 0, b /= length, c /= length, d /= length;
  } else {
    a = std::sqrt(a);
  }
  const double mirror = header.pixdim[0] < 0 ? -1 : 1;
  const auto third = header.dim[0] >= 3 ? header.pixdim[3] : 1.0;
  glm::dmat4 m(1);
  m[0] = glm::dvec4(a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c), 0) * header.pixdim[1];
  m[1] = glm::dvec4(2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b), 0) * header.pixdim[2];
  m[2] = glm::dvec4(2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - b * b - c * c, 0) * (mirror * third);
  m[3] = glm::dvec4(header.qoffset[0], header.qoffset[1], header.qoffset[2], 1);
  return m;
}

glm::dmat4 sform(const NiftiHeader& header) {
  glm::dmat4 m(1);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) m[column][row] = header.srow[static_cast<std::size_t>(4 * row + column)];
  return m;
}

std::string formName(const char* form, int code) {
  static constexpr std::array<const char*, 6> kNames{"", "scanner", "aligned", "Talairach", "MNI 152", "template"};
  return form +
         (code < 6 ? std::string(": ") + kNames[static_cast<std::size_t>(code)] : ": code " + std::to_string(code));
}

void place(const NiftiHeader& header, VolumeInfo& info) {
  glm::dmat4& m = info.indexToWorld;
  std::string field = "sform";
  const bool instead =
      header.sformCode > 0 && !spansSpace(sform(header)) && header.qformCode > 0 && spansSpace(qform(header));
  if (instead)
    info.notes.push_back("the sform (code " + std::to_string(header.sformCode) +
                         ") has no three independent directions: the qform is used");
  if (header.sformCode > 0 && !instead) {
    m = sform(header);
    info.metadata["nifti_form"] = formName("sform", header.sformCode);
  } else if (header.qformCode > 0) {
    checkDistances(info, header);
    m = qform(header);
    field = "qform";
    info.metadata["nifti_form"] = formName("qform", header.qformCode);
  } else {
    checkDistances(info, header);
    for (int axis = 0; axis < 3 && axis < header.dim[0]; ++axis)
      m[axis][axis] = header.pixdim[static_cast<std::size_t>(axis) + 1];
    field = "pixdim";
  }
  if (field != "pixdim") info.metadata["space"] = "RAS";
  checkPlace(info, field);
  if (header.spaceUnit >= 1 && header.spaceUnit <= 3)
    useLengthUnit(info, header.spaceUnit == 1 ? 1000 : header.spaceUnit == 3 ? 1e-3 : 1);
}

// Volumes of one file are pixdim[4] apart, in the unit of xyzt_units.
VolumeTimes niftiTimes(const NiftiHeader& header, const VolumeInfo& info) {
  static constexpr std::array<const char*, 4> kUnits{"", "s", "ms", "us"};
  const int unit = header.timeUnit / 8;
  if (info.frames == 1 || unit < 1 || unit > 3 || !(header.pixdim[4] > 0)) return {};
  VolumeTimes times{
      .first = header.timeOffset, .step = header.pixdim[4], .unit = kUnits[static_cast<std::size_t>(unit)]};
  return times;
}

}  // namespace

std::unique_ptr<VoxelSource> openNifti(const fs::path& path, const PartChoice& parts, bool besideOnly, bool strict) {
  checkedFileSize(path);
  const fs::path headerPath = isPairName(path) ? partner(path, ".hdr") : path;
  const std::int64_t headerBytes = checkedFileSize(headerPath);
  if (headerBytes < 0) throw IoError(path.string() + ": expected a file, found a pipe or device");
  if (besideOnly) requireBeside(headerPath, path);
  const NiftiHeader header = readNiftiHeader(headerPath);

  VolumeInfo info;
  info.name = path.string();
  info.dims = glm::i64vec3(1);
  if (header.dim[0] < 2 || header.dim[0] > 7) failField(path, "dim[0]", "2 to 7", std::to_string(header.dim[0]));
  for (std::size_t axis = 1; axis <= static_cast<std::size_t>(header.dim[0]); ++axis) {
    const std::string field = "dim[" + std::to_string(axis) + "]", found = std::to_string(header.dim[axis]);
    if (axis <= 3 && (header.dim[axis] < 1 || header.dim[axis] > 2147483647))
      failField(path, field, "a number from 1 to 2147483647", found);
    if (axis <= 3) info.dims[static_cast<int>(axis) - 1] = header.dim[axis];
    if (axis == 4) info.frames = std::max<std::int64_t>(header.dim[axis], 1);
    if (axis == 5) info.components = std::max<std::int64_t>(header.dim[axis], 1);
    if (axis > 5 && header.dim[axis] > 1)
      failField(path, field, "1, since two axes beside those of space are read", found);
  }
  const auto type = niftiType(header.datatype);
  if (!type)
    failField(path, "datatype", "integers of 8 to 64 bits, floats, colours or complex numbers",
              datatypeName(header.datatype));
  info.type = type->type;
  PartAxes axes{3, 3, true};
  if (type->components > 1) {
    if (info.components > 1)
      failField(path, "dim[5]", "1 with colours and complex numbers", std::to_string(info.components));
    info.components = type->components;
    axes.components = 0;
  }
  if (header.datatype == 128 || header.datatype == 2304 || header.intent == 2003 || header.intent == 2004)
    info.meaning = VoxelMeaning::colour;
  else if (header.intent == 1006 || header.intent == 1007 || type->components == 2)
    info.meaning = VoxelMeaning::vector;
  guessMeaning(info);
  if (!arrayBytes(info)) failField(path, "dim", "less than 2^63 bytes in all", "more");
  if (header.voxOffset < 0) failField(path, "vox_offset", "a number from 0", "another");

  const bool nifti = header.kind != NiftiHeader::Kind::analyze;
  addProvenance(info, path, nifti ? "NIfTI" : "Analyze");
  place(header, info);
  stateTime(info, niftiTimes(header, info), parts.frame);
  if (!trimmed(header.description).empty()) info.metadata["nifti_description"] = header.description;
  VoxelLayout layout{info.type, header.endian};
  const bool colours = header.datatype == 128 || header.datatype == 2304;  // which the standard never scales
  if (nifti && !colours && std::isfinite(header.slope) && header.slope != 0) {
    if (!std::isfinite(header.inter)) failField(path, "scl_inter", "a finite number", std::to_string(header.inter));
    layout.slope = header.slope;
    layout.intercept = header.inter;
  }

  const fs::path voxels = header.kind == NiftiHeader::Kind::single ? headerPath : partner(headerPath, ".img");
  if (besideOnly) requireBeside(voxels, path);
  info.fileBytes = checkedFileSize(voxels) + (voxels == headerPath ? 0 : headerBytes);
  if (!strict) noteExcess(info, voxels, header.voxOffset);
  const auto again = [info, voxels, strict, offset = header.voxOffset] {
    return openVoxels(info, voxels, offset, strict);
  };
  auto open = openOnceMore(again(), again);
  return openParts(std::move(info), axes, layout, parts, open);
}

}  // namespace umbrick
