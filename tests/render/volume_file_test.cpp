// Any input that can be converted can be looked at: what is read, and what is chosen on the way.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <fstream>

#include "support/temporary_folder.h"
#include "support/test_grids.h"
#include "umbrick/convert/convert.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/render/volume.h"
#include "umbrick/vdb/write_volume.h"

using namespace umbrick;
namespace fs = std::filesystem;
using Catch::Matchers::Contains;

namespace {

constexpr glm::i64vec3 kDims(9, 8, 7);

// Writes voxels of one byte, with a border of `border`.
void writeBytes(const fs::path& path, int border, int inside) {
  std::ofstream out(path, std::ios::binary);
  for (int z = 0; z < kDims.z; ++z)
    for (int y = 0; y < kDims.y; ++y)
      for (int x = 0; x < kDims.x; ++x) {
        const bool face = x == 0 || y == 0 || z == 0 || x == kDims.x - 1 || y == kDims.y - 1 || z == kDims.z - 1;
        out.put(static_cast<char>(face ? border : inside + x));
      }
}

VolumeReference rawBytes(const fs::path& path) {
  VolumeReference reference;
  reference.file = path;
  reference.raw.emplace();
  reference.raw->dims = kDims;
  reference.raw->type = "u8";
  reference.spacing = glm::dvec3(0.5, 1, 2);
  return reference;
}

bool sameVoxels(const ScalarGrid& a, const ScalarGrid& b) {
  for (int z = -1; z <= kDims.z; ++z)
    for (int y = -1; y <= kDims.y; ++y)
      for (int x = -1; x <= kDims.x; ++x) {
        const openvdb::Coord at(x, y, z);
        if (a.grid->tree().getValue(at) != b.grid->tree().getValue(at)) return false;
      }
  return a.grid->transform() == b.grid->transform();
}

void writeNamed(const fs::path& path, const std::vector<std::pair<std::string, ScalarGrid>>& grids) {
  std::vector<openvdb::FloatGrid::ConstPtr> named;
  for (const auto& [name, grid] : grids) {
    const auto copy = grid.grid->deepCopy();
    copy->setName(name);
    named.push_back(copy);
  }
  umbrick::writeGrids(path, named);
}

}  // namespace

TEST_CASE("A volume that is opened equals the one that is converted first", "[render]") {
  const TemporaryFolder folder;
  writeBytes(folder.path() / "v.raw", 0, 50);
  const Volume direct(rawBytes(folder.path() / "v.raw"));
  ConvertOptions options;
  options.source.open.raw = RawOptions{.dims = kDims, .type = VoxelType::u8, .spacing = {0.5, 1, 2}};
  convert({folder.path() / "v.raw"}, folder.path() / "v.vdb", options);
  VolumeReference converted;
  converted.file = folder.path() / "v.vdb";
  CHECK(sameVoxels(direct.grid(), Volume(converted).grid()));
  CHECK_FALSE(direct.foreign());
  CHECK_FALSE(Volume(converted).foreign());  // the file says what it was made from
}

TEST_CASE("Beyond its voxels a volume has the value of its border, which is said", "[render]") {
  const TemporaryFolder folder;
  writeBytes(folder.path() / "v.raw", 12, 50);
  const Volume volume(rawBytes(folder.path() / "v.raw"));
  CHECK(volume.grid().grid->background() == 12);
  REQUIRE(volume.notes().size() == 1);
  CHECK_THAT(volume.notes().front(), Contains("taken to be 12"));
  std::ofstream(folder.path() / "zero.raw", std::ios::binary) << std::string(9 * 8 * 7, '\0');
  CHECK_THROWS_WITH(Volume(rawBytes(folder.path() / "zero.raw")), Contains("all of its voxels are 0"));
  std::ofstream(folder.path() / "seven.raw", std::ios::binary) << std::string(9 * 8 * 7, '\7');
  const Volume seven(rawBytes(folder.path() / "seven.raw"));
  CHECK(seven.grid().grid->background() == 0);
  CHECK_THAT(seven.notes().front(), Contains("all of its voxels are 7"));
}

TEST_CASE("Of several grids density is taken, or else the first that holds something", "[render]") {
  const TemporaryFolder folder;
  const ScalarGrid full = makeFilled({4, 4, 4}, {0, 0, 0}, [](const glm::ivec3&) { return 2.0; });
  const ScalarGrid empty = makeGrid(openvdb::FloatGrid::create(0));
  VolumeReference file;
  file.file = folder.path() / "many.vdb";
  writeNamed(file.file, {{"heat", full}, {"density", full}, {"vel", full}});
  CHECK(Volume(file).source().grid == "density");
  CHECK_THAT(Volume(file).notes().front(), Contains("\"density\" of 3") && Contains("heat, vel"));
  writeNamed(file.file, {{"none", empty}, {"vel", full}, {"other", full}});
  CHECK(Volume(file).source().grid == "vel");
  CHECK_THAT(Volume(file).notes().front(), Contains("empty: none"));
  file.grid = "other";
  CHECK(Volume(file).notes().empty());
  file.grid = "nothing";
  CHECK_THROWS_WITH(Volume(file), Contains("no grid \"nothing\""));
  writeNamed(file.file, {{"a", empty}, {"b", empty}});
  file.grid.clear();
  CHECK_THROWS_WITH(Volume(file), Contains("no active voxel"));
}

TEST_CASE("Of numbered files the first is opened, and named", "[render]") {
  const TemporaryFolder folder;
  writeBytes(folder.path() / "f_0003.raw", 0, 30);
  writeBytes(folder.path() / "f_0010.raw", 0, 90);
  const Volume volume(rawBytes(folder.path() / "f_%04d.raw"));
  CHECK(volume.source().file == folder.path() / "f_0003.raw");
  CHECK(volume.grid().grid->tree().getValue(openvdb::Coord(4, 4, 4)) == 34);
  CHECK_THAT(volume.notes().front(), Contains("frame 3, the first of 2"));
}

TEST_CASE("What does not fit a volume is refused by the name of the field", "[render]") {
  const TemporaryFolder folder;
  writeBytes(folder.path() / "v.raw", 0, 50);
  VolumeReference reference = rawBytes(folder.path() / "v.raw");
  reference.raw->type = "u12";
  CHECK_THROWS_WITH(Volume(reference), Contains("volume.raw.type") && Contains("found 'u12'"));
  reference = rawBytes(folder.path() / "v.raw");
  reference.grid = "density";
  CHECK_THROWS_WITH(Volume(reference), Contains("volume.grid") && Contains("'density'"));
  reference = rawBytes(folder.path() / "v.raw");
  reference.raw.reset();
  reference.spacing.reset();
  CHECK_THROWS_AS(Volume(reference), InvalidArgument);
}

TEST_CASE("The camera frames what is shown, whatever else is active", "[render]") {
  const auto ball = [](const glm::ivec3& at) { return glm::length(glm::dvec3(at) - 20.0) < 8 ? 1.0 : 0.0; };
  const ScalarGrid padded = makeFilled(glm::ivec3(64), glm::ivec3(0), ball);
  const auto bare = padded.grid->deepCopy();
  for (auto voxel = bare->beginValueOn(); voxel; ++voxel)
    if (*voxel == 0) voxel.setValueOff();
  Scene scene;
  scene.transfer = TransferFunction({{0.2, {glm::dvec3(1), 0}}, {1, {glm::dvec3(1), 1}}});
  const Volume all(padded, "padded"), some(makeGrid(bare), "bare");
  CHECK(all.resolve(scene).camera == some.resolve(scene).camera);
  const Box bounds = all.visibleBounds(*scene.transfer);
  CHECK(bounds.centre() == glm::dvec3(20));
  CHECK(bounds.extent() == glm::dvec3(15));  // voxels 13 to 27, from face to face
  // A function that shows nothing leaves the whole volume to look at.
  scene.transfer = TransferFunction({{5, {glm::dvec3(1), 0}}, {6, {glm::dvec3(1), 1}}});
  CHECK(all.visibleBounds(*scene.transfer).extent() == glm::dvec3(64));
}

TEST_CASE("A function for shifted CT values is moved to HU, and the other way round", "[render]") {
  const TransferFunction bone = loadTransferFunction("ct-bone");
  REQUIRE(bone.unit() == kShiftedHounsfield);
  const TransferFunction hounsfield = inUnit(bone, kHounsfield);
  CHECK(hounsfield.unit() == kHounsfield);
  for (const double value : {1000.0, 1200.0, 1400.0, 2500.0}) CHECK(hounsfield(value - 1000) == bone(value));
  CHECK(inUnit(hounsfield, kShiftedHounsfield) == bone);
  CHECK(inUnit(bone, "") == bone);
  CHECK(inUnit(bone.windowed(0, 1), kHounsfield) == bone.windowed(0, 1));  // these are values of the grid already
}
