// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <map>
#include <string_view>

#include "command.h"
#include "option_words.h"
#include "render_command.h"
#include "umbrick/core/memory.h"
#include "umbrick/core/pixel_points.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick::tools {

Scene askedScene(const RenderCommand& command) {
  Scene scene = makeScene(*command.scene, {.model = Model::cone, .emission = true}, true);
  const AskedPicture picture{command.progressive(), command.targetError.has_value(), command.backend == "cpu"};
  asUsage([&] { fitToPicture(*command.scene, picture, scene); });
  return scene;
}

void tellUnused(const RenderCommand& command, Technique technique, bool onCpu) {
  if (onCpu && command.lightSweep != "auto")
    std::cerr << "--light-sweep has no effect on the CPU: it is of OpenGL (--backend osmesa or egl)\n";
  if (technique == Technique::slices || technique == Technique::stacks) return;
  const std::string where = onCpu ? "on the CPU: it is of slices (--backend osmesa)" : "on rays: it is of slices";
  const auto tell = [&](const std::string& option) { std::cerr << option << " has no effect " << where << '\n'; };
  for (const char* option : {"eye-bits", "texel-format"})
    if (command.scene->has(option) && (onCpu || std::string_view(option) == "eye-bits"))
      tell(command.scene->nameOf(option));
  if (command.timePasses) tell("--time-passes");
}

LoadedScene loadScene(const OpenedScene& opened, Technique technique, bool onCpu, bool refined) {
  const Volume& volume = *opened.volume;
  LoadedScene loaded{.scene = opened.seen ? volume.resolve(opened.scene, *opened.seen) : volume.resolve(opened.scene),
                     .loadMs = volume.loadMs(),
                     .volume = opened.volume,
                     .units = unitsOf(volume.grid())};
  loaded.scene.technique = technique;
  const Stopwatch brick;
  loaded.bricks = onCpu     ? volume.cutForCpu(loaded.scene)
                  : refined ? volume.cutForRefinement(loaded.scene)
                            : volume.cut(loaded.scene);
  loaded.brickMs = brick.elapsedMs();
  warnOfNonFinite(opened.scene, loaded.bricks->nonFiniteVoxels);
  return loaded;
}

RenderOptions renderOptions(const RenderCommand& command) {
  RenderOptions options;
  options.visibilityAndDepth = command.output->layers;
  options.countFragments = !command.output->stats.empty();
  options.timePasses = command.timePasses;
  options.lightSweep = parseName(kLightSweeps, command.lightSweep, "--light-sweep");
  return options;
}

nlohmann::ordered_json printStats(const LoadedScene& loaded, const Picture& picture,
                                  const std::vector<double>& framesMs, const std::string& engine, double writeMs,
                                  bool timePasses) {
  const RenderStats& stats = picture.stats;
  nlohmann::ordered_json json;
  json["renderer"] = engine;
  json["technique"] = techniqueName(loaded.scene.technique);
  json["mode"] = modeName(loaded.scene.mode);
  json["size"] = {loaded.scene.camera.width, loaded.scene.camera.height};
  json["time_ms"] = {{"load", loaded.loadMs},    {"brick", loaded.brickMs}, {"geometry", stats.geometryMs},
                     {"upload", stats.uploadMs}, {"sweep", stats.sweepMs},  {"read", stats.readMs},
                     {"write", writeMs}};
  json["frames_ms"] = framesMs;
  json["slices"] = stats.slices;
  json["spacing_world"] = loaded.scene.sampling.spacing;
  const BrickLayout& layout = loaded.bricks->layout;
  json["bricks"] = {{"all", stats.bricks},
                    {"visible", stats.visibleBricks},
                    {"uploaded", stats.uploadedBricks},
                    {"edge", {layout.edge().x, layout.edge().y, layout.edge().z}},
                    {"apron", layout.apron}};
  json["polygons"] = stats.polygons;
  json["fragments_shaded"] = stats.fragments;
  json["bytes"] = {
      {"brick_textures", stats.textureBytes}, {"buffers", stats.bufferBytes}, {"peak_memory", peakMemoryBytes()}};
  if (stats.directions > 0 && occlusionMethod(loaded.scene) == Method::lightVolume)
    json["light"] = {{"directions", stats.directions},
                     {"ms", stats.lightMs},
                     {"bytes", stats.windowBytes},
                     {"updates", stats.windowUpdates},
                     {"spacing", stats.lightSpacing},
                     {"spacing_error", stats.lightSpacingError},
                     {"swept_by", stats.lightOnGl ? "gl" : "cpu"}};
  else if (stats.directions > 0)
    json["windows"] = {{"directions", stats.directions},
                       {"texel_world", stats.windowTexel},
                       {"bytes", stats.windowBytes},
                       {"updates", stats.windowUpdates}};
  if (timePasses)
    json["passes_ms"] = {
        {"extinction", stats.passes.extinctionMs}, {"windows", stats.passes.windowsMs}, {"eye", stats.passes.eyeMs}};
  json["textures"] = stats.textures;
  json["texel_error"] = stats.formatError;
  json["non_finite_voxels"] = loaded.bricks->nonFiniteVoxels;
  json["scene"] = nlohmann::ordered_json::parse(printScene(loaded.scene));
  return json;
}

void writePicture(const PictureOutput& output, const Picture& picture, const ResolvedScene& scene,
                  const std::string& engine, const std::string& progressive, PictureState state) {
  std::vector<ImageLayer> layers{{"", picture.colour}};
  if (output.layers && !picture.depth.pixels.empty()) {
    layers.push_back({"V", picture.visibility});
    layers.push_back({"Z", picture.depth});
  }
  layers.insert(layers.end(), picture.layers.begin(), picture.layers.end());
  std::map<std::string, std::string> metadata{{"umbrick.scene", printScene(scene)},
                                              {"umbrick.renderer", engine},
                                              {"umbrick.filter", pixelFilter(scene.sampling.pixelSamples)},
                                              {"umbrick.version", UMBRICK_VERSION}};
  if (!progressive.empty()) metadata["umbrick.progressive"] = progressive;
  writeOutputs(output, layers, metadata, state);
}

}  // namespace umbrick::tools
