// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/dicom_volume.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <glm/geometric.hpp>
#include <sstream>
#include <utility>

#include "ingest/dicom/dicom_file.h"
#include "ingest/dicom/dicom_series.h"
#include "ingest/header_text.h"
#include "ingest/place.h"
#include "ingest/provenance.h"
#include "ingest/streams/byte_stream.h"
#include "ingest/streams/dense_source.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

// One frame of one file.
struct Slice {
  std::size_t file = 0, frame = 0;
  DicomFrame plane;
};

std::string text(const glm::dvec3& v) {
  std::ostringstream out;
  out << '(' << v.x << ' ' << v.y << ' ' << v.z << ')';
  return out.str();
}

// All slices must have the same size and type.
void checkAlike(const DicomFile& a, const DicomFile& b) {
  const auto size = [](const DicomFile& file) {
    return std::to_string(file.columns) + " x " + std::to_string(file.rows);
  };
  if (a.columns != b.columns || a.rows != b.rows)
    throw IoError(b.path.string() + ": expected " + size(a) + " pixels as in " + a.path.filename().string() +
                  ", found " + size(b));
  if (a.layout.type != b.layout.type)
    throw IoError(b.path.string() + ": expected " + std::string(voxelTypeName(a.layout.type)) + " pixels as in " +
                  a.path.filename().string() + ", found " + std::string(voxelTypeName(b.layout.type)));
}

void checkPlane(const DicomFile& file, const DicomFrame& frame, const DicomFile& firstFile, const DicomFrame& first) {
  if (!frame.position) failField(file.path, "ImagePositionPatient", "the position of the slice", "");
  if (!frame.alongRow) failField(file.path, "ImageOrientationPatient", "the directions of rows and columns", "");
  if (!frame.spacing) failField(file.path, "PixelSpacing", "the distance of the pixels", "");
  if (!(frame.spacing->x > 0) || !(frame.spacing->y > 0))
    failField(file.path, "PixelSpacing", "positive numbers",
              std::to_string(frame.spacing->y) + " " + std::to_string(frame.spacing->x));
  // Cosines are written with six digits or so.
  const glm::dvec3 x = *frame.alongRow, y = *frame.alongColumn;
  if (std::abs(glm::length(x) - 1) > 1e-3 || std::abs(glm::length(y) - 1) > 1e-3 || std::abs(glm::dot(x, y)) > 1e-3)
    failField(file.path, "ImageOrientationPatient", "two unit vectors at right angles", text(x) + " " + text(y));
  if (glm::distance(x, *first.alongRow) > 1e-4 || glm::distance(y, *first.alongColumn) > 1e-4)
    throw IoError(file.path.string() + ": ImageOrientationPatient: expected " + text(*first.alongRow) + " " +
                  text(*first.alongColumn) + " as in " + firstFile.path.filename().string() + ", found " + text(x) +
                  " " + text(y));
  if (glm::distance(*frame.spacing, *first.spacing) > 1e-5 * glm::length(*first.spacing))
    throw IoError(file.path.string() + ": PixelSpacing: expected " + std::to_string(first.spacing->y) + " " +
                  std::to_string(first.spacing->x) + " as in " + firstFile.path.filename().string() + ", found " +
                  std::to_string(frame.spacing->y) + " " + std::to_string(frame.spacing->x));
}

class Stack {
 public:
  Stack(std::string name, std::vector<DicomFile> files) : name_(std::move(name)), files_(std::move(files)) {
    for (std::size_t file = 0; file < files_.size(); ++file) {
      checkAlike(files_.front(), files_[file]);
      for (std::size_t frame = 0; frame < files_[file].frames.size(); ++frame) {
        checkPlane(files_[file], files_[file].frames[frame], files_.front(), files_.front().frames.front());
        slices_.push_back({file, frame, files_[file].frames[frame]});
      }
    }
    const DicomFrame& first = files_.front().frames.front();
    normal_ = glm::normalize(glm::cross(*first.alongRow, *first.alongColumn));
    std::stable_sort(slices_.begin(), slices_.end(),
                     [&](const Slice& a, const Slice& b) { return along(a) < along(b); });
    checkPositions();
  }

  const std::vector<Slice>& slices() const { return slices_; }
  const std::vector<DicomFile>& files() const { return files_; }

  glm::dmat4 indexToWorld() const {
    const DicomFrame& first = slices_.front().plane;
    glm::dmat4 m(1);
    m[0] = glm::dvec4(*first.alongRow * first.spacing->x, 0);
    m[1] = glm::dvec4(*first.alongColumn * first.spacing->y, 0);
    m[2] = glm::dvec4(step(), 0);
    m[3] = glm::dvec4(*first.position, 1);
    return m;
  }

 private:
  double along(const Slice& slice) const { return glm::dot(*slice.plane.position, normal_); }

  std::string called(const Slice& slice) const {
    const DicomFile& file = files_[slice.file];
    return file.path.filename().string() +
           (file.frames.size() > 1 ? " frame " + std::to_string(slice.frame + 1) : std::string());
  }

  // From one slice to the next, the mean of all; a single slice is as thick as it says, or as its pixels are wide.
  glm::dvec3 step() const {
    const DicomFrame& first = slices_.front().plane;
    if (slices_.size() > 1)
      return (*slices_.back().plane.position - *first.position) / static_cast<double>(slices_.size() - 1);
    const double thickness = files_.front().sliceDistance;
    return normal_ * (thickness > 0 ? thickness : std::sqrt(first.spacing->x * first.spacing->y));
  }

  void checkPositions() const {
    if (slices_.size() < 2) return;
    std::vector<double> gaps;
    for (std::size_t i = 1; i < slices_.size(); ++i) gaps.push_back(along(slices_[i]) - along(slices_[i - 1]));
    std::vector<double> sorted = gaps;
    std::nth_element(sorted.begin(), sorted.begin() + std::ssize(sorted) / 2, sorted.end());
    const double usual = sorted[sorted.size() / 2];
    // Positions are written to a micron or so; slices are never that thin.
    constexpr double kSame = 1e-3;
    for (std::size_t i = 0; i < gaps.size(); ++i) {
      const Slice &a = slices_[i], &b = slices_[i + 1];
      if (gaps[i] < kSame)
        throw IoError(name_ + ": expected one slice at each position, found " + called(a) + " and " + called(b) +
                      " at " + text(*a.plane.position));
      if (gaps[i] > 1.5 * usual && usual >= kSame)
        throw IoError(name_ + ": expected slices " + std::to_string(usual) + " mm apart, found " +
                      std::to_string(gaps[i]) + " mm between " + called(a) + " at " + text(*a.plane.position) +
                      " and " + called(b) + " at " + text(*b.plane.position) + ": is a slice missing?");
    }
    const glm::dvec3 each = step();
    const double tolerance = std::max(0.02 * glm::length(each), 0.01);
    for (std::size_t i = 0; i < slices_.size(); ++i) {
      const glm::dvec3 expected = *slices_.front().plane.position + each * static_cast<double>(i);
      if (glm::distance(expected, *slices_[i].plane.position) > tolerance)
        throw IoError(name_ + ": " + called(slices_[i]) + ": ImagePositionPatient: expected " + text(expected) +
                      " for slices that are evenly spaced, found " + text(*slices_[i].plane.position));
    }
  }

  std::string name_;
  std::vector<DicomFile> files_;
  std::vector<Slice> slices_;
  glm::dvec3 normal_{0, 0, 1};
};

class DicomSource : public VoxelSource {
 public:
  DicomSource(VolumeInfo info, Stack stack) : stack_(std::move(stack)) { info_ = std::move(info); }

  double readSlab(std::int64_t count, std::span<float> out) override {
    const auto voxels = static_cast<std::size_t>(info_.dims.x * info_.dims.y);
    const std::size_t bytes = voxels * static_cast<std::size_t>(voxelBytes(info_.type));
    double error = 0;
    for (std::int64_t i = 0; i < count; ++i) {
      const Slice& slice = stack_.slices()[next_++];
      const DicomFile& file = stack_.files()[slice.file];
      const bool native = file.pixelOffset >= 0;
      if (native)
        pixels_ = readDicomPixels(file, slice.frame, 1);
      else if (unpacked_ != slice.file)
        pixels_ = readDicomPixels(file, 0, file.frames.size());
      unpacked_ = slice.file;
      VoxelLayout layout = file.layout;
      layout.slope = slice.plane.slope;
      layout.intercept = slice.plane.intercept;
      error = std::max(error, decodeVoxels(layout, std::span(pixels_).subspan(native ? 0 : slice.frame * bytes, bytes),
                                           out.subspan(static_cast<std::size_t>(i) * voxels, voxels)));
    }
    return error;
  }

 private:
  Stack stack_;
  std::size_t next_ = 0;
  std::size_t unpacked_ = static_cast<std::size_t>(-1);  // index of the file whose frames are held
  std::vector<std::byte> pixels_;
};

void describe(const Stack& stack, VolumeInfo& info) {
  const DicomFile& file = stack.files().front();
  info.metadata["space"] = "LPS";
  info.metadata["length_unit"] = "mm";
  const auto keep = [&](const char* key, const std::string& value) {
    if (!value.empty()) info.metadata[key] = value;
  };
  keep("modality", file.modality);
  keep("series_uid", file.seriesUid);
  keep("series_description", file.seriesDescription);
  keep("value_unit", file.valueUnit.empty() && file.modality == "CT" ? "HU" : file.valueUnit);
  if (file.photometric == "MONOCHROME1") keep("photometric", "MONOCHROME1: the lowest value is white");
  if (file.gantryTilt != 0) keep("gantry_tilt", std::to_string(file.gantryTilt) + " degrees");
  bool alike = true;
  for (const Slice& slice : stack.slices())
    alike = alike && slice.plane.slope == stack.slices()[0].plane.slope &&
            slice.plane.intercept == stack.slices()[0].plane.intercept;
  VoxelLayout layout;
  layout.slope = stack.slices()[0].plane.slope;
  layout.intercept = stack.slices()[0].plane.intercept;
  keep("rescale", alike ? describeRescale(layout).value_or("") : "its own for each slice");
}

}  // namespace

std::unique_ptr<VoxelSource> openDicomSeries(const fs::path& path, DicomSeriesFiles series) {
  VolumeInfo info;
  info.name = path.string();
  for (const DicomFile& file : series.files) {
    if (file.refused) std::rethrow_exception(file.refused);
    info.fileBytes += checkedFileSize(file.path);
  }
  Stack stack(info.name, std::move(series.files));
  const DicomFile& first = stack.files().front();
  info.dims = {first.columns, first.rows, std::ssize(stack.slices())};
  info.type = first.layout.type;
  if (!volumeBytes(info.dims, info.type)) failField(path, "frames", "less than 2^31", std::to_string(info.dims.z));
  info.indexToWorld = stack.indexToWorld();
  addProvenance(info, path, "DICOM");
  describe(stack, info);
  checkPlace(info, "ImagePositionPatient, ImageOrientationPatient and PixelSpacing");
  return std::make_unique<DicomSource>(std::move(info), std::move(stack));
}

std::unique_ptr<VoxelSource> openDicom(const fs::path& path, const std::string& series) {
  return openDicomSeries(path,
                         pickSeries(path, readDicomSeries(path).value_or(std::vector<DicomSeriesFiles>()), series));
}

}  // namespace umbrick
