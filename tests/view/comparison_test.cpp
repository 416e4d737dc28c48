// What is drawn against the reference, in the background: numbers, pictures, and that it gives way.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/image/image_difference.h"
#include "umbrick/reference/reference.h"
#include "umbrick/render/render.h"
#include "view/base64.h"
#include "view/view_fixture.h"

using namespace umbrick;
using namespace umbrick::view;
using Json = nlohmann::ordered_json;

namespace {

struct Comparing {
  TemporaryFolder folder;
  std::shared_ptr<const Volume> volume = testVolume();
  Viewer viewer{testScene(), volume, EngineKind::cpu, {.targetError = 0.02, .mostSamples = 4}, folder.path()};
  std::shared_ptr<NotingClient> page = std::make_shared<NotingClient>();
  Comparing() { viewer.join(page); }
  void send(const Json& message) { viewer.message(message.dump(), page); }
  Json takeState(const std::string& state) {
    return page->take([&](const Json& text) { return text["type"] == "comparison" && text["state"] == state; });
  }
};

Image grey(float value) {
  Image image(20, 10, 4);
  std::fill(image.pixels.begin(), image.pixels.end(), value);
  return image;
}

}  // namespace

TEST_CASE("Base 64 is that of RFC 4648", "[view]") {
  const std::vector<std::pair<std::string, std::string>> vectors{{"", ""},
                                                                 {"f", "Zg=="},
                                                                 {"fo", "Zm8="},
                                                                 {"foo", "Zm9v"},
                                                                 {"foob", "Zm9vYg=="},
                                                                 {"fooba", "Zm9vYmE="},
                                                                 {"foobar", "Zm9vYmFy"},
                                                                 {"\xff\xfe\xfd", "//79"}};
  for (const auto& [bytes, text] : vectors) CHECK(base64(bytes) == text);
}

TEST_CASE("Pictures that differ by one number have it as RMSE and maximum", "[view]") {
  const Json result = comparisonOf(grey(0.53f), grey(0.5f));
  CHECK(result["size"] == Json({20, 10}));
  CHECK(result["top"].get<double>() == Approx(0.05));  // the next of 1, 2, 5 above 0.03
  std::map<std::string, double> measures;
  for (const Json& measure : result["measures"])
    if (measure["value"].is_number()) measures[measure["title"]] = measure["value"];
  CHECK(measures["RMSE RGB"] == Approx(0.03).epsilon(1e-5));
  CHECK(measures["maximum"] == Approx(0.03).epsilon(1e-5));
  CHECK(result["text"] == "RMSE 0.03 against the reference");
  for (const char* name : {"drawn", "reference", "difference"})
    CHECK_THAT(result["pictures"][name].get<std::string>(), Catch::StartsWith("iVBORw0KGgo"));  // of every PNG
  // Equal pictures have a scale, too.
  CHECK(comparisonOf(grey(0.5f), grey(0.5f))["top"] > 0);
}

TEST_CASE("A comparison is what render and reference make at its size, and the picture goes on", "[view]") {
  Comparing comparing;
  comparing.send({{"type", "edit"}, {"patch", {{"camera", {{"size", {320, 240}}}}, {"model", "emission"}}}});
  comparing.send({{"type", "compare"}});
  const Json running = comparing.takeState("running");
  CHECK(running["share"] == 0);
  CHECK(running["size"] == Json({kComparedEdge, kComparedEdge * 3 / 4}));
  const Json done = comparing.takeState("done");
  REQUIRE(done.is_object());
  ViewState state(testScene(), comparing.volume);
  state.edit({{"camera", {{"size", {160, 120}}}}, {"model", "emission"}});
  const Picture drawn = VolumeView(*comparing.volume, state.placed(), {.visibilityAndDepth = true}).render();
  // With the tolerance of comparisons; this model has no directions of light.
  ReferenceOptions options;
  options.tolerance = 1e-3;
  const ReferencePicture reference = renderReference(comparing.volume->grid(), state.resolved(), options);
  const Json expected = comparisonOf(drawn.colour, reference.colour);
  CHECK(done["measures"] == expected["measures"]);
  CHECK(done["pictures"] == expected["pictures"]);
  // The picture at rest comes when it comes, before or after the comparison.
  CHECK(comparing.page->awaitFrame([](const ViewFrame& frame) { return !frame.draft && frame.width == 320; }));
  // Who comes later sees it, too.
  const auto other = std::make_shared<NotingClient>();
  comparing.viewer.join(other);
  CHECK(other->take("comparison")["state"] == "done");
}

TEST_CASE("A comparison ends where it is stopped or its scene changes", "[view]") {
  Comparing comparing;
  // Many directions at full size: this one takes far longer than the messages.
  comparing.send({{"type", "edit"}, {"patch", {{"camera", {{"size", {160, 160}}}}}}});
  comparing.send({{"type", "compare"}});
  comparing.takeState("running");
  comparing.send({{"type", "edit"}, {"patch", {{"occlusion", {{"theta", 20}}}}}});
  CHECK(comparing.takeState("none")["text"] == "the scene has changed");
  comparing.send({{"type", "compare"}});
  comparing.takeState("running");
  comparing.send({{"type", "stopCompare"}});
  CHECK(comparing.takeState("none")["text"] == "stopped");
  // What was given up is silent, and the next one is whole.
  comparing.send({{"type", "edit"}, {"patch", {{"camera", {{"size", {16, 12}}}}, {"model", "emission"}}}});
  comparing.send({{"type", "compare"}});
  const Json next =
      comparing.page->take([](const Json& text) { return text["type"] == "comparison" && text["state"] != "running"; });
  CHECK(next["state"] == "done");
  CHECK(next["size"] == Json({16, 12}));
}

TEST_CASE("A reference that needs more memory than bricks may have is refused", "[view]") {
  const auto volume = std::make_shared<const Volume>(makeDense({100, 100, 100}), "dense");
  Scene scene = testScene();
  scene.bricks.budgetMiB = 1;
  ViewState state(scene, volume);
  // Blocks of 8^3 cells hold 9^3 floats and a byte a cell: 6.7 bytes a voxel.
  CHECK(referenceMemory(*volume, state.resolved()) == Approx(6.7e6).epsilon(0.01));
  ViewRenderer renderer(volume, EngineKind::cpu, {}, {});
  ReferenceComparison comparison([](std::uint64_t, const Json&) {});
  CHECK_THROWS_WITH(comparison.start(volume, state.resolved(), renderer),
                    "compare: the reference would take about 6 MiB, and bricks.budgetMiB is 1");
}
