// Draws what pages look at, in a thread of its own: drafts while something moves, then the picture itself, then samples
// of it until its error is small.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "umbrick/draw/progressive.h"
#include "umbrick/render/engine.h"
#include "umbrick/render/scene_drawer.h"
#include "umbrick/render/volume.h"

namespace umbrick::view {

/// A picture for pages.
struct ViewFrame {
  int width = 0, height = 0;
  bool draft = false;
  int samples = 0;
  std::optional<std::int64_t> number = {};  // of the frame of a sequence that is seen
  std::string mime, bytes;
};

/// How good the present picture is.
struct ViewStatus {
  int samples = 0;                     // 0: a draft
  std::optional<ErrorEstimate> error;  // none: not known
  double targetError = 0;              // at which samples end, or where they cannot lower what is left
  double ms = 0;                       // since the scene was changed last
  bool draft = false, done = false, paused = false;
  std::string text;  // for people: "done: error 0.004"
};

struct ViewGoals {
  double draftMs = 100;        // a draft takes about so long
  double targetError = 0.004;  // no more samples than this needs
  int mostSamples = 64;
};

/// Where results go; they are called by the thread that draws.
struct ViewSink {
  std::function<void(const std::shared_ptr<const ViewFrame>&)> frame;
  std::function<void(const ViewStatus&)> status;
  std::function<void(const std::string&)> error;   // a line on what cannot be drawn
  std::function<void(const std::string&)> engine;  // what draws now
  std::function<void()> taken = {};                // the volume of showVolume() is looked at
};

/// What lies under a pixel.
struct ViewProbe {
  int x = 0, y = 0;
  std::optional<glm::dvec3> world;  // none: nothing is seen there
  double depth = 0;                 // along the view axis, world units
};

/// What makes a draft faster than the picture that it stands for.
struct DraftMeans {
  double scale = 1;          // of the edges
  bool coarseLight = false;  // light volumes have light at every second voxel
  int directions = 0;        // of light; 0: as many as the scene has
};

class ViewRenderer {
 public:
  /// @param number  see open()
  ViewRenderer(std::shared_ptr<const Volume> volume, EngineKind engine, const ViewGoals& goals, ViewSink sink,
               std::optional<std::int64_t> number = {});
  /// Ends what is drawn and waits for it.
  ~ViewRenderer();
  ViewRenderer(const ViewRenderer&) = delete;
  ViewRenderer& operator=(const ViewRenderer&) = delete;

  /// Draws another scene; what is drawn of one before is given up. @param moving  more changes follow soon
  void show(const ResolvedScene& scene, bool moving);
  /// Looks at another volume from now on; what is drawn of the one before is given up.
  /// @param number  of the frame that it is, where it is one
  void open(std::shared_ptr<const Volume> volume, const ResolvedScene& scene, std::optional<std::int64_t> number = {});
  /// Looks at another frame of a sequence, by what draws the one before, and as quickly. ViewSink::taken follows.
  /// @param volume  null: the frame holds nothing
  void showVolume(std::shared_ptr<const Volume> volume, const ResolvedScene& scene, std::int64_t number, bool moving);
  /// Nothing moves any more.
  void rest();
  /// Stops at the picture that there is, or goes on.
  void pause(bool paused);
  /// Sends the last frame and status again, to a page that is new.
  void repeat();

  /// Calls back with what is seen in a pixel of the present picture.
  /// @param x,y  from the upper left of a picture of the scene's size
  void probe(int x, int y, std::function<void(const ViewProbe&)> done);
  /// Draws a scene as umbrick render does and hands out the picture, in the thread that draws.
  void drawWhole(const ResolvedScene& scene, std::function<void(const Picture&, const std::string& engine)> done,
                 std::function<void(const std::string&)> failed);

 private:
  struct Obsolete {};
  void run();
  void draft(const ResolvedScene& scene);
  void lessLight(const ResolvedScene& scene);
  void moreLight(const ResolvedScene& scene);
  void adaptDraft(const ResolvedScene& scene, double light, double drawn, double whole);
  void drawBlank(const ResolvedScene& scene, bool draft);
  void refine(const ResolvedScene& scene, std::uint64_t version);
  bool obsolete(std::uint64_t version) const { return wanted_ != version || stop_; }
  void send(const Picture& picture, bool draft, int samples);
  void tell(ViewStatus status);
  Renderer& rendererFor(const ResolvedScene& scene);
  void answer(int x, int y, const std::function<void(const ViewProbe&)>& done);

  std::shared_ptr<const Volume> volume_;  // null: a frame that holds nothing
  std::optional<std::int64_t> number_;    // of the frame
  EngineKind engine_;
  ViewGoals goals_;
  ViewSink sink_;

  std::mutex mutex_;  // of the following, up to tasks_
  std::condition_variable changed_;
  std::optional<ResolvedScene> scene_;
  bool moving_ = false, paused_ = false;
  std::deque<std::function<void()>> tasks_;
  std::atomic<std::uint64_t> wanted_{0};  // grows with each scene
  std::atomic<bool> stop_{false};

  // Of the thread that draws.
  std::unique_ptr<SceneDrawer> drawer_;
  std::function<void()> interrupt_;  // throws Obsolete where the picture is not wanted any more
  DraftMeans draftMeans_;
  std::uint64_t drawn_ = 0, done_ = 0;
  std::chrono::steady_clock::time_point begun_;
  Picture last_;
  std::optional<ResolvedScene> lastScene_;
  std::shared_ptr<const ViewFrame> lastFrame_;
  ViewStatus lastStatus_;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace umbrick::view
