// The options that describe a scene, shared by the sub-commands that make pictures.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "umbrick/gl/context.h"
#include "umbrick/render/volume.h"
#include "umbrick/scene/scene.h"

namespace umbrick::tools {

/// What the command line says of a scene; what it leaves out comes from the scene file or keeps its default.
struct SceneOptions {
  std::filesystem::path input;
  std::optional<std::string> grid, transfer, quality;
  std::optional<std::vector<double>> window, clipBox;
  std::vector<std::vector<double>> clipPlanes;
  std::optional<double> sigmaScale;
  std::optional<int> tableSize;
  bool orthographic = false;
  /// What was given of the table of scene fields, by the name of the option: sets the field.
  std::map<std::string, std::function<void(Scene&)>, std::less<>> fields;

  bool has(std::string_view option) const { return fields.contains(option); }
};

/// Adds the options to a sub-command.
std::shared_ptr<SceneOptions> addSceneOptions(CLI::App& command);
/// Adds --backend, for those that draw with OpenGL.
void addBackendOption(CLI::App& command, std::string& backend);
/// The context of that name.
std::unique_ptr<GlContext> createContext(const std::string& backend);

/// What stands in for a transfer function that nobody gave; none: then one must be given.
using DefaultTransfer = std::function<TransferFunction(const Scene&)>;

/// The scene of a file and the command line. @throw UsageError, IoError, InvalidArgument
Scene makeScene(const SceneOptions& options, const DefaultTransfer& defaultTransfer = {});

/// One line on stderr, if there are any.
void warnOfNonFinite(const Scene& scene, std::uint64_t voxels);

}  // namespace umbrick::tools
