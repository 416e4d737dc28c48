// SPDX-License-Identifier: Apache-2.0
#include "ingest/dicom/dicom_place.h"

#include <algorithm>
#include <cmath>

#include "ingest/dicom/dicom_frames.h"
#include "ingest/header_text.h"
#include "umbrick/ingest/open_volume.h"

namespace umbrick {
namespace {

constexpr std::uint32_t kInstanceNumber = 0x00200013;

[[noreturn]] void failPlace(const DicomFile& file, const char* field, const char* expected) {
  throw UnplacedSlices(file.path.string() + ": " + field + ": expected " + expected + ", found nothing");
}

// What of its place a series lacks. Slices are alike, but files of several frames may lack their distance.
struct Lack {
  bool spacing = false, position = false, orientation = false, distance = false;

  explicit Lack(const std::vector<DicomFile>& files) {
    const DicomFrame& first = files.front().frames.front();
    spacing = !first.spacing;
    position = !first.position;
    orientation = !first.alongRow;
    for (const DicomFile& file : files) distance = distance || file.framesApartUnknown;
  }
  bool any() const { return spacing || position || orientation || distance; }
};

void checkOptions(const std::string& name, const Lack& lack, const DicomOptions& options) {
  const auto check = [&](const char* field, const std::optional<glm::dvec3>& given, bool lacking, bool positive) {
    if (!given) return;
    if (!lacking && !options.overridePlace)
      throw StatedPlace(name + ": " + field + ": this DICOM series states its own");
    for (int axis = 0; axis < 3; ++axis)
      if (!std::isfinite((*given)[axis]) || (positive && !((*given)[axis] > 0)))
        throw InvalidArgument(name + ": " + field + ": expected " + (positive ? "positive " : "") +
                              "finite numbers, found " + std::to_string((*given)[axis]));
  };
  check("spacing", options.spacing, lack.spacing || lack.position || lack.distance, true);
  check("origin", options.origin, lack.position, false);
}

// Slices that follow each other by their numbers, or by the names of their files where they have none.
void lineUp(std::vector<DicomFile>& files, const glm::dvec3& origin, double step) {
  const auto instance = [](const DicomFile& file) {
    const std::string* text = valueOf(file, file.frames.front(), kInstanceNumber);
    return text ? integer(*text).value_or(0) : 0;
  };
  std::stable_sort(files.begin(), files.end(),
                   [&](const DicomFile& a, const DicomFile& b) { return instance(a) < instance(b); });
  double along = 0;
  for (DicomFile& file : files)
    for (DicomFrame& frame : file.frames) frame.position = origin + step * along++ * sliceNormal(frame);
}

}  // namespace

void completePlaces(const std::string& name, std::vector<DicomFile>& files, const DicomOptions& options,
                    std::vector<std::string>& notes) {
  const Lack lack(files);
  checkOptions(name, lack, options);
  if (!lack.any()) return;
  if (!options.spacing) {
    if (lack.position) failPlace(files.front(), "ImagePositionPatient", "the position of the slice");
    if (lack.orientation) failPlace(files.front(), "ImageOrientationPatient", "the directions of rows and columns");
    if (lack.spacing) failPlace(files.front(), "PixelSpacing", "the distance of the pixels");
    for (const DicomFile& file : files)
      if (file.framesApartUnknown) failPlace(file, "SpacingBetweenSlices", "the distance of the frames");
  }
  const glm::dvec3 spacing = *options.spacing;
  for (DicomFile& file : files) {
    if (lack.position) file.sliceDistance = spacing.z;
    for (DicomFrame& frame : file.frames) {
      if (!frame.spacing) frame.spacing = glm::dvec2(spacing);
      if (!frame.alongRow) frame.alongRow = glm::dvec3(1, 0, 0), frame.alongColumn = glm::dvec3(0, 1, 0);
      if (file.framesApartUnknown && frame.position)
        *frame.position += (spacing.z - 1) * static_cast<double>(&frame - file.frames.data()) * sliceNormal(frame);
    }
  }
  if (lack.orientation)
    notes.push_back("the slices state no ImageOrientationPatient: rows and columns are taken for x and y");
  if (lack.spacing && !lack.position)
    notes.push_back("the pixels are as far apart as was asked for, the slices as their positions state");
  if (!lack.spacing) notes.push_back("the pixels are as far apart as PixelSpacing states, the slices as was asked for");
  if (!lack.position) return;
  notes.push_back("the slices state no ImagePositionPatient and follow each other by InstanceNumber");
  lineUp(files, options.origin.value_or(glm::dvec3(0)), spacing.z);
}

}  // namespace umbrick
