// SPDX-License-Identifier: Apache-2.0
#include "ingest/dicom/dicom_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <string_view>

#include "ingest/dicom/dicom_dictionary.h"
#include "ingest/header_text.h"

namespace umbrick {
namespace {

constexpr std::size_t kLongestTextKept = 64;

// The functional groups that state the plane of a frame: its position, its orientation and the measures of its pixels.
constexpr std::array<std::uint32_t, 3> kPlaneGroups{0x00209113, 0x00209116, 0x00289110};

// Vectors of nuclear medicine, which say for each frame which slice, phase and so on it is. Those of the last four are
// views from around the patient where no slices are counted.
constexpr std::uint32_t kSliceVector = 0x00540080;
constexpr std::array<std::uint32_t, 9> kVectors{0x00540010, 0x00540020, 0x00540030, 0x00540060, 0x00540070,
                                                0x00540080, 0x00540050, 0x00540090, 0x00540100};

// What one more in the last digit of the numbers comes to: 0.01 for "1.25\-3\7.5".
double lastDigit(std::string_view numbers) {
  int most = 0, digits = 0, exponent = 0;
  bool behindPoint = false;
  double least = 1;
  const auto close = [&] {
    most = digits - exponent;
    least = std::min(least, std::pow(10.0, -most));
    digits = exponent = 0;
    behindPoint = false;
  };
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const char c = numbers[i];
    if (c == '\\') {
      close();
    } else if (c == '.') {
      behindPoint = true;
    } else if (c == 'e' || c == 'E') {
      const std::size_t end = std::min(numbers.find('\\', i), numbers.size());
      exponent = static_cast<int>(integer(numbers.substr(i + 1, end - i - 1)).value_or(0));
      exponent = std::clamp(exponent, -30, 30);
      i = end - 1;
    } else if (behindPoint && c >= '0' && c <= '9') {
      ++digits;
    }
  }
  close();
  return least;
}

void readPlane(const DicomTags& tags, DicomFrame& frame) {
  if (const auto found = tags.numbers(0x00200032, "ImagePositionPatient", 3)) {
    frame.position = glm::dvec3((*found)[0], (*found)[1], (*found)[2]);
    frame.lastDigit = lastDigit(tags.text(0x00200032));
  }
  if (const auto found = tags.numbers(0x00200037, "ImageOrientationPatient", 6)) {
    frame.alongRow = glm::dvec3((*found)[0], (*found)[1], (*found)[2]);
    frame.alongColumn = glm::dvec3((*found)[3], (*found)[4], (*found)[5]);
  }
  if (const auto found = tags.numbers(0x00280030, "PixelSpacing", 2))
    frame.spacing = glm::dvec2((*found)[1], (*found)[0]);  // stored as between rows, between columns
}

void readRescale(const DicomTags& tags, DicomFrame& frame) {
  frame.slope = tags.number(0x00281053, "RescaleSlope", frame.slope);
  frame.intercept = tags.number(0x00281052, "RescaleIntercept", frame.intercept);
}

// Reads the functional groups of an enhanced image. Those that all frames share come first, then those of each frame.
void readGroups(const DicomTags& groups, DicomFrame& frame, double& sliceDistance) {
  for (const std::uint32_t group : kPlaneGroups)
    for (const DicomElements& item : groups.items(group)) readPlane(DicomTags(groups.path(), item), frame);
  for (const DicomElements& item : groups.items(0x00289110))
    sliceDistance = DicomTags(groups.path(), item).number(0x00180050, "SliceThickness", sliceDistance);
  for (const DicomElements& item : groups.items(0x00289145)) readRescale(DicomTags(groups.path(), item), frame);
  for (const DicomElements& item : groups.items(0x0062000a))
    frame.segment = DicomTags(groups.path(), item).unsignedShort(0x0062000b, frame.segment);
}

void addValues(const DicomElements& elements, DicomValues& out) {
  for (const DicomElement& element : elements)
    if (!element.items.empty()) addValues(element.items.front(), out);
  const DicomValues own = shortValues(elements, kLongestTextKept);
  out.insert(out.end(), own.begin(), own.end());
}

// All that the groups of a frame say, in order of tags.
DicomValues valuesOf(const DicomElements& groups) {
  DicomValues out;
  addValues(groups, out);
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return out;
}

void setValue(DicomValues& values, std::uint32_t tag, const std::string& value) {
  const auto at = std::lower_bound(values.begin(), values.end(), tag,
                                   [](const auto& each, std::uint32_t wanted) { return each.first < wanted; });
  values.insert(at, {tag, value});
}

// Keeps the number that each vector has for each frame.
void readVectors(const DicomTags& tags, DicomFile& file) {
  for (const std::uint32_t tag : kVectors) {
    const auto numbers = tags.numbers(tag, dicomKeyword(tag).c_str(), 0);
    if (!numbers || numbers->size() != file.frames.size()) continue;
    for (std::size_t i = 0; i < numbers->size(); ++i)
      setValue(file.frames[i].values, tag, std::to_string(static_cast<std::int64_t>((*numbers)[i])));
  }
}

// The number of a frame in a vector, from 0.
std::size_t inVector(const DicomFrame& frame, std::uint32_t vector, std::size_t otherwise) {
  for (const auto& [tag, value] : frame.values)
    if (tag == vector) return static_cast<std::size_t>(std::max<std::int64_t>(integer(value).value_or(1), 1) - 1);
  return otherwise;
}

// Frames that follow each other around the patient, or in time, make no volume.
void checkIncrement(const DicomTags& tags, DicomFile& file) {
  const auto pointer = tags.numbers(0x00280009, "FrameIncrementPointer", 0);
  if (!pointer) return;
  bool slices = false;
  std::string others;
  for (std::size_t i = 0; i + 1 < pointer->size(); i += 2) {
    const auto tag = static_cast<std::uint32_t>((*pointer)[i]) << 16 | static_cast<std::uint32_t>((*pointer)[i + 1]);
    slices = slices || tag == kSliceVector || tag == 0x3004000c;
    if (tag >> 16 == 0x0054 && tag != kSliceVector) others += (others.empty() ? "" : ", ") + dicomKeyword(tag);
    if (tag == 0x00181063 || tag == 0x00181065)
      file.notes.push_back({"its frames follow each other in time and are taken for slices",
                            "FrameIncrementPointer: " + dicomKeyword(tag)});
  }
  if (!slices && !others.empty())
    failField(file.path, "FrameIncrementPointer", "SliceVector, frames that are slices", others);
}

// Older kinds state one plane, and how far along its normal the others lie or only how far apart they are. Where that
// is negative, they lie against the normal.
void placeFrames(const DicomTags& tags, DicomFile& file, double step) {
  checkIncrement(tags, file);
  readVectors(tags, file);
  const auto offsets = tags.numbers(0x3004000c, "GridFrameOffsetVector", file.frames.size());
  const std::vector<DicomElements>& detectors = tags.items(0x00540022);
  file.framesApartUnknown = !offsets && step == 0;
  if (!file.frames.front().alongRow)
    file.notes.push_back({"states no ImageOrientationPatient: rows and columns are taken for x and y", "frames of it"});
  for (std::size_t i = 0; i < file.frames.size(); ++i) {
    DicomFrame& frame = file.frames[i];
    const std::size_t detector = inVector(frame, 0x00540020, 0);
    if (detector > 0 && detector < detectors.size()) readPlane(DicomTags(file.path, detectors[detector]), frame);
    if (!frame.alongRow) frame.alongRow = glm::dvec3(1, 0, 0), frame.alongColumn = glm::dvec3(0, 1, 0);
    const auto slice = static_cast<double>(inVector(frame, kSliceVector, i));
    const double along = offsets ? (*offsets)[i] - (*offsets)[0] : slice * (file.framesApartUnknown ? 1 : step);
    frame.position = frame.position.value_or(glm::dvec3(0)) + along * sliceNormal(frame);
    frame.lastDigit = 0;  // the steps are as even as their sum is
  }
}

}  // namespace

glm::dvec3 sliceNormal(const DicomFrame& frame) { return glm::cross(*frame.alongRow, *frame.alongColumn); }

DicomValues shortValues(const DicomElements& elements, std::size_t longest) {
  DicomValues out;
  for (const DicomElement& element : elements) {
    if (element.value.empty() || element.value.size() > longest || element.tag >> 16 == 0x0010) continue;
    std::string text = elementText(element);
    const bool readable =
        std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) >= ' '; });
    if (!text.empty() && readable) out.emplace_back(element.tag, std::move(text));
  }
  return out;
}

void readDicomFrames(const DicomTags& tags, DicomFile& file) {
  DicomFrame shared;
  // Nuclear medicine may state the plane with the detector alone.
  const std::vector<DicomElements>& detectors = tags.items(0x00540022);
  if (!detectors.empty()) readPlane(DicomTags(file.path, detectors.front()), shared);
  readPlane(tags, shared);
  readRescale(tags, shared);
  shared.slope = tags.number(0x3004000e, "DoseGridScaling", shared.slope);
  double step = tags.number(0x00180050, "SliceThickness", 0);
  step = tags.number(0x00180088, "SpacingBetweenSlices", step);
  file.sliceDistance = std::abs(step);
  for (const DicomElements& item : tags.items(0x52009229))
    readGroups(DicomTags(file.path, item), shared, file.sliceDistance);
  const std::size_t count = file.pixels.images;
  file.frames.assign(count, shared);
  for (std::size_t i = 0; i < count; ++i) file.frames[i].image = i;
  const std::vector<DicomElements>& each = tags.items(0x52009230);
  if (!each.empty() && each.size() != count)
    failField(file.path, "PerFrameFunctionalGroupsSequence", std::to_string(count) + " items, one for each frame",
              std::to_string(each.size()));
  for (std::size_t i = 0; i < each.size(); ++i) {
    readGroups(DicomTags(file.path, each[i]), file.frames[i], file.sliceDistance);
    file.frames[i].values = valuesOf(each[i]);
  }
  if (each.empty() && count > 1) placeFrames(tags, file, step);
}

}  // namespace umbrick
