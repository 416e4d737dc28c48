// When a volume is, as its file says: the time and the number of its frame, which its metadata keep.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// The times of the volumes of a file.
struct VolumeTimes {
  std::vector<double> each = {};                // of each volume, where the file lists them
  std::optional<double> first = {}, step = {};  // of the first one, and from one to the next, where it does not
  std::string unit = {};                        // as the file spells it; empty: it states none
};

/// Puts what is known of the volume of `frame` into the metadata: frame, where the file has several volumes, time,
/// time_step and time_unit. See VolumeInfo::metadata. @param frame  counted from 0; none: the only one
void stateTime(VolumeInfo& info, const VolumeTimes& times, std::optional<std::int64_t> frame);

}  // namespace umbrick
