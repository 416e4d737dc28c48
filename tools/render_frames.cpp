// umbrick render of many pictures: a sequence of volumes, or a camera that moves around one.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <chrono>
#include <iostream>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <utility>

#include "command.h"
#include "film.h"
#include "frame_job.h"
#include "frame_outcome.h"
#include "frame_samples.h"
#include "frame_scenes.h"
#include "frame_words.h"
#include "mode_options.h"
#include "progress.h"
#include "render_command.h"
#include "umbrick/core/pending_file.h"
#include "umbrick/core/pixel_points.h"
#include "umbrick/core/printable.h"
#include "umbrick/core/short_number.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/draw/blank_picture.h"
#include "umbrick/image/exr.h"
#include "umbrick/render/picture_notes.h"
#include "umbrick/render/volume_frames.h"
#include "umbrick/shade/prepare.h"
#include "validators.h"

namespace umbrick::tools {
namespace {

// While it lives, a signal is noticed within the time that a job has to do so, however long one picture takes.
class StopWatcher {
 public:
  explicit StopWatcher(const StopRequest& stop)
      : thread_([&stop](const std::stop_token& end) {
          while (!end.stop_requested() && !stop.requested()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }) {}

 private:
  std::jthread thread_;
};

// Draws the frames of a job, writes them and says what has become of each.
class FrameRun {
 public:
  FrameRun(const RenderCommand& command, FrameJob job, const Scene& scene);
  int run();

 private:
  void open(const Scene& scene);
  Picture taken(const FrameJob::Frame& frame);
  FrameOutcome drawOne(const FrameJob::Frame& frame, VolumeFrame read);
  void makeRenderer();
  std::unique_ptr<Bricks> cut(const Volume& volume, const FrameJob::Frame& frame);
  std::unique_ptr<Bricks> cut(const Volume& volume, const ResolvedScene& scene) const;
  FrameOutcome write(const FrameJob::Frame& frame, const Picture& picture, double drawMs, bool holdsSomething);
  FrameOutcome skip(const FrameJob::Frame& frame, const std::string& why);
  bool drawAll(const std::vector<const FrameJob::Frame*>& left);
  void hand(std::size_t item, const FrameOutcome& outcome, const std::vector<const FrameJob::Frame*>& left);
  void collect(const std::vector<const FrameJob::Frame*>& left);
  void keep(const FrameJob::Frame& frame, const FrameOutcome& outcome);
  void say(const std::string& line);
  void show(double share);
  void tellStopping();
  void tellInterrupted() const;
  void tellOtherScene() const;

  const RenderCommand& command_;
  Ranks& ranks_;
  FrameJob job_;
  StopRequest stop_;
  ProgressBar bar_{"rendering"};
  OpenedScene opened_;
  Engine engine_;
  std::unique_ptr<GlContext, ContextCloser> context_;  // null: on the CPU
  std::optional<LoadedScene> shown_;                   // the frame at hand
  std::optional<FrameScenes> scenes_;
  FrameKind kind_;  // of the frames
  std::unique_ptr<ResidentVolume> resident_;
  std::unique_ptr<Renderer> renderer_;
  std::vector<std::unique_ptr<Film>> films_;
  nlohmann::ordered_json stats_ = nlohmann::ordered_json::array();
  std::set<std::string> said_;
  std::vector<std::int64_t> written_;
  std::size_t wanted_ = 0, done_ = 0;
  double drawn_ = 0, lastShare_ = 0;  // samples of the picture at hand
  Stopwatch work_;
  bool chosenSaid_ = false, strictFailed_ = false;
  std::optional<Stopwatch> stopping_;  // since the user wants the job to stop, where ranks share it
  bool stopTold_ = false;
  std::string beyond_;  // the first frame that shows more than the camera was placed for, once it is known
  std::atomic<bool> beyondKnown_ = false;
};

FrameRun::FrameRun(const RenderCommand& command, FrameJob job, const Scene& scene)
    : command_(command), ranks_(*command.ranks), job_(std::move(job)), chosenSaid_(!ranks_.isFirst()) {
  wanted_ = static_cast<std::size_t>(
      std::count_if(job_.frames.begin(), job_.frames.end(), [](const auto& frame) { return !frame.finished; }));
  if (wanted_ > 0) open(scene);
}

void FrameRun::open(const Scene& scene) {
  bar_.begin("loading " + scene.volume.file.filename().string());
  opened_ = openFrames(*command_.scene, job_, scene, showShare(bar_, stop_, "interrupted; nothing was written"));
  engine_ = chooseEngine(opened_.scene, parseName(kEngineKinds, command_.backend, "--backend"));
  context_.reset(engine_.context.release());
  bar_.clear();
  tellUnused(command_, engine_.technique, !context_);
  tellUnusedByMode(*command_.scene, opened_.scene, command_.output->layers);
  scenes_.emplace(opened_, job_, engine_.technique, command_.frames.orbit);
  shown_ = job_.oneVolume ? loadScene(opened_, engine_.technique, !context_, false)
                          : LoadedScene{.scene = scenes_->at(job_.frames.front(), opened_.volume.get()),
                                        .units = unitsOf(opened_.volume->grid())};
  prepareLook(*command_.output, command_.scene->backdrop, shown_->scene, shown_->units);
  for (const std::filesystem::path& film : job_.films) {
    if (!ranks_.isFirst()) break;
    const Camera& camera = shown_->scene.camera;
    if (camera.width % 2 != 0 || camera.height % 2 != 0)
      std::cerr << film.string() << ": the film is " << camera.width / 2 * 2 << " x " << camera.height / 2 * 2
                << " pixels, since films have even numbers of them\n";
    films_.push_back(std::make_unique<Film>(film, camera.width, camera.height,
                                            FilmOptions{command_.frames.fps, command_.frames.filmQuality}));
  }
  tellOtherScene();
  if (job_.oneVolume) return;
  // The reader brings the first frame again: no volume is kept besides the two that are read and drawn.
  kind_ = kindOf(*opened_.volume);
  opened_.volume.reset();
  for (FrameJob::Frame& frame : job_.frames)
    if (frame.volume.grid.empty()) frame.volume.grid = opened_.scene.volume.grid;
}

// Says where the frames that are there were drawn otherwise than the others will be: the header of an EXR tells.
void FrameRun::tellOtherScene() const {
  const auto there = std::ranges::find_if(job_.frames, &FrameJob::Frame::finished);
  if (there == job_.frames.end()) return;
  const auto file = std::ranges::find_if(there->pictures, [](const auto& path) { return path.extension() == ".exr"; });
  if (file == there->pictures.end()) return;
  const auto known = [](const std::string& scene) {
    nlohmann::json json = nlohmann::json::parse(scene, nullptr, false);
    for (const char* ofTheFrame : {"volume", "bricks"})
      if (json.is_object()) json.erase(ofTheFrame);
    return json;
  };
  std::string what;
  try {
    const ExrFile picture = readExr(*file);
    const auto scene = picture.metadata.find("umbrick.scene");
    const nlohmann::json drawn = known(scene == picture.metadata.end() ? std::string() : scene->second);
    const nlohmann::json change =
        nlohmann::json::diff(drawn, known(printScene(scenes_->at(*there, opened_.volume.get()))));
    if (change.empty()) return;
    what = "was drawn of another scene (" + change.at(0).at("path").get<std::string>() + ")";
  } catch (const IoError&) {
    what = "is no picture that can be read";
  }
  std::cerr << printable(file->string()) << ": " << what << " and stays; --overwrite draws all again\n";
}

std::unique_ptr<Bricks> FrameRun::cut(const Volume& volume, const ResolvedScene& scene) const {
  return context_ ? volume.cut(scene) : volume.cutForCpu(scene);
}

std::unique_ptr<Bricks> FrameRun::cut(const Volume& volume, const FrameJob::Frame& frame) {
  requireAlike(volume, kind_);
  if (!beyondKnown_ && scenes_->leavesView(volume)) {
    beyond_ = volume.name();
    beyondKnown_ = true;
  }
  return cut(volume, scenes_->at(frame, &volume));
}

void FrameRun::say(const std::string& line) {
  if (!said_.insert(line).second) return;
  bar_.clear();
  std::cerr << printable(line) << '\n';
}

void FrameRun::show(double share) {
  const double seconds = work_.elapsedMs() / 1000;
  WorkDone done{done_, share};
  if (!ranks_.isAlone()) {
    done = ranks_.show(share);
    tellStopping();
  }
  std::string step = std::to_string(done.items) + " of " + std::to_string(wanted_) + " frames";
  if (done.items > 0) step += ", " + shortNumber(seconds / static_cast<double>(done.items), 3) + " s each";
  if (!ranks_.isAlone()) step += ", " + std::to_string(ranks_.count()) + " ranks";
  bar_.show((static_cast<double>(done.items) + done.shares) / static_cast<double>(wanted_), step);
}

// mpirun ends its ranks a second after it has asked them to stop, unless it is told to wait longer: what there is to
// say is said before that.
void FrameRun::tellStopping() {
  constexpr double kLatestMs = 500;
  if (!ranks_.isFirst() || !stop_.requested()) return;
  if (!stopping_) stopping_.emplace();
  if (stopping_->elapsedMs() < kLatestMs || std::exchange(stopTold_, true)) return;
  bar_.clear();
  std::cerr << "umbrick: interrupted after " << done_ << " of " << wanted_
            << " frames; those at hand are finished as far as mpirun waits for them, and the same command goes on\n";
}

void FrameRun::makeRenderer() {
  RenderOptions options = renderOptions(command_);
  // A frame is drawn once for each sample of the area of a pixel, each of which begins at 0.
  options.progress = [this](double share) {
    if (share < lastShare_) ++drawn_;
    lastShare_ = share;
    show((drawn_ + share) / shown_->scene.sampling.pixelSamples);
  };
  renderer_.reset();
  resident_.reset();
  if (context_)
    resident_ =
        std::make_unique<ResidentVolume>(*context_, *shown_->bricks, atlasOptions(shown_->scene, *shown_->bricks));
  renderer_ = resident_ ? umbrick::makeRenderer(*resident_, shown_->scene, options)
                        : umbrick::makeRenderer(*shown_->bricks, shown_->scene, options);
  if (!std::exchange(chosenSaid_, true)) {
    bar_.clear();
    std::cerr << opened_.chosen;
  }
}

Picture FrameRun::taken(const FrameJob::Frame& frame) {
  if (command_.frames.shutter == 0) return renderer_->render();
  const std::vector<double> times = pixelTimes(shown_->scene.sampling.pixelSamples);
  return renderer_->render({}, [&](std::size_t i) {
    renderer_->setCamera(scenes_->cameraAt(frame, *shown_->volume, times[i] * command_.frames.shutter));
  });
}

FrameOutcome FrameRun::drawOne(const FrameJob::Frame& frame, VolumeFrame read) {
  const Stopwatch draw;
  if (!job_.oneVolume) {
    // A renderer points to the bricks, and these to their volume.
    renderer_.reset();
    resident_.reset();
    shown_->bricks = std::move(read.bricks);
    shown_->volume = std::move(read.volume);
    shown_->brickMs = read.brickMs;
    shown_->loadMs = shown_->volume ? shown_->volume->loadMs() : 0;
  }
  shown_->scene = scenes_->at(frame, shown_->volume.get());
  drawn_ = lastShare_ = 0;
  if (!shown_->bricks) {
    say(frame.volume.file.string() + ": frame " + std::to_string(frame.number) + " holds nothing and is drawn empty");
    return write(frame, blankPicture(shown_->scene, command_.output->layers), draw.elapsedMs(), false);
  }
  // What bricks must have may change with the scene's keys.
  if (renderer_ && scenes_->haveKeys() &&
      (shown_->bricks->hasGradients < shown_->scene.transfer.is2d() || !renderer_->sampling(shown_->scene))) {
    renderer_.reset();
    resident_.reset();
    shown_->bricks = cut(*shown_->volume, shown_->scene);
  }
  if (!renderer_)
    makeRenderer();
  else
    renderer_->setScene(shown_->scene);
  const Picture picture = taken(frame);
  for (const std::string& note : notesOn(picture, shown_->scene, *command_.scene)) say(note);
  if (!job_.oneVolume && shown_->bricks->nonFiniteVoxels > 0) {
    bar_.clear();
    Scene named = opened_.scene;
    named.volume = frame.volume;
    warnOfNonFinite(named, shown_->bricks->nonFiniteVoxels);
  }
  FrameOutcome outcome = write(frame, picture, draw.elapsedMs(), true);
  outcome.shows =
      !command_.strict || !describeEmptyPicture(picture.colour, shown_->scene, *shown_->volume, *command_.scene);
  return outcome;
}

FrameOutcome FrameRun::write(const FrameJob::Frame& frame, const Picture& picture, double drawMs, bool holdsSomething) {
  const Stopwatch writing;
  PictureOutput output = *command_.output;
  output.files = frame.pictures;
  if (output.annotations) output.annotations = annotationsFor(output, shown_->scene, shown_->units);
  bar_.clear();
  writePicture(output, picture, shown_->scene, engine_.description);
  FrameOutcome outcome{.drawn = true};
  if (!job_.films.empty()) outcome.film = filmPixels(shownPicture(output, picture.colour));
  if (!frame.stats.empty() || !job_.stats.empty()) {
    nlohmann::ordered_json stats{{"frame", frame.number}};
    if (holdsSomething)
      stats.update(
          printStats(*shown_, picture, {drawMs}, engine_.description, writing.elapsedMs(), command_.timePasses));
    else
      stats["empty"] = true;
    if (!frame.stats.empty()) writeTextFile(frame.stats, stats.dump(2) + "\n");
    if (!job_.stats.empty()) outcome.stats = std::move(stats);
  }
  return outcome;
}

// Goes on without a frame, or ends the job.
FrameOutcome FrameRun::skip(const FrameJob::Frame& frame, const std::string& why) {
  const std::string line = "frame " + std::to_string(frame.number) + ": " + why;
  if (!command_.frames.skipMissing) throw Error(line + "; --skip-missing goes on without it");
  say(line + "; left out");
  return {};
}

// Does what is left to do with a frame. It is called in the order of frames, by the first rank alone.
void FrameRun::keep(const FrameJob::Frame& frame, const FrameOutcome& outcome) {
  ++done_;
  if (!outcome.beyond.empty() && said_.insert("beyond").second) {
    bar_.clear();
    std::cerr << printable(outcome.beyond)
              << ": shows something outside of the box that the camera was placed for by the first, the middle and the "
                 "last frame; --zoom or --eye shows more\n";
  }
  if (!outcome.drawn) return;
  for (const std::unique_ptr<Film>& film : films_) film->add(outcome.film);
  PictureOutput output = *command_.output;
  output.files = frame.pictures;
  bar_.clear();
  printOutputs(output);
  std::cout.flush();
  if (!outcome.stats.is_null()) stats_.push_back(outcome.stats);
  if (!outcome.shows) strictFailed_ = true;
  written_.push_back(frame.number);
}

void FrameRun::hand(std::size_t item, const FrameOutcome& outcome, const std::vector<const FrameJob::Frame*>& left) {
  if (ranks_.isAlone()) return keep(*left[item], outcome);
  ranks_.put(item, bytesOf(outcome));
  collect(left);
}

void FrameRun::collect(const std::vector<const FrameJob::Frame*>& left) {
  while (const std::optional<ItemResult> result = ranks_.collect()) {
    std::istringstream said(result->said);
    for (std::string line; std::getline(said, line);) say(line);
    keep(*left[result->item], outcomeOf(result->bytes));
  }
}

void FrameRun::tellInterrupted() const {
  if (stopTold_) return;
  std::vector<std::int64_t> there = written_;
  for (const FrameJob::Frame& frame : job_.frames)
    if (frame.finished) there.push_back(frame.number);
  std::sort(there.begin(), there.end());
  const bool pictures = !job_.frames.front().pictures.empty();
  std::cerr << "umbrick: interrupted after " << there.size() << " of " << job_.frames.size() << " frames";
  if (pictures && !there.empty())
    std::cerr << "; these are there: " << rangesText(rangesOf(there, job_.step)) << ", and the same command goes on";
  for (const std::filesystem::path& film : job_.films) std::cerr << "; " << film.string() << " is not written";
  std::cerr << '\n';
}

// Draws frames as long as there are any, and takes turns with other ranks. @return whether the user has stopped it
bool FrameRun::drawAll(const std::vector<const FrameJob::Frame*>& left) {
  // Results that wait for their turn are kept in memory, those for films as pictures.
  ranks_.begin(left.size(), 4 * static_cast<std::size_t>(ranks_.count()));
  const auto stopAll = [this] {
    if (stop_.requested()) ranks_.stop();
  };
  const auto pick = [&](bool ahead) {
    return ranks_.take(ahead ? Ranks::When::ahead : Ranks::When::now, [&] {
      stopAll();
      collect(left);
      show(0);
    });
  };
  std::optional<VolumeFrames> reader;
  if (!job_.oneVolume) {
    std::vector<VolumeReference> files;
    for (const FrameJob::Frame* frame : left) files.push_back(frame->volume);
    reader.emplace(
        std::move(files), [&](const Volume& volume, std::size_t index) { return cut(volume, *left[index]); }, pick);
  }
  const auto drawNext = [&](const FrameJob::Frame& frame) {
    VolumeFrame read;
    if (reader) {
      // What was drawn last is let go of, so that no more than two frames are in memory.
      renderer_.reset();
      resident_.reset();
      shown_->bricks.reset();
      shown_->volume.reset();
      try {
        read = reader->next([this] {
          if (stop_.requested()) throw Interrupted("");
          show(0);
        });
      } catch (const Interrupted&) {
        throw;
      } catch (const Error& error) {
        return skip(frame, error.what());
      }
    }
    return drawOne(frame, std::move(read));
  };
  bool stopped = false;
  try {
    while (!stopped) {
      const std::optional<std::size_t> item = reader ? reader->upcoming() : pick(false);
      if (!item) break;
      FrameOutcome outcome = drawNext(*left[*item]);
      if (beyondKnown_) outcome.beyond = beyond_;
      hand(*item, outcome, left);
      stopped = stop_.requested();
    }
  } catch (const Interrupted&) {
    stopped = true;
  }
  stopAll();
  ranks_.rest();
  while (!ranks_.allRest()) {
    stopAll();
    collect(left);
    show(0);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  collect(left);
  return (stopped || ranks_.stopped()) && done_ < wanted_;
}

int FrameRun::run() {
  if (wanted_ == 0) return 0;
  stop_.keepParts();
  const StopWatcher watcher(stop_);
  std::vector<const FrameJob::Frame*> left;
  for (const FrameJob::Frame& frame : job_.frames)
    if (!frame.finished) left.push_back(&frame);
  bar_.begin("rendering");
  work_ = Stopwatch();
  const bool stopped = drawAll(left);
  bar_.clear();
  if (!ranks_.isFirst()) return 0;
  if (!job_.stats.empty()) writeTextFile(job_.stats, stats_.dump(2) + "\n");
  if (stopped) {
    tellInterrupted();
    return 1;
  }
  for (const std::unique_ptr<Film>& film : films_) {
    film->finish();
    std::cout << printable(film->path().string()) << '\n';
  }
  return strictFailed_ ? 1 : 0;
}

// Lets all ranks have the frames of the first one, also where some of them are finished before all ranks have looked.
void agreeOnFrames(Ranks& ranks, FrameJob& job) {
  std::string own, finished;
  for (const FrameJob::Frame& frame : job.frames) {
    own += std::to_string(frame.number) + ' ';
    finished += frame.finished ? '1' : '0';
  }
  const std::string agreed = ranks.agree(finished + own);
  if (agreed.substr(std::min(agreed.size(), job.frames.size())) != own)
    throw Error("finds other frames here than the first rank does");
  for (std::size_t i = 0; i < job.frames.size(); ++i) job.frames[i].finished = agreed[i] == '1';
}

}  // namespace

std::optional<int> renderFrames(const RenderCommand& command, const Scene& scene) {
  std::optional<FrameJob> job = findFrameJob(command, scene);
  if (!job) return {};
  agreeOnFrames(*command.ranks, *job);
  return FrameRun(command, std::move(*job), scene).run();
}

void addFrameOptions(CLI::App& app, FrameOptions& options) {
  const std::string group = "Frames";
  app.add_option("--frames", options.range,
                 "of a sequence, where input and output have a number in their names ('smoke_%04d.vdb', out_%04d.png), "
                 "or the input is one file of several volumes, counted from 0: A, A-B or A-B:step [all there are]")
      ->group(group);
  app.add_option("--count", options.count, "make so many pictures of one volume, numbered from 0, as of a turntable")
      ->check(CLI::Range(1, 1000000))
      ->group(group);
  app.add_option("--orbit", options.orbit,
                 "degrees that the camera goes around the volume over all frames, counter-clockwise from above; after "
                 "360 the first picture would follow the last one")
      ->check(numberIn(-360000, 360000, "-360000 to 360000"))
      ->capture_default_str()
      ->group(group);
  app.add_option("--shutter", options.shutter,
                 "of a camera that moves, by --orbit or by keys of the scene: it is open for this share of the time "
                 "from a frame to the next one, and the --samples of a pixel are taken at as many times; 0.5 is usual")
      ->check(numberIn(0, 1, "0 to 1"))
      ->capture_default_str()
      ->group(group);
  app.add_flag("--skip-missing", options.skipMissing,
               "go on without frames that are missing, damaged or unlike the first one (other transform or unit), and "
               "say which; else they end the job")
      ->group(group);
  app.add_flag("--overwrite", options.overwrite,
               "draw all frames again; else those whose files are all there stay, so that a job goes on where it ended")
      ->group(group);
  app.add_option("--fps", options.fps, "of a film (-o film.mp4 or film.webm, made by ffmpeg): frames a second")
      ->check(numberIn(0.01, 1000, "0.01 to 1000"))
      ->capture_default_str()
      ->group(group);
  app.add_option("--film-quality", options.filmQuality,
                 "of a film: the encoder's constant rate factor, 0 (best) to 51 (.mp4) or 63 (.webm) [16; .webm 24]")
      ->check(CLI::Range(0, 63))
      ->group(group);
}

}  // namespace umbrick::tools
