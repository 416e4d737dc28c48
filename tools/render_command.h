// What umbrick render is asked for, and the parts that one picture and many have in common.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "dist/ranks.h"
#include "opened_scene.h"
#include "picture_output.h"
#include "scene_options.h"
#include "umbrick/render/render.h"

namespace umbrick::tools {

/// Which pictures are made where there are several, and where they go.
struct FrameOptions {
  std::string range;         // of --frames; empty: all there are
  std::optional<int> count;  // pictures of one volume
  double orbit = 0;          // degrees that the camera goes around the volume over all frames
  double shutter = 0;        // share of the time from frame to frame in which the camera is seen to move
  bool skipMissing = false, overwrite = false;
  double fps = 25;                 // of a film
  std::optional<int> filmQuality;  // none: the usual one of the format
};

struct RenderCommand {
  Ranks* ranks = nullptr;  // share the work; outlive the command
  std::shared_ptr<SceneOptions> scene;
  std::shared_ptr<PictureOutput> output;
  FrameOptions frames;
  std::string backend = "auto", lightSweep = "auto";
  int repeat = 1;
  bool timePasses = false;
  std::optional<int> passes;  // of a progressive picture: most samples
  std::optional<double> maxSeconds, targetError;
  std::uint64_t seed = 1;
  bool strict = false;

  bool progressive() const { return passes || maxSeconds || targetError; }
};

/// Makes the scene before its volume is known. @throw UsageError, IoError, InvalidArgument  as makeScene
Scene askedScene(const RenderCommand& command);

/// Says which options mean nothing to what draws.
void tellUnused(const RenderCommand& command, Technique technique, bool onCpu);

/// The volume of a scene, cut into bricks for it.
struct LoadedScene {
  ResolvedScene scene;
  double loadMs = 0, brickMs = 0;
  std::shared_ptr<const Volume> volume = {};
  VolumeUnits units = {};
  std::shared_ptr<const Bricks> bricks = {};
};
/// @param refined  bricks are cut for a picture whose samples become finer
LoadedScene loadScene(const OpenedScene& opened, Technique technique, bool onCpu, bool refined);

RenderOptions renderOptions(const RenderCommand& command);

nlohmann::ordered_json printStats(const LoadedScene& loaded, const Picture& picture,
                                  const std::vector<double>& framesMs, const std::string& engine, double writeMs,
                                  bool timePasses);

/// @param progressive  what is known of a picture of several passes, as JSON; may be empty
void writePicture(const PictureOutput& output, const Picture& picture, const ResolvedScene& scene,
                  const std::string& engine, const std::string& progressive = {},
                  PictureState state = PictureState::done);

/// Draws the samples of a picture (--samples) together with the other ranks.
/// @param show  is called now and then with the share of the picture that is done; what it throws ends the picture
/// @return the picture that one rank would make alone, to the bit; on ranks other than the first nothing
/// @throw Interrupted  another rank was stopped
std::optional<Picture> renderTogether(Renderer& renderer, Ranks& ranks, const std::function<void(double)>& show);

/// Makes pictures of a sequence or of a camera that moves, where the command asks for several.
/// @param scene  as askedScene() makes it
/// @return the exit status; nothing where it asks for one picture
std::optional<int> renderFrames(const RenderCommand& command, const Scene& scene);
/// Adds the options of several pictures.
void addFrameOptions(CLI::App& app, FrameOptions& options);

}  // namespace umbrick::tools
