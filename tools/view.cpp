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
#include "opened_scene.h"
#include "progress.h"
#include "scene_options.h"
#include "umbrick/core/error.h"
#include "umbrick/core/names.h"
#include "umbrick/scene/capabilities.h"
#include "view/server.h"

namespace umbrick::tools {
namespace {

struct ViewCommand {
  std::shared_ptr<SceneOptions> scene;
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

// Opens what a page asks for, as if it had been given on the command line without options. A header or a scene of a
// stranger cannot bring in files from elsewhere.
view::OpenedVolume openForPage(const std::filesystem::path& file, const std::function<void(double)>& progress) {
  SceneOptions options;
  options.input = file;
  options.volume.besideOnly = true;
  try {
    OpenedScene opened = openScene(options, makeScene(options, {.model = Model::cone}), progress);
    opened.scene.tracks.clear();  // the page has no frames
    return {std::move(opened.scene), std::move(opened.volume), std::move(opened.chosen)};
  } catch (const UsageError& error) {
    throw InvalidArgument(error.what());
  }
}

int run(const ViewCommand& command) {
  Scene scene = makeScene(*command.scene, {.model = Model::cone});
  StopRequest stop;
  ProgressBar bar("loading " + scene.volume.file.filename().string());
  OpenedScene opened =
      openScene(*command.scene, scene, showShare(bar, stop, "interrupted before there was anything to look at"));
  bar.clear();
  std::cerr << opened.chosen;
  opened.scene.tracks.clear();  // the page has no frames
  view::ViewGoals goals;
  goals.draftMs = 1000 / command.framesPerSecond;
  goals.targetError = command.targetError;
  view::Viewer viewer(opened.scene, opened.volume, parseName(kEngineKinds, command.backend, "--backend"), goals,
                      std::filesystem::current_path(), openForPage);
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
  addEngineOption(*sub, command->backend);
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
