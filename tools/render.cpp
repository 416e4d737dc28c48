// umbrick render: a picture of a volume.
#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "command.h"
#include "scene_options.h"
#include "umbrick/atlas/brick_atlas.h"
#include "umbrick/core/error.h"
#include "umbrick/core/pending_file.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/image/exr.h"
#include "umbrick/image/png.h"
#include "umbrick/shade/slice_renderer.h"

namespace umbrick::tools {
namespace {
namespace fs = std::filesystem;

struct RenderCommand {
  std::shared_ptr<SceneOptions> scene;
  std::vector<fs::path> outputs;
  fs::path stats;
  std::string exrPixel = "half", toneMap = "none";
  double exposure = 0;
  bool layers = false;
  int frames = 1;
};

bool isExr(const fs::path& path) { return path.extension() == ".exr"; }

// A picture can take long: what cannot be written is said before it is made.
void checkOutputs(const RenderCommand& command) {
  for (const fs::path& path : command.outputs) {
    if (!isExr(path) && path.extension() != ".png")
      throw UsageError(path.string() + ": expected a picture that ends in .exr or .png");
    PendingFile probe(path);
  }
  if (!command.stats.empty()) PendingFile probe(command.stats);
}

void writeOutputs(const RenderCommand& command, const Scene& scene, const Picture& picture,
                  const std::string& renderer) {
  const std::string sceneText = printScene(scene);
  for (const fs::path& path : command.outputs) {
    if (isExr(path)) {
      std::vector<ImageLayer> layers{{"", picture.colour}};
      if (command.layers) {
        layers.push_back({"V", picture.visibility});
        layers.push_back({"Z", picture.depth});
      }
      ExrOptions options;
      options.pixel = command.exrPixel == "half" ? ExrPixel::half : ExrPixel::float32;
      options.metadata = {
          {"umbrick.scene", sceneText}, {"umbrick.renderer", renderer}, {"umbrick.version", UMBRICK_VERSION}};
      writeExr(path, layers, options);
    } else {
      PngOptions options;
      options.toneMap = command.toneMap == "reinhard" ? ToneMap::reinhard
                        : command.toneMap == "filmic" ? ToneMap::filmic
                                                      : ToneMap::none;
      options.exposure = static_cast<float>(command.exposure);
      options.metadata = {{"umbrick.scene", sceneText}};
      writePng(path, picture.colour, options);
    }
    std::cout << path.string() << '\n';
  }
}

nlohmann::ordered_json printStats(const LoadedScene& loaded, const Picture& picture,
                                  const std::vector<double>& framesMs, const GlContext& context, double writeMs) {
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
  json["textures"] = stats.textures;
  json["texel_error"] = stats.formatError;
  json["non_finite_voxels"] = loaded.bricks->nonFiniteVoxels;
  json["scene"] = nlohmann::ordered_json::parse(printScene(loaded.scene));
  return json;
}

int render(const RenderCommand& command) {
  checkOutputs(command);
  const Scene scene = makeScene(*command.scene);
  const LoadedScene loaded = loadScene(scene);
  const auto context = createGlContext(parseBackend(command.scene->backend));
  RenderOptions options;
  options.visibilityAndDepth = command.layers;
  options.countFragments = !command.stats.empty();
  SliceRenderer renderer(*context, *loaded.bricks, loaded.scene, options);
  std::vector<double> framesMs;
  Picture picture;
  for (int i = 0; i < command.frames; ++i) {
    const Stopwatch frame;
    picture = renderer.render();
    framesMs.push_back(frame.elapsedMs());
  }
  const Stopwatch write;
  writeOutputs(command, loaded.scene, picture, context->description());
  if (!command.stats.empty()) {
    const auto stats = printStats(loaded, picture, framesMs, *context, write.elapsedMs());
    writeTextFile(command.stats, stats.dump(2) + "\n");
  }
  return 0;
}

}  // namespace

Command addRender(CLI::App& app) {
  const auto command = std::make_shared<RenderCommand>();
  CLI::App* sub = app.add_subcommand("render", "Make a picture of a volume.");
  command->scene = addSceneOptions(*sub);
  const std::string output = "Output";
  sub->add_option("-o,--output", command->outputs,
                  "picture: .exr (linear, premultiplied) or .png (sRGB, alpha); may be repeated")
      ->required()
      ->type_size(1)
      ->allow_extra_args(false)
      ->group(output);
  sub->add_option("--exr-pixel", command->exrPixel, "half or float")
      ->check(CLI::IsMember({"half", "float"}))
      ->capture_default_str()
      ->group(output);
  sub->add_flag("--layers", command->layers,
                "add to the EXR: V (visibility weighted by opacity) and Z (mean depth, world units)")
      ->group(output);
  sub->add_option("--tone-map", command->toneMap, "of the PNG: none, reinhard or filmic")
      ->check(CLI::IsMember({"none", "reinhard", "filmic"}))
      ->capture_default_str()
      ->group(output);
  sub->add_option("--exposure", command->exposure, "of the PNG, stops")->capture_default_str()->group(output);
  sub->add_option("--stats", command->stats, "write times, counts and the scene as JSON")->group(output);
  sub->add_option("--frames", command->frames, "render so many times and time each; the last is written")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str()
      ->group(output);
  return {sub, [command] { return render(*command); }};
}

}  // namespace umbrick::tools
