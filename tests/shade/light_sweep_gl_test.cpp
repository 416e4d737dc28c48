// Light that compute shaders sweep: closed forms, the CPU's light voxel by voxel, and what must not change it.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <glm/vector_relational.hpp>

#include "shade/gl_light_sweep.h"
#include "shade/hard_case.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/source_filters.h"
#include "umbrick/ingest/raw_volume.h"
#include "umbrick/optics/directions.h"
#include "umbrick/shade/ray_caster.h"

using namespace umbrick;

namespace {

constexpr std::uint64_t kPlenty = std::uint64_t{1} << 32;

template <class Visit>
void forEachOf(const glm::ivec3& edge, const Visit& visit) {
  for (int z = 0; z < edge.z; ++z)
    for (int y = 0; y < edge.y; ++y)
      for (int x = 0; x < edge.x; ++x) visit(glm::ivec3(x, y, z));
}

/// The light of a medium in the bricks of its cells, swept by OpenGL.
class GlLight {
 public:
  GlLight(const GlContext& context, const Bricks& volume, LightMedium& medium, bool background = false,
          VoxelFormat format = VoxelFormat::float32, int maxTextureEdge = 0)
      : gl_(context.gl()),
        resident_(context, volume, {.format = format, .maxTextureBytes = kPlenty, .maxTextureEdge = maxTextureEdge}) {
    std::vector<std::int32_t> shown;
    for (std::size_t i = 0; i < volume.bricks.size(); ++i)
      if (!medium.transfer.isTransparent(volume.bricks[i].value, volume.bricks[i].gradient))
        shown.push_back(static_cast<std::int32_t>(i));
    if (background) shown.insert(shown.end(), resident_.background().begin(), resident_.background().end());
    selection_.emplace(resident_.atlas(), shown, SlotSharing::apart);
    REQUIRE(selection_->reserve());
    std::vector<std::int32_t> all(shown.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::int32_t>(i);
    selection_->require(all);
    medium.cells.assign(selection_->origins().begin(), selection_->origins().end());
    channels_ = isColoured(medium.directions) ? 3 : 1;
    CHECK(GlLightSweep::refusal(resident_, *selection_, medium).empty());
    textures_.clear(gl_, resident_.atlas(), channels_);
    const TransferLookup transfer(gl_, medium.transfer, SamplingOptions{}, volume, format);
    sweep_.sweep(resident_, *selection_, medium, transfer, textures_);
    const glm::ivec3 size = resident_.atlas().textureSize();
    for (int i = 0; i < resident_.atlas().textureCount(); ++i) {
      std::vector<float>& texels = texels_.emplace_back(4 * static_cast<std::size_t>(size.x * size.y * size.z));
      gl_.GetTextureImage(textures_.texture(i), 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(4 * texels.size()),
                          texels.data());
    }
  }
  int channels() const { return channels_; }
  const GlLightSweep& sweep() const { return sweep_; }
  int textures() const { return static_cast<int>(texels_.size()); }
  std::span<const glm::ivec3> origins() const { return selection_->origins(); }

  /// Returns the light of a brick and its apron, as LightVolume::read() does.
  std::vector<float> block(std::size_t position) const {
    const BrickAtlas::Slot slot = selection_->slot(static_cast<std::int32_t>(position));
    const glm::ivec3 edge = resident_.volume().layout.edge(), size = resident_.atlas().textureSize();
    std::vector<float> light;
    forEachOf(edge, [&](const glm::ivec3& i) {
      const glm::ivec3 texel = slot.origin + i;
      const auto at = 4 * static_cast<std::size_t>((texel.z * size.y + texel.y) * size.x + texel.x);
      for (std::size_t c = 0; c < static_cast<std::size_t>(channels_); ++c)
        light.push_back(texels_[static_cast<std::size_t>(slot.texture)][at + c]);
    });
    return light;
  }
  /// Returns the light of a voxel that a brick owns, of the first channel.
  double at(const glm::ivec3& voxel) const {
    const BrickLayout& layout = resident_.volume().layout;
    for (std::size_t i = 0; i < origins().size(); ++i) {
      const glm::ivec3 p = voxel - origins()[i], edge = layout.edge(), q = p + layout.apron;
      if (glm::any(glm::lessThan(p, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(p, layout.interior))) continue;
      return block(i)[static_cast<std::size_t>(channels_ * ((q.z * edge.y + q.y) * edge.x + q.x))];
    }
    return std::nan("");
  }

 private:
  const GlFunctions& gl_;
  ResidentVolume resident_;
  std::optional<BrickSelection> selection_;
  int channels_ = 1;
  LightTextures textures_;
  GlLightSweep sweep_;
  std::vector<std::vector<float>> texels_;
};

struct Difference {
  double largest = 0;
  std::size_t voxels = 0, lit = 0;  // that are compared; that get some light but not all
};

/// Tells which voxels of a brick and its apron somebody reads the light of: those next to medium, and no farther
/// outside of planes than a point inside of them reads.
std::vector<bool> readVoxels(const Bricks& volume, const LightMedium& medium, const glm::ivec3& origin) {
  const glm::ivec3 edge = volume.layout.edge();
  std::vector<float> values(volume.layout.voxels());
  volume.read(origin, values);
  const auto at = [&](const glm::ivec3& i) { return static_cast<std::size_t>((i.z * edge.y + i.y) * edge.x + i.x); };
  std::vector<bool> isRead(values.size());
  forEachOf(edge, [&](const glm::ivec3& i) {
    const glm::dvec3 place(origin - volume.layout.apron + i);
    for (const glm::dvec4& plane : medium.planes) {
      const glm::dvec3 normal(plane), size = glm::abs(normal);
      if (glm::dot(normal, place) + plane.w < -(size.x + size.y + size.z)) return;
    }
    // Medium of the cells around the voxel, each by itself.
    for (unsigned cell = 0; cell < 8; ++cell) {
      const glm::ivec3 first = i - glm::ivec3(cell & 1, cell >> 1 & 1, cell >> 2);
      if (glm::any(glm::lessThan(first, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(first + 1, edge))) continue;
      Range range;
      for (unsigned corner = 0; corner < 8; ++corner)
        range.include(values[at(first + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2))]);
      if (!medium.transfer.isTransparent(range, volume.gradient)) isRead[at(i)] = true;
    }
  });
  return isRead;
}

/// Compares the light of all voxels that somebody reads.
Difference againstCpu(const Bricks& volume, const LightMedium& medium, const GlLight& gl) {
  LightVolume cpu(volume);
  cpu.update(medium, kPlenty);
  REQUIRE(cpu.channels() == gl.channels());
  const auto channels = static_cast<std::size_t>(cpu.channels());
  std::vector<float> block(volume.layout.voxels() * channels);
  Difference difference;
  for (std::size_t i = 0; i < gl.origins().size(); ++i) {
    cpu.read(gl.origins()[i], block);
    const std::vector<bool> isRead = readVoxels(volume, medium, gl.origins()[i]);
    const std::vector<float> other = gl.block(i);
    for (std::size_t k = 0; k < block.size(); ++k) {
      if (!isRead[k / channels]) continue;
      ++difference.voxels;
      if (block[k] > 0.02 && block[k] < 0.98) ++difference.lit;
      difference.largest = std::max(difference.largest, double{std::abs(block[k] - other[k])});
    }
  }
  return difference;
}

// How far the engines' light may be apart. The CPU keeps light in steps of 1/65535, or of as much of the most that
// there is beyond planes; it rounds by half of one, but what is dark counts as a whole step. It adds directions in
// units of 2^-22. Both round values to steps of the table, and where single precision puts one to other sides of a
// half, the extinction between two slices is that of ends half a step apart: of the four paths that a voxel takes the
// mean of, one or two of some direction are off so. Optical depths are sums of some hundred numbers in single
// precision.
double farApart(const Bricks& volume, const LightMedium& medium, double most = 1) {
  const ExtinctionTable table(medium.transfer);
  double steepest = 0, brightest = 0, length = 0;
  for (int i = 0; i < ExtinctionTable::kSteps; ++i)
    steepest = std::max(steepest, std::abs(double{table.means()[i + 1]} - table.means()[i]));
  const glm::dvec3 whole = wholeLight(medium.directions);
  for (const LightDirection& light : medium.directions)
    for (int c = 0; c < 3; ++c) brightest = std::max(brightest, light.radiance[c] / whole[c]);
  for (const SweepSide& side : sweepSides(medium.directions, whole, volume.indexToWorld))
    for (const SweptDirection& direction : side.directions) length = std::max(length, direction.length);
  return most / 65535 + static_cast<double>(medium.directions.size()) * 0x1p-22 + 0.5 * steepest * length * brightest +
         4e-6;
}

LightMedium mediumOf(const TransferFunction& transfer, std::vector<LightDirection> directions) {
  return {transfer, std::move(directions), {}, {}, 0};
}

std::vector<LightDirection> randomLights(TestRandom& random, int count, bool coloured) {
  std::vector<LightDirection> lights;
  while (static_cast<int>(lights.size()) < count) {
    const glm::dvec3 p = random.point(glm::dvec3(-1), glm::dvec3(1));
    if (glm::length(p) < 0.1 || glm::length(p) > 1) continue;
    const double radiance = random.uniform(0.2, 1);
    lights.push_back(
        {glm::normalize(p), coloured ? radiance * random.point(glm::dvec3(0.1), glm::dvec3(1)) : glm::dvec3(radiance)});
  }
  return lights;
}

// A number in [0, 1) for each voxel: a hash, since a generator of random numbers takes long to seed.
double noiseAt(const glm::ivec3& i, unsigned seed) {
  unsigned h = seed + static_cast<unsigned>((i.z * 64 + i.y) * 64 + i.x);
  for (int round = 0; round < 2; ++round) h = (h ^ h >> 16) * 0x45d9f3bu;
  return (h ^ h >> 16) / 4294967296.0;
}

// Blobs and empty space, rough enough that no two voxels have one value.
FieldBricks::Field roughBlobs(unsigned seed) {
  return [seed](const glm::ivec3& i) {
    const double blob = coneAt(i, {{13, 12, 22, 11}, {30, 24, 14, 12}, {20, 36, 33, 8}});
    return blob > 0 ? blob * (0.6 + 0.8 * noiseAt(i, seed)) : 0.0;
  };
}

// A solid that ends before the bricks do: beyond them there is nothing that light could meet.
double solid(const glm::ivec3& i) {
  return glm::all(glm::greaterThan(i, glm::ivec3(0))) && glm::all(glm::lessThan(i, glm::ivec3(47))) ? 1 : 0;
}

const IndexBox kBox{glm::ivec3(0), glm::ivec3(47)};

}  // namespace

TEST_CASE("OpenGL gives voxels the light that the CPU gives them", "[shade][light-sweep][gl]") {
  const auto context = testContext();
  if (!context) return;
  TestRandom random(18);
  for (const auto& [interior, apron] : {std::pair{8, 1}, {16, 2}, {24, 1}})
    for (const bool coloured : {false, true}) {
      glm::dmat4 world(1);  // sheared, mirrored, and of voxels that are no cubes
      world[0] = {-0.9, 0.1, 0, 0};
      world[1] = {0.2, 1.1, -0.1, 0};
      world[2] = {0, 0.05, 1.4, 0};
      const FieldBricks volume(
          roughBlobs(7), kBox,
          {.interior = interior, .apron = apron, .indexToWorld = interior == 16 ? world : glm::dmat4(1)});
      LightMedium medium = mediumOf(ramp(0.4, 0.1), randomLights(random, 9, coloured));
      const GlLight gl(*context, volume, medium);
      const Difference difference = againstCpu(volume, medium, gl);
      INFO("interior " << interior << ", coloured " << coloured << ", voxels " << difference.voxels);
      CHECK(difference.lit > difference.voxels / 10);
      CHECK(difference.largest < farApart(volume, medium));
      CHECK(gl.sweep().updates() > 0);
    }
}

TEST_CASE("Light of OpenGL is the CPU's in texels of 16 bits", "[shade][light-sweep][gl]") {
  const auto context = testContext();
  if (!context) return;
  // Whole numbers, of which the first control point is one: no voxel of that value may count as medium.
  FieldBricks volume([](const glm::ivec3& i) { return std::floor(900 * roughBlobs(3)(i)) - 200; }, kBox,
                     {.interior = 16, .background = -200});
  volume.exactFormat = VoxelFormat::unorm16;
  TestRandom random(5);
  for (const double first : {-150.0, 40.0}) {
    const TransferFunction transfer({{first, {kAlbedo, 0}},
                                     {first + 1, {kAlbedo, 0.3}},
                                     {220, {kAlbedo, 0.05}},
                                     {300, {kAlbedo, 0}},
                                     {500, {kAlbedo, 0.8}}});
    LightMedium medium = mediumOf(transfer, randomLights(random, 6, false));
    const GlLight gl(*context, volume, medium, false, VoxelFormat::unorm16);
    CHECK(againstCpu(volume, medium, gl).largest < farApart(volume, medium));
  }
}

TEST_CASE("Light of OpenGL is the CPU's for functions of value and gradient", "[shade][light-sweep][gl]") {
  const auto context = testContext();
  if (!context) return;
  const FieldBricks volume(roughBlobs(8), kBox, {.interior = 16, .gradients = true});
  const Medium none{kAlbedo, 0};
  // Where values are steep there is less medium, and none where they are flat.
  const TransferFunction transfer(
      {0.05, 0.4, 0.9}, {0.05, 0.2, 0.5},
      {none, none, none, none, {kAlbedo, 0.3}, {kAlbedo, 0.7}, none, {kAlbedo, 0.1}, {kAlbedo, 0.2}});
  TestRandom random(11);
  for (const bool cut : {false, true}) {
    LightMedium medium = mediumOf(transfer, randomLights(random, 6, cut));
    if (cut) medium.planes.emplace_back(-0.8113, 0.3019, 0.5227, 10.3);
    const GlLight gl(*context, volume, medium);
    const Difference difference = againstCpu(volume, medium, gl);
    CHECK(difference.lit > difference.voxels / 10);
    CHECK(difference.largest < farApart(volume, medium, cut ? 3 : 1) + 2e-5);
  }
}

TEST_CASE("Planes cut the light of OpenGL as they cut the CPU's", "[shade][light-sweep][gl]") {
  const auto context = testContext();
  if (!context) return;
  TestRandom random(31);
  for (const int interior : {8, 24}) {
    const FieldBricks volume([](const glm::ivec3& i) { return i.x < 30 ? solid(i) : roughBlobs(1)(i); }, kBox,
                             {.interior = interior});
    for (int i = 0; i < 3; ++i) {
      LightMedium medium = mediumOf(ramp(0.25), randomLights(random, 7, i == 1));
      const glm::dvec3 normal = glm::normalize(random.point(glm::dvec3(-1), glm::dvec3(1)));
      medium.planes.emplace_back(normal, -glm::dot(normal, glm::dvec3(20.3, 23.1, 22.2)));
      medium.planes.emplace_back(0, 0, -1, 40.3);
      medium.planes.emplace_back(1, 0, 0, -3.7);
      const GlLight gl(*context, volume, medium);
      const Difference difference = againstCpu(volume, medium, gl);
      CHECK(difference.lit > difference.voxels / 10);
      // Light beyond a cut is at most that of three voxels of depth more, so that steps are as much larger. Where a
      // plane is, is known to 2^-24 of 64 voxels, times the extinction, times the slope of what goes on beyond it.
      CHECK(difference.largest < farApart(volume, medium, 3) + 2e-5);
    }
  }
}

TEST_CASE("OpenGL lights a visible background from the box where it ends", "[shade][light-sweep][gl]") {
  const auto context = testContext();
  if (!context) return;
  const FieldBricks volume(roughBlobs(2), {glm::ivec3(0), glm::ivec3(31)}, {.interior = 8});
  const TransferFunction transfer({{0, {kAlbedo, 0.15}}, {1, {kAlbedo, 0.6}}});
  TestRandom random(3);
  LightMedium medium = mediumOf(transfer, randomLights(random, 8, false));
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec4 low(0), high(0);
    low[axis] = 1;
    low.w = 0.5;
    high[axis] = -1;
    high.w = 31.5;
    medium.planes.push_back(low);
    medium.planes.push_back(high);
  }
  const GlLight gl(*context, volume, medium, true);
  CHECK(againstCpu(volume, medium, gl).largest < farApart(volume, medium, 3) + 2e-5);
}

// Along an axis paths go through voxels, so that nothing is interpolated: exp(-tau) of the way behind the face.
TEST_CASE("Light of OpenGL falls as exp(-tau) in a solid from before, beside and behind", "[shade][light-sweep][gl]") {
  const auto context = testContext();
  if (!context) return;
  const double sigma_t = 0.15;
  const FieldBricks volume([](const glm::ivec3&) { return 1.0; }, kBox, {.interior = 16});
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {1.0, -1.0}) {
      glm::dvec3 direction(0);
      direction[axis] = side;
      LightMedium medium = mediumOf(ramp(sigma_t), {{direction, glm::dvec3(1)}});
      // A plane of which the medium is on the far side, beyond a quarter of a voxel.
      glm::dvec4 plane(0);
      plane[axis] = -side;
      plane.w = side > 0 ? 35.25 : -12.75;
      medium.planes.push_back(plane);
      const GlLight gl(*context, volume, medium);
      for (int way = 0; way < 20; ++way) {
        glm::ivec3 voxel(19, 27, 23);
        voxel[axis] = side > 0 ? 35 - way : 13 + way;
        INFO("axis " << axis << ", side " << side << ", voxels behind the face " << way);
        CHECK(gl.at(voxel) == Approx(std::exp(-sigma_t * (way + 0.25))).margin(2e-6));
      }
      // What a face casts behind the solid: the block of 48 voxels in front of its border.
      glm::ivec3 last(24);
      last[axis] = side > 0 ? 0 : 47;
      const double depth = side > 0 ? 35.25 : 47 - 12.75;
      CHECK(gl.at(last) == Approx(std::exp(-sigma_t * depth)).margin(2e-6));
    }
}

TEST_CASE("Light of OpenGL is the same however the volume is cut into bricks", "[shade][light-sweep][gl]") {
  const auto context = testContext();
  if (!context) return;
  TestRandom random(77);
  const std::vector<LightDirection> lights = randomLights(random, 20, false);
  for (const bool cut : {false, true}) {
    const auto swept = [&](const FieldBricks& volume) {
      LightMedium medium = mediumOf(ramp(0.4, 0.05), lights);
      if (cut) medium.planes.emplace_back(0.6, 0.48, -0.64, 3.3);
      return std::make_unique<GlLight>(*context, volume, medium);
    };
    const FieldBricks one(roughBlobs(4), kBox, {.interior = 48}),
        many(roughBlobs(4), kBox, {.interior = 8, .apron = 2});
    const auto whole = swept(one), bricked = swept(many);
    double largest = 0, least = 1;
    const std::vector<float> all = whole->block(0);
    for (std::size_t i = 0; i < bricked->origins().size(); ++i) {
      const std::vector<float> block = bricked->block(i);
      for (int z = 0; z < 8; ++z)
        for (int y = 0; y < 8; ++y)
          for (int x = 0; x < 8; ++x) {
            const glm::ivec3 p(x, y, z), q = p + bricked->origins()[i];
            const float a = block[static_cast<std::size_t>(((z + 2) * 12 + y + 2) * 12 + x + 2)];
            const float b = all[static_cast<std::size_t>(((q.z + 1) * 50 + q.y + 1) * 50 + q.x + 1)];
            if (a == 0 || b == 0) continue;  // left out
            largest = std::max(largest, double{std::abs(a - b)});
            least = std::min(least, double{a});
          }
    }
    CHECK(least < 0.5);
    // Directions are the same, in the same order: nothing but the place of planes is rounded differently.
    CHECK(largest < (cut ? 1e-5 : 1e-6));
  }
}

// A piece of the CT from the forehead to the mouth, which its own border cuts: skin, bone and air, in whole numbers.
TEST_CASE("OpenGL lights the bundled head as the CPU does", "[shade][light-sweep][gl]") {
  const auto context = testContext();
  if (!context) return;
  RawOptions raw;
  raw.dims = {256, 256, 94};
  raw.type = VoxelType::u16;
  raw.bitsStored = 15;
  raw.spacing = {0.8, 0.8, 1.5};
  const auto source = cropSource(openRaw(std::string(UMBRICK_ASSETS) + "/headsq_256x256x94_uint16le.raw.gz", raw),
                                 {{70, 20, 20}, {169, 99, 79}});
  const auto volume = brickGrid(ScalarGrid{buildGrid(*source).grid, "density"}, {24, 1, false});
  const VoxelFormat format = parseVoxelFormat("auto", *volume);
  CHECK(format == VoxelFormat::unorm16);
  TestRandom random(12);
  for (const bool cut : {false, true}) {
    LightMedium medium = mediumOf(loadTransferFunction("ct-head"), randomLights(random, 8, false));
    if (cut) medium.planes.emplace_back(-0.8113, 0.3019, 0.5227, 60.1);
    const GlLight gl(*context, *volume, medium, false, format);
    const Difference difference = againstCpu(*volume, medium, gl);
    INFO("voxels " << difference.voxels << ", between light and dark " << difference.lit);
    CHECK(difference.lit > 10'000);
    CHECK(difference.largest < farApart(*volume, medium, cut ? 3 : 1) + (cut ? 2e-5 : 0));
  }
}

TEST_CASE("Bricks of several textures get the light of one", "[shade][light-sweep][gl]") {
  const auto context = testContext();
  if (!context) return;
  const FieldBricks volume(roughBlobs(6), kBox, {.interior = 8});
  TestRandom random(9);
  LightMedium medium = mediumOf(ramp(0.5), randomLights(random, 5, false));
  const GlLight gl(*context, volume, medium, false, VoxelFormat::float32, 40);  // 4 bricks along each axis
  CHECK(gl.textures() > 1);
  CHECK(againstCpu(volume, medium, gl).largest < farApart(volume, medium));
}

namespace {

RenderOptions onGl() {
  RenderOptions options;
  options.visibilityAndDepth = true;
  options.lightSweep = LightSweep::gl;
  return options;
}

ResolvedScene litScene(Model model, const Camera& camera) {
  ResolvedScene scene = plainScene(ramp(0.5), camera, 1.25);
  scene.model = model;
  scene.method = Method::lightVolume;
  scene.occlusion.aperture = 60 * kDegree;
  scene.occlusion.ordinates.directions = 14;
  scene.bricks.interior = 8;
  scene.lights = {{LightFrame::world, ConeLight{{0.3, -0.9, -0.4}, 0.4, glm::dvec3(1, 0.8, 0.5)}},
                  {LightFrame::view, ConeLight{{-0.6, 0, 1}, 0.3, glm::dvec3(0.1, 0.3, 1.5)}}};
  return scene;
}

}  // namespace

TEST_CASE("Pictures are the same whichever engine sweeps the light", "[shade][light-sweep][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  for (const Model model : {Model::cone, Model::lights, Model::ambient})
    for (const bool clipped : {false, true}) {
      ResolvedScene scene = litScene(model, smallCameras(32).back());
      if (clipped) scene.clipPlanes.emplace_back(glm::normalize(glm::dvec3(-0.5, -0.2, -0.9)), 17.3);
      INFO("model " << static_cast<int>(model) << ", clipped " << clipped);
      const auto bricks = bricksFor(grid, scene);
      const Picture cpu = renderPicture(*context, *bricks, scene, kLayers);
      const Picture gl = renderPicture(*context, *bricks, scene, onGl());
      CHECK_FALSE(cpu.stats.lightOnGl);  // this context runs in software, or the test compares nothing
      CHECK(gl.stats.lightOnGl);
      CHECK(gl.stats.lightNote.empty());
      CHECK(gl.stats.directions == cpu.stats.directions);
      CHECK(gl.stats.lightSpacing == 1);
      // As light, which is of two numbers per pixel at most 2.5 times as bright as 1.
      CHECK(largestAlpha(cpu.colour) > 0.3);
      CHECK(maxDifference(cpu.colour, gl.colour) < 1e-4);
      CHECK(maxDifference(cpu.visibility, gl.visibility) < 1e-4);
      RayCaster rays(*context, *bricks, scene, onGl());
      const Picture cast = rays.render();
      CHECK(cast.stats.lightOnGl);
      CHECK(maxDifference(cast.colour, RayCaster(*context, *bricks, scene).render().colour) < 1e-4);
    }
}

TEST_CASE("OpenGL sweeps light again where it depends on what changed", "[shade][light-sweep][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  ResolvedScene scene = litScene(Model::lights, smallCameras().front());
  scene.lights.pop_back();
  const auto bricks = bricksFor(grid, scene);
  ResidentVolume resident(*context, *bricks, atlasOptions(scene, *bricks));
  SliceRenderer renderer(resident, scene, onGl());
  const auto swept = [&] {
    const RenderStats stats = renderer.render().stats;
    CHECK(stats.lightOnGl);
    return stats.lightMs > 0;
  };
  const auto isFresh = [&] {
    return maxDifference(renderer.render().colour, renderPicture(*context, *bricks, renderer.scene(), onGl()).colour) <
           2e-4;  // a driver may find texels elsewhere in a smaller texture by a little
  };
  CHECK(swept());
  CHECK_FALSE(swept());
  renderer.setCamera(orthographicCamera({25, 28, 40}, kSmallCentre, 30, 32));
  CHECK_FALSE(swept());
  CHECK(isFresh());
  renderer.setTransfer(ramp(0.7, 0.3));
  CHECK(swept());
  CHECK(isFresh());
  renderer.setClip({ClipPlane(0, 0, -1, 15)}, {});
  CHECK(swept());
  CHECK(isFresh());
  // The cone around the view axis moves with the camera.
  renderer.setLight(Model::cone, Method::lightVolume, {});
  CHECK(swept());
  CHECK_FALSE(swept());
  renderer.setCamera(orthographicCamera({30, 22, 40}, kSmallCentre, 30, 32));
  CHECK(swept());
  CHECK(isFresh());
  // Another renderer of the volume shares slots of bricks and moves them.
  ResolvedScene plain = scene;
  plain.model = Model::emission;
  plain.transfer = ramp(0.2);
  SliceRenderer(resident, plain).render();
  CHECK(isFresh());
}

TEST_CASE("Light that OpenGL cannot sweep comes from the CPU, and the statistics say why", "[shade][light-sweep][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  ResolvedScene scene = litScene(Model::cone, smallCameras().front());
  const auto bricks = bricksFor(grid, scene);
  const Picture whole = renderPicture(*context, *bricks, scene, onGl());
  CHECK(whole.stats.lightOnGl);
  AtlasLimits limits;
  const std::uint64_t texel = parseVoxelFormat("auto", *bricks) == VoxelFormat::float32 ? 4 : 2;
  limits.budgetBytes = bricks->layout.voxels() * texel * (whole.stats.visibleBricks - 1);
  const Picture streamed = renderPicture(*context, *bricks, scene, onGl(), limits);
  CHECK_FALSE(streamed.stats.lightOnGl);
  CHECK_THAT(streamed.stats.lightNote, Catch::Contains("do not hold the visible ones at once"));
  CHECK(maxDifference(streamed.colour, whole.colour) < 1e-4);
  // The renderer goes from one engine to the other and back.
  SliceRenderer renderer(*context, *bricks, scene, onGl());
  const Image first = renderer.render().colour;
  OcclusionOptions coarse = scene.occlusion;
  coarse.ordinates.lightSpacing = 2;
  renderer.setOcclusion(coarse);
  CHECK_THAT(renderer.render().stats.lightNote, Catch::Contains("at every voxel alone"));
  renderer.setOcclusion(scene.occlusion);
  CHECK(maxDifference(renderer.render().colour, first) == 0);
  renderer.setOcclusion(coarse);
  const Image again = renderer.render().colour;
  CHECK(maxDifference(again, renderPicture(*context, *bricks, renderer.scene()).colour) < 1e-6);
}
