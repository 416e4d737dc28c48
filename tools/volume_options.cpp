// SPDX-License-Identifier: Apache-2.0
#include "volume_options.h"

#include <algorithm>
#include <sstream>

#include "command.h"
#include "umbrick/convert/holds_grids.h"
#include "umbrick/ingest/frame_sequence.h"
#include "umbrick/ingest/open_volume.h"
#include "validators.h"

namespace umbrick::tools {

std::optional<std::vector<double>> parseNumbers(const std::string& text) {
  std::istringstream in(text);
  std::vector<double> numbers;
  for (std::string word; in >> word;) {
    char* end = nullptr;
    numbers.push_back(std::strtod(word.c_str(), &end));
    if (*end != '\0') return std::nullopt;
  }
  if (numbers.empty()) return std::nullopt;
  return numbers;
}

std::vector<std::string> joinVectors(std::vector<std::string> arguments) {
  const auto isNumber = [](const std::string& text) {
    const auto numbers = parseNumbers(text);
    return numbers && numbers->size() == 1;
  };
  for (std::size_t i = 0; i + 3 < arguments.size(); ++i) {
    if (arguments[i] != "--spacing" && arguments[i] != "--up") continue;
    const auto first = arguments.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    if (!std::all_of(first, first + 3, isNumber)) continue;
    *first = *first + ' ' + *(first + 1) + ' ' + *(first + 2);
    arguments.erase(first + 1, first + 3);
  }
  return arguments;
}

void addVolumeOptions(CLI::App& command, VolumeOptions& o) {
  const std::string group = "Volume";
  command
      .add_option(
          "--grid", o.grid,
          "of a file of grids: name, or name[1] for the second of that name [density, else the first scalar one "
          "that holds something]")
      ->group(group);
  command.add_option("--series", o.series, "of a DICOM folder: the UID of a series, or its number in the list")
      ->group(group);
  command
      .add_option("--where", o.where,
                  "of DICOM: only slices whose tag has this value, as AcquisitionNumber=2; may be repeated [all]")
      ->allow_extra_args(false)
      ->group(group);
  command
      .add_option(
          "--component", o.component,
          "of voxels of several numbers, also of a grid of vec3: 0, 1, ..., x, y, z of a vector, r, g, b, a of a "
          "colour, or magnitude, the length of the vector")
      ->group(group);
  command
      .add_option(
          "--frame", o.frame,
          "of a file of several volumes (4D NIfTI and others): which one, counted from 0; of numbered files the "
          "number [the first of numbered files]")
      ->check(nonNegativeNumber())
      ->group(group);
  command.add_option("--dims", o.dims, "of headerless raw: voxels along x (fastest), y, z")->expected(3)->group(group);
  command.add_option("--type", o.type, "of headerless raw: u8, i8, u16, i16, u32, i32, i64, u64, f16, f32 or f64")
      ->check(voxelType())
      ->group(group);
  command.add_option("--endian", o.endian, "of headerless raw: little or big")
      ->check(CLI::IsMember({"little", "big"}))
      ->capture_default_str()
      ->group(group);
  command.add_option("--header-bytes", o.headerBytes, "of headerless raw: bytes to skip at its start")
      ->check(nonNegativeNumber())
      ->capture_default_str()
      ->group(group);
  command.add_option("--bits-stored", o.bitsStored, "of headerless raw: bits that hold the value [all]")
      ->check(CLI::Range(1, 64))
      ->group(group);
  command.add_option("--origin", o.origin, "position of the first voxel, for formats that state none, world [0 0 0]")
      ->expected(3)
      ->group(group);
  command.add_flag("--beside-only", o.besideOnly, kBesideOnly)->group(group);
}

namespace {

constexpr const char* kNoGrid = "none";

// The part that is shown stands behind the name of the grid: "v.x", or "[3].x" of a volume.
void applyParts(const VolumeOptions& o, VolumeReference& volume) {
  if (o.frame && isFramePattern(volume.file))
    volume.file = framePath(volume.file, *o.frame);
  else if (o.frame && holdsGrids(volume.file))
    throw UsageError(volume.file.string() + ": --frame is for files of several volumes, and this is one of grids");
  else if (o.frame)
    volume.grid += '[' + std::to_string(*o.frame) + ']';
  if (!o.component.empty()) volume.grid += '.' + o.component;
}

}  // namespace

void applyVolumeOptions(const VolumeOptions& o, VolumeReference& volume) {
  if (o.besideOnly) volume.besideOnly = true;
  if (o.grid) volume.grid = *o.grid;
  if (o.emissionGrid) volume.emissionGrid = *o.emissionGrid == kNoGrid ? std::string() : *o.emissionGrid;
  applyParts(o, volume);
  if (!o.series.empty()) volume.series = o.series;
  if (!o.where.empty()) volume.where = o.where;
  const auto vector = [](const std::vector<double>& numbers) { return glm::dvec3(numbers[0], numbers[1], numbers[2]); };
  if (o.spacing) volume.spacing = vector(*o.spacing);
  if (o.origin) volume.origin = vector(*o.origin);
  if (o.dims.empty() && o.type.empty()) return;
  if (o.dims.size() != 3 || o.type.empty())
    throw UsageError(volume.file.string() + ": headerless raw needs --dims and --type");
  if (holdsGrids(volume.file) || formatOfName(volume.file))
    throw UsageError(volume.file.string() + ": --dims and --type are for headerless raw, not for " +
                     formatOfName(volume.file).value_or(volume.file.extension().string()));
  RawLayout raw;
  raw.dims = {o.dims[0], o.dims[1], o.dims[2]};
  raw.type = o.type;
  raw.bigEndian = o.endian == "big";
  raw.headerBytes = o.headerBytes;
  if (o.bitsStored != 0) raw.bitsStored = o.bitsStored;
  volume.raw = raw;
}

}  // namespace umbrick::tools
