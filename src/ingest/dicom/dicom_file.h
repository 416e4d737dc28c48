// One DICOM file: what its tags say about its frames, and its pixels. Only the .cpp sees GDCM.
//
// DCMTK 3.6.7 was tried beside GDCM 3.0.21 on 13 small files and 2080 damaged copies of them. DCMTK never crashed and
// took at most 24 MB, while GDCM alone ended by an assertion on 4 of the first 17 files, which dicom_structure.h is
// for: of 151 of these files the reader with its checks read or refused every one. But DCMTK as Debian builds it
// decodes no JPEG 2000, and it gave 36 damaged files pixels that are not as many as their tags say, so checks would be
// needed as well.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ingest/streams/decode.h"

namespace umbrick {

/// The plane of one frame, in mm of patient space.
struct DicomFrame {
  std::optional<glm::dvec3> position;  // of the centre of its first pixel
  std::optional<glm::dvec3> alongRow, alongColumn;
  std::optional<glm::dvec2> spacing;  // between columns (x) and between rows (y)
  double slope = 1, intercept = 0;
};

struct DicomFile {
  std::filesystem::path path;
  std::string seriesUid, seriesDescription, modality, valueUnit, photometric;
  std::int64_t seriesNumber = 0;
  std::int64_t columns = 0, rows = 0;  // 0: no image
  VoxelLayout layout;
  std::vector<DicomFrame> frames;
  std::int64_t pixelOffset = -1;  // of native pixels in the file; -1: GDCM unpacks them
  double sliceDistance = 0;       // SpacingBetweenSlices or SliceThickness; 0 unknown
  double gantryTilt = 0;          // degrees
  // Why the pixels cannot be those of a volume, such as colour: thrown when the series of the file is opened. Others of
  // the same folder can be read all the same.
  std::exception_ptr refused;
};

/// Opens the file once and reads all tags before its pixels. Nothing when it has not the magic bytes of DICOM.
/// @throw IoError  unreadable
std::optional<DicomFile> readDicomTagsIfAny(const std::filesystem::path& path);

/// The same of a file that must be DICOM. @throw IoError
DicomFile readDicomTags(const std::filesystem::path& path);

/// The pixels of `count` frames from `first` on, as `layout` says. Native ones are read from their place in the file;
/// for packed ones, of which all must be asked for, the whole file is unpacked.
/// @throw IoError  unreadable, a transfer syntax that is not decoded, or not as many pixels as the tags say
std::vector<std::byte> readDicomPixels(const DicomFile& file, std::size_t first, std::size_t count);

}  // namespace umbrick
