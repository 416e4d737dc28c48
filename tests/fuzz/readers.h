// Feeds bytes to a reader and holds it to its word: a result, or an Error that says why not.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/described_tiff.h"
#include "umbrick/core/error.h"
#include "umbrick/ingest/dicom_volume.h"
#include "umbrick/ingest/hdf5_volume.h"
#include "umbrick/ingest/image_stack.h"
#include "umbrick/ingest/metaimage_volume.h"
#include "umbrick/ingest/nifti_volume.h"
#include "umbrick/ingest/npy_volume.h"
#include "umbrick/ingest/nrrd_volume.h"
#include "umbrick/ingest/raw_volume.h"
#include "umbrick/ingest/segment_source.h"
#include "umbrick/ingest/vtk_volume.h"
#include "umbrick/optics/transfer_function.h"
#include "umbrick/scene/scene.h"

namespace umbrick::fuzz {

/// Reads a volume slice by slice. Sizes that a header only promises cost the reader nothing: slices beyond 16 MiB,
/// which the caller would have to hold, are not asked for.
inline void readAll(VoxelSource& source) {
  const glm::i64vec3 dims = source.info().dims;
  const std::int64_t several = source.info().valuesPerVoxel;
  if (dims.x > (1 << 22) / std::max<std::int64_t>(dims.y, 1) / std::max<std::int64_t>(several, 1)) return;
  std::vector<float> slice(static_cast<std::size_t>(dims.x * dims.y * several));
  for (std::int64_t z = 0; z < std::min<std::int64_t>(dims.z, 64); ++z) source.readSlab(1, slice);
}

/// Reads the frames of a segmentation, if they are as small as slices of readAll.
inline void readSegments(SegmentSource& source) {
  const glm::i64vec3 dims = source.info().dims;
  if (dims.x > (1 << 22) / std::max<std::int64_t>(dims.y, 1)) return;
  std::vector<float> slice(static_cast<std::size_t>(dims.x * dims.y));
  for (std::size_t i = 0; i < std::min<std::size_t>(source.frames().size(), 64); ++i) source.read(i, slice);
}

/// What a target makes of a file of that content. `path` is where the content lies.
using Target = std::function<void(const std::filesystem::path& path, std::string_view content)>;

/// All numbers of a voxel of a frame.
inline PartChoice allParts(std::int64_t frame) {
  PartChoice parts;
  parts.allComponents = true;
  parts.frame = frame;
  return parts;
}

/// Reads the first frame with all components, and the second where there is one.
template <class Open>
Target volumeTarget(Open open) {
  return [open](const std::filesystem::path& path, std::string_view) {
    const auto first = open(path, allParts(0));
    readAll(*first);
    if (first->info().frames > 1) readAll(*open(path, allParts(1)));
  };
}

/// Name of a target, extension of its files, and what it does.
struct NamedTarget {
  std::string extension;
  Target run;
};

inline std::map<std::string, NamedTarget> targets() {
  return {
      {"dicom",
       {".dcm",
        [](const std::filesystem::path& path, std::string_view) {
          if (const auto segments = openDicomSegments(path)) return readSegments(*segments);
          DicomOptions options;
          options.parts = allParts(0);
          readAll(*openDicom(path, options));
        }}},
      {"hdf5", {".h5", volumeTarget([](const std::filesystem::path& path, const PartChoice& parts) {
                  return openHdf5(path, parts);
                })}},
      {"metaimage", {".mha", volumeTarget([](const std::filesystem::path& path, const PartChoice& parts) {
                       return openMetaImage(path, false, parts);
                     })}},
      {"nifti", {".nii", volumeTarget([](const std::filesystem::path& path, const PartChoice& parts) {
                   return openNifti(path, parts);
                 })}},
      {"npy", {".npy", volumeTarget([](const std::filesystem::path& path, const PartChoice& parts) {
                 return openNpy(path, parts);
               })}},
      {"nrrd", {".nrrd", volumeTarget([](const std::filesystem::path& path, const PartChoice& parts) {
                  return openNrrd(path, false, parts);
                })}},
      {"description",
       {".tif",
        // OME-XML, or what ImageJ and tifffile write.
        [](const std::filesystem::path& path, std::string_view content) {
          std::ofstream(path, std::ios::binary | std::ios::trunc) << describedTiff(content, std::string(64, 'x'));
          readAll(*openImageStack(path, allParts(0)));
        }}},
      {"png", {".png", volumeTarget([](const std::filesystem::path& path, const PartChoice& parts) {
                 return openImageStack(path, parts);
               })}},
      {"raw",
       {".raw",
        // The first bytes choose the options, the rest is the file.
        [](const std::filesystem::path& path, std::string_view content) {
          const auto byte = [&](std::size_t i) {
            return i < content.size() ? static_cast<unsigned char>(content[i]) : 0;
          };
          RawOptions options;
          options.dims = {byte(0), byte(1), byte(2) | byte(3) << 24};
          options.type = static_cast<VoxelType>(byte(4) % 8);
          options.endian = byte(5) % 2 != 0 ? std::endian::big : std::endian::little;
          options.headerBytes = byte(6) % 32;
          if (byte(7) % 2 != 0) options.bitsStored = byte(7) / 2;
          options.components = 1 + byte(6) / 32;
          readAll(*openRaw(path, options, allParts(0)));
        }}},
      {"tiff", {".tif", volumeTarget([](const std::filesystem::path& path, const PartChoice& parts) {
                  return openImageStack(path, parts);
                })}},
      {"vti", {".vti", volumeTarget(openVti)}},
      {"vtk", {".vtk", volumeTarget(openLegacyVtk)}},
      {"scene", {".json", [](const auto&, std::string_view content) { parseScene(content, "scene.json"); }}},
      {"transfer",
       {".json", [](const auto&, std::string_view content) { parseTransferFunction(content, "transfer.json"); }}},
  };
}

/// Files of grids, "nvdb" and "vdb", in grid_targets.cpp, since OpenVDB takes minutes to compile for fuzzing. They are
/// too large for libFuzzer to change to the point: what it gives are changes, of five bytes each, a place and the byte
/// there, to a good file, which is made when it is first asked for.
std::map<std::string, NamedTarget> gridTargets();

/// The record of a study, "study", in study_target.cpp: changes to a good one, too.
std::map<std::string, NamedTarget> studyTargets();

/// What a page of `umbrick view` says, "message", in message_target.cpp.
std::map<std::string, NamedTarget> messageTargets();

/// Makes the changes that gridTargets() speaks of.
inline std::string patched(std::string bytes, std::string_view changes) {
  for (std::size_t i = 0; i + 5 <= changes.size(); i += 5) {
    std::size_t place = 0;
    for (std::size_t k = 0; k < 4; ++k) place = place << 8 | static_cast<unsigned char>(changes[i + k]);
    bytes[place % bytes.size()] = changes[i + 4];
  }
  return bytes;
}

/// @throw what a reader must not throw
inline void runTarget(const Target& target, const std::filesystem::path& path, std::string_view content) {
  try {
    target(path, content);
  } catch (const Error&) {
  }
}

}  // namespace umbrick::fuzz
