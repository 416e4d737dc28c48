// Volumes of labels to one grid for each label, in one pass over the voxels whatever the number of labels.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/grid/verify.h"
#include "umbrick/ingest/segment_source.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Which labels of a volume become grids.
struct LabelChoice {
  std::vector<std::string> wanted = {};  // values or names; empty: all but 0, which is the background
};

struct LabelGrid {
  VolumeLabel label;
  openvdb::FloatGrid::Ptr grid;  // a fog volume that is 1 in the voxels of the label and 0 elsewhere
  BuildReport report;
};

struct LabelGrids {
  std::vector<LabelGrid> grids;    // those that the file names in its order, then the others by value
  std::vector<std::string> notes;  // labels without a voxel, names that were made different
};

/// Reads a source to its end. A grid is called as the file calls its label, or else label_3 for the value 3; names that
/// are equal get a number behind them. The metadata of a grid say label_value, and label_name and label_colour (sRGB,
/// three numbers from 0 to 1) where the file states them.
/// Of several numbers a voxel each is a layer of labels of its own, see VolumeLabel::component.
/// @param progress  may be empty; is called now and then with the share that is done
/// @throw IoError          the source fails
/// @throw InvalidArgument  a voxel is no integer or beyond 2^24, there are more than 4096 labels (each grid takes some
/// 300 KiB at the least), or a label that is
///                         wanted is not there
LabelGrids buildLabelGrids(VoxelSource& source, const LabelChoice& choice = {},
                           const std::function<void(double)>& progress = {});

/// Reads the source to its end and compares it with the grids of its labels, whose voxels must be just those of the
/// labels.
/// @return one report for each grid
std::vector<VerifyReport> verifyLabelGrids(VoxelSource& source, const std::vector<VolumeLabel>& labels,
                                           const std::vector<openvdb::FloatGrid::ConstPtr>& grids,
                                           const std::function<void(double)>& progress = {});

/// Does the same for a segmentation whose segments may overlap and be fractional: a grid holds the share of its segment
/// in each voxel. Frames of segments that are not wanted are not read.
LabelGrids buildSegmentGrids(SegmentSource& source, const LabelChoice& choice = {},
                             const std::function<void(double)>& progress = {});

/// As verifyLabelGrids.
std::vector<VerifyReport> verifySegmentGrids(SegmentSource& source, const std::vector<VolumeLabel>& labels,
                                             const std::vector<openvdb::FloatGrid::ConstPtr>& grids,
                                             const std::function<void(double)>& progress = {});

}  // namespace umbrick
