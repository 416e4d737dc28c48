// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/open_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <sstream>
#include <string_view>

#include "core/input_file.h"
#include "ingest/dicom/dicom_series.h"
#include "ingest/header_text.h"
#include "ingest/length_unit.h"
#include "ingest/parts.h"
#include "ingest/placed_source.h"
#include "ingest/streams/packed_stream.h"
#include "umbrick/core/error.h"
#include "umbrick/ingest/dicom_volume.h"
#include "umbrick/ingest/hdf5_volume.h"
#include "umbrick/ingest/image_stack.h"
#include "umbrick/ingest/metaimage_volume.h"
#include "umbrick/ingest/nifti_volume.h"
#include "umbrick/ingest/npy_volume.h"
#include "umbrick/ingest/nrrd_volume.h"
#include "umbrick/ingest/vtk_volume.h"
#include "umbrick/ingest/world.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

struct Format {
  FormatRow row;
  std::function<bool(std::string_view)> begins;  // true for the first bytes of such a file; may be empty
  bool placed;                                   // the file states spacing and origin
  std::function<std::unique_ptr<VoxelSource>(const fs::path&, const OpenOptions&)> open;
};

constexpr std::size_t kMagicBytes = 352;

DicomOptions dicomOptions(const OpenOptions& options) {
  return {options.series,        options.where,      options.spacing, options.origin,
          options.overridePlace, options.evenSlices, options.parts};
}

std::vector<Format> formats() {
  using Bytes = std::string_view;
  return {
      {{"NRRD",
        {".nrrd", ".nhdr"},
        "scalar volumes; raw, gzip, bzip2, text and hex; detached, in lists and in numbered files"},
       [](Bytes b) { return b.starts_with("NRRD000"); },
       true,
       [](const fs::path& path, const OpenOptions& options) {
         return openNrrd(path, options.strict, options.parts, options.besideOnly);
       }},
      {{"MetaImage",
        {".mha", ".mhd"},
        "scalar volumes; binary, compressed and ASCII; in one file, beside, in lists and in numbered files"},
       [](Bytes b) { return b.starts_with("ObjectType") || b.starts_with("NDims"); },
       true,
       [](const fs::path& path, const OpenOptions& options) {
         return openMetaImage(path, options.strict, options.parts, options.besideOnly);
       }},
      {{"NIfTI and Analyze",
        {".nii", ".nii.gz", ".hdr", ".img", ".img.gz"},
        "scalar volumes of NIfTI-1, NIfTI-2 and Analyze 7.5; sform, qform, units, slope and intercept"},
       [](Bytes b) {
         return b.size() >= 348 && (b.substr(344, 4) == Bytes("n+1\0", 4) || b.substr(4, 4) == Bytes("n+2\0", 4));
       },
       true,
       [](const fs::path& path, const OpenOptions& options) {
         return openNifti(path, options.parts, options.besideOnly, options.strict);
       }},
      {{"DICOM",
        {".dcm", ".ima"},
        "a file or a folder of them: grey and coloured series, single- and multi-frame, raw and compressed"},
       [](Bytes b) { return b.size() >= 132 && b.substr(128, 4) == "DICM"; },
       true,
       [](const fs::path& path, const OpenOptions& options) { return openDicom(path, dicomOptions(options)); }},
      {{"images",
        {".tif", ".tiff", ".png"},
        "grey and coloured TIFF of one or many pages and PNG: a file, slice_%04d.tif, 'slice*.png' or a folder; "
        "OME-XML, ImageJ"},
       [](Bytes b) {
         return b.starts_with(Bytes("II*\0", 4)) || b.starts_with(Bytes("MM\0*", 4)) ||
                b.starts_with(Bytes("II+\0", 4)) || b.starts_with(Bytes("MM\0+", 4)) || b.starts_with("\x89PNG");
       },
       false,
       [](const fs::path& path, const OpenOptions& options) {
         return openImageStack(path, options.parts, options.besideOnly);
       }},
      {{"VTK ImageData",
        {".vti"},
        "one scalar array of points or cells: file.vti:name, or the only one; ascii, base64 and raw; zlib, LZ4 and "
        "LZMA"},
       {},
       true,
       [](const fs::path& path, const OpenOptions& options) { return openVti(path, options.parts); }},
      {{"legacy VTK", {".vtk"}, "structured points, ASCII and binary: file.vtk:name, or the first scalars"},
       [](Bytes b) { return b.starts_with("# vtk DataFile"); },
       true,
       [](const fs::path& path, const OpenOptions& options) { return openLegacyVtk(path, options.parts); }},
      {{"HDF5",
        {".h5", ".hdf5", ".he5", ".nc", ".nc4"},
        "a dataset of three axes, also of netCDF-4: file.h5:/path, or the only one; frames, components; scale, offset, "
        "missing values"},
       [](Bytes b) { return b.starts_with("\x89HDF\r\n\x1a\n"); },
       false,
       [](const fs::path& path, const OpenOptions& options) {
         return openHdf5(path, options.parts, options.besideOnly);
       }},
      {{"NumPy",
        {".npy", ".npy.gz", ".npy.xz", ".npy.zst", ".npy.bz2"},
        "arrays of two or three axes in C or Fortran order"},
       [](Bytes b) { return b.starts_with("\x93NUMPY"); },
       false,
       [](const fs::path& path, const OpenOptions& options) { return openNpy(path, options.parts, options.strict); }},
  };
}

// "file.vti:pressure" is a .vti.
bool hasExtension(const Format& format, const fs::path& path) {
  std::string name = lower(path.filename().string());
  if (const std::string array = vtkArrayName(path); !array.empty())
    name = lower(path.string()).substr(0, path.string().size() - array.size() - 1);
  return std::any_of(format.row.extensions.begin(), format.row.extensions.end(),
                     [&](const std::string& extension) { return name.ends_with(extension); });
}

std::optional<Format> formatOf(const fs::path& path) {
  const std::vector<Format> all = formats();
  const auto named = [&](const char* name) {
    return *std::find_if(all.begin(), all.end(), [&](const Format& format) { return format.row.name == name; });
  };
  if (fs::is_directory(path))
    if (auto found = readDicomFolder(path)) {
      Format dicom = named("DICOM");
      dicom.open = [found = std::move(*found)](const fs::path& folder, const OpenOptions& options) {
        return openDicomFolder(folder, found, dicomOptions(options));
      };
      return dicom;
    }
  if (isImageStack(path)) return named("images");
  if (isHdf5Dataset(path)) return named("HDF5");
  for (const Format& format : all)
    if (hasExtension(format, path)) return format;
  if (!fs::is_regular_file(path)) return std::nullopt;
  std::array<char, kMagicBytes> bytes{};
  const std::size_t got = openPlain(path)->read(std::as_writable_bytes(std::span(bytes)));
  for (const Format& format : all)
    if (format.begins && format.begins(std::string_view(bytes.data(), got))) return format;
  return std::nullopt;
}

// Only headerless raw is read from what may have no end, or tells of the machine: a header that is found there means
// nothing. What is no file is a pattern of names, a dataset in a file or a folder, whose readers look at each file.
void requireOrdinary(const fs::path& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored) || fs::is_directory(path, ignored)) return;
  ordinaryFileSize(path);
}

// Refuses links that lead out of the folder of what is opened.
void requireNoWayOut(const fs::path& path) {
  std::error_code error;
  if (fs::is_regular_file(path, error)) return requireBeside(path, path);
  const bool folder = fs::is_directory(path, error);
  const fs::path top = folder ? path : path.parent_path().empty() ? fs::path(".") : path.parent_path();
  if (!fs::is_directory(top, error)) return;
  for (auto each = fs::recursive_directory_iterator(top, error); !error && each != fs::recursive_directory_iterator();
       each.increment(error)) {
    if (!folder) each.disable_recursion_pending();
    if (each->is_symlink() && !liesBelow(each->path(), top))
      throw IoError(path.string() + ": expected only files in its folder, found the link " + each->path().string());
  }
  if (error) throw IoError(top.string() + ": cannot read: " + error.message());
}

// The world in a unit that OpenVDB can hold, unless one was asked for.
std::unique_ptr<VoxelSource> withUnit(std::unique_ptr<VoxelSource> source, const std::string& unit) {
  if (!unit.empty()) return source;
  VolumeInfo info = source->info();
  enlargeUnstated(info);
  if (info.notes.size() == source->info().notes.size()) return source;
  return std::make_unique<PlacedSource>(std::move(source), std::move(info));
}

void checkNumbers(const fs::path& path, const char* field, const std::optional<glm::dvec3>& numbers, bool positive) {
  if (!numbers) return;
  for (int axis = 0; axis < 3; ++axis)
    if (!std::isfinite((*numbers)[axis]) || (positive && !((*numbers)[axis] > 0)))
      throw InvalidArgument(path.string() + ": " + field + ": expected " + (positive ? "positive " : "") +
                            "finite numbers, found " + std::to_string((*numbers)[axis]));
}

std::string text(const glm::dvec3& v) {
  std::ostringstream out;
  out.precision(6);
  out << v.x << ' ' << v.y << ' ' << v.z;
  return out.str();
}

// Puts a volume where the options say. @param stated  the file states a place, whose axes keep their directions
std::unique_ptr<VoxelSource> placed(std::unique_ptr<VoxelSource> source, const OpenOptions& options, bool stated) {
  VolumeInfo info = source->info();
  glm::dmat4& place = info.indexToWorld;
  const std::string unit = info.metadata.contains("length_unit") ? ' ' + info.metadata["length_unit"] : "";
  if (options.spacing) {
    const glm::dvec3 own(glm::length(glm::dvec3(place[0])), glm::length(glm::dvec3(place[1])),
                         glm::length(glm::dvec3(place[2])));
    for (int axis = 0; axis < 3; ++axis) {
      if (stated) {
        place[axis] *= (*options.spacing)[axis] / own[axis];
      } else {
        place[axis] = glm::dvec4(0);
        place[axis][axis] = (*options.spacing)[axis];
      }
    }
    if (stated)
      info.notes.push_back("the spacing is " + text(*options.spacing) + unit + ", in place of the file's " + text(own));
  }
  if (options.origin) {
    if (stated)
      info.notes.push_back("the first voxel is at " + text(*options.origin) + unit + ", in place of the file's " +
                           text(glm::dvec3(place[3])));
    place[3] = glm::dvec4(*options.origin, 1);
  }
  return std::make_unique<PlacedSource>(std::move(source), std::move(info));
}

std::unique_ptr<VoxelSource> openPlacedArray(const fs::path& path, const OpenOptions& options) {
  auto source = openArray(*options.array, path.string(), options.parts);
  // Who gives an array says what its numbers mean: there is no file that could have stated something else.
  VolumeInfo info = source->info();
  if (!options.lengthUnit.empty() && options.lengthUnit != "file") info.metadata["length_unit"] = options.lengthUnit;
  if (!options.space.empty() && options.space != "file") info.metadata["space"] = options.space;
  source = std::make_unique<PlacedSource>(std::move(source), std::move(info));
  if (!options.spacing && !options.origin) return source;
  if (options.array->indexToWorld)
    throw StatedPlace(path.string() + ": spacing and origin: its affine matrix states its own");
  checkNumbers(path, "spacing", options.spacing, true);
  checkNumbers(path, "origin", options.origin, false);
  return placed(std::move(source), options, false);
}

std::unique_ptr<VoxelSource> openPlaced(const fs::path& path, const OpenOptions& options) {
  const auto inUnit = [&](std::unique_ptr<VoxelSource> source) {
    return options.lengthUnit.empty() ? std::move(source) : inLengthUnit(std::move(source), options.lengthUnit);
  };
  if (options.array) return inUnit(openPlacedArray(path, options));
  if (options.raw) return inUnit(openRaw(path, *options.raw, options.parts, options.strict));
  requireOrdinary(path);
  if (options.besideOnly) requireNoWayOut(path);
  const auto format = formatOf(path);
  if (!format) {
    checkedFileSize(path);
    throw UnknownFormat(path.string() + ": taken for headerless raw, which needs dims and type");
  }
  auto source = inUnit(format->open(path, options));
  checkChoice(source->info(), options.parts);
  if (!options.spacing && !options.origin) return source;
  // DICOM has looked at them: a series may state a part of its place.
  if (format->row.name == "DICOM" && !options.overridePlace) return source;
  if (format->placed && !options.overridePlace)
    throw StatedPlace(path.string() + ": spacing and origin: " + format->row.name + " states its own");
  checkNumbers(path, "spacing", options.spacing, true);
  checkNumbers(path, "origin", options.origin, false);
  return placed(std::move(source), options, format->placed);
}

}  // namespace

std::unique_ptr<VoxelSource> openVolume(const fs::path& path, const OpenOptions& options) {
  auto source = withUnit(openPlaced(path, options), options.lengthUnit);
  return options.space.empty() ? std::move(source) : inSpace(std::move(source), options.space);
}

VolumeInfo describeVolume(const fs::path& path, OpenOptions options) {
  options.parts = {};
  options.parts.allComponents = true;
  options.parts.frame = 0;
  return openVolume(path, options)->info();
}

std::optional<std::string> formatOfName(const fs::path& path) {
  if (isHdf5Dataset(path)) return "HDF5";
  for (const Format& format : formats())
    if (hasExtension(format, path)) return format.row.name;
  return std::nullopt;
}

std::optional<std::string> formatOfFile(const fs::path& path) {
  const auto format = formatOf(path);
  return format ? std::optional(format->row.name) : std::nullopt;
}

std::vector<FormatRow> listFormats() {
  std::vector<FormatRow> rows;
  for (const Format& format : formats()) rows.push_back(format.row);
  rows.push_back({"raw",
                  {".raw", ".raw.gz", ".raw.xz", ".raw.zst", ".raw.bz2"},
                  "headerless voxels of any name, plain or packed by gzip, xz, zstd or bzip2"});
  return rows;
}

}  // namespace umbrick
