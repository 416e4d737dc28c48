// The options that describe a scene, for all sub-commands that make pictures.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "command_line.h"
#include "umbrick/gl/context.h"
#include "umbrick/image/display.h"
#include "umbrick/render/asked_scene.h"
#include "umbrick/scene/scene.h"
#include "volume_options.h"

namespace umbrick::tools {

/// Other names of options of the table of scene fields, for a sub-command: {"samples", "pixel-samples"}.
using OptionNames = std::map<std::string, std::string, std::less<>>;

/// Holds what the command line says of a scene. The rest comes from the scene file, follows from the volume or keeps
/// its default.
struct SceneOptions : AskedScene {
  std::filesystem::path input;
  VolumeOptions volume;
  std::optional<int> tableSize;
  Backdrop backdrop = Backdrop::none;  // --background gradient, which a PNG has in place of the scene's background
  /// What options of the table of scene fields are called where their own name means something else, see
  /// addSceneOptions.
  OptionNames renamed;

  /// Takes the input: a volume, or a scene, which is whole.
  void take(const std::filesystem::path& file);
  /// Returns the option on the command line for an option of the table: "--theta" for "theta".
  std::string nameOf(std::string_view option) const override;
};

/// Adds the options to a sub-command. @param renamed  options of the table that get another name there
std::shared_ptr<SceneOptions> addSceneOptions(CLI::App& command, const OptionNames& renamed = {});
/// Adds --strict, for sub-commands that make one picture.
void addStrictOption(CLI::App& command, bool& strict);
/// Writes the name of a background three times: an option has a fixed number of values, and a background has three
/// numbers. @param arguments  of the command line
std::vector<std::string> spellOutBackground(std::vector<std::string> arguments);
/// Adds --backend, for sub-commands that draw with OpenGL alone.
void addBackendOption(CLI::App& command, std::string& backend);
/// Adds --backend, for sub-commands that draw on the CPU, too.
void addEngineOption(CLI::App& command, std::string& engine);
/// Adds --light-sweep; the text is one of kLightSweeps.
void addLightSweepOption(CLI::App& command, std::string& sweep);
/// Closes a context, unless the program leaves anyway (leaveIfStopped).
struct ContextCloser {
  void operator()(GlContext* context) const;
};
/// Makes the context of that name.
std::unique_ptr<GlContext, ContextCloser> createContext(const std::string& backend);

/// Says that a scene whose fields have keys is shown as it is at frame 0, if it is such a scene.
void tellFrameShown(const SceneOptions& options, const Scene& scene);

/// Makes a scene from a file and the command line, before its volume is known: what is wrong is said before anything is
/// loaded. Without a transfer function, none is set. @throw UsageError, IoError, InvalidArgument
/// @param frames  the command draws what changes over frames; else frame 0 is shown, and said to be
Scene makeScene(const SceneOptions& options, const SceneDefaults& defaults = {}, bool frames = false);

/// Refuses a backdrop, for sub-commands that write no PNG. @throw UsageError
void refuseBackdrop(const SceneOptions& options);

/// Prints one line to stderr, if there are such voxels.
void warnOfNonFinite(const Scene& scene, std::uint64_t voxels);

}  // namespace umbrick::tools
