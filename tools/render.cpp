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
#include "mode_options.h"
#include "opened_scene.h"
#include "picture_output.h"
#include "progress.h"
#include "render_command.h"
#include "scene_options.h"
#include "umbrick/core/error.h"
#include "umbrick/core/pending_file.h"
#include "umbrick/core/pixel_points.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/draw/progressive.h"
#include "umbrick/render/picture_notes.h"
#include "umbrick/render/render.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/shade/prepare.h"
#include "validators.h"

namespace umbrick::tools {
namespace {

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
  const Scene scene = askedScene(command);
  if (!command.ranks->isAlone())
    if (const std::optional<std::string> note = idleCoresNote()) std::cerr << *note << '\n';
  if (const std::optional<int> several = renderFrames(command, scene)) return *several;
  tellFrameShown(*command.scene, scene);
  Ranks& ranks = *command.ranks;
  if (ranks.isFirst()) checkOutputs(*command.output);
  const PictureOutput& output = *command.output;
  const bool progressive = command.progressive();
  if (progressive && command.repeat > 1) throw UsageError("--repeat and --progressive exclude each other");
  if (!ranks.isAlone() && (progressive || command.repeat > 1))
    throw UsageError(std::string(progressive ? "--progressive, --max-seconds and --target-error are" : "--repeat is") +
                     " for one process, found " + std::to_string(ranks.count()) +
                     " ranks; these share frames, and the --samples of one picture");
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
  RenderOptions options = renderOptions(command);
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
  } else if (!ranks.isAlone()) {
    const int samples = loaded.scene.sampling.pixelSamples;
    if (samples == 1)
      std::cerr << "one picture of one sample is drawn by one rank of " << ranks.count()
                << "; the --samples of a picture and the frames of a sequence are shared\n";
    const auto show = showShare(watch.bar, watch.stop, nothing);
    options.progress = [&](double share) {
      const WorkDone done = ranks.show(share);
      show((static_cast<double>(done.items) + done.shares) / samples);
    };
    const std::unique_ptr<Renderer> renderer = make(options);
    watch.bar.begin("rendering");
    const Stopwatch frame;
    std::optional<Picture> together = renderTogether(*renderer, ranks, show);
    if (!together) return 0;
    picture = std::move(*together);
    framesMs.push_back(frame.elapsedMs());
    watch.bar.clear();
  } else {
    const auto show = showShare(watch.bar, watch.stop, nothing);
    // A frame is drawn once for each sample of the area of a pixel, each of which begins at 0.
    double drawn = 0, last = 0;
    options.progress = [&](double share) {
      if (share < last) ++drawn;
      last = share;
      show((drawn + share) / (command.repeat * loaded.scene.sampling.pixelSamples));
    };
    const std::unique_ptr<Renderer> renderer = make(options);
    watch.bar.begin("rendering");
    for (int i = 0; i < command.repeat; ++i) {
      const Stopwatch frame;
      picture = renderer->render();
      framesMs.push_back(frame.elapsedMs());
      // A picture of few slices tells nothing by itself. The last one is written, whenever the user stops.
      if (i + 1 < command.repeat) show((i + 1.0) / command.repeat);
    }
    watch.bar.clear();
  }
  for (const std::string& note : notesOn(picture, loaded.scene, *command.scene)) std::cerr << note << '\n';
  const Stopwatch write;
  writePicture(output, picture, loaded.scene, engine.description,
               passes ? printPasses(*passes, command.seed).dump() : std::string());
  printOutputs(output);
  if (!output.stats.empty()) {
    auto stats = printStats(loaded, picture, framesMs, engine.description, write.elapsedMs(), command.timePasses);
    if (passes) stats["progressive"] = printPasses(*passes, command.seed);
    if (!ranks.isAlone()) stats["ranks"] = ranks.count();
    writeTextFile(output.stats, stats.dump(2) + "\n");
  }
  const auto empty = describeEmptyPicture(picture.colour, loaded.scene, *loaded.volume, *command.scene);
  if (empty) std::cerr << *empty << '\n';
  // A picture that is whole by now is written, whenever the user stops; the samples of one that is not are kept.
  const bool stopped = passes && watch.stop.requested();
  if (stopped) std::cerr << "umbrick: interrupted after " << passes->passes << " passes; the picture has these\n";
  return stopped || (command.targetError && !passes->reachedTarget) || (empty && command.strict) ? 1 : 0;
}

}  // namespace

Command addRender(CLI::App& app, Ranks& ranks) {
  const auto command = std::make_shared<RenderCommand>();
  command->ranks = &ranks;
  CLI::App* sub = app.add_subcommand("render", "Make a picture of a volume.");
  command->scene = addSceneOptions(*sub);
  command->output =
      addPictureOutput(*sub, "half",
                       "V (visibility weighted by opacity) and Z (mean depth, world units); of isosurfaces also value, "
                       "position and normal of the nearest one");
  addEngineOption(*sub, command->backend);
  addLightSweepOption(*sub, command->lightSweep);
  addFrameOptions(*sub, command->frames);
  sub->add_option("--repeat", command->repeat, "render one picture so many times and time each; the last is written")
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
