// Transfer functions that nobody has written: what a volume is taken for, and that what is shown is neither empty nor
// solid.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/render/suggest_transfer.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "support/test_grids.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/grid/value_survey.h"

using namespace umbrick;

namespace {

// A volume as a scanner gives it: with metadata that say where it comes from.
Volume scanned(const ScalarGrid& grid, const std::string& unit = {}, double voxel = 1) {
  const auto copy = grid.grid->deepCopy();
  copy->insertMeta("source_format", openvdb::StringMetadata("test"));
  if (!unit.empty()) copy->insertMeta("value_unit", openvdb::StringMetadata(unit));
  return Volume(withTransform(makeGrid(copy), glm::dmat4(glm::dmat3(voxel))), "test");
}

double distance(const glm::ivec3& at, double centre) { return glm::length(glm::dvec3(at) - centre); }

// A head: air, tissue and bone around it, with noise. @param air  its value
ScalarGrid head(double air) {
  return makeFilled(
      glm::ivec3(64), glm::ivec3(0),
      [=, random = TestRandom(4)](const glm::ivec3& at) mutable {
        const double r = distance(at, 32);
        const double value = r > 28 ? 0 : r > 24 ? 1040 : r > 20 ? 1900 : 1030;
        return std::floor(air + std::max(0.0, value + random.uniform(-15, 15)));
      },
      static_cast<float>(air));
}

// The mean optical depth of columns that are not empty.
double meanDepth(const Volume& volume, const TransferFunction& transfer) {
  const std::vector<double> columns =
      columnIntegrals(volume.grid(), 1, [&](double value) { return transfer(value).sigma_t; });
  return std::accumulate(columns.begin(), columns.end(), 0.0) / static_cast<double>(columns.size());
}

}  // namespace

TEST_CASE("CT is known by its unit, or by its values with air at -1000 or at 0", "[render]") {
  const Volume hounsfield = scanned(head(-1000), "HU"), unnamed = scanned(head(-1000)), shifted = scanned(head(0));
  for (const Volume* volume : {&hounsfield, &unnamed, &shifted}) {
    const SuggestedTransfer suggested = suggestTransfer(*volume);
    CHECK(suggested.kind == VolumeKind::ct);
    const double air = volume == &shifted ? 0 : -1000;
    CHECK(suggested.transfer.unit() == (volume == &shifted ? kShiftedHounsfield : kHounsfield));
    CHECK(suggested.transfer(air).sigma_t == 0);
    CHECK(suggested.transfer(air + 600).sigma_t == 0);  // lung
    const double tissue = suggested.transfer(air + 1040).sigma_t, bone = suggested.transfer(air + 1900).sigma_t;
    CHECK(tissue > 0);
    CHECK(bone > 10 * tissue);
  }
}

TEST_CASE("A level set shows its surface and a mask the middle between in and out", "[render]") {
  const Volume sphere(makeSphereLevelSet(20, 0.25), "sphere");
  const SuggestedTransfer surface = suggestTransfer(sphere);
  CHECK(surface.kind == VolumeKind::levelSet);
  CHECK(surface.transfer(0.5).sigma_t == 0);
  CHECK(surface.transfer(-0.5).sigma_t > 1 / 0.25);
  const Volume mask = scanned(makeFilled(glm::ivec3(40), glm::ivec3(0),
                                         [](const glm::ivec3& at) { return distance(at, 20) < 12 ? 4.0 : 0.0; }));
  const SuggestedTransfer middle = suggestTransfer(mask);
  CHECK(middle.kind == VolumeKind::labels);
  CHECK(middle.transfer(0.5).sigma_t == 0);
  CHECK(middle.transfer(2).sigma_t > 0);
  CHECK(middle.transfer(3.5).sigma_t == middle.transfer(4).sigma_t);
}

TEST_CASE("Labels have colours of their own and nothing between them", "[render]") {
  const auto label = [](const glm::ivec3& at) {
    const int cell = at.x / 7 + 6 * (at.y / 7) + 36 * (at.z / 7);
    return double(cell * 7 % 13);
  };
  const SuggestedTransfer suggested = suggestTransfer(scanned(makeFilled(glm::ivec3(40), glm::ivec3(0), label)));
  CHECK(suggested.kind == VolumeKind::labels);
  for (int i = 1; i <= 12; ++i) {
    CHECK(suggested.transfer(i).sigma_t > 0);
    CHECK(suggested.transfer(i + 0.5).sigma_t == 0);
    for (int j = 1; j < i; ++j) CHECK(glm::length(suggested.transfer(i).albedo - suggested.transfer(j).albedo) > 0.05);
  }
}

TEST_CASE("Regions of one value each become fainter from the inside out", "[render]") {
  const auto nested = [random = TestRandom(9)](const glm::ivec3& at) mutable {
    const double r = distance(at, 36), noise = random.uniform(-2, 2);
    // Values run from one region to the next within three voxels, as in any image of limited resolution.
    const auto step = [&](double edge) { return std::clamp((edge - r) / 3 + 0.5, 0.0, 1.0); };
    return r > 33 ? 0.0 : std::round(70 * step(30) + 60 * step(20) + 90 * step(10) + noise * step(31));
  };
  const SuggestedTransfer suggested = suggestTransfer(scanned(makeFilled(glm::ivec3(72), glm::ivec3(0), nested)));
  CHECK(suggested.kind == VolumeKind::materials);
  const double outer = suggested.transfer(70).sigma_t, middle = suggested.transfer(130).sigma_t,
               inner = suggested.transfer(220).sigma_t;
  CHECK(suggested.transfer(3).sigma_t == 0);
  CHECK(outer > 0);
  CHECK(middle > 1.5 * outer);
  CHECK(inner > 3 * middle);
}

TEST_CASE("Fog has the same optical depth in voxels of any size and values of any scale", "[render]") {
  std::vector<double> depths;
  for (const double voxel : {1e-4, 1.0, 1e6})
    for (const double scale : {1e-20, 1.0, 1e20}) {
      const ScalarGrid fog = makeSparse({0, 0, 0}, 3, 12, 96);
      const auto scaled = fog.grid->deepCopy();
      for (auto value = scaled->beginValueOn(); value; ++value) value.setValue(static_cast<float>(*value * scale));
      const Volume volume = scanned(withTransform(makeGrid(scaled), glm::dmat4(glm::dmat3(voxel))), {}, voxel);
      const SuggestedTransfer suggested = suggestTransfer(volume);
      depths.push_back(meanDepth(volume, suggested.transfer));
    }
  for (const double depth : depths) CHECK(depth == Approx(depths.front()).epsilon(0.01));
  CHECK(depths.front() > 0.5);
  CHECK(depths.front() < 10);
}

TEST_CASE("Values on both sides of zero have two colours and a clear middle", "[render]") {
  const auto wave = [](const glm::ivec3& at) {
    return std::sin(at.x / 5.0) * std::cos(at.y / 6.0) * std::sin(at.z / 7.0);
  };
  const SuggestedTransfer suggested = suggestTransfer(scanned(makeFilled(glm::ivec3(48), glm::ivec3(0), wave)));
  CHECK(suggested.kind == VolumeKind::signedField);
  CHECK(suggested.transfer(0).sigma_t == 0);
  CHECK(suggested.transfer(0.9).sigma_t == Approx(suggested.transfer(-0.9).sigma_t).epsilon(1e-6));
  CHECK(suggested.transfer(0.9).albedo.r > suggested.transfer(0.9).albedo.b);
  CHECK(suggested.transfer(-0.9).albedo.b > suggested.transfer(-0.9).albedo.r);
}

TEST_CASE("A scene without a transfer function is given the suggested one", "[render]") {
  const Volume volume = scanned(head(0));
  CHECK(volume.resolve(Scene{}).transfer == suggestTransfer(volume).transfer);
}

TEST_CASE("A preset for CT fits volumes in HU, stated or not, and volumes from 0 on", "[render]") {
  const TransferFunction bone = loadTransferFunction("ct-bone");
  for (const double air : {-1000.0, 0.0})
    for (const char* unit : {"", "HU"}) {
      if (air == 0 && *unit != '\0') continue;
      const TransferFunction found = fitted(bone, scanned(head(air), unit));
      CHECK(found(air + 1900) == bone(1900));
      CHECK(found(air + 1040).sigma_t == 0);
    }
}
