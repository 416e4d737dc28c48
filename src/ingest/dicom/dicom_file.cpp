// SPDX-License-Identifier: Apache-2.0
#include "ingest/dicom/dicom_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

#include "ingest/dicom/dicom_colours.h"
#include "ingest/dicom/dicom_frames.h"
#include "ingest/dicom/dicom_mosaic.h"
#include "ingest/dicom/dicom_segments.h"
#include "ingest/dicom/dicom_tags.h"
#include "ingest/header_text.h"
#include "ingest/streams/byte_stream.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kRunLengths = "1.2.840.10008.1.2.5";
constexpr std::size_t kLongestKept = 64;  // characters of a value by which slices may be picked

void readSeries(const DicomTags& tags, DicomFile& file) {
  file.seriesUid = tags.text(0x0020000e);
  file.seriesDescription = tags.text(0x0008103e);
  file.modality = tags.text(0x00080060);
  file.seriesNumber = integer(tags.text(0x00200011)).value_or(0);
}

void readPixelLayout(const DicomElements& elements, const DicomTags& tags, DicomFile& file) {
  file.rows = tags.unsignedShort(0x00280010, 0);
  file.columns = tags.unsignedShort(0x00280011, 0);
  if (file.rows < 1 || file.columns < 1)
    failField(file.path, "Rows and Columns", "an image",
              std::to_string(file.rows) + " x " + std::to_string(file.columns));
  DicomPixelData& pixels = file.pixels;
  readDicomColours(elements, tags, file);
  const auto allocated = tags.unsignedShort(0x00280100, 0), stored = tags.unsignedShort(0x00280101, allocated),
             high = tags.unsignedShort(0x00280102, stored - 1);
  const bool isSigned = tags.unsignedShort(0x00280103, 0) == 1;
  if (allocated != 1 && allocated != 8 && allocated != 12 && allocated != 16 && allocated != 32)
    failField(file.path, "BitsAllocated", "1, 8, 12, 16 or 32", std::to_string(allocated));
  if (stored < 1 || stored > allocated || high != stored - 1)
    failField(file.path, "BitsStored and HighBit", "the lowest bits of " + std::to_string(allocated),
              std::to_string(stored) + " and " + std::to_string(high));
  using enum VoxelType;
  pixels.bitsAllocated = static_cast<int>(allocated);
  pixels.layout.type = allocated == 1    ? u8  // each pixel becomes a byte
                       : allocated == 8  ? (isSigned ? i8 : u8)
                       : allocated == 32 ? (isSigned ? i32 : u32)
                                         : (isSigned ? i16 : u16);
  pixels.layout.endian = std::endian::native;
  pixels.layout.bitsStored = static_cast<int>(stored);
  for (const DicomElements& table : tags.items(0x00283000))
    failField(file.path, "ModalityLUTSequence", "rescale slope and intercept",
              "a table: " + DicomTags(file.path, table).text(0x00283003));
}

// Finds the fragments of each picture: one each, or all of the only one, or by the table of where each begins.
void readFragments(const DicomHeader& header, DicomPixelData& pixels) {
  const std::vector<DicomFragment>& all = header.fragments;
  pixels.fragments.clear();
  if (pixels.images > 1 && all.size() == pixels.images) {
    for (const DicomFragment& fragment : all) pixels.fragments.push_back({fragment});
    return;
  }
  if (pixels.images > 1 && header.fragmentTable.size() == 4 * pixels.images && !all.empty()) {
    const std::int64_t first = all.front().offset;
    std::vector<std::int64_t> starts;
    for (std::size_t i = 0; i < pixels.images; ++i) {
      std::array<unsigned char, 4> raw;
      std::memcpy(raw.data(), header.fragmentTable.data() + 4 * i, 4);
      starts.push_back(first +
                       (raw[0] | std::int64_t(raw[1]) << 8 | std::int64_t(raw[2]) << 16 | std::int64_t(raw[3]) << 24));
    }
    if (starts.front() == first && std::is_sorted(starts.begin(), starts.end())) {
      pixels.fragments.resize(pixels.images);
      for (const DicomFragment& fragment : all) {
        const auto after = std::upper_bound(starts.begin(), starts.end(), fragment.offset);
        pixels.fragments[static_cast<std::size_t>(after - starts.begin()) - 1].push_back(fragment);
      }
      return;
    }
  }
  pixels.fragments = {all};
}

// Checks that the pixels are there, and finds them.
void readPixelPlace(const DicomHeader& header, DicomFile& file) {
  DicomPixelData& pixels = file.pixels;
  if (header.pixelOffset < 0) failField(file.path, "PixelData", "the element", "");
  pixels.transferSyntax = header.transferSyntax;
  pixels.columns = file.columns;
  pixels.rows = file.rows;
  pixels.deflated = header.deflated;
  pixels.dataOffset = header.dataOffset;
  if (header.encapsulated && pixels.bitsAllocated == 1)
    failField(file.path, "TransferSyntaxUID", "one of pixels that are not packed, where BitsAllocated is 1",
              transferSyntaxName(header.transferSyntax));
  if (header.encapsulated && pixels.samples > 1 &&
      (header.transferSyntax != kRunLengths || pixels.layout.type != VoxelType::u8))
    failField(file.path, "TransferSyntaxUID",
              "one of colours that are not packed, or run lengths of 8 bits, where there are three samples per pixel",
              transferSyntaxName(header.transferSyntax));
  if (header.encapsulated) return readFragments(header, pixels);
  const std::int64_t voxels = file.rows * file.columns * pixels.samples * static_cast<std::int64_t>(pixels.images);
  const bool bits = pixels.bitsAllocated == 1 || pixels.bitsAllocated == 12;
  const std::int64_t bytes = bits ? (voxels * pixels.bitsAllocated + 7) / 8 : voxels * voxelBytes(pixels.layout.type);
  if (header.pixelBytes < bytes)
    throw IoError(file.path.string() + ": PixelData: expected " + std::to_string(file.columns) + " x " +
                  std::to_string(file.rows) + " x " + std::to_string(pixels.images) +
                  (pixels.samples > 1 ? " x 3 samples " : " ") + std::string(voxelTypeName(pixels.layout.type)) +
                  " = " + std::to_string(bytes) + " bytes, found " + std::to_string(header.pixelBytes));
  // DICOM adds a byte where the length would be odd, and asks readers to bear more (PS3.5 8.1.1).
  if (header.pixelBytes > bytes + 1)
    file.notes.push_back({"PixelData has more bytes than the pixels, which are not read",
                          "expected " + std::to_string(bytes) + ", found " + std::to_string(header.pixelBytes)});
  pixels.offset = header.pixelOffset;
  pixels.bytes = bytes;
  pixels.layout.endian = header.bigEndian ? std::endian::big : std::endian::little;
}

// Frames and pixels of an image.
void readImage(const DicomHeader& header, const DicomTags& tags, DicomFile& file) {
  readPixelLayout(header.elements, tags, file);
  file.valueUnit = tags.has(0x00281054) ? tags.text(0x00281054) : tags.text(0x00541001);
  file.gantryTilt = tags.number(0x00181120, "GantryDetectorTilt", 0);
  const std::string text = tags.text(0x00280008);
  const auto frames = text.empty() ? std::optional<std::int64_t>(1) : integer(text);
  // A frame has at least some bytes of its own in the file, also when it is packed.
  const std::int64_t size = checkedFileSize(file.path) * (header.deflated ? 1032 : 1);
  if (!frames || *frames < 1 || *frames > size)
    failField(file.path, "NumberOfFrames", "a number from 1 that the file can hold", text);
  file.pixels.images = static_cast<std::size_t>(*frames);
  readPixelPlace(header, file);
  readDicomFrames(tags, file);
  readDicomSegments(tags, file);
  if (!header.preamble)
    file.notes.push_back({"without the preamble of a DICOM file, taken for a data set alone",
                          "read as " + transferSyntaxName(header.transferSyntax)});
  unfoldMosaic(header.elements, tags, file);
}

DicomFile fileOf(const fs::path& path, const DicomHeader& header) {
  DicomFile file;
  file.path = path;
  const DicomTags tags(file.path, header.elements);
  readSeries(tags, file);
  file.rows = tags.unsignedShort(0x00280010, 0);
  if (file.rows == 0) return file;
  file.values = shortValues(header.elements, kLongestKept);
  try {
    readImage(header, tags, file);
  } catch (const Error&) {
    file.refused = std::current_exception();
  }
  return file;
}

}  // namespace

std::optional<DicomFile> readDicomTagsIfAny(const fs::path& path) {
  DicomHeader begun;
  try {
    const std::optional<DicomHeader> header = readDicomHeader(path, &begun);
    if (header) return fileOf(path, *header);
  } catch (const Error&) {
    // What looks like a data set without preamble and ends in damage is no DICOM, as far as anyone can tell.
    if (!begun.preamble) return std::nullopt;
    DicomFile file;
    file.path = path;
    readSeries(DicomTags(file.path, begun.elements), file);
    file.rows = 1;
    file.damaged = true;
    file.refused = std::current_exception();
    return file;
  }
  return std::nullopt;
}

DicomFile readDicomTags(const fs::path& path) {
  const std::optional<DicomHeader> header = readDicomHeader(path);
  if (!header)
    throw IoError(
        path.string() +
        ": expected a DICOM header, DICM at byte 128 or the elements of a data set at the start, found neither");
  return fileOf(path, *header);
}

const std::string* valueOf(const DicomFile& file, const DicomFrame& frame, std::uint32_t tag) {
  for (const DicomValues* values : {&frame.values, &file.values}) {
    const auto found = std::lower_bound(values->begin(), values->end(), tag,
                                        [](const auto& each, std::uint32_t wanted) { return each.first < wanted; });
    if (found != values->end() && found->first == tag) return &found->second;
  }
  return nullptr;
}

std::string messageOf(const std::exception_ptr& error) try {
  std::rethrow_exception(error);
} catch (const std::exception& thrown) {
  return thrown.what();
}

}  // namespace umbrick
