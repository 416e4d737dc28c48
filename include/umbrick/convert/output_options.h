// What a conversion writes: the format by the extension of the output, and how it packs values.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "umbrick/convert/target.h"
#include "umbrick/core/axis.h"
#include "umbrick/grid/vdb_codec.h"
#include "umbrick/vdb/write_volume.h"

namespace umbrick {

/// How an output is packed. Its format is told by its extension: .vdb, .nvdb, or the dense box of the active voxels as
/// .nrrd or as .mhd with a .raw beside it.
struct OutputOptions {
  /// ".vdb", ".nvdb" or ".nrrd", of a name whose extension is none of these, as that of a stream.
  std::string format = {};
  std::optional<VdbCodec> codec = {};  // of a .vdb only; blosc where none is given
  /// Of a .nvdb only; 32-bit floats where none are given. With NanoValues::adaptive and no maxError of its own, the
  /// values take half of BuildOptions::maxError, and what is left out or merged the other half.
  std::optional<NanoOptions> nano = {};
  /// Of a .vdb only: place, names and values are made ready for this program, see TargetTraits. Values of a fog that
  /// are mapped to 0..1 lose what lies below the background, which is the border's where none is given.
  std::optional<Target> target = {};
  Axis up = Axis::automatic;        // which axis of the input is up, for the target; automatic: see orientationOf
  std::string creator = "umbrick";  // is kept as metadata "creator" of a .vdb whose input states none
};

/// Asks whether the output can be written, before anything is read. Conversions begin with this.
/// @throw OptionsError  another extension, a codec for another format than .vdb, packed values for another one than
///                      .nvdb, several inputs for a format that holds one grid, or a dense output that would take the
///                      place of an input
void checkOutput(const std::filesystem::path& output, const OutputOptions& options,
                 const std::vector<std::filesystem::path>& inputs);

}  // namespace umbrick
