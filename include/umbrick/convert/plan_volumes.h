// What conversions of volumes would make and need, before they are done.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "umbrick/convert/convert_options.h"
#include "umbrick/grid/plan.h"
#include "umbrick/grid/source_filters.h"

namespace umbrick {

struct VolumePlan {
  std::filesystem::path input;
  std::optional<BorderMode> background;  // what the border of the volume has, where that was asked for
  GridPlan grid;
};

/// Tells from a part of each volume what convertVolumes would make of it, see planGrid. Writes nothing. The codec is
/// output.codec.
/// @throw Error  as convertVolumes
std::vector<VolumePlan> planVolumes(const std::vector<std::filesystem::path>& inputs,
                                    const ConvertOptions& options = {});

}  // namespace umbrick
