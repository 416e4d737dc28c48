// umbrick render makes a picture of a volume.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "empty_picture.h"
#include "mode_options.h"
#include "opened_scene.h"
#include "picture_output.h"
#include "progress.h"
#include "scene_options.h"
#include "umbrick/core/error.h"
#include "umbrick/core/pending_file.h"
#include "umbrick/core/pixel_points.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/draw/progressive.h"
#include "umbrick/render/render.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/shade/prepare.h"
#include "validators.h"

namespace umbrick::tools {
namespace {

struct RenderCommand {
  std::shared_ptr<SceneOptions> scene;
  std::shared_ptr<PictureOutput> output;
  std::string backend = "auto", lightSweep = "auto";
  int frames = 1;
  bool timePasses = false;
  std::optional<int> passes;  // of a progressive picture: most samples
  std::optional<double> maxSeconds, targetError;
  std::uint64_t seed = 1;
  bool strict = false;
};

// Says which options mean nothing to what draws.
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

// The volume of a scene, cut into bricks for it.
struct LoadedScene {
  ResolvedScene scene;
  double loadMs = 0, brickMs = 0;
  std::shared_ptr<const Volume> volume;
  VolumeUnits units = {};
  std::unique_ptr<Bricks> bricks = {};
};

LoadedScene loadScene(const OpenedScene& opened, Technique technique, bool onCpu, bool refined) {
  const Volume& volume = *opened.volume;
  LoadedScene loaded{.scene = volume.resolve(opened.scene),
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

nlohmann::ordered_json printPasses(const ProgressivePicture& picture, std::uint64_t seed) {
  nlohmann::ordered_json json;
  json["passes"] = picture.passes;
  json["seconds"] = picture.seconds;
  json["seed"] = seed;
  json["standard_error"] = picture.error.statistical;
  json["systematic_error"] = picture.error.systematic;
  json["error"] = picture.error.total();
  json["reached_target"] = picture.reachedTarget;
  return json;
}

void writePicture(const PictureOutput& output, const Picture& picture, const ResolvedScene& scene,
                  const std::string& engine, const std::string& progressive = {},
                  PictureState state = PictureState::done) {
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

// What is seen of a picture while it is made, and what is left of it when the user stops it.
struct RenderWatch {
  StopRequest stop;
  ProgressBar bar{"rendering"};
  std::optional<ProgressivePicture> kept;  // the samples that are done
};

// Returns the share of a progressive picture that is done, by the number of its samples or by their time, whichever
// ends it first. An error that is asked for may end it before. @param share  of the present sample
double shareOfPasses(const RenderCommand& command, const std::optional<ProgressivePicture>& done, double share) {
  double whole = 0;
  if (command.passes) whole = ((done ? done->passes : 0) + share) / *command.passes;
  if (command.maxSeconds && done) whole = std::max(whole, done->seconds / *command.maxSeconds);
  return std::min(whole, 1.0);
}

std::string describe(const ProgressivePicture& picture) {
  const auto rounded = [](double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g", number);
    return std::string(std::isfinite(number) ? text : "not known yet");
  };
  return "passes " + std::to_string(picture.passes) + ", standard error " + rounded(picture.error.statistical) +
         ", systematic error " + rounded(picture.error.systematic) + ", together " + rounded(picture.error.total());
}

// Returns what a picture that was to reach an error could do about it, as the end of a line; may be empty.
std::string whyNotReached(const ProgressivePicture& picture, double target) {
  const bool light = occlusionMethod(picture.scene) == Method::lightVolume;
  if (!light || picture.error.systematic < target) return {};
  return ": light is known at voxels alone; windows of --method ordinates (--backend osmesa or egl) can be finer";
}

// Returns the scene that a file names: one sample of a pixel's area is each pass, unless all go through its centre.
ResolvedScene recordedScene(const ProgressivePicture& picture, const ProgressiveOptions& options) {
  ResolvedScene scene = picture.scene;
  scene.sampling.pixelSamples = options.pixelArea ? std::clamp(picture.passes, 1, kMostPixelSamples) : 1;
  return scene;
}

// Makes a renderer of the scene; once it accepts that, there will be a picture.
using MakeRenderer = std::function<std::unique_ptr<Renderer>(const RenderOptions& options)>;

// Renders samples until there are enough, or time is over, or the picture is accurate enough. The file
// gets better meanwhile.
ProgressivePicture renderPasses(const RenderCommand& command, const MakeRenderer& make, const ResolvedScene& scene,
                                const std::string& engine, RenderOptions options, RenderWatch& watch,
                                std::vector<double>& framesMs) {
  constexpr double kWriteEveryMs = 1000;
  ProgressiveOptions progressive;
  progressive.passes = command.passes.value_or(1 << 20);
  progressive.maxSeconds = command.maxSeconds.value_or(0);
  progressive.targetError = command.targetError.value_or(0);
  progressive.refine = command.targetError.has_value();
  progressive.seed = command.seed;
  const bool given = command.scene->has("samples");
  progressive.pixelArea = !(given && scene.sampling.pixelSamples == 1);
  if (given && progressive.pixelArea)
    std::cerr << "--samples " << scene.sampling.pixelSamples
              << " has no effect: each pass of a progressive picture is one sample of the area of a pixel\n";
  Stopwatch pass, written;
  int told = 0;
  bool first = true;
  options.progress = [&](double share) {
    watch.bar.show(shareOfPasses(command, watch.kept, share));
    if (watch.stop.requested()) throw Interrupted("interrupted before the first pass was done; nothing was written");
  };
  const std::unique_ptr<Renderer> renderer = make(options);
  watch.bar.begin("rendering");
  const auto renderAll = [&] {
    return renderProgressive(*renderer, progressive, [&](const ProgressivePicture& picture) {
      framesMs.push_back(pass.elapsedMs());
      watch.kept = picture;
      watch.bar.clear();
      if (first || written.elapsedMs() > kWriteEveryMs) {
        writePicture(*command.output, picture.picture, recordedScene(picture, progressive), engine,
                     printPasses(picture, command.seed).dump(), PictureState::unfinished);
        written = Stopwatch();
        first = false;
      }
      if (picture.passes < told) told = 0;
      if (picture.passes >= 2 * told) {
        std::cerr << describe(picture) << '\n';
        told = picture.passes;
      }
      pass = Stopwatch();
      return !watch.stop.requested();
    });
  };
  ProgressivePicture last = [&] {
    try {
      return renderAll();
    } catch (const Interrupted&) {
      if (!watch.kept) throw;
      return *watch.kept;
    }
  }();
  watch.bar.clear();
  if (last.passes != told) std::cerr << describe(last) << '\n';
  // Errors follow an order only where there are enough slabs to refine.
  constexpr std::int64_t kFewSlabs = 12;
  if (last.picture.stats.slices > 0 && last.picture.stats.slices < kFewSlabs)
    std::cerr << "the volume is only " << last.picture.stats.slices
              << " slabs deep: the estimated error may be several times too low or too high\n";
  if (command.targetError && !last.reachedTarget)
    std::cerr << "the error asked for, " << *command.targetError << ", is not reached"
              << whyNotReached(last, *command.targetError) << '\n';
  last.scene = recordedScene(last, progressive);
  return last;
}

int render(const RenderCommand& command) {
  checkOutputs(*command.output);
  const PictureOutput& output = *command.output;
  Scene scene = makeScene(*command.scene, {.model = Model::cone});
  const bool progressive = command.passes || command.maxSeconds || command.targetError;
  if (progressive && command.frames > 1) throw UsageError("--frames and --progressive exclude each other");
  if (progressive && !canAverage(scene))
    throw UsageError(
        "--progressive, --max-seconds and --target-error need the model emission, or cone, ambient or lights and the "
        "method ordinates or light-volume");
  // Ordinates can be refined further than light at voxels, so that a target takes them where there is OpenGL, unless
  // the user names a method.
  if (command.targetError && command.backend != "cpu" && !command.scene->has("method"))
    scene.method = Method::ordinates;
  // A draft is one of slices, but where these cannot be.
  const bool bySlices =
      command.backend != "cpu" && (scene.technique == Technique::automatic || scene.technique == Technique::slices);
  if (!bySlices && command.scene->quality && !command.scene->has("method")) scene.method = Method::lightVolume;
  RenderWatch watch;
  const std::string nothing = "interrupted; nothing was written";
  watch.bar.begin("loading " + scene.volume.file.filename().string());
  const OpenedScene opened = openScene(*command.scene, scene, showShare(watch.bar, watch.stop, nothing));
  Engine engine = chooseEngine(opened.scene, parseName(kEngineKinds, command.backend, "--backend"));
  const std::unique_ptr<GlContext, ContextCloser> context(engine.context.release());  // null: on the CPU
  tellUnused(command, engine.technique, !context);
  tellUnusedByMode(*command.scene, opened.scene, output.layers);
  LoadedScene loaded = loadScene(opened, engine.technique, !context, progressive);
  prepareLook(*command.output, command.scene->backdrop, loaded.scene, loaded.units);
  std::unique_ptr<ResidentVolume> volume;
  if (context)
    volume = std::make_unique<ResidentVolume>(*context, *loaded.bricks, atlasOptions(loaded.scene, *loaded.bricks));
  RenderOptions options;
  options.visibilityAndDepth = output.layers;
  options.countFragments = !output.stats.empty();
  options.timePasses = command.timePasses;
  options.lightSweep = parseName(kLightSweeps, command.lightSweep, "--light-sweep");
  watch.bar.clear();
  std::vector<double> framesMs;
  Picture picture;
  std::optional<ProgressivePicture> passes;
  const MakeRenderer make = [&](const RenderOptions& chosen) {
    auto renderer =
        volume ? makeRenderer(*volume, loaded.scene, chosen) : makeRenderer(*loaded.bricks, loaded.scene, chosen);
    std::cerr << opened.chosen;
    return renderer;
  };
  if (progressive) {
    watch.stop.keepParts();
    passes = renderPasses(command, make, loaded.scene, engine.description, options, watch, framesMs);
    picture = passes->picture;
    loaded.scene = passes->scene;
  } else {
    const auto show = showShare(watch.bar, watch.stop, nothing);
    // A frame is drawn once for each sample of the area of a pixel, each of which begins at 0.
    double drawn = 0, last = 0;
    options.progress = [&](double share) {
      if (share < last) ++drawn;
      last = share;
      show((drawn + share) / (command.frames * loaded.scene.sampling.pixelSamples));
    };
    const std::unique_ptr<Renderer> renderer = make(options);
    watch.bar.begin("rendering");
    for (int i = 0; i < command.frames; ++i) {
      const Stopwatch frame;
      picture = renderer->render();
      framesMs.push_back(frame.elapsedMs());
      // A picture of few slices tells nothing by itself. The last one is written, whenever the user stops.
      if (i + 1 < command.frames) show((i + 1.0) / command.frames);
    }
    watch.bar.clear();
  }
  // A format that is asked for by name may round voxels; the automatic choice does not.
  if (loaded.scene.bricks.format != "auto" && picture.stats.formatError > 0)
    std::cerr << "texels of " << loaded.scene.bricks.format << " are off by up to " << picture.stats.formatError
              << ", in units of the grid\n";
  if (picture.stats.lightSpacing == 2 && loaded.scene.occlusion.ordinates.lightSpacing == 0)
    std::cerr << "for lack of memory light is held at every second voxel alone, which changes it by about "
              << picture.stats.lightSpacingError << " of the whole (--memory-budget)\n";
  if (!picture.stats.lightNote.empty())
    std::cerr << "light is computed on the CPU: " << picture.stats.lightNote << '\n';
  const Stopwatch write;
  writePicture(output, picture, loaded.scene, engine.description,
               passes ? printPasses(*passes, command.seed).dump() : std::string());
  printOutputs(output);
  if (!output.stats.empty()) {
    auto stats = printStats(loaded, picture, framesMs, engine.description, write.elapsedMs(), command.timePasses);
    if (passes) stats["progressive"] = printPasses(*passes, command.seed);
    writeTextFile(output.stats, stats.dump(2) + "\n");
  }
  const auto empty = describeEmptyPicture(picture.colour, loaded.scene, *loaded.volume);
  if (empty) std::cerr << *empty << '\n';
  // A picture that is whole by now is written, whenever the user stops; the samples of one that is not are kept.
  const bool stopped = passes && watch.stop.requested();
  if (stopped) std::cerr << "umbrick: interrupted after " << passes->passes << " passes; the picture has these\n";
  return stopped || (command.targetError && !passes->reachedTarget) || (empty && command.strict) ? 1 : 0;
}

}  // namespace

Command addRender(CLI::App& app) {
  const auto command = std::make_shared<RenderCommand>();
  CLI::App* sub = app.add_subcommand("render", "Make a picture of a volume.");
  command->scene = addSceneOptions(*sub);
  command->output =
      addPictureOutput(*sub, "half",
                       "V (visibility weighted by opacity) and Z (mean depth, world units); of isosurfaces also value, "
                       "position and normal of the nearest one");
  addEngineOption(*sub, command->backend);
  addLightSweepOption(*sub, command->lightSweep);
  sub->add_option("--frames", command->frames, "render so many times and time each; the last is written")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str()
      ->group("Output");
  const std::string progressive = "Progressive";
  sub->add_option("--progressive", command->passes,
                  "all but dos: average so many passes, each of other directions, slices, texels and places in the "
                  "pixels (--samples 1: their centres); the picture is written again meanwhile")
      ->check(CLI::Range(1, 1 << 20))
      ->group(progressive);
  sub->add_option("--max-seconds", command->maxSeconds, "begin no pass later")
      ->check(CLI::PositiveNumber)
      ->group(progressive);
  sub->add_option(
         "--target-error", command->targetError,
         "stop when the estimated RMSE of linear RGB is no larger; the distance of samples (slabs and texels) is "
         "halved where it is in its way; with ordinates or without occlusion; exit status 1 when it is not "
         "reached")
      ->check(CLI::PositiveNumber)
      ->group(progressive);
  sub->add_option("--seed", command->seed, "of the passes")
      ->check(nonNegativeNumber())
      ->capture_default_str()
      ->group(progressive);
  sub->add_flag("--time-passes", command->timePasses, "also time each kind of pass, for --stats; slower");
  sub->get_option("--time-passes")->group("Output");
  addStrictOption(*sub, command->strict);
  return {sub, [command] { return render(*command); }};
}

}  // namespace umbrick::tools
