// The scene that pages edit: patches, what they may not do, and undo.
// SPDX-License-Identifier: Apache-2.0
#include "view/view_state.h"

#include <catch2/catch.hpp>

#include "umbrick/core/error.h"
#include "view/surface_value.h"
#include "view/view_fixture.h"

using namespace umbrick;
using namespace umbrick::view;
using Json = nlohmann::ordered_json;

TEST_CASE("A patch changes what it names and nothing else", "[view]") {
  ViewState state(testScene(), testVolume());
  Scene expected = state.scene();
  state.edit({{"occlusion", {{"theta", 30}}}});
  expected.occlusion.aperture = state.scene().occlusion.aperture;
  CHECK(state.scene().occlusion.aperture == Approx(30 * 3.14159265358979 / 180));
  CHECK(state.scene() == expected);
  state.edit({{"light", {{"background", {0.1, 0.2, 0.3}}}}});
  CHECK(state.scene().background == glm::dvec3(0.1, 0.2, 0.3));
  state.edit({{"light", {{"background", nullptr}}}});
  CHECK(state.scene() == expected);
}

TEST_CASE("Steps are undone together and done again", "[view]") {
  ViewState state(testScene(), testVolume());
  const Scene first = state.scene();
  CHECK_FALSE(state.canUndo());
  for (const double theta : {20, 30, 40}) state.edit({{"occlusion", {{"theta", theta}}}}, "drag");
  const Scene dragged = state.scene();
  state.edit({{"sampling", {{"spacing", 1}}}});
  const Scene last = state.scene();
  state.undo();
  CHECK(state.scene() == dragged);
  state.undo();
  CHECK(state.scene() == first);
  CHECK_FALSE(state.canUndo());
  state.undo();
  CHECK(state.scene() == first);
  state.redo();
  state.redo();
  CHECK(state.scene() == last);
  CHECK_FALSE(state.canRedo());
  // A drag that begins again after an undo is a step of its own.
  state.undo();
  state.edit({{"occlusion", {{"theta", 50}}}}, "drag");
  state.undo();
  CHECK(state.scene() == dragged);
  // What changes nothing is no step.
  state.edit({{"occlusion", {{"theta", 40}}}});
  CHECK(state.canRedo());
  state.reset();
  CHECK(state.scene() == first);
  state.undo();
  CHECK(state.scene() == dragged);
}

TEST_CASE("The size of a window is part of the scene, and no step", "[view]") {
  ViewState state(testScene(), testVolume());
  state.edit({{"camera", {{"size", {50, 40}}}}}, "size");
  CHECK(state.scene().camera.width == 50);
  CHECK_FALSE(state.canUndo());
  state.edit({{"occlusion", {{"theta", 20}}}});
  state.undo();
  state.edit({{"camera", {{"size", {60, 40}}}}}, "size");
  CHECK(state.canRedo());
}

TEST_CASE("Surfaces that nobody has named are one where the values part best", "[view]") {
  ViewState state(testScene(), testVolume());
  state.edit({{"mode", "isosurface"}});
  REQUIRE(state.scene().surfaces.size() == 1);
  CHECK(state.scene().surfaces[0].value == Approx(suggestSurface(testVolume()->grid())));
  state.edit(Json::parse(R"({"surfaces": [{"value": 0.5, "opacity": 0.4}, {"value": 0.7}]})"));
  CHECK(state.scene().surfaces.size() == 2);
}

TEST_CASE("Only so many steps are kept", "[view]") {
  ViewState state(testScene(), testVolume());
  for (std::size_t i = 0; i < kMostSteps + 20; ++i) state.edit({{"occlusion", {{"theta", 1 + 0.1 * double(i)}}}});
  std::size_t steps = 0;
  for (; state.canUndo(); ++steps) state.undo();
  CHECK(steps == kMostSteps);
}

TEST_CASE("A patch that is wrong leaves the scene as it was, and says why", "[view]") {
  ViewState state(testScene(), testVolume());
  const Scene before = state.scene();
  for (const auto& [patch, message] : std::vector<std::pair<Json, std::string>>{
           {{{"occlusion", {{"theta", 95}}}}, "occlusion.theta: is 95 degrees"},
           {{{"occlusion", {{"theta", "wide"}}}}, "occlusion.theta"},
           {{{"bogus", 1}}, "unknown field"},
           {Json::array({1}), "no object"},
           {{{"volume", {{"file", "/etc/passwd"}}}}, "volume: a page cannot change it"},
           {{{"transfer", "/etc/passwd"}}, "is no preset"},
           {{{"transfer", "../secret.json"}}, "is no preset"},
           {{{"transfer", {{"points", Json::array()}}}}, "transfer"},
           {Json::parse(R"({"mesh": {"file": "/etc/passwd"}})"), "mesh.file: a page cannot change it"},
           {Json::parse(R"({"transfer": {"keys": [{"frame": 0, "function": "secret.json"}]}})"), "keys: a page cannot"},
           {Json::parse(R"({"camera": {"keys": [{"frame": 0, "azimuth": 9}]}})"), "keys: a page cannot set them"},
           {{{"light", {{"sources", {{{"type", "environment"}, {"file", "/etc/passwd"}}}}}}}, "expected a file beside"},
           {{{"camera", {{"size", {100000, 10}}}}}, "a page shows up to 4096"},
           {{{"model", "lights"}}, "light"}}) {
    INFO(patch.dump());
    CHECK_THROWS_WITH(state.edit(patch), Catch::Contains(message));
    CHECK(state.scene() == before);
    CHECK_FALSE(state.canUndo());
  }
}

TEST_CASE("A transfer function comes by name, by itself or by what suits the volume", "[view]") {
  ViewState state(testScene(), testVolume());
  state.edit({{"transfer", "smoke"}});
  CHECK(*state.scene().transfer == loadTransferFunction("smoke"));
  state.edit({{"transfer", "auto"}});
  CHECK(state.scene().transfer.has_value());
  state.edit(Json::parse(
      R"({"transfer": {"points": [{"value": 0, "albedo": [1, 1, 1], "sigma_t": 0}, {"value": 1, "albedo": [1, 0, 0], "sigma_t": 2}]}})"));
  CHECK((*state.scene().transfer)(1.0).sigma_t == 2);
}

TEST_CASE("The camera stays where the transfer function changes, and a placed scene makes the same picture", "[view]") {
  const auto volume = testVolume();
  ViewState state(testScene(), volume);
  const Camera before = state.resolved().camera;
  state.edit({{"transfer", "grey-ramp"}});
  CHECK(state.resolved().camera == before);
  state.edit({{"camera", {{"azimuth", 100}}}});
  CHECK(state.resolved().camera != before);
  const ResolvedScene again = volume->resolve(parseScene(printScene(state.placed()), "placed"));
  CHECK(again.camera == state.resolved().camera);
  CHECK(again == state.resolved());
}
