// One DICOM file: what its tags say about its frames.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ingest/dicom/dicom_elements.h"
#include "ingest/streams/decode.h"

namespace umbrick {

/// Tags and what they say, in order of tags: all short ones of a data set, but for sequences.
using DicomValues = std::vector<std::pair<std::uint32_t, std::string>>;

/// One slice, in mm of patient space.
struct DicomFrame {
  std::optional<glm::dvec3> position;  // of the centre of its first pixel
  std::optional<glm::dvec3> alongRow, alongColumn;
  std::optional<glm::dvec2> spacing;  // between columns (x) and between rows (y)
  double lastDigit = 0;               // what one more in the last digit of the position as it is written comes to, mm
  double slope = 1, intercept = 0;
  std::int64_t segment = 0;   // of a segmentation: the number of the segment that the frame shows
  std::size_t image = 0;      // which picture of the file it is in
  glm::i64vec2 corner{0, 0};  // of its first pixel in that picture: not 0 in mosaics alone
  DicomValues values;         // its own, where the file has several frames
};

/// What the samples of a pixel are.
enum class DicomColours { grey, rgb, ybrFull, palette };

/// The colours that pixels of one number stand for.
struct DicomPalette {
  std::size_t count = 0, first = 0;    // entries, and the pixel that stands for the first one
  int bits = 8;                        // of an entry, 8 or 16
  std::vector<std::uint16_t> entries;  // all of red, then green, then blue
};

/// Where the pixels of a file lie.
struct DicomPixelData {
  std::string transferSyntax, photometric;
  DicomColours colours = DicomColours::grey;
  int samples = 1;      // numbers of a pixel in the file
  bool planes = false;  // of several, the first ones of all pixels come before the second ones
  std::shared_ptr<const DicomPalette> palette = {};
  std::int64_t columns = 0, rows = 0;  // of a picture
  std::size_t images = 1;              // pictures in the file
  VoxelLayout layout;
  int bitsAllocated = 16;
  bool deflated = false;
  std::int64_t dataOffset = 0;  // of what is deflated
  std::int64_t offset = -1;     // of native pixels; -1: they are packed
  std::int64_t bytes = 0;       // of native pixels, without what is behind the last one
  /// Packed pixels: the parts of each picture, or all parts in one list where the file does not tell them apart.
  std::vector<std::vector<DicomFragment>> fragments;
  /// Whether a picture can be had without the others.
  bool single() const { return (offset >= 0 && bitsAllocated != 12) || (offset < 0 && fragments.size() == images); }
};

struct DicomFile {
  std::filesystem::path path;
  std::string seriesUid, seriesDescription, modality, valueUnit;
  std::int64_t seriesNumber = 0;
  std::int64_t columns = 0, rows = 0;  // of a slice; 0: no image
  DicomPixelData pixels;
  DicomValues values;
  std::vector<DicomFrame> frames;
  std::vector<VolumeLabel> segments;  // of a segmentation, whose values are their numbers
  double wholeSegment = 0;            // of a fractional one: the pixel that stands for a share of 1; 0: it is binary
  double sliceDistance = 0;           // SpacingBetweenSlices or SliceThickness, without its sign; 0 unknown
  bool framesApartUnknown = false;    // several frames, of which nothing says how far apart they are
  double gantryTilt = 0;              // degrees
  /// What was guessed or passed over: a sentence that many files share, and what was found in this one.
  std::vector<std::pair<std::string, std::string>> notes;
  // Why the pixels cannot be those of a volume, such as colour or damage: thrown when the series of the file is opened.
  // Others of the same folder can be read all the same.
  std::exception_ptr refused;
  bool damaged = false;  // that is why, and only what comes before the damage is known
};

/// Reads the header of a file. Nothing when it has none of DICOM.
/// @throw IoError  the file cannot be opened. Damage is left in `refused`, so that other series can be read.
std::optional<DicomFile> readDicomTagsIfAny(const std::filesystem::path& path);

/// The same of a file that must be DICOM. @throw IoError
DicomFile readDicomTags(const std::filesystem::path& path);

/// The value of a tag, of the frame or else of its file; null where there is none.
const std::string* valueOf(const DicomFile& file, const DicomFrame& frame, std::uint32_t tag);

/// The message of what is thrown.
std::string messageOf(const std::exception_ptr& error);

}  // namespace umbrick
