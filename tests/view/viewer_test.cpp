// What a page is sent, in process: drafts and pictures, states, saved files, and lines on what is wrong.
// SPDX-License-Identifier: Apache-2.0
#include "view/viewer.h"

#include <catch2/catch.hpp>
#include <filesystem>

#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/image/png.h"
#include "umbrick/render/render.h"
#include "view/frame_encoder.h"
#include "view/view_fixture.h"

using namespace umbrick;
using namespace umbrick::view;
using Json = nlohmann::ordered_json;

namespace {

struct Looking {
  TemporaryFolder folder;
  std::shared_ptr<const Volume> volume = testVolume();
  ViewGoals goals{.targetError = 0.02, .mostSamples = 16};
  Viewer viewer{testScene(), volume, EngineKind::cpu, goals, folder.path()};
  std::shared_ptr<NotingClient> page = std::make_shared<NotingClient>();
  Looking() { viewer.join(page); }
  void send(const Json& message) { viewer.message(message.dump(), page); }
};

}  // namespace

TEST_CASE("A page gets the volume, the scene, a draft and a picture that is done", "[view]") {
  Looking looking;
  const Json hello = looking.page->take("hello");
  CHECK(hello["volume"]["dims"] == Json({20, 18, 16}));
  CHECK(hello["volume"]["histogram"].size() == 256);
  CHECK(hello["presets"].size() >= 5);
  CHECK(hello["fields"].size() > 20);
  const Json scene = looking.page->take("scene");
  CHECK(scene["scene"]["model"] == "cone");
  CHECK(scene["canUndo"] == false);
  CHECK_THAT(scene["command"].get<std::string>(), Catch::Contains("umbrick render scene.json"));
  const Json done = looking.page->takeDone();
  CHECK(done["samples"] >= 4);
  CHECK(done["error"] > 0);
  CHECK_THAT(done["text"].get<std::string>(), Catch::StartsWith("done: error 0.0"));
  const auto frames = looking.page->frames();
  REQUIRE(frames.size() >= 3);
  CHECK(frames.front()->draft);
  CHECK(frames.front()->mime == "image/jpeg");
  CHECK_FALSE(frames.back()->draft);
  CHECK(frames.back()->width == 40);
}

TEST_CASE("The first frame at rest is the picture that umbrick render makes", "[view]") {
  Looking looking;
  looking.page->takeDone();
  ViewState state(testScene(), looking.volume);
  const Picture picture = VolumeView(*looking.volume, state.placed(), {.visibilityAndDepth = true}).render();
  const auto frames = looking.page->frames();
  const auto first = std::find_if(frames.begin(), frames.end(), [](const auto& frame) { return !frame->draft; });
  REQUIRE(first != frames.end());
  CHECK(((*first)->bytes == encodePng(picture.colour)));
}

TEST_CASE("A saved picture and a saved scene are those of umbrick render", "[view]") {
  Looking looking;
  looking.send({{"type", "edit"}, {"patch", {{"camera", {{"azimuth", 77}}}, {"model", "emission"}}}});
  looking.send({{"type", "save"}, {"what", "picture"}, {"name", "a.png"}, {"size", {30, 20}}, {"samples", 4}});
  CHECK(looking.page->take("saved")["path"] == (looking.folder.path() / "a.png").string());
  looking.send({{"type", "save"}, {"what", "picture"}, {"name", "b.exr"}});
  looking.page->take("saved");
  looking.send({{"type", "save"}, {"what", "scene"}, {"name", "a.json"}});
  looking.page->take("saved");
  Scene saved = readScene(looking.folder.path() / "a.json");
  CHECK(saved.model == Model::emission);
  CHECK(saved.camera.width == 40);
  saved.camera.width = 30;
  saved.camera.height = 20;
  saved.sampling.pixelSamples = 4;
  writePng(looking.folder.path() / "again.png", VolumeView(*looking.volume, saved).render().colour);
  CHECK((readPng(looking.folder.path() / "a.png").pixels == readPng(looking.folder.path() / "again.png").pixels));
}

TEST_CASE("A page names files in the folder, and none that is there", "[view]") {
  Looking looking;
  const auto refused = [&](const std::string& what, const std::string& name) {
    looking.send({{"type", "save"}, {"what", what}, {"name", name}});
    return looking.page->take("error")["message"].get<std::string>();
  };
  for (const std::string name : {"../a.json", "/tmp/a.json", ".a.json", "a.txt", "", "a\n.json", "a/b.json"})
    CHECK_THAT(refused("scene", name), Catch::Contains("is no name"));
  CHECK_THAT(refused("picture", "a.json"), Catch::Contains(".png or .exr"));
  CHECK_THAT(refused("film", "a.png"), Catch::Contains("a picture or a scene"));
  std::filesystem::create_symlink("elsewhere.json", looking.folder.path() / "link.json");
  CHECK_THAT(refused("scene", "link.json"), Catch::Contains("is there already"));
  CHECK_THAT(refused("scene", std::string(200, 'a') + ".json"), Catch::Contains("is no name"));
}

TEST_CASE("What is wrong with a message is said to its page in one line", "[view]") {
  Looking looking;
  const auto answer = [&](const std::string& message) {
    looking.viewer.message(message, looking.page);
    const Json error = looking.page->take("error");
    return error["message"].get<std::string>();
  };
  CHECK(answer("") == "message: is no JSON");
  CHECK(answer("{") == "message: is no JSON");
  CHECK(answer("[1]") == "message: has no type");
  CHECK(answer(std::string(100000, '[')) == "message: nested more than 32 deep");
  CHECK(answer("\"" + std::string(kMostMessageBytes, 'a') + "\"") == "message: longer than 1048576");
  CHECK(answer(R"({"type": "nix"})") == "message: no type 'nix'");
  CHECK(answer(R"({"type": "edit"})") == "message: patch is missing or of another kind");
  CHECK(answer(R"({"type": "edit", "patch": {}, "moving": 3})") == "message: moving is missing or of another kind");
  CHECK(answer(R"({"type": "probe", "x": "a"})") == "message: x is missing or of another kind");
  CHECK(answer(R"({"type": "edit", "patch": {"model": "nix"}})").find("model") != std::string::npos);
}

TEST_CASE("A pixel tells the value that is seen in it", "[view]") {
  Looking looking;
  looking.page->takeDone();
  looking.send({{"type", "probe"}, {"x", 20}, {"y", 15}});
  const Json hit = looking.page->take("probe");
  REQUIRE(hit["world"].is_array());
  // The middle of the picture lies on the line from the eye to the middle of what is seen.
  const Camera camera = ViewState(testScene(), looking.volume).resolved().camera;
  const glm::dvec3 forward = glm::normalize(camera.lookAt - camera.eye);
  const glm::dvec3 world(hit["world"][0], hit["world"][1], hit["world"][2]);
  CHECK(glm::dot(world - camera.eye, forward) == Approx(hit["depth"].get<double>()));
  CHECK(glm::length(glm::cross(world - camera.eye, forward)) < 1.5);
  CHECK(hit["value"].is_number());
  looking.send({{"type", "probe"}, {"x", 0}, {"y", 0}});
  CHECK(looking.page->take("probe")["value"].is_null());
  looking.send({{"type", "probe"}, {"x", -5}, {"y", 1000000}});
  CHECK(looking.page->take("probe")["world"].is_null());
}

TEST_CASE("Pages of one viewer share its scene, and nothing is drawn for nobody", "[view]") {
  Looking looking;
  const auto other = std::make_shared<NotingClient>();
  looking.viewer.join(other);
  other->take("scene");
  looking.send({{"type", "edit"}, {"patch", {{"occlusion", {{"theta", 20}}}}}});
  CHECK(other->take("scene")["scene"]["occlusion"]["theta"] == 20);
  looking.viewer.message(R"({"type": "undo"})", other);
  CHECK(looking.page->take([](const Json& text) { return text["type"] == "scene" && text["canRedo"] == true; })
            .is_object());
  looking.viewer.leave(*other);
  looking.viewer.leave(*looking.page);
  const auto third = std::make_shared<NotingClient>();
  looking.viewer.join(third);
  CHECK(third->takeDone().is_object());
}

TEST_CASE("Bricks are cut anew for what looks farther than rays do", "[view]") {
  Looking looking;
  looking.page->takeDone();
  for (const Json& patch :
       {Json{{"mode", "isosurface"}}, Json{{"mode", "mip"}}, Json{{"mode", "integrate"}, {"model", "emission"}},
        Json{{"shading", {{"kind", "phong"}}}}, Json{{"shading", {{"kind", "auto"}}}, {"technique", "shear-warp"}}}) {
    INFO(patch.dump());
    looking.send({{"type", "edit"}, {"patch", patch}});
    const Json answer = looking.page->take(
        [](const Json& text) { return text["type"] == "error" || (text["type"] == "status" && text["done"] == true); });
    CHECK(answer["type"] == "status");
  }
}

TEST_CASE("A paused picture goes on", "[view]") {
  Looking looking;
  looking.page->takeDone();
  looking.send({{"type", "pause"}});
  CHECK(looking.page->take([](const Json& text) { return text["type"] == "status" && text["paused"] == true; })
            .is_object());
  looking.send({{"type", "edit"}, {"patch", {{"occlusion", {{"theta", 20}}}}}});
  CHECK(looking.page->take([](const Json& text) { return text["type"] == "status" && text["draft"] == true; })
            .is_object());
  looking.send({{"type", "resume"}});
  CHECK(looking.page->takeDone().is_object());
}
