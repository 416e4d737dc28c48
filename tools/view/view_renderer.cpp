// SPDX-License-Identifier: Apache-2.0
#include "view/view_renderer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "umbrick/core/camera.h"
#include "umbrick/core/error.h"
#include "umbrick/core/short_number.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/draw/blank_picture.h"
#include "umbrick/scene/capabilities.h"
#include "view/frame_encoder.h"

namespace umbrick::view {
namespace {

constexpr int kDraftQuality = 80;    // of JPEG
constexpr double kLeastScale = 0.2;  // of the edges of a draft
constexpr int kLeastDirections = 4;

// Light may take this share of a draft's time.
constexpr double kMostLight = 0.65;
// A draft is aimed at a bit less than the time that is wanted, since the next one may take longer.
constexpr double kAim = 0.9;

// Returns the scene as a draft shows it: smaller, and with light at fewer places or of fewer directions.
ResolvedScene draftOf(const ResolvedScene& scene, const DraftMeans& means) {
  const double scale = means.scale;
  ResolvedScene draft = scene;
  draft.camera.width = std::max(1, static_cast<int>(std::lround(scene.camera.width * scale)));
  draft.camera.height = std::max(1, static_cast<int>(std::lround(scene.camera.height * scale)));
  draft.sampling.pixelSamples = 1;
  OrdinatesOptions& light = draft.occlusion.ordinates;
  if (means.coarseLight) light.lightSpacing = 2;
  if (means.directions > 0) light.directions = std::min(means.directions, light.directions);
  return draft;
}

}  // namespace

ViewRenderer::ViewRenderer(std::shared_ptr<const Volume> volume, EngineKind engine, const ViewGoals& goals,
                           ViewSink sink, std::optional<std::int64_t> number)
    : volume_(std::move(volume)),
      number_(number),
      engine_(engine),
      goals_(goals),
      sink_(std::move(sink)),
      thread_([this] { run(); }) {}

ViewRenderer::~ViewRenderer() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void ViewRenderer::show(const ResolvedScene& scene, bool moving) {
  const std::lock_guard lock(mutex_);
  scene_ = scene;
  moving_ = moving;
  ++wanted_;
  changed_.notify_all();
}

void ViewRenderer::open(std::shared_ptr<const Volume> volume, const ResolvedScene& scene,
                        std::optional<std::int64_t> number) {
  const std::lock_guard lock(mutex_);
  scene_ = scene;
  moving_ = false;
  ++wanted_;
  tasks_.emplace_back([this, volume = std::move(volume), number] {
    drawer_.reset();  // looks at the volume before
    volume_ = volume;
    number_ = number;
    last_ = {};
    lastScene_.reset();
    lastFrame_.reset();
    lastStatus_ = {};
    draftMeans_ = {};
  });
  changed_.notify_all();
}

void ViewRenderer::showVolume(std::shared_ptr<const Volume> volume, const ResolvedScene& scene, std::int64_t number,
                              bool moving) {
  const std::lock_guard lock(mutex_);
  scene_ = scene;
  moving_ = moving;
  ++wanted_;
  tasks_.emplace_back([this, volume = std::move(volume), number] {
    if (drawer_) drawer_->open(volume);
    volume_ = volume;
    number_ = number;
    begun_ = std::chrono::steady_clock::now();
    if (sink_.taken) sink_.taken();
  });
  changed_.notify_all();
}

void ViewRenderer::rest() {
  const std::lock_guard lock(mutex_);
  moving_ = false;
  changed_.notify_all();
}

void ViewRenderer::pause(bool paused) {
  const std::lock_guard lock(mutex_);
  paused_ = paused;
  tasks_.emplace_back([this, paused] {
    lastStatus_.paused = paused;
    tell(lastStatus_);
  });
  changed_.notify_all();
}

void ViewRenderer::repeat() {
  const std::lock_guard lock(mutex_);
  tasks_.emplace_back([this] {
    if (!lastFrame_) return;
    sink_.frame(lastFrame_);
    sink_.status(lastStatus_);
  });
  changed_.notify_all();
}

void ViewRenderer::probe(int x, int y, std::function<void(const ViewProbe&)> done) {
  const std::lock_guard lock(mutex_);
  tasks_.emplace_back([this, x, y, done = std::move(done)] { answer(x, y, done); });
  changed_.notify_all();
}

void ViewRenderer::drawWhole(const ResolvedScene& scene, std::function<void(const Picture&, const std::string&)> done,
                             std::function<void(const std::string&)> failed) {
  const std::lock_guard lock(mutex_);
  tasks_.emplace_back([this, scene, done = std::move(done), failed = std::move(failed)] {
    try {
      interrupt_ = [this] {
        if (stop_) throw Obsolete{};
      };
      const Picture picture = volume_ ? rendererFor(scene).render() : blankPicture(scene, true);
      done(picture, drawer_ ? drawer_->engine().description : std::string());
    } catch (const Error& error) {
      failed(error.what());
    }
  });
  changed_.notify_all();
}

void ViewRenderer::run() {
  std::unique_lock lock(mutex_);
  while (!stop_) {
    const std::uint64_t version = wanted_;
    std::function<void()> work;
    if (!tasks_.empty()) {
      work = std::move(tasks_.front());
      tasks_.pop_front();
    } else if (scene_ && drawn_ != version) {
      if (drawn_ == done_) begun_ = std::chrono::steady_clock::now();
      work = [this, scene = *scene_, version] {
        drawn_ = version;
        draft(scene);
      };
    } else if (scene_ && done_ != version && !moving_ && !paused_) {
      work = [this, scene = *scene_, version] { refine(scene, version); };
    } else {
      changed_.wait(lock);
      continue;
    }
    lock.unlock();
    try {
      work();
    } catch (const Obsolete&) {
      // Another picture is wanted by now.
    } catch (const std::exception& error) {
      done_ = version;  // the same picture would fail again
      sink_.error(error.what());
    }
    lock.lock();
  }
  lock.unlock();
  drawer_.reset();  // contexts end where they are current
}

Renderer& ViewRenderer::rendererFor(const ResolvedScene& scene) {
  if (!drawer_) {
    RenderOptions options;
    options.visibilityAndDepth = true;
    options.countFragments = false;
    options.progress = [this](double) {
      if (interrupt_) interrupt_();
    };
    drawer_ = std::make_unique<SceneDrawer>(
        volume_, engine_, std::move(options), /*refined=*/true,
        [this](const Engine& engine) { sink_.engine(engine.description + ", " + techniqueName(engine.technique)); });
  }
  return drawer_->rendererFor(scene);
}

void ViewRenderer::drawBlank(const ResolvedScene& scene, bool draft) {
  last_ = blankPicture(scene, true);
  lastScene_ = scene;
  ViewStatus status;
  status.draft = draft;
  status.done = !draft;
  status.samples = draft ? 0 : scene.sampling.pixelSamples;
  status.text = draft ? "draft" : "done: this frame holds nothing";
  send(last_, draft, draft ? 0 : 1);
  tell(status);
}

void ViewRenderer::draft(const ResolvedScene& scene) {
  if (!volume_) return drawBlank(scene, true);
  const std::uint64_t version = drawn_;
  const Stopwatch watch;
  // A draft that takes far too long gives way to the next one.
  interrupt_ = [this, &watch, version] {
    if (stop_ || (wanted_ != version && watch.elapsedMs() > 4 * goals_.draftMs)) throw Obsolete{};
  };
  const ResolvedScene drafted = draftOf(scene, draftMeans_);
  Renderer& renderer = rendererFor(drafted);
  const Stopwatch drawing;
  try {
    last_ = renderer.render();
  } catch (const Obsolete&) {
    draftMeans_.scale = std::max(kLeastScale, draftMeans_.scale / 2);
    lessLight(scene);
    throw;
  }
  lastScene_ = drafted;
  ViewStatus status;
  status.draft = true;
  status.ms = drawing.elapsedMs();
  status.text = "draft";
  send(last_, true, 0);
  adaptDraft(scene, last_.stats.lightMs, status.ms, watch.elapsedMs());
  tell(status);
}

// Makes the light of drafts cheaper by one step.
void ViewRenderer::lessLight(const ResolvedScene& scene) {
  const std::optional<Method> method = occlusionMethod(scene);
  if (!method) return;
  const int directions = draftOf(scene, draftMeans_).occlusion.ordinates.directions;
  if (*method == Method::lightVolume && !draftMeans_.coarseLight)
    draftMeans_.coarseLight = true;
  else if (directions > kLeastDirections)
    draftMeans_.directions = std::max(kLeastDirections, directions / 2);
}

// Makes it better by one step.
void ViewRenderer::moreLight(const ResolvedScene& scene) {
  if (draftMeans_.directions > 0)
    draftMeans_.directions =
        2 * draftMeans_.directions < scene.occlusion.ordinates.directions ? 2 * draftMeans_.directions : 0;
  else
    draftMeans_.coarseLight = false;
}

// Chooses the next draft's means by the times of this one, ms: of its light, of all that was drawn, and of all.
void ViewRenderer::adaptDraft(const ResolvedScene& scene, double light, double drawn, double whole) {
  const double aim = kAim * goals_.draftMs;
  if (light > kMostLight * aim)
    lessLight(scene);
  else if (light > 0 && light < 0.25 * aim)
    moreLight(scene);
  // The time of a picture goes with its pixels; it is followed with some delay, so that one slow picture does not make
  // all coarse.
  const double picture = std::max(1.0, drawn - light), left = std::max(0.25 * aim, aim - light - (whole - drawn));
  draftMeans_.scale = std::clamp(draftMeans_.scale * std::pow(left / picture, 0.35), kLeastScale, 1.0);
}

void ViewRenderer::refine(const ResolvedScene& scene, std::uint64_t version) {
  if (!volume_) {
    done_ = version;
    return drawBlank(scene, false);
  }
  interrupt_ = [this, version] {
    if (obsolete(version)) throw Obsolete{};
  };
  const auto since = [this] {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun_).count();
  };
  Renderer& renderer = rendererFor(scene);
  last_ = renderer.render();
  lastScene_ = scene;
  send(last_, false, 1);
  ViewStatus status;
  status.samples = scene.sampling.pixelSamples;
  status.ms = since();
  status.text = "1 sample";
  tell(status);
  if (!canAverage(scene)) {
    status.done = true;
    status.text = "done";
    done_ = version;
    tell(status);
    return;
  }
  bool paused = false;
  renderProgressive(renderer, {.passes = goals_.mostSamples}, [&](const ProgressivePicture& picture) {
    if (obsolete(version)) throw Obsolete{};
    {
      const std::lock_guard lock(mutex_);
      paused = paused_;
    }
    const double samples = picture.error.statistical, total = picture.error.total();
    // More samples do not help where what is left is not theirs.
    const bool enough =
        picture.passes >= kStreams &&
        (total <= goals_.targetError || samples <= goals_.targetError / 2 || samples <= picture.error.systematic / 4);
    const bool done = enough || picture.passes >= goals_.mostSamples;
    const bool power = (picture.passes & (picture.passes - 1)) == 0;
    last_ = picture.picture;
    if ((power && picture.passes > 1) || done || paused) send(last_, false, picture.passes);
    status.samples = picture.passes;
    if (std::isfinite(total)) status.error = picture.error;
    status.ms = since();
    status.done = done;
    const std::string error = std::isfinite(total) ? "error " + shortNumber(total, 2) : "";
    status.text = done ? "done" + (error.empty() ? error : ": " + error)
                       : std::to_string(picture.passes) + (picture.passes == 1 ? " sample" : " samples") +
                             (error.empty() ? error : ", " + error);
    if (done && total > goals_.targetError && picture.error.systematic > samples)
      status.text += " (a smaller spacing lowers it)";
    if (done) done_ = version;
    tell(status);
    return !done && !paused;
  });
}

void ViewRenderer::send(const Picture& picture, bool draft, int samples) {
  auto frame = std::make_shared<ViewFrame>();
  frame->width = picture.colour.width;
  frame->height = picture.colour.height;
  frame->draft = draft;
  frame->samples = samples;
  frame->number = number_;
  frame->mime = draft ? "image/jpeg" : "image/png";
  frame->bytes = draft ? encodeJpeg(picture.colour, kDraftQuality) : encodePng(picture.colour);
  lastFrame_ = frame;
  sink_.frame(lastFrame_);
}

void ViewRenderer::tell(ViewStatus status) {
  {
    const std::lock_guard lock(mutex_);
    status.paused = paused_;
  }
  status.targetError = goals_.targetError;
  lastStatus_ = status;
  sink_.status(lastStatus_);
}

void ViewRenderer::answer(int x, int y, const std::function<void(const ViewProbe&)>& done) {
  ViewProbe probe{x, y, {}, 0};
  glm::dvec2 size(0);
  {
    const std::lock_guard lock(mutex_);
    if (scene_) size = {scene_->camera.width, scene_->camera.height};
  }
  if (lastScene_ && !last_.depth.pixels.empty() && size.x > 0) {
    const Camera& camera = lastScene_->camera;
    // The present picture may be a draft of another size.
    const glm::dvec2 place((x + 0.5) / size.x, 1 - (y + 0.5) / size.y);
    const int px = static_cast<int>(std::floor(place.x * camera.width));
    const int py = static_cast<int>(std::floor(place.y * camera.height));
    if (px >= 0 && py >= 0 && px < last_.depth.width && py < last_.depth.height) {
      const double depth = *last_.depth.at(px, py);
      if (std::isfinite(depth)) {
        const CameraFrame frame = cameraFrame(camera);
        const glm::dvec2 p = screenPlane(camera).halfExtent * (2.0 * place - 1.0);
        const double scale = camera.projection == Projection::perspective ? depth : 1;
        probe.depth = depth;
        probe.world = camera.eye + depth * frame.forward + scale * (p.x * frame.right + p.y * frame.up);
      }
    }
  }
  done(probe);
}

}  // namespace umbrick::view
