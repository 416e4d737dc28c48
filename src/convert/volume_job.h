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
#include "convert/volume_source.h"
#include "umbrick/convert/convert_options.h"
#include "umbrick/convert/convert_report.h"

namespace umbrick {

struct VolumeJob {
  std::filesystem::path input;
  ConvertOptions options;  // with the name of its grid, and its background once that is found
  std::string unit;
  std::unique_ptr<ReadNotes> notes = std::make_unique<ReadNotes>();  // sources hold on to its place
  std::shared_ptr<openvdb::FloatGrid> grid;
  std::optional<ValueMap> map;  // of the values of the grid, where a target asks for one
  std::string settled;          // how its background was found where nobody asked for it; becomes a note
  std::int64_t bytesIn = 0;
  ConvertedGrid report;
};

/// One for each input.
/// @param options  settled  @throw OptionsError  names or units that do not fit
std::vector<VolumeJob> volumeJobs(const std::vector<std::filesystem::path>& inputs, const ConvertOptions& options);

/// Finds the background where that is asked for.
/// @return the source to build the grid from, which must not outlive the job
std::unique_ptr<VoxelSource> openJob(VolumeJob& job);

/// Opens one after the other and calls `use`. Each is brought to the world of those before it.
void openEach(std::vector<VolumeJob>& jobs, const std::function<void(VoxelSource& source, VolumeJob& job)>& use);

/// Reads the source to its end.
void buildVolume(VoxelSource& source, VolumeJob& job);

/// Writes the grids, and verifies the file before it takes its name where that is asked for. The reports of the jobs
/// are moved from.
ConvertReport writeVolumes(std::span<VolumeJob> jobs, const std::filesystem::path& output);

}  // namespace umbrick
