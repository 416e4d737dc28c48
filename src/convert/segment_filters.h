// Segmentations as they are converted: in another world, masked, cropped, as volumes are.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "convert/volume_source.h"
#include "umbrick/ingest/segment_source.h"

namespace umbrick {

/// Does with a segmentation what openVolume and openFiltered do with a volume, but for resampling. Pixels that the mask
/// leaves out have no share of any segment.
/// @param notes  gets how many pixels with a share of a segment the mask left out; outlives the segments
/// @throw InvalidArgument  a box outside of the volume, a mask of another size or place, or another space
std::unique_ptr<SegmentSource> filteredSegments(std::unique_ptr<SegmentSource> segments, const SourceOptions& options,
                                                ReadNotes& notes);

}  // namespace umbrick
