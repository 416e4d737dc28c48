// What a conversion is asked for.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "umbrick/convert/convert_progress.h"
#include "umbrick/convert/output_options.h"
#include "umbrick/core/box.h"
#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/isosurface.h"
#include "umbrick/grid/label_grids.h"
#include "umbrick/ingest/open_volume.h"
#include "umbrick/ingest/world.h"

namespace umbrick {

/// How the inputs are read, and which part of them. They are masked first, then cropped, then resampled.
struct SourceOptions {
  OpenOptions open = {};  // layout of headerless raw, DICOM series, spacing and origin; for volumes only, but `space`
  /// The input is brought to this world where both state theirs. Of several inputs, those without get that of the
  /// first. For volumes only.
  std::optional<World> world = {};
  /// A volume of the size and place of the input, whose world is brought to that of the input, or a file with one
  /// scalar grid: where it is 0, the input becomes background. Empty: no mask.
  std::filesystem::path mask = {};
  OpenOptions openMask = {};          // how the mask is opened where it is a volume
  std::optional<IndexBox> crop = {};  // only these voxels, which stay where they are in the world; of grids by index
  std::optional<glm::dvec3> resample = {};  // new spacing of the voxels, world units; for volumes only
  /// The value of most voxels on the faces of the volume becomes the background, for which the input is read once
  /// before. For volumes only.
  bool backgroundFromBorder = false;
};

struct ConvertOptions {
  SourceOptions source = {};
  BuildOptions build = {};  // what may be lost; its `progress` is not used
  /// Names of the grids, one for each volume. Where there are none, one volume alone becomes build.name, and several
  /// take the stems of their file names: "head" for scans/head.nii.gz. Grids of a file keep their names.
  std::vector<std::string> names = {};
  std::vector<std::string> units = {};  // of the values, as metadata "value_unit": none, one for all, or one each
  std::vector<std::string> grids = {};  // of a file of grids only these, "name" or "name[1]"; else all scalar ones
  /// A volume of several numbers a voxel becomes one grid for each of them, which is called as the volume with the name
  /// of the component behind it. Else three numbers become a grid of vec3, and others one grid each.
  bool eachComponent = false;
  /// Each label of a volume becomes a grid of its own, which is 1 where the voxels have that label.
  std::optional<LabelChoice> labels = {};
  std::optional<IsosurfaceOptions> isosurface = {};  // writes level sets in place of the grids
  OutputOptions output = {};
  /// Reads the file back before it takes its name, and compares it with the input.
  bool verify = false;
  ConvertProgressCallback progress = {};  // may be empty
};

}  // namespace umbrick
