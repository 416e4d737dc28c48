// umbrick render: a picture of a volume.
#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "command.h"
#include "picture_output.h"
#include "scene_options.h"
#include "umbrick/atlas/brick_atlas.h"
#include "umbrick/core/error.h"
#include "umbrick/core/pending_file.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/shade/slice_renderer.h"

namespace umbrick::tools {
namespace {

struct RenderCommand {
  std::shared_ptr<SceneOptions> scene;
  std::shared_ptr<PictureOutput> output;
  std::string backend = "auto";
  int frames = 1;
  bool timePasses = false;
};

nlohmann::ordered_json printStats(const LoadedScene& loaded, const Picture& picture,
                                  const std::vector<double>& framesMs, const GlContext& context, double writeMs,
                                  bool timePasses) {
  const RenderStats& stats = picture.stats;
  nlohmann::ordered_json json;
  json["renderer"] = context.description();
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
  if (stats.directions > 0)
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

int render(const RenderCommand& command) {
  const PictureOutput& output = *command.output;
  checkOutputs(output);
  const Scene scene = makeScene(*command.scene);
  const LoadedScene loaded = loadScene(scene);
  const auto context = createGlContext(parseBackend(command.backend));
  RenderOptions options;
  options.visibilityAndDepth = output.layers;
  options.countFragments = !output.stats.empty();
  options.timePasses = command.timePasses;
  SliceRenderer renderer(*context, *loaded.bricks, loaded.scene, options);
  std::vector<double> framesMs;
  Picture picture;
  for (int i = 0; i < command.frames; ++i) {
    const Stopwatch frame;
    picture = renderer.render();
    framesMs.push_back(frame.elapsedMs());
  }
  const Stopwatch write;
  std::vector<ImageLayer> layers{{"", picture.colour}};
  if (output.layers) {
    layers.push_back({"V", picture.visibility});
    layers.push_back({"Z", picture.depth});
  }
  writeOutputs(output, std::move(layers),
               {{"umbrick.scene", printScene(loaded.scene)},
                {"umbrick.renderer", context->description()},
                {"umbrick.version", UMBRICK_VERSION}});
  if (!output.stats.empty()) {
    const auto stats = printStats(loaded, picture, framesMs, *context, write.elapsedMs(), command.timePasses);
    writeTextFile(output.stats, stats.dump(2) + "\n");
  }
  return 0;
}

}  // namespace

Command addRender(CLI::App& app) {
  const auto command = std::make_shared<RenderCommand>();
  CLI::App* sub = app.add_subcommand("render", "Make a picture of a volume.");
  command->scene = addSceneOptions(*sub);
  command->output =
      addPictureOutput(*sub, "half", "V (visibility weighted by opacity) and Z (mean depth, world units)");
  addBackendOption(*sub, command->backend);
  sub->add_option("--frames", command->frames, "render so many times and time each; the last is written")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str()
      ->group("Output");
  sub->add_flag("--time-passes", command->timePasses, "also time each kind of pass, for --stats; slower");
  sub->get_option("--time-passes")->group("Output");
  return {sub, [command] { return render(*command); }};
}

}  // namespace umbrick::tools
