// Which grid of a file emits light, and what is chosen of it.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <string>
#include <utility>
#include <vector>

#include "support/temporary_folder.h"
#include "support/test_grids.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/render/asked_scene.h"
#include "umbrick/render/render.h"
#include "umbrick/render/volume.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/vdb/write_volume.h"

using namespace umbrick;
using Catch::Matchers::Contains;

namespace {

using NamedGrids = std::vector<std::pair<std::string, ScalarGrid>>;

VolumeReference fileOf(const TemporaryFolder& folder, const NamedGrids& grids, const std::string& emission) {
  std::vector<openvdb::FloatGrid::ConstPtr> named;
  for (const auto& [name, grid] : grids) {
    const auto copy = grid.grid->deepCopy();
    copy->setName(name);
    named.push_back(copy);
  }
  VolumeReference reference;
  reference.file = folder.path() / "fire.vdb";
  writeGrids(reference.file, named);
  reference.emissionGrid = emission;
  return reference;
}

ScalarGrid hotGrid(double largest) {
  return makeFilled(glm::ivec3(12), {4, 0, 0}, [=](const glm::ivec3& p) { return largest * (p.x + 1) / 12; });
}

std::string joinedNotes(const Volume& volume) {
  std::string all;
  for (const std::string& note : volume.notes()) all += note + "\n";
  return all;
}

struct Asked : AskedScene {};

CompletedScene completedFor(const Asked& asked, const VolumeReference& reference) {
  Scene scene;
  scene.volume = reference;
  scene = askedScene(asked, scene, {.model = Model::emission, .emission = true});
  const Volume volume(scene.volume);
  return completedScene(asked, std::move(scene), volume);
}

std::string chosenOf(const CompletedScene& completed, const std::string& option) {
  for (const auto& [name, value] : completed.chosen)
    if (name == option) return value;
  return "nothing";
}

}  // namespace

TEST_CASE("A grid that emits is found by its name, in any case, or named, or left alone", "[render][emission]") {
  const TemporaryFolder folder;
  const NamedGrids grids{{"density", makeDense(glm::ivec3(16))}, {"fuel", hotGrid(1)}, {"Flames", hotGrid(2)}};
  const Volume found(fileOf(folder, grids, "auto"));
  CHECK(found.source().emissionGrid == "Flames");
  CHECK(found.source().grid == "density");
  REQUIRE(found.grid().emission);
  CHECK(found.grid().emission->tree().getValue({15, 3, 4}) == 2);
  CHECK(Volume(fileOf(folder, grids, "fuel")).grid().emission->tree().getValue({15, 3, 4}) == 1);
  CHECK_FALSE(Volume(fileOf(folder, grids, "")).grid().emission);
  CHECK_THROWS_WITH(Volume(fileOf(folder, grids, "plasma")), Contains("plasma"));
  // Both grids count for the place of the volume.
  CHECK(found.worldBounds().max == glm::dvec3(15));
  const Volume none(fileOf(folder, {{"density", makeDense(glm::ivec3(16))}}, "auto"));
  CHECK(none.source().emissionGrid.empty());
  CHECK_FALSE(emits([&] {
    Scene scene;
    scene.volume = none.source();
    return scene;
  }()));
}

TEST_CASE("A temperature of zeros and one on another lattice are said", "[render][emission]") {
  const TemporaryFolder folder;
  const ScalarGrid zeros = makeFilled(glm::ivec3(8), glm::ivec3(0), [](const glm::ivec3&) { return 0.0; });
  const NamedGrids cold{{"density", makeDense(glm::ivec3(16))}, {"temperature", zeros}, {"heat", hotGrid(1)}};
  const Volume skipped(fileOf(folder, cold, "auto"));
  CHECK(skipped.source().emissionGrid == "heat");
  CHECK_THAT(joinedNotes(skipped), Contains("\"temperature\" is nowhere above 0"));
  const ScalarGrid elsewhere = withTransform(hotGrid(900), glm::scale(glm::dmat4(1), glm::dvec3(0.75)));
  const Volume moved(fileOf(folder, {{"density", makeDense(glm::ivec3(16))}, {"temperature", elsewhere}}, "auto"));
  CHECK_THAT(joinedNotes(moved), Contains("\"temperature\" lies on a lattice of its own"));
  CHECK(moved.grid().emission->transform() == moved.grid().grid->transform());
}

TEST_CASE("Values that are no kelvin get a scale, or the one that would fit is said", "[render][emission]") {
  const TemporaryFolder folder;
  const NamedGrids grids{{"density", makeDense(glm::ivec3(16))}, {"temperature", hotGrid(1)}};
  Asked asked;
  const CompletedScene completed = completedFor(asked, fileOf(folder, grids, ""));
  CHECK(chosenOf(completed, "emission-grid") == "'temperature'");
  CHECK(chosenOf(completed, "emission-scale") == "2000");
  CHECK(completed.scene.emission.scale == 2000);
  CHECK(completed.scene.emission.intensity > 0);
  CHECK(completed.scene.background == glm::dvec3(0));
  // With the options that it names the same scene comes out.
  Asked repeated;
  repeated.fields["emission-scale"] = [](Scene& scene) { scene.emission.scale = 1; };
  const CompletedScene cold = completedFor(repeated, fileOf(folder, grids, "temperature"));
  CHECK(cold.scene.emission.scale == 1);
  std::string reasons;
  for (const std::string& reason : cold.reasons) reasons += reason;
  CHECK_THAT(reasons, Contains("nothing glows below 798 K: emission-scale 2000 would fit"));
  // Kelvin stay what they are.
  const CompletedScene kelvin =
      completedFor(asked, fileOf(folder, {{"density", makeDense(glm::ivec3(16))}, {"temperature", hotGrid(1800)}}, ""));
  CHECK(kelvin.scene.emission.scale == 1);
  CHECK(chosenOf(kelvin, "emission-scale") == "nothing");
  // Who gives a transfer function gets no fire that is not asked for.
  asked.transfer = "smoke";
  CHECK(completedFor(asked, fileOf(folder, grids, "")).scene.volume.emissionGrid.empty());
}

TEST_CASE("A file with fire makes a picture that glows in one call", "[render][emission]") {
  const TemporaryFolder folder;
  Scene scene;
  scene.volume = fileOf(folder, {{"density", makeDense(glm::ivec3(16))}, {"temperature", hotGrid(1800)}}, "auto");
  const Volume volume(scene.volume);
  scene.volume = volume.source();
  scene.camera.width = scene.camera.height = 16;
  scene.ambient = glm::dvec3(0);
  scene.emission.intensity = 0.2;
  const Picture picture = VolumeView(volume, scene).render();
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < picture.colour.pixels.size(); i += 4)
    for (int c = 0; c < 3; ++c) sum[c] += picture.colour.pixels[i + static_cast<std::size_t>(c)];
  CHECK(sum.r > 1);
  CHECK(sum.r > sum.g);
  CHECK(sum.g > sum.b);
}
