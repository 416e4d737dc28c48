// umbrick view shows a volume in a browser and lets people steer it.
// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <utility>

#include "command.h"
#include "frame_job.h"
#include "frame_samples.h"
#include "frame_words.h"
#include "opened_scene.h"
#include "progress.h"
#include "scene_options.h"
#include "umbrick/core/error.h"
#include "umbrick/core/names.h"
#include "umbrick/core/printable.h"
#include "umbrick/scene/capabilities.h"
#include "view/server.h"

namespace umbrick::tools {
namespace {

struct ViewCommand {
  std::shared_ptr<SceneOptions> scene;
  FrameOptions frames;
  std::string backend = "auto";
  view::ServerOptions server;
  double framesPerSecond = 10, targetError = 0.004;
  bool noBrowser = false;
};

// Opens a browser, where the desktop has a way to do so. The address holds digits, letters and what addresses have, so
// that a shell finds nothing in it.
void openBrowser(const std::string& address) {
  const bool desktop = std::getenv("DISPLAY") || std::getenv("WAYLAND_DISPLAY");
  if (!desktop) return;
  const std::string command = "command -v xdg-open >/dev/null 2>&1 && xdg-open '" + address + "' >/dev/null 2>&1 &";
  if (std::system(command.c_str()) != 0) std::cerr << "no browser was opened\n";
}

// The frames of a sequence as the viewer shows them.
std::shared_ptr<const view::ViewSequence> sequenceOf(const FrameJob& job, const VolumeReference& volume,
                                                     const OpenedScene& opened) {
  if (job.frames.size() < 2) return nullptr;
  auto sequence = std::make_shared<view::ViewSequence>();
  for (const FrameJob::Frame& frame : job.frames) {
    sequence->frames.push_back({frame.number, frame.volume});
    VolumeReference& own = sequence->frames.back().volume;
    if (own.grid.empty()) own.grid = opened.scene.volume.grid;
  }
  sequence->step = job.step;
  sequence->whole = volume;
  sequence->inside = job.frames[0].volume.file == job.frames[1].volume.file;
  if (!sequence->inside && volume.grid.empty()) sequence->whole.grid = opened.scene.volume.grid;
  sequence->seen = opened.seen;
  sequence->first = opened.frame;
  sequence->check = [kind = kindOf(*opened.volume)](const Volume& frame) { requireAlike(frame, kind); };
  return sequence;
}

// Opens a volume, or all frames of a sequence, of which the first one that holds something is shown first.
view::OpenedVolume openAll(const SceneOptions& options, const FrameOptions& frames,
                           const std::function<void(double)>& progress) {
  const Scene scene = makeScene(options, {.model = Model::cone, .emission = true});
  refuseSeveralNumbers(scene.volume.file);
  const std::optional<FrameJob> job = findSequence(scene.volume, options.volume.frame.has_value(), frames);
  if (!job && !frames.range.empty())
    throw UsageError("--frames: is for sequences, as 'smoke_%04d.vdb' or a file of several volumes, found " +
                     scene.volume.file.string());
  OpenedScene opened = job ? openFrames(options, *job, scene, progress) : openScene(options, scene, progress);
  view::OpenedVolume all;
  all.chosen = std::move(opened.chosen);
  if (job) {
    std::string notes;
    for (const std::string& note : job->notes) notes += printable(note) + '\n';
    all.chosen = notes + all.chosen;
    all.sequence = sequenceOf(*job, scene.volume, opened);
  }
  opened.scene.tracks.clear();  // frames of a page are volumes alone
  all.scene = std::move(opened.scene);
  all.volume = std::move(opened.volume);
  return all;
}

// Opens what a page asks for, as if it had been given on the command line without options. A header or a scene of a
// stranger cannot bring in files from elsewhere.
view::OpenedVolume openForPage(const std::filesystem::path& file, const std::function<void(double)>& progress) {
  SceneOptions options;
  options.take(file);
  options.volume.besideOnly = true;
  FrameOptions frames;
  frames.skipMissing = true;
  try {
    return openAll(options, frames, progress);
  } catch (const UsageError& error) {
    throw InvalidArgument(error.what());
  }
}

int run(const ViewCommand& command) {
  StopRequest stop;
  ProgressBar bar("loading " + command.scene->input.filename().string());
  view::OpenedVolume opened =
      openAll(*command.scene, command.frames, showShare(bar, stop, "interrupted before there was anything to look at"));
  bar.clear();
  std::cerr << opened.chosen;
  view::ViewGoals goals;
  goals.draftMs = 1000 / command.framesPerSecond;
  goals.targetError = command.targetError;
  view::Viewer viewer(std::move(opened.scene), std::move(opened.volume),
                      parseName(kEngineKinds, command.backend, "--backend"), goals, std::filesystem::current_path(),
                      openForPage, std::move(opened.sequence));
  view::ViewServer server(viewer, command.server);
  const std::string port = std::to_string(server.port());
  if (command.server.host == "127.0.0.1" || command.server.host == "::1")
    std::cerr << "from another machine: ssh -L " << port << ":localhost:" << port << " "
              << "HOST\n";
  else
    std::cerr << "warning: " << command.server.host
              << " may be open to other machines; the address is the password, and "
              << "nothing is encrypted\n";
  std::cerr << "pictures and scenes are saved in, and files opened from, " << std::filesystem::current_path().string()
            << "; Ctrl-C ends\n";
  std::cout << server.address() << std::endl;
  if (!command.noBrowser) openBrowser(server.address());
  server.run([&] { return stop.requested(); });
  leaveIfStopped(0);
  return 0;
}

}  // namespace

Command addView(CLI::App& app) {
  const auto command = std::make_shared<ViewCommand>();
  CLI::App* sub = app.add_subcommand(
      "view",
      "Look at a volume in a browser: turn it, edit its transfer function, light and cuts. Prints the address.");
  command->scene = addSceneOptions(*sub);
  sub->get_option("input")->description(
      "a volume of any format that convert reads, a .vdb or .nvdb, numbered files ('frame_%04d.nrrd') or one file of "
      "several volumes, whose frames are played, or a .json scene");
  addEngineOption(*sub, command->backend);
  const std::string frames = "Frames";
  sub->add_option("--frames", command->frames.range,
                  "of a sequence, which is numbered files ('smoke_%04d.vdb') or one file of several volumes, counted "
                  "from 0: A, A-B or A-B:step [all there are]")
      ->group(frames);
  sub->add_flag("--skip-missing", command->frames.skipMissing,
                "go on where frames are missing, or those that the look of all is decided by are damaged")
      ->group(frames);
  const std::string group = "Server";
  sub->add_option("--port", command->server.port, "of HTTP; 0: any that is free")->capture_default_str()->group(group);
  sub->add_option("--host", command->server.host,
                  "the address that it listens on; anything but this machine's own lets others in who know the token")
      ->capture_default_str()
      ->group(group);
  sub->add_flag("--no-browser", command->noBrowser, "open no browser")->group(group);
  const std::string speed = "Speed";
  sub->add_option("--target-fps", command->framesPerSecond, "drafts a second while something moves")
      ->check(CLI::Range(1.0, 120.0))
      ->capture_default_str()
      ->group(speed);
  sub->add_option("--target-error", command->targetError,
                  "samples end when the estimated RMSE of linear RGB is no larger, or is not theirs")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group(speed);
  return {sub, [command] { return run(*command); }};
}

}  // namespace umbrick::tools
