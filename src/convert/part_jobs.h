// What becomes of a file of several volumes, or of several numbers a voxel: one grid of vec3, or a grid for each
// number.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "convert/volume_job.h"

namespace umbrick {

/// How one grid comes from a volume.
struct PartPlan {
  PartChoice parts;
  std::string name;                // of the grid; empty: that of its job
  std::vector<std::string> notes;  // a line each, about the choice
};

/// Opens the volume of a job to see what its grids are to be: one, unless its voxels have several numbers. A volume
/// that becomes a single scalar grid stays open in the job.
/// @throw SeveralParts  a sequence, of which no frame is chosen
/// @throw OptionsError  options that are not for what the grids are to be
std::vector<PartPlan> planParts(VolumeJob& job, const std::filesystem::path& output);

/// Sets a job to make the grid of a plan.
void usePlan(const PartPlan& plan, VolumeJob& job);

/// The jobs of all grids of a volume.
std::vector<VolumeJob> partJobs(VolumeJob job, const std::filesystem::path& output);

}  // namespace umbrick
