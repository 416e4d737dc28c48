// A kit for people who test renderers of their own: volumes as bricks, points with their values, slices and pictures,
// with the errors of all of it, in files that need neither OpenVDB nor this library.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "umbrick/check/kit_cases.h"

namespace umbrick {

struct KitOptions {
  int apron = 1;                                     // ghost voxels of the bricks, 1 to 8
  std::size_t samples = 600;                         // points of each case
  int slices = 8;                                    // of each picture, spread over the volume's depth
  unsigned seed = 1;                                 // of the points
  std::uint64_t mostBytes = std::uint64_t(4) << 30;  // of the raw bricks of a case, and of its dense voxels
  /// Called now and then with what is done and its share of the whole, in [0, 1]. The export stops when it returns
  /// false.
  std::function<bool(const std::string& step, double done)> progress;
};

struct KitSummary {
  std::size_t cases = 0, pictures = 0, samples = 0, bricks = 0;
  double largestErrorBar = 0;      // of all pictures
  std::vector<std::string> notes;  // what was left out, and why, a sentence each
  bool complete = true;            // false: the export was stopped, and nothing was written
};

/// Writes a kit into a new folder, whole or not at all: it is written beside the folder, as FOLDER.partial-PID,
/// which takes the name in the end, and goes where something fails.
///
///   README.md                    what all files mean: axes, units, matrices, the model
///   kit.json                     the names of the cases
///   cases/CASE/case.json         place, bricks, transfer function, cameras and what is asked for
///   cases/CASE/volume.raw, .vdb  the voxels, dense and sparse
///   cases/CASE/bricks.raw, .vdb, .csv   the same in bricks with aprons
///   cases/CASE/samples.csv       points, the exact value at each, and the brick that owns it
///   cases/CASE/transfer.csv      the points of the transfer function
///   cases/CASE/VIEW.exr          the reference picture; its layer errorBar says how far off each channel may be
///   cases/CASE/VIEW.slices.json  polygons in which slices cut the bricks
///   cases/CASE/VIEW.scene.json   the scene, for umbrick itself
///
/// The error bar is twice the difference between the integrals over adaptive steps and over steps of a quarter of a
/// voxel, which have no step in common, and 1e-6 for the light behind what is nearly opaque and for 32-bit floats.
/// @param cases  one or more, of different names; the bricks' edge is that of each case's first scene, or usual
/// @throw InvalidArgument  the folder holds something; a view has no scene that kitCaseOf() would take; bricks or an
///                         option out of range
/// @throw IoError          not writable
KitSummary exportKit(const std::filesystem::path& folder, const std::vector<KitCase>& cases,
                     const KitOptions& options = {});

}  // namespace umbrick
