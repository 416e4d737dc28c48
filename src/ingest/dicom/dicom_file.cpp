// SPDX-License-Identifier: Apache-2.0
#include "ingest/dicom/dicom_file.h"

#include <gdcmImageReader.h>
#include <gdcmSequenceOfFragments.h>
#include <gdcmSequenceOfItems.h>
#include <gdcmTrace.h>

#include <array>
#include <cassert>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string_view>

#include "ingest/dicom/dicom_structure.h"
#include "ingest/dicom/jpeg_check.h"
#include "ingest/header_text.h"
#include "ingest/streams/byte_stream.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

using gdcm::Tag;

// The tags of a data set, or of an item in a sequence of it.
class Tags {
 public:
  Tags(const fs::path& path, const gdcm::DataSet& set) : path_(path), set_(&set) {}

  std::string text(Tag tag) const {
    if (!set_->FindDataElement(tag)) return {};
    const gdcm::ByteValue* value = set_->GetDataElement(tag).GetByteValue();
    if (!value || !value->GetPointer()) return {};
    std::string out(value->GetPointer(), value->GetLength());
    while (!out.empty() && (out.back() == '\0' || out.back() == ' ')) out.pop_back();
    return std::string(trimmed(out));
  }
  bool has(Tag tag) const { return !text(tag).empty(); }

  /// Numbers that are written as text, with backslashes between them.
  std::optional<std::vector<double>> numbers(Tag tag, const char* name, std::size_t count) const {
    const std::string all = text(tag);
    if (all.empty()) return std::nullopt;
    std::vector<double> out;
    std::string_view rest = all;
    for (bool more = true; more;) {
      const std::size_t end = std::min(rest.find('\\'), rest.size());
      const auto parsed = number(trimmed(rest.substr(0, end)));
      if (!parsed || !std::isfinite(*parsed)) break;
      out.push_back(*parsed);
      more = end < rest.size();
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    if (!rest.empty() || (count > 0 && out.size() != count))
      failField(path_, name, (count > 0 ? std::to_string(count) + " " : std::string()) + "finite numbers", all);
    return out;
  }
  double number1(Tag tag, const char* name, double otherwise) const {
    const auto found = numbers(tag, name, 1);
    return found ? (*found)[0] : otherwise;
  }

  /// A binary number of 16 bits, which GDCM has put into this machine's byte order.
  std::int64_t unsignedShort(Tag tag, std::int64_t otherwise) const {
    const gdcm::ByteValue* value = set_->FindDataElement(tag) ? set_->GetDataElement(tag).GetByteValue() : nullptr;
    std::uint16_t number = 0;
    if (!value || value->GetLength() < sizeof number) return otherwise;
    std::memcpy(&number, value->GetPointer(), sizeof number);
    return number;
  }

  /// The items of a sequence, or none where there is no such sequence.
  std::vector<gdcm::DataSet> items(Tag tag) const {
    std::vector<gdcm::DataSet> out;
    if (!set_->FindDataElement(tag)) return out;
    const auto sequence = set_->GetDataElement(tag).GetValueAsSQ();
    for (std::size_t i = 1; sequence && i <= sequence->GetNumberOfItems(); ++i)
      out.push_back(sequence->GetItem(i).GetNestedDataSet());
    return out;
  }

 private:
  fs::path path_;
  const gdcm::DataSet* set_;
};

// The functional groups that state the plane of a frame: its position, its orientation and the measures of its pixels.
constexpr std::array<std::pair<std::uint16_t, std::uint16_t>, 3> kPlaneGroups{
    {{0x0020, 0x9113}, {0x0020, 0x9116}, {0x0028, 0x9110}}};

void readPlane(const Tags& tags, DicomFrame& frame) {
  if (const auto found = tags.numbers(Tag(0x0020, 0x0032), "ImagePositionPatient", 3))
    frame.position = glm::dvec3((*found)[0], (*found)[1], (*found)[2]);
  if (const auto found = tags.numbers(Tag(0x0020, 0x0037), "ImageOrientationPatient", 6)) {
    frame.alongRow = glm::dvec3((*found)[0], (*found)[1], (*found)[2]);
    frame.alongColumn = glm::dvec3((*found)[3], (*found)[4], (*found)[5]);
  }
  if (const auto found = tags.numbers(Tag(0x0028, 0x0030), "PixelSpacing", 2))
    frame.spacing = glm::dvec2((*found)[1], (*found)[0]);  // stored as between rows, between columns
}

void readRescale(const Tags& tags, DicomFrame& frame) {
  frame.slope = tags.number1(Tag(0x0028, 0x1053), "RescaleSlope", frame.slope);
  frame.intercept = tags.number1(Tag(0x0028, 0x1052), "RescaleIntercept", frame.intercept);
}

// Reads the functional groups of an enhanced image. Those that all frames share come first, then those of each frame.
void readGroups(const fs::path& path, const gdcm::DataSet& set, DicomFrame& frame, double& sliceDistance) {
  const Tags groups(path, set);
  for (const auto& [group, element] : kPlaneGroups)
    for (const gdcm::DataSet& item : groups.items(Tag(group, element))) readPlane(Tags(path, item), frame);
  for (const gdcm::DataSet& item : groups.items(Tag(0x0028, 0x9110)))
    sliceDistance = Tags(path, item).number1(Tag(0x0018, 0x0050), "SliceThickness", sliceDistance);
  for (const gdcm::DataSet& item : groups.items(Tag(0x0028, 0x9145))) readRescale(Tags(path, item), frame);
}

void readFrames(const Tags& tags, DicomFile& file, std::size_t count) {
  DicomFrame shared;
  readPlane(tags, shared);
  readRescale(tags, shared);
  shared.slope = tags.number1(Tag(0x3004, 0x000e), "DoseGridScaling", shared.slope);
  for (const gdcm::DataSet& item : tags.items(Tag(0x5200, 0x9229)))
    readGroups(file.path, item, shared, file.sliceDistance);
  file.frames.assign(count, shared);
  const std::vector<gdcm::DataSet> each = tags.items(Tag(0x5200, 0x9230));
  if (!each.empty() && each.size() != count)
    failField(file.path, "PerFrameFunctionalGroupsSequence", std::to_string(count) + " items, one for each frame",
              std::to_string(each.size()));
  for (std::size_t i = 0; i < each.size(); ++i) readGroups(file.path, each[i], file.frames[i], file.sliceDistance);
  if (!each.empty() || count == 1) return;

  // Older kinds state one plane and how far along its normal the others lie, or only how far apart they are.
  const auto offsets = tags.numbers(Tag(0x3004, 0x000c), "GridFrameOffsetVector", count);
  if (!offsets && !(file.sliceDistance > 0))
    failField(file.path, "SpacingBetweenSlices", "the distance of the frames", "");
  const glm::dvec3 x = shared.alongRow.value_or(glm::dvec3(1, 0, 0)),
                   y = shared.alongColumn.value_or(glm::dvec3(0, 1, 0));
  const glm::dvec3 normal(x.y * y.z - x.z * y.y, x.z * y.x - x.x * y.z, x.x * y.y - x.y * y.x);
  for (std::size_t i = 0; i < count; ++i) {
    DicomFrame& frame = file.frames[i];
    if (!frame.alongRow) frame.alongRow = x, frame.alongColumn = y;
    const double along = offsets ? (*offsets)[i] - (*offsets)[0] : static_cast<double>(i) * file.sliceDistance;
    frame.position = shared.position.value_or(glm::dvec3(0)) + along * normal;
  }
}

void readPixelLayout(const Tags& tags, DicomFile& file) {
  file.rows = tags.unsignedShort(Tag(0x0028, 0x0010), 0);
  file.columns = tags.unsignedShort(Tag(0x0028, 0x0011), 0);
  if (file.rows < 1 || file.columns < 1)
    failField(file.path, "Rows and Columns", "an image",
              std::to_string(file.rows) + " x " + std::to_string(file.columns));
  file.photometric = tags.text(Tag(0x0028, 0x0004));
  const auto samples = tags.unsignedShort(Tag(0x0028, 0x0002), 1);
  if (samples != 1 || (file.photometric != "MONOCHROME1" && file.photometric != "MONOCHROME2"))
    failField(file.path, "PhotometricInterpretation", "MONOCHROME1 or MONOCHROME2 with one sample per pixel",
              file.photometric + ", " + std::to_string(samples) + " samples");
  const auto allocated = tags.unsignedShort(Tag(0x0028, 0x0100), 0),
             stored = tags.unsignedShort(Tag(0x0028, 0x0101), allocated),
             high = tags.unsignedShort(Tag(0x0028, 0x0102), stored - 1);
  const bool isSigned = tags.unsignedShort(Tag(0x0028, 0x0103), 0) == 1;
  if (allocated != 8 && allocated != 12 && allocated != 16 && allocated != 32)
    failField(file.path, "BitsAllocated", "8, 12, 16 or 32", std::to_string(allocated));
  if (stored < 1 || stored > allocated || high != stored - 1)
    failField(file.path, "BitsStored and HighBit", "the lowest bits of " + std::to_string(allocated),
              std::to_string(stored) + " and " + std::to_string(high));
  using enum VoxelType;
  file.layout.type = allocated == 8    ? (isSigned ? i8 : u8)
                     : allocated == 32 ? (isSigned ? i32 : u32)
                                       : (isSigned ? i16 : u16);
  file.layout.endian = std::endian::native;
  file.layout.bitsStored = static_cast<int>(stored);
  for (const gdcm::DataSet& table : tags.items(Tag(0x0028, 0x3000)))
    failField(file.path, "ModalityLUTSequence", "rescale slope and intercept",
              "a table: " + Tags(file.path, table).text(Tag(0x0028, 0x3003)));
}

const Tag kModality(0x0008, 0x0060), kSeriesDescription(0x0008, 0x103e), kSeriesUid(0x0020, 0x000e),
    kSeriesNumber(0x0020, 0x0011);

void readSeries(const Tags& tags, DicomFile& file) {
  file.seriesUid = tags.text(kSeriesUid);
  file.seriesDescription = tags.text(kSeriesDescription);
  file.modality = tags.text(kModality);
  file.seriesNumber = integer(tags.text(kSeriesNumber)).value_or(0);
}

// Each fragment is the JPEG stream of one frame, or all fragments together are that of the only frame.
void checkJpeg(const DicomFile& file, const gdcm::DataElement& pixels) {
  const gdcm::SequenceOfFragments* fragments = pixels.GetSequenceOfFragments();
  if (!fragments) return;
  const std::size_t count = fragments->GetNumberOfFragments();
  if (file.frames.size() != 1 && file.frames.size() != count) return;
  std::vector<std::byte> stream;
  for (std::size_t i = 0; i < count; ++i) {
    if (file.frames.size() != 1) stream.clear();
    if (const gdcm::ByteValue* bytes = fragments->GetFragment(i).GetByteValue()) {
      const auto* first = reinterpret_cast<const std::byte*>(bytes->GetPointer());
      stream.insert(stream.end(), first, first + std::size_t(bytes->GetLength()));
    }
    if ((file.frames.size() == 1 && i + 1 < count) || stream.size() < 2 || stream[0] != std::byte(0xff) ||
        stream[1] != std::byte(0xd8))
      continue;
    if (const auto damage = jpegDamage(stream))
      throw IoError(file.path.string() + ": PixelData: frame " + std::to_string(file.frames.size() == 1 ? 1 : i + 1) +
                    ": expected a whole JPEG, found: " + *damage);
  }
}

IoError unreadable(const fs::path& path) {
  return IoError(path.string() + ": expected a DICOM file, found one that cannot be read: truncated or corrupt");
}

std::ifstream opened(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw IoError(path.string() + ": cannot read: " + std::strerror(errno));
  return in;
}

// To be read from its start by GDCM, which by a name would open the file again.
void giveTo(gdcm::Reader& reader, std::ifstream& in) {
  in.clear();
  in.seekg(0);
  reader.SetStream(in);
}

// Runs `read` with the messages of GDCM turned off, and makes its exceptions ours.
template <class Read>
auto quietly(const fs::path& path, const Read& read) {
  gdcm::Trace::DebugOff();
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
  try {
    return read();
  } catch (const Error&) {
    throw;
  } catch (const std::exception&) {
    throw unreadable(path);
  }
}

// Frames and pixels of an image.
void readImage(const DicomStructure& structure, const Tags& tags, DicomFile& file) {
  readPixelLayout(tags, file);
  file.valueUnit = tags.has(Tag(0x0028, 0x1054)) ? tags.text(Tag(0x0028, 0x1054)) : tags.text(Tag(0x0054, 0x1001));
  file.gantryTilt = tags.number1(Tag(0x0018, 0x1120), "GantryDetectorTilt", 0);
  file.sliceDistance = tags.number1(Tag(0x0018, 0x0050), "SliceThickness", 0);
  file.sliceDistance = std::abs(tags.number1(Tag(0x0018, 0x0088), "SpacingBetweenSlices", file.sliceDistance));
  const std::string text = tags.text(Tag(0x0028, 0x0008));
  const auto frames = text.empty() ? std::optional<std::int64_t>(1) : integer(text);
  // A frame has at least some bytes of its own in the file, also when it is packed.
  const std::int64_t size = checkedFileSize(file.path);
  if (!frames || *frames < 1 || *frames > size)
    failField(file.path, "NumberOfFrames", "a number from 1 that the file can hold", text);
  const std::int64_t bytes = file.rows * file.columns * *frames * voxelBytes(file.layout.type);
  if (structure.pixelOffset < 0) failField(file.path, "PixelData", "the element", "");
  if (!structure.encapsulated && tags.unsignedShort(Tag(0x0028, 0x0100), 0) != 12) {
    // DICOM adds a byte where the length would be odd.
    if (structure.pixelBytes < bytes || structure.pixelBytes > bytes + 1)
      throw IoError(file.path.string() + ": PixelData: expected " + std::to_string(file.columns) + " x " +
                    std::to_string(file.rows) + " x " + std::to_string(*frames) + " " +
                    std::string(voxelTypeName(file.layout.type)) + " = " + std::to_string(bytes) + " bytes, found " +
                    std::to_string(structure.pixelBytes));
    file.pixelOffset = structure.pixelOffset;
    file.layout.endian = structure.bigEndian ? std::endian::big : std::endian::little;
  }
  readFrames(tags, file, static_cast<std::size_t>(*frames));
}

bool readUpToPixels(gdcm::Reader& reader, std::ifstream& in) {
  giveTo(reader, in);
  try {
    return reader.ReadUpToTag(Tag(0x7fe0, 0x0010));
  } catch (const std::exception&) {
    return false;
  }
}

// Leaves in file.refused what does not concern other series.
void readAll(const DicomStructure& structure, std::ifstream& in, DicomFile& file) {
  gdcm::Reader reader;
  if (readUpToPixels(reader, in)) {
    const Tags tags(file.path, reader.GetFile().GetDataSet());
    readSeries(tags, file);
    try {
      quietly(file.path, [&] { readImage(structure, tags, file); });
    } catch (const Error&) {
      file.refused = std::current_exception();
    }
    return;
  }
  // What tells series apart may be whole.
  gdcm::Reader beginning;
  giveTo(beginning, in);
  if (!beginning.ReadSelectedTags({kModality, kSeriesDescription, kSeriesUid, kSeriesNumber, Tag(0x0028, 0x0010)}))
    throw unreadable(file.path);
  readSeries(Tags(file.path, beginning.GetFile().GetDataSet()), file);
  file.refused = std::make_exception_ptr(unreadable(file.path));
}

DicomFile readTags(const fs::path& path, std::ifstream& in) {
  return quietly(path, [&] {
    DicomFile file;
    file.path = path;
    const DicomStructure structure = readDicomStructure(path, in);
    file.rows = structure.rows;
    if (file.rows > 0) readAll(structure, in, file);
    return file;
  });
}

}  // namespace

std::optional<DicomFile> readDicomTagsIfAny(const fs::path& path) {
  std::ifstream in = opened(path);
  std::array<char, 132> bytes{};
  if (!in.read(bytes.data(), bytes.size()) || std::string_view(bytes.data() + 128, 4) != "DICM") return std::nullopt;
  return readTags(path, in);
}

DicomFile readDicomTags(const fs::path& path) {
  checkedFileSize(path);
  std::ifstream in = opened(path);
  return readTags(path, in);
}

std::vector<std::byte> readDicomPixels(const DicomFile& file, std::size_t first, std::size_t count) {
  const std::int64_t frameBytes = file.rows * file.columns * voxelBytes(file.layout.type);
  if (file.pixelOffset >= 0) {
    std::vector<std::byte> pixels(static_cast<std::size_t>(frameBytes) * count);
    const auto stream = openPlain(file.path, file.pixelOffset + frameBytes * static_cast<std::int64_t>(first));
    if (const std::size_t got = stream->read(pixels); got < pixels.size())
      throw IoError(file.path.string() + ": PixelData: expected " + std::to_string(pixels.size()) + " bytes, found " +
                    std::to_string(got));
    return pixels;
  }
  assert(first == 0 && count == file.frames.size());
  return quietly(file.path, [&] {
    // Before the image reader, which unpacks as it reads and gives a JPEG that it cannot to another program.
    std::ifstream in = opened(file.path);
    gdcm::Reader packed;
    giveTo(packed, in);
    if (packed.Read()) checkJpeg(file, packed.GetFile().GetDataSet().GetDataElement(Tag(0x7fe0, 0x0010)));
    gdcm::ImageReader reader;
    giveTo(reader, in);
    const std::int64_t expected = frameBytes * static_cast<std::int64_t>(count);
    if (!reader.Read())
      throw IoError(
          file.path.string() + ": PixelData: expected " + std::to_string(expected) +
          " bytes of pixels, found none that can be read: truncated, corrupt or in an unknown transfer syntax");
    const gdcm::Image& image = reader.GetImage();
    const auto length = static_cast<std::int64_t>(image.GetBufferLength());
    if (length != expected)
      throw IoError(file.path.string() + ": PixelData: expected " + std::to_string(expected) +
                    " bytes of pixels, found " + std::to_string(length));
    std::vector<std::byte> pixels(static_cast<std::size_t>(expected));
    if (!image.GetBuffer(reinterpret_cast<char*>(pixels.data())))
      throw IoError(file.path.string() + ": PixelData: cannot unpack transfer syntax " +
                    image.GetTransferSyntax().GetString() + ": truncated, corrupt or of an unknown kind");
    return pixels;
  });
}

}  // namespace umbrick
