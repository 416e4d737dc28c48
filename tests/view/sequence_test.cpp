// The frames of a sequence, in process: what is read when, what pages are told, and what they see.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "tools/program.h"
#include "umbrick/core/error.h"
#include "umbrick/draw/blank_picture.h"
#include "umbrick/image/exr.h"
#include "umbrick/image/png.h"
#include "umbrick/render/render.h"
#include "view/frame_encoder.h"
#include "view/view_fixture.h"

using namespace umbrick;
using namespace umbrick::view;
using Json = nlohmann::ordered_json;

namespace {

constexpr int kFrames = 6, kEmptyFrame = 4, kDamagedFrame = 5;

// A ball that grows with the number of its frame, as bytes.
std::string ballImage(int number) {
  std::string file =
      "ObjectType = Image\nNDims = 3\nDimSize = 12 12 12\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n";
  for (int z = 0; z < 12; ++z)
    for (int y = 0; y < 12; ++y)
      for (int x = 0; x < 12; ++x)
        file += static_cast<char>(std::hypot(x - 5.5, y - 5.5, z - 5.5) < 1.6 + 0.6 * number ? 60 + 30 * number : 0);
  return file;
}

// What is read of a sequence. A test may hold up the reading of a frame.
class ReadingLog {
 public:
  void note(const Volume& volume) {
    std::unique_lock lock(mutex_);
    const std::string name = volume.source().file.stem().string();
    files_.push_back(name);
    changed_.notify_all();
    changed_.wait(lock, [&] { return name != held_; });
  }
  void hold(const std::string& name) {
    const std::lock_guard lock(mutex_);
    held_ = name;
    changed_.notify_all();
  }
  /// Waits until so many frames were read.
  std::vector<std::string> wait(std::size_t count) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::minutes(2), [&] { return files_.size() >= count; });
    return files_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> files_;
  std::string held_;
};

struct Sequence {
  TemporaryFolder folder;
  std::shared_ptr<ReadingLog> log = std::make_shared<ReadingLog>();
  std::shared_ptr<const ViewSequence> frames;
  std::shared_ptr<const Volume> first;

  Sequence() {
    auto made = std::make_shared<ViewSequence>();
    for (int number = 1; number <= kFrames; ++number) {
      const auto path = folder.path() / ("f_0" + std::to_string(number) + ".mha");
      std::ofstream(path, std::ios::binary) << (number == kDamagedFrame ? "damaged" : ballImage(number));
      if (number == kEmptyFrame) {
        std::string nothing = ballImage(number);
        std::fill(nothing.end() - 12 * 12 * 12, nothing.end(), '\0');
        std::ofstream(path, std::ios::binary) << nothing;
      }
      VolumeReference volume;
      volume.file = path;
      made->frames.push_back({number, volume});
    }
    made->whole.file = folder.path() / "f_%02d.mha";
    made->check = [log = log](const Volume& volume) { log->note(volume); };
    first = std::make_shared<const Volume>(made->frames[0].volume);
    made->seen = first->worldBounds();
    frames = made;
  }
  Scene scene() const {
    Scene scene = testScene();
    scene.transfer = TransferFunction({{50, {{0.9, 0.5, 0.2}, 0}}, {250, {{0.2, 0.6, 0.9}, 1}}});
    scene.volume = first->source();
    return scene;
  }
};

// Waits for the first picture at rest of a frame. What is done may be the frame before.
std::shared_ptr<const ViewFrame> takeResting(NotingClient& page, int number) {
  while (!page.takeDone().is_null())
    for (const auto& frame : page.frames())
      if (frame->number == number && !frame->draft) return frame;
  return nullptr;
}

struct Watching : Sequence {
  ViewGoals goals{.targetError = 0.02, .mostSamples = 8};
  Viewer viewer{scene(), first, EngineKind::cpu, goals, folder.path(), {}, frames};
  std::shared_ptr<NotingClient> page = std::make_shared<NotingClient>();
  Watching() { viewer.join(page); }
  void send(const Json& message) { viewer.message(message.dump(), page); }
  void ask(int number) { send({{"type", "sequence"}, {"number", number}}); }
  Json takeShown(int number) {
    return page->take([&](const Json& text) { return text["type"] == "sequence" && text["number"] == number; });
  }
  Json takeScene(int number) {
    return page->take([&](const Json& text) { return text["type"] == "scene" && text["number"] == number; });
  }
};

}  // namespace

TEST_CASE("Another frame changes the volume, and neither the scene nor its history", "[view]") {
  Watching watching;
  const Json hello = watching.page->take("hello");
  CHECK(hello["sequence"] == Json::parse(R"({"ranges": [[1, 6]], "step": 1})"));
  CHECK(hello["volume"]["file"] == "f_%02d.mha");
  watching.send({{"type", "edit"}, {"patch", {{"camera", {{"azimuth", 77}}}}}});
  const Json before =
      watching.page->take([](const Json& text) { return text["type"] == "scene" && text["canUndo"] == true; });
  watching.ask(3);
  const Json after = watching.takeScene(3);
  CHECK(after["camera"] == before["camera"]);
  CHECK(after["canUndo"] == true);
  CHECK_THAT(after["scene"]["volume"]["file"].get<std::string>(), Catch::EndsWith("f_03.mha"));
  const auto shown = takeResting(*watching.page, 3);
  REQUIRE(shown);
  const auto third = std::make_shared<const Volume>(watching.frames->frames[2].volume);
  const ViewState state(parseScene(after["scene"].dump(), "scene"), third, watching.frames->seen);
  VolumeView view(*third, state.placed(), {.visibilityAndDepth = true});
  CHECK((shown->bytes == encodePng(view.render().colour)));
  watching.send({{"type", "undo"}});
  const Json undone = watching.takeScene(3);
  CHECK_THAT(undone["scene"]["volume"]["file"].get<std::string>(), Catch::EndsWith("f_03.mha"));
  CHECK(undone["scene"]["camera"]["azimuth"] != 77);
}

TEST_CASE("The frame behind the one that is shown is read ahead, once, and a newer request drops an older one",
          "[view]") {
  Watching watching;
  using Names = std::vector<std::string>;
  watching.ask(2);
  CHECK(watching.log->wait(2) == Names{"f_02", "f_03"});
  watching.ask(3);
  watching.takeShown(3);
  // Frame 4 holds nothing, and is not checked for what it has in common with others.
  watching.log->hold("f_02");
  watching.ask(2);
  watching.log->wait(3);
  watching.ask(1);
  watching.ask(6);
  watching.log->hold("");
  CHECK(watching.page->take(
            [](const Json& text) { return text["type"] == "sequence" && text["number"] != 3; })["number"] == 6);
  Names names = watching.log->wait(4);
  names.resize(4);  // what follows is read ahead
  CHECK(names == Names{"f_02", "f_03", "f_02", "f_06"});
}

TEST_CASE("A frame that is damaged is said, and one that holds nothing is shown empty", "[view]") {
  Watching watching;
  watching.ask(kDamagedFrame);
  CHECK_THAT(watching.page->take("error")["message"].get<std::string>(),
             Catch::StartsWith("frame 5: ") && Catch::Contains("f_05.mha"));
  CHECK(watching.takeShown(1)["asked"].is_null());
  watching.ask(kEmptyFrame);
  CHECK(watching.page->take(
            [](const Json& text) { return text["type"] == "sequence" && text["number"] == 4; })["empty"] == true);
  CHECK(takeResting(*watching.page, kEmptyFrame));
  const ResolvedScene scene = ViewState(watching.scene(), watching.first).resolved();
  CHECK((watching.page->frames().back()->bytes == encodePng(blankPicture(scene, false).colour)));
  watching.send({{"type", "compare"}});
  CHECK(watching.page->take("error")["message"] == "compare: this frame holds nothing");
}

TEST_CASE("Play draws a draft of each frame that can be shown, and its last one gets a picture", "[view]") {
  Watching watching;
  REQUIRE(takeResting(*watching.page, 1));
  watching.send({{"type", "play"}, {"on", true}, {"loop", false}, {"fps", 120}});
  CHECK(watching.page->take([](const Json& text) {
    return text["type"] == "sequence" && text["playing"] == false;
  })["number"] == kFrames);
  CHECK(takeResting(*watching.page, kFrames));
  std::vector<std::int64_t> drafts;
  for (const auto& frame : watching.page->frames()) {
    if (frame->draft && (drafts.empty() || drafts.back() != *frame->number)) drafts.push_back(*frame->number);
    if (!frame->draft) CHECK((frame->number == 1 || frame->number == kFrames));
  }
  CHECK(drafts == std::vector<std::int64_t>{1, 2, 3, 4, 6});
  // From the end it begins anew, and with a loop it goes on.
  watching.send({{"type", "play"}, {"on", true}, {"loop", true}});
  for (const int number : {1, 2, 6, 1}) watching.takeShown(number);
  watching.send({{"type", "play"}, {"on", false}});
  const Json stopped =
      watching.page->take([](const Json& text) { return text["type"] == "sequence" && text["playing"] == false; });
  CHECK(watching.takeScene(stopped["number"]).is_object());
}

TEST_CASE("No frame is played before the one in front of it is drawn, and one alone is read meanwhile", "[view]") {
  Sequence sequence;
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<std::size_t> shown;
  SequencePlayer player({[&](std::uint64_t, const ReadFrame& frame) {
                           const std::lock_guard lock(mutex);
                           shown.push_back(frame.index);
                           changed.notify_all();
                         },
                         [](std::uint64_t, const std::string&) {}, [](std::uint64_t) {}});
  const auto wait = [&](std::size_t count) {
    std::unique_lock lock(mutex);
    changed.wait_for(lock, std::chrono::minutes(2), [&] { return shown.size() >= count; });
    return shown;
  };
  player.open(sequence.frames);
  player.setRate(kMostPlayRate);
  player.play(true);
  CHECK(wait(1) == std::vector<std::size_t>{1});
  CHECK(sequence.log->wait(2) == std::vector<std::string>{"f_02", "f_03"});
  player.drawn();  // of the frame before: nobody has taken this one
  CHECK(wait(1).size() == 1);
  player.taken();
  CHECK(wait(1).size() == 1);
  player.drawn();
  CHECK(wait(2) == std::vector<std::size_t>{1, 2});
  CHECK(sequence.log->wait(2).size() == 2);
}

TEST_CASE("Requests for frames are checked", "[view]") {
  Watching watching;
  const auto answer = [&](const Json& message) {
    watching.send(message);
    return watching.page->take("error")["message"].get<std::string>();
  };
  CHECK(answer({{"type", "sequence"}}) == "message: number is missing or of another kind");
  CHECK(answer({{"type", "sequence"}, {"number", 1.5}}) == "message: number is missing or of another kind");
  CHECK(answer({{"type", "sequence"}, {"number", 1e300}}) == "message: number is missing or of another kind");
  CHECK(answer({{"type", "sequence"}, {"number", 18446744073709551615u}}) ==
        "message: number is missing or of another kind");
  CHECK(answer({{"type", "sequence"}, {"number", 7}}) == "sequence: there is no frame 7");
  CHECK(answer({{"type", "play"}, {"on", 1}}) == "message: on is missing or of another kind");
  CHECK(answer({{"type", "play"}, {"fps", 0}}) == "play: fps is 0, expected 0.1 to 120");
  Viewer alone(testScene(), testVolume(), EngineKind::cpu, {.mostSamples = 4}, watching.folder.path());
  alone.join(watching.page);
  for (const Json& message : {Json{{"type", "sequence"}, {"number", 1}}, Json{{"type", "play"}, {"on", true}}}) {
    alone.message(message.dump(), watching.page);
    CHECK(watching.page->take("error")["message"] == "sequence: the volume is no frame of a sequence");
  }
}

TEST_CASE("The command of all frames makes the picture of each as the page shows it, to the bit", "[view]") {
  Watching watching;
  // Some frames: the damaged one would end the command, and is told to be missing instead.
  auto some = std::make_shared<ViewSequence>(*watching.frames);
  some->frames.erase(some->frames.begin() + kDamagedFrame - 1);
  std::filesystem::remove(watching.folder.path() / "f_05.mha");
  Viewer viewer(watching.scene(), watching.first, EngineKind::cpu, watching.goals, watching.folder.path(), {}, some);
  const auto page = std::make_shared<NotingClient>();
  viewer.join(page);
  REQUIRE(takeResting(*page, 1));
  std::string command;
  for (const int number : {kEmptyFrame, 3}) {
    viewer.message(Json{{"type", "sequence"}, {"number", number}}.dump(), page);
    command = page->take(
        [&](const Json& text) { return text["type"] == "scene" && text["number"] == number; })["commandOfAll"];
    REQUIRE(takeResting(*page, number));
  }
  viewer.message(R"({"type": "save", "what": "picture", "name": "page.png"})", page);
  page->take("saved");
  const std::string program = "umbrick render";
  CHECK_THAT(command, Catch::EndsWith("--frames 1-6 --skip-missing -o 'frame_%04d.png'"));
  command.replace(command.find(program), program.size(), "\"$umbrick\" render --backend cpu");
  const ProgramResult result = runShell(watching.folder, command + " -o 'frame_%04d.exr' --exr-pixel float");
  INFO(result.err);
  REQUIRE(result.status == 0);
  const auto path = [&](const std::string& name) { return watching.folder.path() / name; };
  CHECK((readPng(path("frame_0003.png")).pixels == readPng(path("page.png")).pixels));
  for (const auto& frame : page->frames()) {
    if (frame->draft || frame->samples > 1) continue;
    INFO("frame " << *frame->number);
    const std::string name = "frame_000" + std::to_string(*frame->number) + ".exr";
    CHECK((frame->bytes == encodePng(readExr(path(name)).layers.at(0).image)));
  }
}
