// One volume on its way to a grid: opened, built, written with others, verified.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "convert/target_grid.h"
#include "convert/target_vectors.h"
#include "convert/volume_source.h"
#include "umbrick/convert/convert_options.h"
#include "umbrick/convert/convert_report.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/ingest/segment_source.h"
#include "umbrick/ingest/world.h"

namespace umbrick {

/// A grid of a volume, with its report.
struct JobGrid {
  openvdb::GridBase::Ptr grid;
  ConvertedGrid report;
};

struct VolumeJob {
  std::filesystem::path input;
  ConvertOptions options;  // with the name of its grid, and its background once that is found
  std::string unit;
  std::unique_ptr<ReadNotes> notes = std::make_unique<ReadNotes>();  // sources hold on to its place
  std::optional<ValueMap> map;                  // of the values of the grid, where a target asks for one
  std::optional<VectorMap> vectorMap;           // the same of a grid of vec3
  VoxelMeaning meaning = VoxelMeaning::scalar;  // of the numbers of a grid of vec3
  std::string settled;                  // how its background was found where nobody asked for it; becomes a note
  bool usualName = false;               // nobody has given the grid a name
  std::unique_ptr<VoxelSource> opened;  // the input, where it had to be opened before
  /// The input in place of `opened`, where its labels lie in pictures of one each.
  std::unique_ptr<SegmentSource> segments;
  std::shared_ptr<KeptStream> again;  // of frames that are opened once more to be verified
  std::vector<JobGrid> grids;         // that were built: one, or one for each label
  std::int64_t bytesIn = 0;
  ConvertedGrid report;  // what is known before a grid is built
};

/// The options of a pass over the voxels of a job, which tells how far it is.
BuildOptions passOf(const VolumeJob& job, ConvertStage stage, const VolumeInfo& info);

/// One for each input.
/// @param options  settled  @throw OptionsError  names or units that do not fit
std::vector<VolumeJob> volumeJobs(const std::vector<std::filesystem::path>& inputs, const ConvertOptions& options);

/// Finds the background where that is asked for.
/// @return the source to build the grid from, which must not outlive the job
std::unique_ptr<VoxelSource> openJob(VolumeJob& job);

/// Opens one after the other and calls `use`. Each is brought to the world of those before it.
void openEach(std::vector<VolumeJob>& jobs, const std::function<void(VoxelSource& source, VolumeJob& job)>& use);

/// Reads the source to its end, and builds a grid of floats, of vec3, or one for each label.
void buildVolume(VoxelSource& source, VolumeJob& job);

/// Opens the input of a job and builds its grids. @return the world of the input
World openAndBuild(VolumeJob& job);

/// Whether jobs are the components of one volume, each a grid of floats, which can be built in one pass over it. A mask
/// is read for each of them.
bool shareVolume(const std::vector<VolumeJob>& jobs);

/// Does what openAndBuild does for the components of one volume. @pre shareVolume(jobs)
World openAndBuildTogether(std::vector<VolumeJob>& jobs);

/// Looks at how much of a volume stays, so that a background that leaves out nothing is noticed.
void judgeBackground(const openvdb::FloatGrid& grid, ConvertedGrid& report);

/// Writes the grids, and verifies the file before it takes its name where that is asked for. The reports of the jobs
/// are moved from.
ConvertReport writeVolumes(std::span<VolumeJob> jobs, const std::filesystem::path& output);

}  // namespace umbrick
