// SPDX-License-Identifier: Apache-2.0
#include "ingest/dicom/dicom_segments.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <utility>

#include "ingest/dicom/dicom_frames.h"
#include "ingest/dicom/dicom_pixels.h"
#include "ingest/dicom/dicom_series.h"
#include "ingest/header_text.h"
#include "ingest/length_unit.h"
#include "ingest/place.h"
#include "ingest/provenance.h"
#include "ingest/streams/byte_stream.h"
#include "umbrick/core/error.h"
#include "umbrick/core/srgb.h"
#include "umbrick/ingest/segment_source.h"

namespace umbrick {
namespace {
namespace fs = std::filesystem;

// Where a frame lies, along the normal of the slices.
double alongNormal(const DicomFrame& frame, const glm::dvec3& normal) { return glm::dot(*frame.position, normal); }

// Slices at equal distances, on which all frames lie.
struct SegmentGrid {
  glm::dvec3 first{0}, normal{0, 0, 1};
  double step = 1;  // mm
  std::int64_t slices = 1;

  double placeOf(const DicomFrame& frame) const { return glm::dot(*frame.position - first, normal) / step; }
};

[[noreturn]] void refuseFrame(const DicomFile& file, std::size_t frame, const std::string& expected) {
  throw IoError(file.path.string() + ": frame " + std::to_string(frame + 1) + ": expected " + expected);
}

void checkFramePlanes(const DicomFile& file) {
  constexpr double kSameDirection = 1e-4;
  const DicomFrame& first = file.frames.front();
  for (std::size_t i = 0; i < file.frames.size(); ++i) {
    const DicomFrame& frame = file.frames[i];
    if (!frame.position || !frame.alongRow || !frame.alongColumn || !frame.spacing)
      refuseFrame(file, i, "ImagePositionPatient, ImageOrientationPatient and PixelSpacing, found not all of them");
    if (glm::distance(*frame.alongRow, *first.alongRow) > kSameDirection ||
        glm::distance(*frame.alongColumn, *first.alongColumn) > kSameDirection ||
        glm::distance(*frame.spacing, *first.spacing) > kSameDirection * first.spacing->x)
      refuseFrame(file, i, "the orientation and spacing of the first frame, found others");
  }
}

// Whether all places are whole numbers of steps, up to 2 % of one.
bool fitsSteps(const std::vector<double>& places, double step) {
  constexpr double kOffGrid = 0.02;
  return step > 0 && std::all_of(places.begin(), places.end(), [&](double place) {
           const double steps = (place - places.front()) / step;
           return std::abs(steps - std::round(steps)) <= kOffGrid;
         });
}

SegmentGrid gridOf(const DicomFile& file) {
  constexpr double kSamePlace = 1e-3;  // mm
  constexpr double kMostSlices = 65536;
  checkFramePlanes(file);
  SegmentGrid grid;
  grid.normal = glm::normalize(sliceNormal(file.frames.front()));
  std::vector<std::pair<double, std::size_t>> sorted;
  for (std::size_t i = 0; i < file.frames.size(); ++i) sorted.emplace_back(alongNormal(file.frames[i], grid.normal), i);
  std::sort(sorted.begin(), sorted.end());
  grid.first = *file.frames[sorted.front().second].position;
  std::vector<double> places;
  double least = 0;
  for (const auto& [place, frame] : sorted) {
    if (!places.empty() && place - places.back() <= kSamePlace) continue;
    if (!places.empty()) least = least > 0 ? std::min(least, place - places.back()) : place - places.back();
    places.push_back(place);
  }
  if (places.size() == 1) {
    grid.step = file.sliceDistance > 0 ? file.sliceDistance : file.frames.front().spacing->x;
  } else if (fitsSteps(places, least)) {
    grid.step = least;
  } else if (fitsSteps(places, file.sliceDistance)) {
    grid.step = file.sliceDistance;
  } else {
    throw IoError(file.path.string() + ": expected frames on an even grid along their normal, found some in between");
  }
  const double steps = std::round((places.back() - places.front()) / grid.step);
  if (steps >= kMostSlices)
    throw IoError(file.path.string() + ": expected less than 65536 slices, found " + std::to_string(steps + 1));
  grid.slices = static_cast<std::int64_t>(steps) + 1;
  if (steps > 0) grid.step = (places.back() - places.front()) / steps;
  for (std::size_t i = 0; i < file.frames.size(); ++i) {
    const DicomFrame& frame = file.frames[i];
    const glm::dvec3 expected = grid.first + grid.normal * (grid.placeOf(frame) * grid.step);
    if (glm::distance(expected, *frame.position) > std::max(0.02 * grid.step, 0.01))
      refuseFrame(file, i, "a position in line with those of the others along the normal, found another");
  }
  return grid;
}

class DicomSegments : public SegmentSource {
 public:
  DicomSegments(const fs::path& path, DicomFile file, const std::string& lengthUnit) : file_(std::move(file)) {
    const SegmentGrid grid = gridOf(file_);
    const DicomFrame& first = file_.frames.front();
    info_.name = path.string();
    info_.dims = {file_.columns, file_.rows, grid.slices};
    info_.type = file_.wholeSegment > 0 ? VoxelType::f32 : VoxelType::u8;
    glm::dmat4& m = info_.indexToWorld;
    m[0] = glm::dvec4(glm::normalize(*first.alongRow) * first.spacing->x, 0);
    m[1] = glm::dvec4(glm::normalize(*first.alongColumn) * first.spacing->y, 0);
    m[2] = glm::dvec4(grid.normal * grid.step, 0);
    m[3] = glm::dvec4(grid.first, 1);
    checkPlace(info_, "ImagePositionPatient, ImageOrientationPatient and PixelSpacing");
    describe();
    addProvenance(info_, path, "DICOM");
    if (!lengthUnit.empty()) changeLengthUnit(info_, lengthUnit);
    for (std::size_t i = 0; i < file_.frames.size(); ++i)
      frames_.push_back({labelOf(i), static_cast<std::int64_t>(std::round(grid.placeOf(file_.frames[i])))});
  }

  void read(std::size_t frame, std::span<float> out) override {
    VoxelLayout layout = file_.pixels.layout;
    decodeVoxels(layout, pixelsOf(file_.frames[frame].image), out);
    const double whole = file_.wholeSegment;
    for (float& value : out)
      value = whole > 0 ? static_cast<float>(std::min(double(value) / whole, 1.0)) : (value != 0 ? 1.0f : 0.0f);
  }

 private:
  void describe() {
    info_.fileBytes = checkedFileSize(file_.path);
    info_.labels = file_.segments;
    info_.metadata["space"] = "LPS";
    info_.metadata["length_unit"] = "mm";
    info_.metadata["modality"] = file_.modality;
    if (!file_.seriesUid.empty()) info_.metadata["series_uid"] = file_.seriesUid;
    if (!file_.seriesDescription.empty()) info_.metadata["series_description"] = file_.seriesDescription;
    for (const auto& [what, found] : file_.notes) info_.notes.push_back(what + " (" + found + ")");
  }

  std::size_t labelOf(std::size_t frame) const {
    const std::int64_t number = file_.frames[frame].segment;
    for (std::size_t i = 0; i < file_.segments.size(); ++i)
      if (file_.segments[i].value == number) return i;
    refuseFrame(file_, frame, "a ReferencedSegmentNumber of the SegmentSequence, found " + std::to_string(number));
  }

  // Pictures that cannot be had one by one are kept together.
  std::vector<std::byte> pixelsOf(std::size_t image) {
    if (file_.pixels.single()) return readDicomPixels(file_, image);
    if (all_.empty()) all_ = readDicomPixels(file_, 0);
    const auto bytes = all_.size() / file_.pixels.images;
    const auto begin = all_.begin() + static_cast<std::ptrdiff_t>(image * bytes);
    return {begin, begin + static_cast<std::ptrdiff_t>(bytes)};
  }

  DicomFile file_;
  std::vector<std::byte> all_;
};

}  // namespace

void readDicomSegments(const DicomTags& tags, DicomFile& file) {
  for (const DicomElements& item : tags.items(0x00620002)) {
    const DicomTags segment(file.path, item);
    VolumeLabel label;
    label.value = segment.unsignedShort(0x00620004, 0);
    label.name = segment.text(0x00620005);
    if (const auto lab = segment.numbers(0x0062000d, "RecommendedDisplayCIELabValue", 3))
      label.colour = srgbOfDicomLab({(*lab)[0], (*lab)[1], (*lab)[2]});
    file.segments.push_back(std::move(label));
  }
  // A single segment needs no number at its frames.
  if (file.segments.size() == 1)
    for (DicomFrame& frame : file.frames)
      if (frame.segment == 0) frame.segment = file.segments.front().value;
  if (tags.text(0x00620001) == "FRACTIONAL")
    file.wholeSegment = static_cast<double>(std::max<std::int64_t>(tags.unsignedShort(0x0062000e, 255), 1));
}

glm::dvec3 srgbOfDicomLab(const glm::dvec3& stored) {
  const double lightness = stored.x * 100 / 65535, a = stored.y * 255 / 65535 - 128, b = stored.z * 255 / 65535 - 128;
  const auto linearised = [](double f) {
    constexpr double kEdge = 6.0 / 29;
    return f > kEdge ? f * f * f : 3 * kEdge * kEdge * (f - 4.0 / 29);
  };
  const double f = (lightness + 16) / 116;
  const glm::dvec3 xyz(0.96422 * linearised(f + a / 500), linearised(f), 0.82521 * linearised(f - b / 200));
  // Rows of the matrix from XYZ under D50 to linear sRGB.
  const glm::dvec3 red(3.1338561, -1.6168667, -0.4906146), green(-0.9787684, 1.9161415, 0.0334540),
      blue(0.0719453, -0.2289914, 1.4052427);
  const glm::dvec3 linear =
      glm::clamp(glm::dvec3(glm::dot(red, xyz), glm::dot(green, xyz), glm::dot(blue, xyz)), 0.0, 1.0);
  return {linearToSrgb(linear.x), linearToSrgb(linear.y), linearToSrgb(linear.z)};
}

std::unique_ptr<SegmentSource> openDicomSegments(const fs::path& path, const std::string& lengthUnit) {
  std::optional<DicomFile> found;
  if (fs::is_directory(path)) {
    const auto folder = readDicomFolder(path);
    if (!folder || folder->series.size() != 1 || folder->series.front().files.size() != 1) return nullptr;
    found = folder->series.front().files.front();
  } else if (checkedFileSize(path) >= 0) {
    found = readDicomTagsIfAny(path);
  }
  if (!found || found->segments.empty()) return nullptr;
  if (found->refused) std::rethrow_exception(found->refused);
  return std::make_unique<DicomSegments>(path, std::move(*found), lengthUnit);
}

}  // namespace umbrick
