// One volume out of a dense array with axes of components and of frames beside those of space.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "ingest/streams/byte_stream.h"
#include "ingest/streams/decode.h"
#include "umbrick/ingest/volume_parts.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Where the axes of components and frames stand among those of space: how many of x, y and z vary faster.
struct PartAxes {
  int components = 0;        // 0: side by side; 3: one whole volume after the other
  int frames = 3;            // as components
  bool framesFirst = false;  // frames vary faster than components that stand at the same place
};

/// Bytes of the whole array, or nothing when some dimension is outside [1, 2^31) or they do not fit into 63 bits.
std::optional<std::int64_t> arrayBytes(const VolumeInfo& info);

/// Gives the components a meaning where the file states none, with a note: three or four bytes are a colour, else
/// several numbers are a vector.
void guessMeaning(VolumeInfo& info);

/// @return the volume or the components that were chosen, which are all where there is one
/// @param info  has dims, type, components and frames of the array, and its name
/// @throw SeveralParts     there are several volumes or numbers, and none is chosen
/// @throw InvalidArgument  there is no such component or frame
void checkChoice(const VolumeInfo& info, const PartChoice& choice);

/// Gives the stream when it is called first, and from then on what `again` opens.
std::function<std::unique_ptr<ByteStream>()> openOnceMore(std::unique_ptr<ByteStream> first,
                                                          std::function<std::unique_ptr<ByteStream>()> again);

/// Opens what was chosen of an array whose voxels are packed as dense ones.
/// @param open  gives the bytes of the whole array from its first number on, each time it is called
/// @param hint  added to the message when bytes are left over
/// @throw Error  as checkChoice does
std::unique_ptr<VoxelSource> openParts(VolumeInfo info, const PartAxes& axes, const VoxelLayout& layout,
                                       const PartChoice& choice,
                                       const std::function<std::unique_ptr<ByteStream>()>& open,
                                       const std::string& hint = {});

/// The one component that was chosen, or the length of the vector, of a source that gives all of them.
/// @param source  gives all components  @throw Error  as checkChoice does
std::unique_ptr<VoxelSource> pickComponents(std::unique_ptr<VoxelSource> source, const PartChoice& choice);

}  // namespace umbrick
