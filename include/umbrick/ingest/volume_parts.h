// Which volume of a file of several is read, and which numbers of a voxel that has several.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "umbrick/core/error.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

struct KeptStream;  // see keepStream()

struct PartChoice {
  std::optional<std::int64_t> component = {};  // only this number of each voxel, counted from 0
  bool allComponents = false;                  // all numbers of a voxel side by side: VolumeInfo::valuesPerVoxel
  bool magnitude = false;                      // the length of the vector of all components
  std::optional<std::int64_t> frame = {};      // only this volume of the file, counted from 0
  std::shared_ptr<KeptStream> kept = {};       // of frames that are opened one after the other
};

/// Returns what carries a file that is still open from one frame to the next, so that a packed file is unpacked once
/// where its frames are read in ascending order. Sources that share it must not be alive at the same time.
std::shared_ptr<KeptStream> keepStream();

/// A file has several volumes, or several numbers a voxel, and none was chosen.
struct SeveralParts : InvalidArgument {
  SeveralParts(const std::string& message, VolumeInfo info_) : InvalidArgument(message), info(std::move(info_)) {}
  VolumeInfo info;  // of the whole file
};

/// Sets what a word names: a number from 0, x, y or z of a vector, r, g, b or a of a colour, or "magnitude".
/// @throw InvalidArgument  another word
void chooseComponent(const std::string& word, PartChoice& parts);

/// "vector", "colour" or "number": what the components of a voxel are, for a message.
std::string meaningName(VoxelMeaning meaning);

/// What the components are called behind the name of a grid: r, g, b and a of colours, else 0, 1, 2, ...
std::string componentName(const VolumeInfo& info, std::int64_t component);

/// The name of a grid of all components that its file has no name for: "Cd" for colours, "v" for vectors, which are the
/// names that Houdini and others look for; "density" for single numbers.
std::string usualGridName(const VolumeInfo& info);

}  // namespace umbrick
