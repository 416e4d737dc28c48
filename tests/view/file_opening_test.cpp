// Another volume for the same pages: opened beside the one before, and only from where pages may open files.
// SPDX-License-Identifier: Apache-2.0
#include "view/file_opening.h"

#include <catch2/catch.hpp>
#include <fstream>

#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "view/view_fixture.h"

using namespace umbrick;
using namespace umbrick::view;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

struct Opening {
  TemporaryFolder folder;
  fs::path served = folder.path() / "served";
  std::unique_ptr<Viewer> viewer;
  std::shared_ptr<NotingClient> page = std::make_shared<NotingClient>();

  explicit Opening(OpenVolume open = openForTest) {
    fs::create_directories(served / "below");
    write(served / "below" / "a.mha", metaImage());
    write(folder.path() / "secret.mha", metaImage());
    viewer = std::make_unique<Viewer>(testScene(), testVolume(), EngineKind::cpu,
                                      ViewGoals{.targetError = 0.05, .mostSamples = 4}, served, std::move(open));
    viewer->join(page);
  }
  static void write(const fs::path& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }
  void send(const Json& message) { viewer->message(message.dump(), page); }
  Json takeState(const std::string& state) {
    return page->take([&](const Json& text) { return text["type"] == "opening" && text["state"] == state; });
  }
};

}  // namespace

TEST_CASE("Another volume is greeted anew, drawn, and has no steps to undo", "[view]") {
  Opening opening;
  CHECK(opening.page->take("hello")["folder"] == fs::canonical(opening.served).string());
  opening.send({{"type", "edit"}, {"patch", {{"occlusion", {{"theta", 20}}}}}});
  opening.page->takeDone();
  opening.send({{"type", "files"}, {"path", "below"}});
  const Json listing = opening.page->take("files");
  CHECK(listing["entries"] ==
        Json::parse(R"([{"name": "a.mha", "kind": "volume", "bytes": )" + std::to_string(metaImage().size()) + "}]"));
  opening.send({{"type", "open"}, {"path", "below/a.mha"}});
  CHECK(opening.takeState("running")["name"] == "a.mha");
  const Json hello = opening.page->take("hello");
  CHECK(hello["volume"]["dims"] == Json({9, 8, 7}));
  CHECK(hello["volume"]["file"] == "a.mha");
  CHECK(opening.page->take("scene")["canUndo"] == false);
  const Json done = opening.takeState("done");
  CHECK(done["text"] == "chosen for a.mha");
  CHECK(opening.page->takeDone()["samples"] > 0);
  opening.send({{"type", "probe"}, {"x", 20}, {"y", 15}});
  const Json probe = opening.page->take("probe");
  REQUIRE(probe["value"].is_number());
  CHECK(probe["value"] > 0);
}

TEST_CASE("A scene opens with its volume from below its folder alone", "[view]") {
  Opening opening;
  Opening::write(opening.served / "good.json", R"({"volume": {"file": "below/a.mha"}, "transfer": "grey-ramp"})");
  Opening::write(opening.served / "bad.json", R"({"volume": {"file": "../secret.mha"}, "transfer": "grey-ramp"})");
  opening.send({{"type", "open"}, {"path", "bad.json"}});
  CHECK_FALSE(opening.takeState("none")["text"].get<std::string>().empty());
  opening.send({{"type", "open"}, {"path", "good.json"}});
  CHECK(opening.takeState("done").is_object());
}

TEST_CASE("What cannot be opened leaves the volume that is shown", "[view]") {
  Opening opening;
  Opening::write(opening.served / "broken.mha", "ObjectType = Image\nNDims = 3\n");
  opening.send({{"type", "open"}, {"path", "broken.mha"}});
  const Json failed = opening.takeState("none");
  CHECK_THAT(failed["text"].get<std::string>(), Catch::Contains("broken.mha"));
  opening.send({{"type", "open"}, {"path", "../secret.mha"}});
  CHECK_THAT(opening.page->take("error")["message"].get<std::string>(), Catch::Contains("no path below"));
  opening.send({{"type", "open"}, {"path", "nothing.mha"}});
  CHECK_THAT(opening.page->take("error")["message"].get<std::string>(), Catch::Contains("nothing.mha"));
  opening.send({{"type", "edit"}, {"patch", {{"occlusion", {{"theta", 20}}}}}});
  CHECK(opening.page->take("scene")["scene"]["occlusion"]["theta"] == 20);
}

TEST_CASE("A file that is swapped for a link while it is opened is not shown", "[view]") {
  fs::path secret;
  // Stands for one who swaps the file at the worst moment, after it was looked at and before it is read, and for a
  // reader that follows the link.
  Opening opening([&](const fs::path& file, const std::function<void(double)>& progress) {
    fs::remove(file);
    fs::create_symlink(secret, file);
    return openForTest(fs::canonical(file), progress);
  });
  secret = opening.folder.path() / "secret.mha";
  opening.send({{"type", "open"}, {"path", "below/a.mha"}});
  CHECK_THAT(opening.takeState("none")["text"].get<std::string>(), Catch::Contains("link"));
}

TEST_CASE("A file that a page has sent is shown and goes away, and scenes name it without its folder", "[view]") {
  Opening opening;
  fs::path path;
  {
    auto file = std::make_shared<UploadedFile>("sent.mha");
    path = file->path();
    Opening::write(path, metaImage());
    opening.viewer->upload(std::move(file));
  }
  CHECK(opening.takeState("done")["name"] == "sent.mha");
  opening.send({{"type", "save"}, {"what", "scene"}, {"name", "s.json"}});
  opening.page->take("saved");
  CHECK(readScene(opening.served / "s.json").volume.file == opening.served / "sent.mha");
  // The thread that opened it lets it go when its job has ended.
  for (int i = 0; i < 200 && fs::exists(path); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  CHECK_FALSE(fs::exists(path));
}

TEST_CASE("A viewer of one volume opens no other", "[view]") {
  Opening opening(OpenVolume{});
  CHECK(opening.page->take("hello")["folder"].is_null());
  opening.send({{"type", "open"}, {"path", "below/a.mha"}});
  CHECK(opening.page->take("error")["message"] == "open: this viewer shows one volume alone");
}
