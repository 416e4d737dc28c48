// Decides where a picture goes and in which form, for the sub-commands that make one.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command_line.h"
#include "umbrick/grid/scalar_grid.h"
#include "umbrick/image/display.h"
#include "umbrick/image/exr.h"
#include "umbrick/scene/annotations.h"

namespace umbrick::tools {

struct PictureOutput {
  std::vector<std::filesystem::path> files;
  std::filesystem::path stats;  // empty: none
  std::string format;           // of files whose names do not say; empty: not given
  bool force = false;           // replaces what is read-only
  std::string exrPixel, toneMap = "none";
  double exposure = 0;
  std::vector<std::string> annotate;            // names of annotations, or all
  Backdrop backdrop = Backdrop::none;           // of the PNG
  std::optional<Annotations> annotations = {};  // set once the scene is known, see prepareLook
  bool layers = false;

  Look look() const;
};

/// Adds the options to a sub-command.
/// @param exrPixel  default of --exr-pixel
/// @param layers  what --layers adds
std::shared_ptr<PictureOutput> addPictureOutput(CLI::App& command, const std::string& exrPixel,
                                                const std::string& layers);

/// Checks that no two of the files are the same, even by another path; empty ones do not count. @throw UsageError
void checkApart(const std::vector<std::filesystem::path>& files);

/// Checks that the files can be written, before the picture is made, which can take long. See prepareOutput.
/// @throw UsageError, IoError
void checkOutputs(PictureOutput& output);

/// Decides what is drawn into a PNG besides the picture, once the scene is known, and says what has no effect.
/// @param backdrop  of the scene's options, see SceneOptions
void prepareLook(PictureOutput& output, Backdrop backdrop, const ResolvedScene& scene, const VolumeUnits& units);
/// Returns what is drawn over a picture of the scene, where anything is asked for.
std::optional<Annotations> annotationsFor(const PictureOutput& output, const ResolvedScene& scene,
                                          const VolumeUnits& units);
/// Returns a picture as a PNG shows it, in linear display values, premultiplied, with all that is drawn over it.
Image shownPicture(const PictureOutput& output, const Image& colour);
/// Returns the units that a grid names.
VolumeUnits unitsOf(const ScalarGrid& grid);

/// Whether a picture is done, or is written again later. A stream gets the one that is done alone.
enum class PictureState { done, unfinished };

/// Writes the picture.
/// @param layers    of EXR files, the colour first
/// @param metadata  of EXR files; a PNG keeps the scene
/// @throw IoError
void writeOutputs(const PictureOutput& output, const std::vector<ImageLayer>& layers,
                  const std::map<std::string, std::string>& metadata, PictureState state = PictureState::done);
/// Prints the names of the files that hold the picture.
void printOutputs(const PictureOutput& output);

}  // namespace umbrick::tools
