// The segments that 3D Slicer names in the header of a .seg.nrrd.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <vector>

#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Reads Segment0_Name, Segment0_LabelValue, Segment0_Layer and Segment0_Color, and those of the numbers that follow.
/// Segments without a value are left out.
/// Source: https://slicer.readthedocs.io/en/latest/developer_guide/modules/segmentations.html
std::vector<VolumeLabel> slicerSegments(const std::map<std::string, std::string>& metadata);

}  // namespace umbrick
