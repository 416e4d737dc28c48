// The options that describe a scene, shared by the sub-commands that make pictures.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "umbrick/brick/bricks.h"
#include "umbrick/gl/context.h"
#include "umbrick/grid/scalar_grid.h"
#include "umbrick/scene/scene.h"

namespace umbrick::tools {

/// What the command line says of a scene; what it leaves out comes from the scene file or keeps its default.
struct SceneOptions {
  std::filesystem::path input;
  std::optional<std::string> grid, transfer, model, method, quality, spacingUnit, quadrature, format;
  std::optional<std::vector<double>> window, eye, lookAt, up, ambient, background, clipBox;
  std::vector<std::vector<double>> clipPlanes;
  std::optional<double> occlusionScale, sigmaScale, azimuth, elevation, fov, viewHeight, nearDistance, spacing,
      saturation, theta;
  std::optional<std::string> size;
  std::optional<int> eyeBits, occlusionBits, tableSize, segments, footprint, passes, algorithm, directions, interior;
  std::optional<std::uint64_t> budgetMiB;
  bool orthographic = false, noPerspectiveCorrection = false, unbricked = false, noCulling = false;
};

/// Adds the options to a sub-command.
std::shared_ptr<SceneOptions> addSceneOptions(CLI::App& command);
/// Adds --backend, for those that draw with OpenGL.
void addBackendOption(CLI::App& command, std::string& backend);

/// What stands in for a transfer function that nobody gave; none: then one must be given.
using DefaultTransfer = std::function<TransferFunction(const Scene&)>;

/// The scene of a file and the command line. @throw UsageError, IoError, InvalidArgument
Scene makeScene(const SceneOptions& options, const DefaultTransfer& defaultTransfer = {});

/// A scene with its volume in memory.
struct LoadedVolume {
  Scene scene;  // resolved
  ScalarGrid grid;
  double loadMs = 0;
};
/// @throw IoError, InvalidArgument
LoadedVolume loadVolume(const Scene& scene);
/// One line on stderr, if there are any.
void warnOfNonFinite(const Scene& scene, std::uint64_t voxels);

/// Cut into bricks as well.
struct LoadedScene : LoadedVolume {
  std::unique_ptr<Bricks> bricks = {};
  double brickMs = 0;
};

/// Reads the grid and cuts it as the scene wants. @param coarserToo  with the apron of coarserScene() as well, if
/// bricks are large enough for that. @throw IoError, InvalidArgument
LoadedScene loadScene(const Scene& scene, bool coarserToo = false);
/// Cuts a grid that is in memory already as the resolved scene wants.
std::unique_ptr<Bricks> cutBricks(const ScalarGrid& grid, const Scene& resolved);

}  // namespace umbrick::tools
