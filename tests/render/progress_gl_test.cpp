// How far a picture and a volume that is loaded are, and their end where the user wants none.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "support/files.h"
#include "support/gl_fixture.h"
#include "support/temporary_folder.h"
#include "support/test_grids.h"
#include "support/test_scenes.h"
#include "umbrick/core/error.h"
#include "umbrick/render/render.h"
#include "umbrick/shade/slice_renderer.h"
#include "umbrick/vdb/read_grid.h"
#include "umbrick/vdb/write_volume.h"

using namespace umbrick;

namespace {

struct Enough : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Returns a scene of so many slices that something is told of them, by a model and a method.
Scene sceneOf(Model model, Method method) {
  Scene scene;
  scene.transfer = TransferFunction({{0, {{0.9, 0.5, 0.2}, 0}}, {1, {{0.9, 0.5, 0.2}, 0.2}}});
  scene.camera.width = scene.camera.height = 40;
  scene.sampling.spacing = 0.25;
  scene.occlusion.ordinates.directions = 4;
  scene.model = model;
  scene.method = method;
  return scene;
}

void checkShares(const std::vector<double>& shares) {
  REQUIRE(shares.size() >= 2);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    CHECK(shares[i] > (i == 0 ? 0 : shares[i - 1]));
    CHECK(shares[i] <= 1);
  }
}

}  // namespace

TEST_CASE("A picture tells how far it is, ends where its caller throws, and the next one is whole", "[render][gl]") {
  const auto context = testContext();
  if (!context) return;
  const Volume volume(makeDense({40, 40, 40}, {3, -7, 1}), "dense");
  for (const auto& [model, method] :
       {std::pair{Model::emission, Method::ordinates}, {Model::cone, Method::dos}, {Model::cone, Method::ordinates}}) {
    CAPTURE(modelName(model), methodName(method));
    const Scene scene = sceneOf(model, method);
    const Image silent = VolumeView(*context, volume, scene).render().colour;
    std::vector<double> shares;
    bool stop = false;
    RenderOptions options;
    options.progress = [&](double share) {
      shares.push_back(share);
      if (stop && shares.size() == 2) throw Enough("enough");
    };
    VolumeView view(*context, volume, scene, options);
    // To wait for the driver between slices changes no pixel.
    CHECK((view.render().colour.pixels == silent.pixels));
    checkShares(shares);

    shares.clear();
    stop = true;
    CHECK_THROWS_AS(view.renderer().draw(), Enough);
    CHECK(shares.size() == 2);
    CHECK_THROWS_AS(view.renderer().read(), InvalidArgument);
    stop = false;
    CHECK((view.render().colour.pixels == silent.pixels));
  }
}

TEST_CASE("Slices that are cut and not drawn are probed as those of a picture", "[render][gl]") {
  const auto context = testContext();
  if (!context) return;
  const Volume volume(makeDense({30, 30, 30}, {3, -7, 1}), "dense");
  const ResolvedScene scene = volume.resolve(sceneOf(Model::emission, Method::ordinates));
  const auto bricks = volume.cut(scene);
  SliceRenderer drawn(*context, *bricks, scene), cut(*context, *bricks, scene);
  drawn.render();
  cut.cut();
  REQUIRE(cut.sliceDepths() == drawn.sliceDepths());
  REQUIRE(cut.sliceDepths().size() > 20);
  CHECK((cut.probe(20).pixels == drawn.probe(20).pixels));
  // There is no picture.
  CHECK_THROWS_AS(cut.read(), InvalidArgument);
}

TEST_CASE("A grid that is read tells its share, and is not read on where its caller throws", "[render]") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "noise.vdb";
  // Noise does not pack, so that the file has some mebibytes.
  writeGrids(file, {makeNoise({128, 128, 96}, {0, 0, 0}).grid});
  REQUIRE(std::filesystem::file_size(file) > 4u << 20);
  std::vector<double> shares;
  const Volume volume({file, ""}, [&](double share) { shares.push_back(share); });
  checkShares(shares);
  CHECK(volume.grid().grid->activeVoxelCount() == readScalarGrid(file).grid->activeVoxelCount());
  CHECK_THROWS_AS(readScalarGrid(file, {}, [](double) { throw IoError("enough"); }), IoError);
}
