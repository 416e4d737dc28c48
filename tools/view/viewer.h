// What pages and the program say to each other, without the network: messages of pages change the scene, and pictures
// and states go to all of them.
//
// Messages are JSON texts. From a page:
//   {"type": "edit", "patch": {...}, "moving": bool, "step": "..."}   see ViewState::edit(); moving: more follows soon
//   {"type": "rest"}  {"type": "undo"}  {"type": "redo"}  {"type": "reset"}  {"type": "pause"}  {"type": "resume"}
//   {"type": "shown", "frame": n}                a frame is on the screen: the next one may be sent
//   {"type": "probe", "x": px, "y": px}          from the upper left of a picture of the scene's size
//   {"type": "gradients"}                        asks for the histogram of value and gradient magnitude
//   {"type": "compare"}  {"type": "stopCompare"}  with the reference, see ReferenceComparison
//   {"type": "files", "path": "..."}  {"type": "open", "path": "..."}   of the folder of the server, see OpenFolder
//   {"type": "save", "what": "picture" | "scene" | "sequence", "name": "...", "size": [w, h], "samples": n}
//   {"type": "sequence", "number": n, "moving": bool}   shows a frame of a sequence; moving: others follow soon
//   {"type": "play", "on": bool, "loop": bool, "fps": x}   what is not named stays
// To pages: hello, scene, status, probe, comparison, gradients, files, opening, sequence, saved, note, error; and
// frames, which are binary: four bytes with the length of a JSON text, little-endian, that text, and the bytes of an
// image. A frame is a picture here; a frame of a sequence has a number.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "view/file_opening.h"
#include "view/latest_job.h"
#include "view/page_message.h"
#include "view/reference_comparison.h"
#include "view/sequence_player.h"
#include "view/view_renderer.h"
#include "view/view_sequence.h"
#include "view/view_state.h"

namespace umbrick::view {

/// A page that is connected. Its functions may be called by any thread.
class ViewClient {
 public:
  virtual ~ViewClient() = default;
  virtual void text(const std::string& message) = 0;
  /// Takes a frame. One that is not sent before the next one comes is dropped.
  virtual void frame(const std::shared_ptr<const ViewFrame>& frame) = 0;
};

class Viewer {
 public:
  /// @param scene   with a transfer function, as openScene() completes it
  /// @param folder  where pictures and scenes are saved, and from which files are opened
  /// @param open    opens other volumes; none: there is this one alone
  /// @param sequence  of which the volume is the first frame; null: it is alone
  Viewer(Scene scene, std::shared_ptr<const Volume> volume, EngineKind engine, const ViewGoals& goals,
         std::filesystem::path folder, OpenVolume open = {}, std::shared_ptr<const ViewSequence> sequence = {});
  ~Viewer();

  void join(const std::shared_ptr<ViewClient>& client);
  void leave(const ViewClient& client);
  /// Does what a message asks for. What is wrong with it is said to the page that sent it.
  void message(std::string_view text, const std::shared_ptr<ViewClient>& from);
  /// Shows a file that a page has sent.
  void upload(std::shared_ptr<UploadedFile> file);
  bool opensFiles() const { return opening_ != nullptr; }

 private:
  using Json = nlohmann::ordered_json;
  void toAll(const Json& message);
  Json hello() const;
  Json sceneMessage() const;
  void show(bool moving);
  void probe(const Json& message, const std::shared_ptr<ViewClient>& from);
  void save(const Json& message, const std::shared_ptr<ViewClient>& from);
  void compare();
  void sendGradients(const std::shared_ptr<ViewClient>& from);
  void dropComparison(const std::string& why);
  const ViewSequence& sequence() const;
  Json sequenceMessage() const;
  std::optional<std::int64_t> frameNumber() const;
  void askFrame(const FrameRequest& request);
  void play(const PlayRequest& request);
  void settle();
  SequencePlayer::Sink playerSink();
  void showFrame(std::uint64_t number, const ReadFrame& frame);
  void startOpening(OpenVolume open);
  void take(std::uint64_t number, OpenedVolume opened, const std::string& name);
  FileOpening& opening() const;
  std::filesystem::path place(const std::string& name, const std::vector<std::string>& endings) const;
  ViewSink sink();

  mutable std::mutex mutex_;  // of what follows, up to clients_
  ViewState state_;
  std::string engine_;
  std::vector<std::shared_ptr<ViewClient>> clients_;
  std::filesystem::path folder_;
  Json about_;      // what hello says of the volume
  Json gradients_;  // the histogram of value and gradient magnitude; null: nobody has asked for it
  Json compared_;   // the last message on the comparison; null: there is none
  std::shared_ptr<const ViewSequence> sequence_;  // null: the volume is alone
  std::size_t frame_ = 0;                         // of the sequence: which one the state shows
  bool blank_ = false;                            // it holds nothing
  std::unique_ptr<SequencePlayer> player_;        // before what draws, which tells it when it has drawn
  std::unique_ptr<ViewRenderer> renderer_;
  std::unique_ptr<ReferenceComparison> comparison_;
  std::unique_ptr<FileOpening> opening_;
  std::unique_ptr<LatestJob> surveying_ = std::make_unique<LatestJob>();
};

}  // namespace umbrick::view
