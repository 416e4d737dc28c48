// The slices of a series in order of their positions, on an even grid.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

#include "ingest/dicom/dicom_file.h"
#include "ingest/dicom/dicom_pick.h"
#include "umbrick/ingest/dicom_volume.h"

namespace umbrick {

/// A slice of the volume: (1 - share) of one slice of the series and `share` of the next one.
struct DicomBlend {
  std::size_t slice = 0;
  double share = 0;  // 0: the slice as it is
};

class DicomStack {
 public:
  /// Drops odd slices, fills in places that are not stated, sorts and checks, as openDicom says.
  /// @param name  for messages  @param notes  gets what was guessed or left out, a sentence each
  DicomStack(std::string name, std::vector<DicomFile> files, const DicomOptions& options,
             std::vector<std::string>& notes);
  DicomStack(DicomStack&&) = default;

  const std::vector<DicomFile>& files() const { return files_; }
  const std::vector<DicomSlice>& slices() const { return slices_; }
  /// The slices of the volume.
  const std::vector<DicomBlend>& blends() const { return blends_; }
  glm::dmat4 indexToWorld() const;

 private:
  double along(const DicomSlice& slice) const;
  glm::dvec3 meanStep() const;
  void sortSlices();
  void checkOnePerPlace() const;
  /// Returns what is wrong with the distances of slices, or nothing.
  std::string unevenness(std::vector<std::string>& notes) const;
  void evenOut(std::vector<std::string>& notes);

  std::string name_;
  std::vector<DicomFile> files_;
  std::vector<DicomSlice> slices_;  // into files_, whose elements stay where they are when this is moved
  std::vector<DicomBlend> blends_;
  glm::dvec3 normal_{0, 0, 1};
};

}  // namespace umbrick
