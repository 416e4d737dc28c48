// Segmentations that are stored as pictures of one segment each, which may overlap and leave slices out.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// A slice of one segment.
struct SegmentFrame {
  std::size_t label = 0;   // place in VolumeInfo::labels
  std::int64_t slice = 0;  // along z
};

class SegmentSource {
 public:
  virtual ~SegmentSource() = default;
  /// The volume that the frames lie in. Its labels are the segments, whose values are their numbers.
  const VolumeInfo& info() const { return info_; }
  const std::vector<SegmentFrame>& frames() const { return frames_; }
  /// The share of the segment in each pixel of a frame, from 0 to 1; out.size() == dims.x * dims.y, x fastest.
  /// @throw IoError
  virtual void read(std::size_t frame, std::span<float> out) = 0;

 protected:
  VolumeInfo info_;
  std::vector<SegmentFrame> frames_;
};

/// Opens a DICOM segmentation: a file, or a folder that holds one. Segments are binary or fractional, with the names
/// and colours that the file recommends. Source: DICOM PS3.3 C.8.20
/// @param lengthUnit  as OpenOptions::lengthUnit
/// @return null where the file is something else
/// @throw IoError          damaged, or slices that do not lie in line on an even grid
/// @throw InvalidArgument  another unit
std::unique_ptr<SegmentSource> openDicomSegments(const std::filesystem::path& path, const std::string& lengthUnit = {});

}  // namespace umbrick
