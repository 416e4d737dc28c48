// SPDX-License-Identifier: Apache-2.0
#include "ingest/dicom/dicom_alike.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <sstream>
#include <utility>

#include "ingest/dicom/dicom_colours.h"
#include "ingest/header_text.h"
#include "umbrick/core/error.h"
#include "umbrick/ingest/dicom_volume.h"

namespace umbrick {
namespace {

struct Slice {
  std::size_t file = 0, frame = 0;
};

// Slices that are alike.
struct Group {
  std::vector<Slice> slices;
};

std::string sizeText(const DicomFile& file) { return std::to_string(file.columns) + " x " + std::to_string(file.rows); }

std::string spacingText(const glm::dvec2& spacing) {
  return std::to_string(spacing.y) + " " + std::to_string(spacing.x);
}

// How a slice differs from the one that others are like: the field, and what there is in both. Empty: it does not.
struct Difference {
  std::string field, expected, found;
};

Difference difference(const DicomFile& fileA, const DicomFrame& a, const DicomFile& fileB, const DicomFrame& b) {
  if (fileA.columns != fileB.columns || fileA.rows != fileB.rows)
    return {"Columns and Rows", sizeText(fileA) + " pixels", sizeText(fileB)};
  const bool greyA = fileA.pixels.colours == DicomColours::grey, greyB = fileB.pixels.colours == DicomColours::grey;
  if (greyA != greyB || (!greyA && valueType(fileA.pixels) != valueType(fileB.pixels)))
    return {"PhotometricInterpretation", fileA.pixels.photometric, fileB.pixels.photometric};
  if (greyA && fileA.pixels.layout.type != fileB.pixels.layout.type)
    return {"PixelRepresentation and BitsAllocated", std::string(voxelTypeName(fileA.pixels.layout.type)) + " pixels",
            std::string(voxelTypeName(fileB.pixels.layout.type))};
  const auto stated = [](bool is) { return is ? std::string("one") : std::string("none"); };
  if (a.position.has_value() != b.position.has_value())
    return {"ImagePositionPatient", stated(a.position.has_value()), stated(b.position.has_value())};
  if (a.alongRow.has_value() != b.alongRow.has_value())
    return {"ImageOrientationPatient", stated(a.alongRow.has_value()), stated(b.alongRow.has_value())};
  if (a.spacing.has_value() != b.spacing.has_value())
    return {"PixelSpacing", stated(a.spacing.has_value()), stated(b.spacing.has_value())};
  if (a.alongRow &&
      (glm::distance(*a.alongRow, *b.alongRow) > 1e-4 || glm::distance(*a.alongColumn, *b.alongColumn) > 1e-4))
    return {"ImageOrientationPatient", pointText(*a.alongRow) + " " + pointText(*a.alongColumn),
            pointText(*b.alongRow) + " " + pointText(*b.alongColumn)};
  if (a.spacing && glm::distance(*a.spacing, *b.spacing) > 1e-5 * glm::length(*a.spacing))
    return {"PixelSpacing", spacingText(*a.spacing), spacingText(*b.spacing)};
  return {};
}

class Groups {
 public:
  explicit Groups(const std::vector<DicomFile>& files) : files_(files) {
    for (std::size_t i = 0; i < files.size(); ++i)
      for (std::size_t k = 0; k < files[i].frames.size(); ++k) add({i, k});
    std::stable_sort(groups_.begin(), groups_.end(),
                     [](const Group& a, const Group& b) { return a.slices.size() > b.slices.size(); });
  }

  const std::vector<Group>& all() const { return groups_; }
  std::size_t count() const {
    std::size_t slices = 0;
    for (const Group& group : groups_) slices += group.slices.size();
    return slices;
  }
  bool hasMost() const { return 2 * groups_.front().slices.size() > count(); }

  /// "i7.dcm: PixelSpacing: expected 1 1 as in i5.dcm and 3 more slices, found 2 2"
  std::string oddness(const Group& odd) const {
    const Slice &usual = groups_.front().slices.front(), &first = odd.slices.front();
    const Difference d = difference(file(usual), frame(usual), file(first), frame(first));
    const std::size_t more = groups_.front().slices.size() - 1;
    return d.field + ": expected " + d.expected + " as in " + sliceName(file(usual), frame(usual)) +
           (more > 0 ? " and " + std::to_string(more) + (more == 1 ? " more slice" : " more slices") : "") +
           ", found " + d.found;
  }
  const DicomFile& file(const Slice& slice) const { return files_[slice.file]; }
  const DicomFrame& frame(const Slice& slice) const { return files_[slice.file].frames[slice.frame]; }

 private:
  void add(const Slice& slice) {
    for (Group& group : groups_) {
      const Slice& first = group.slices.front();
      if (difference(file(first), frame(first), file(slice), frame(slice)).field.empty()) {
        group.slices.push_back(slice);
        return;
      }
    }
    groups_.push_back({{slice}});
  }

  const std::vector<DicomFile>& files_;
  std::vector<Group> groups_;
};

}  // namespace

std::string pointText(const glm::dvec3& v) {
  std::ostringstream out;
  out << '(' << v.x << ' ' << v.y << ' ' << v.z << ')';
  return out.str();
}

std::string sliceName(const DicomFile& file, const DicomFrame& frame) {
  const std::string name = file.path.filename().string();
  if (file.pixels.images > 1) return name + " frame " + std::to_string(frame.image + 1);
  if (file.frames.size() > 1) {
    const std::int64_t tiles = file.pixels.columns / file.columns;
    return name + " tile " + std::to_string(frame.corner.y / file.rows * tiles + frame.corner.x / file.columns + 1);
  }
  return name;
}

void checkPlanes(const std::vector<DicomFile>& files) {
  for (const DicomFile& file : files)
    for (const DicomFrame& frame : file.frames) {
      if (frame.spacing && (!(frame.spacing->x > 0) || !(frame.spacing->y > 0)))
        failField(file.path, "PixelSpacing", "positive numbers", spacingText(*frame.spacing));
      if (!frame.alongRow) continue;
      // Cosines are written with six digits or so, and now and then with two: 0.71 for a half right angle.
      constexpr double kLengthOff = 0.01;
      const glm::dvec3 x = *frame.alongRow, y = *frame.alongColumn;
      if (std::abs(glm::length(x) - 1) > kLengthOff || std::abs(glm::length(y) - 1) > kLengthOff ||
          std::abs(glm::dot(x, y)) > kLengthOff)
        failField(file.path, "ImageOrientationPatient", "two unit vectors at right angles",
                  pointText(x) + " " + pointText(y));
    }
}

void keepAlike(std::vector<DicomFile>& files, bool leaveOut, std::vector<std::string>& notes) {
  const Groups groups(files);
  if (groups.all().size() < 2) return;
  const Group& odd = groups.all()[1];
  const std::string path = groups.file(odd.slices.front()).path.string();
  if (!groups.hasMost()) throw IoError(path + ": " + groups.oddness(odd));
  if (!leaveOut) throw OddSlices(path + ": " + groups.oddness(odd));
  std::vector<std::vector<bool>> drop(files.size());
  for (std::size_t i = 0; i < files.size(); ++i) drop[i].resize(files[i].frames.size());
  for (std::size_t g = 1; g < groups.all().size(); ++g) {
    const Group& group = groups.all()[g];
    const std::size_t more = group.slices.size() - 1;
    notes.push_back(sliceName(groups.file(group.slices.front()), groups.frame(group.slices.front())) +
                    (more > 0 ? " and " + std::to_string(more) + " more are" : " is") +
                    " left out: " + groups.oddness(group));
    for (const Slice& slice : group.slices) drop[slice.file][slice.frame] = true;
  }
  for (std::size_t i = 0; i < files.size(); ++i) {
    std::size_t at = 0;
    std::erase_if(files[i].frames, [&](const DicomFrame&) { return drop[i][at++]; });
  }
  std::erase_if(files, [](const DicomFile& file) { return file.frames.empty(); });
}

}  // namespace umbrick
