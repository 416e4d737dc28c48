// SPDX-License-Identifier: Apache-2.0
#include "umbrick/atlas/brick_atlas.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <set>
#include <string>
#include <tuple>

#include "support/complaint.h"
#include "support/field_bricks.h"
#include "support/gl_fixture.h"
#include "umbrick/core/error.h"

using namespace umbrick;
using Catch::Matchers::Contains;

namespace {

const IndexBox kVoxels{glm::ivec3(-13, 0, 5), glm::ivec3(20, 19, 30)};

// Returns values in grid units, as of a CT, such that no two voxels near each other are equal.
double scattered(const glm::ivec3& i) {
  const unsigned hash = static_cast<unsigned>(i.x) * 73856093u ^ static_cast<unsigned>(i.y) * 19349663u ^
                        static_cast<unsigned>(i.z) * 83492791u;
  return -1000 + hash % 40'000 * 0.1;
}

std::vector<std::int32_t> allOf(const BrickAtlas& atlas) {
  std::vector<std::int32_t> bricks(atlas.bricks().size());
  std::iota(bricks.begin(), bricks.end(), 0);
  return bricks;
}

// Reads every texel of every texture, with two channels, x fastest.
std::vector<std::vector<float>> readTextures(const GlFunctions& gl, const BrickAtlas& atlas) {
  const glm::ivec3 size = atlas.textureSize();
  std::vector<std::vector<float>> textures;
  gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
  for (int i = 0; i < atlas.textureCount(); ++i) {
    std::vector<float> texels(2 * static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                              static_cast<std::size_t>(size.z));
    gl.GetTextureImage(atlas.texture(i), 0, GL_RG, GL_FLOAT, static_cast<GLsizei>(texels.size() * sizeof(float)),
                       texels.data());
    textures.push_back(std::move(texels));
  }
  return textures;
}

struct Difference {
  double value = 0, gradient = 0;
  double texel = 0;  // largest difference from what BrickAtlas::texelOf says
};

// Returns the largest difference of resident bricks from what the volume reads.
Difference compare(const GlFunctions& gl, const BrickAtlas& atlas, const Bricks& volume) {
  const auto textures = readTextures(gl, atlas);
  const glm::ivec3 edge = volume.layout.edge(), size = atlas.textureSize();
  const TexelScale scale = atlas.valueScale();
  std::vector<float> values(volume.layout.voxels()), gradients(volume.hasGradients ? volume.layout.voxels() : 0);
  Difference worst;
  for (std::size_t b = 0; b < atlas.bricks().size(); ++b) {
    const auto brick = static_cast<std::int32_t>(b);
    if (!atlas.isResident(brick)) continue;
    volume.read(atlas.bricks()[b].origin, values, gradients);
    const BrickAtlas::Slot slot = atlas.slot(brick);
    std::size_t i = 0;
    for (int z = 0; z < edge.z; ++z)
      for (int y = 0; y < edge.y; ++y)
        for (int x = 0; x < edge.x; ++x, ++i) {
          const glm::ivec3 at = slot.origin + glm::ivec3(x, y, z);
          const std::size_t texel =
              (static_cast<std::size_t>(at.z) * static_cast<std::size_t>(size.y) + static_cast<std::size_t>(at.y)) *
                  static_cast<std::size_t>(size.x) +
              static_cast<std::size_t>(at.x);
          const float* found = &textures[static_cast<std::size_t>(slot.texture)][2 * texel];
          worst.value = std::max(worst.value, std::abs(found[0] * scale.scale + scale.offset - values[i]));
          worst.texel = std::max(worst.texel, std::abs(found[0] - atlas.texelOf(values[i])) /
                                                  std::max(1e-9, std::abs(atlas.texelOf(values[i]))));
          if (volume.hasGradients)
            worst.gradient = std::max(worst.gradient, std::abs(static_cast<double>(found[1]) - gradients[i]));
        }
  }
  return worst;
}

}  // namespace

TEST_CASE("Every voxel comes back from the texture as the volume reads it", "[atlas][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (const int interior : {8, 16, 24})
    for (const int apron : {1, 2, 5})
      for (const bool gradients : {false, true}) {
        FieldOptions field;
        field.interior = interior;
        field.apron = apron;
        field.gradients = gradients;
        const FieldBricks volume(scattered, kVoxels, field);
        for (const char* name : {"unorm8", "unorm16", "half", "float32"}) {
          if (gradients && std::string(name).starts_with("unorm")) {
            CHECK_THAT(complaint<InvalidArgument>([&] { parseVoxelFormat(name, volume); }), Contains("gradient"));
            continue;
          }
          // The slots are in one texture, and in as many textures as small ones make.
          for (const int texturesOf : {0, 2}) {
            INFO("interior " << interior << ", apron " << apron << ", gradients " << gradients << ", " << name << ", "
                             << texturesOf);
            AtlasOptions options;
            options.format = parseVoxelFormat(name, volume);
            if (texturesOf > 0) options.maxTextureEdge = volume.layout.edge().x * texturesOf;
            BrickAtlas atlas(*context, volume, volume.bricks, options);
            CHECK(atlas.holdsAll());
            CHECK(atlas.slots() == volume.bricks.size());
            if (texturesOf > 0) {
              CHECK(atlas.textureCount() == static_cast<int>((atlas.slots() + 7) / 8));
              CHECK(std::max({atlas.textureSize().x, atlas.textureSize().y, atlas.textureSize().z}) <=
                    options.maxTextureEdge);
            } else {
              CHECK(atlas.textureCount() == 1);
            }
            atlas.require(allOf(atlas));
            CHECK(atlas.uploadedBricks() == volume.bricks.size());
            const Difference worst = compare(context->gl(), atlas, volume);
            CHECK(worst.texel < 2.4e-7);  // two units in the last place, relative
            const double extent = static_cast<double>(volume.value.max) - volume.value.min;
            const double rounding =
                4e-7 * std::max(std::abs(volume.value.max), static_cast<float>(extent));  // of reading back
            const double step = std::string(name) == "unorm8"    ? extent / 255
                                : std::string(name) == "unorm16" ? extent / 65535
                                                                 : 2.0;
            if (std::string(name) == "float32") {
              CHECK(worst.value == 0);
              CHECK(worst.gradient == 0);
              CHECK(atlas.formatError() == 0);
            } else {
              CHECK(worst.value <= 0.5 * step + rounding);
              CHECK(std::abs(worst.value - atlas.formatError()) <= rounding);
              CHECK(worst.gradient <= 0.5 * 2.0);  // a half float: gradients of up to 4000 over 2 voxels
            }
          }
        }
      }
}

TEST_CASE("Whole numbers are exact in every format that has room for them", "[atlas][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (const double low : {0.0, -1024.0, 3000.0, 100'000.0})
    for (const int span : {255, 65535}) {
      FieldBricks volume(
          [&](const glm::ivec3& i) { return low + static_cast<int>(10 * (scattered(i) + 1000)) % (span + 1); }, kVoxels,
          {.background = static_cast<float>(low)});
      volume.value.include(static_cast<float>(low + span));
      volume.exactFormat = span == 255 ? VoxelFormat::unorm8 : VoxelFormat::unorm16;
      for (const VoxelFormat format :
           {VoxelFormat::unorm8, VoxelFormat::unorm16, VoxelFormat::half, VoxelFormat::float32}) {
        INFO("from " << low << ", span " << span << ", " << voxelFormatName(format));
        AtlasOptions options;
        options.format = format;
        BrickAtlas atlas(*context, volume, volume.bricks, options);
        atlas.require(allOf(atlas));
        const double worst = compare(context->gl(), atlas, volume).value;
        // Reading back rounds a code to single precision, as a shader does.
        const double rounding = 2e-7 * (std::abs(low) + span);
        CHECK(std::abs(worst - atlas.formatError()) <= rounding);
        const bool exact = format == VoxelFormat::float32 || format == VoxelFormat::unorm16 ||
                           (format == VoxelFormat::unorm8 && span == 255);
        if (exact) CHECK(atlas.formatError() == 0);
        if (format == VoxelFormat::half) CHECK((atlas.formatError() == 0) == (low + span <= 2048));
      }
      CHECK(parseVoxelFormat("auto", volume) == VoxelFormat::unorm16);
    }
}

TEST_CASE("Bricks of one value share a slot, and give it back together", "[atlas][gl]") {
  const auto context = testContext();
  if (!context) return;
  const FieldBricks volume([](const glm::ivec3&) { return 7.0; }, {glm::ivec3(0), glm::ivec3(63, 15, 15)},
                           {.background = -1});
  REQUIRE(volume.bricks.size() == 32);
  BrickAtlas atlas(*context, volume, volume.bricks, {});
  CHECK(atlas.slots() == 1);
  atlas.require(allOf(atlas));
  CHECK(atlas.uploadedBricks() == 1);
  CHECK(compare(context->gl(), atlas, volume).value == 0);
  for (std::int32_t brick = 0; brick < 31; ++brick) atlas.release(brick);
  CHECK(atlas.isResident(31));
  atlas.require(std::vector<std::int32_t>{0});
  CHECK(atlas.uploadedBricks() == 1);  // brick 31 still holds the slot
  atlas.release(0);
  atlas.release(31);
  atlas.require(std::vector<std::int32_t>{5});
  CHECK(atlas.uploadedBricks() == 2);
  CHECK(compare(context->gl(), atlas, volume).value == 0);
}

TEST_CASE("Slots are recycled and bricks stay what they are", "[atlas][gl]") {
  const auto context = testContext();
  if (!context) return;
  // A third of the bricks are uniform, with three different values.
  const auto field = [](const glm::ivec3& i) { return i.x >= 30 ? 1.0 + (i.x + i.y) / 100 : scattered(i); };
  const FieldBricks volume(field, {glm::ivec3(0), glm::ivec3(63, 31, 31)}, {.background = -1});
  AtlasOptions options;
  options.budgetBytes = 11 * volume.layout.voxels() * 4;
  options.maxTextureEdge = 20;  // texels: 8 slots to a texture
  BrickAtlas atlas(*context, volume, volume.bricks, options);
  CHECK_FALSE(atlas.holdsAll());
  CHECK(atlas.slots() == 11);
  CHECK(atlas.textureBytes() >= options.budgetBytes);
  std::set<std::int32_t> resident;
  unsigned state = 1;
  const auto random = [&](std::size_t below) {
    state = state * 1664525u + 1013904223u;
    return static_cast<std::int32_t>((state >> 8) % below);
  };
  for (int round = 0; round < 200; ++round) {
    while (resident.size() > 8) {
      const std::int32_t brick = random(volume.bricks.size());
      atlas.release(brick);
      atlas.release(brick);  // a second release changes nothing
      resident.erase(brick);
    }
    std::vector<std::int32_t> wanted{random(volume.bricks.size()), random(volume.bricks.size())};
    wanted.push_back(wanted.front());
    atlas.require(wanted);
    resident.insert(wanted.begin(), wanted.end());
    std::set<std::tuple<int, int, int, int>> slots;
    std::size_t ownSlots = 0;
    for (std::size_t b = 0; b < volume.bricks.size(); ++b) {
      const auto brick = static_cast<std::int32_t>(b);
      if (atlas.isResident(brick) != resident.contains(brick)) FAIL("resident is not what was asked for");
      if (!resident.contains(brick) || volume.bricks[b].uniform()) continue;
      const BrickAtlas::Slot slot = atlas.slot(brick);
      slots.insert({slot.texture, slot.origin.x, slot.origin.y, slot.origin.z});
      ++ownSlots;
    }
    CHECK(slots.size() == ownSlots);  // no two bricks are in one slot
    if (round % 20 == 0) CHECK(compare(context->gl(), atlas, volume).value == 0);
  }
  CHECK(compare(context->gl(), atlas, volume).value == 0);
}

TEST_CASE("A pool that grows keeps what it holds, by copies on the GPU where the budget has room", "[atlas][gl]") {
  const auto context = testContext();
  if (!context) return;
  const FieldBricks volume(scattered, {glm::ivec3(0), glm::ivec3(47)}, {});
  REQUIRE(volume.bricks.size() == 216);
  const std::uint64_t slotBytes = volume.layout.voxels() * 4;
  for (const bool roomy : {true, false})
    for (const int textureEdge : {0, 40}) {
      INFO("room for two pools " << roomy << ", textures of " << textureEdge);
      AtlasOptions options;
      options.budgetBytes = (roomy ? 500 : 216) * slotBytes;
      options.maxTextureEdge = textureEdge;
      BrickAtlas atlas(*context, volume, options);
      atlas.append(volume.bricks);
      CHECK(atlas.slots() == 0);
      std::vector<std::int32_t> few(40);
      std::iota(few.begin(), few.end(), 100);
      atlas.reserve(atlas.slotsFor(few));
      CHECK(atlas.slots() == 40);
      atlas.require(few);
      CHECK(atlas.uploadedBricks() == 40);
      for (const std::int32_t brick : {101, 105, 139}) atlas.release(brick);
      atlas.reserve(216);
      CHECK(atlas.slots() == 216);
      for (const std::int32_t brick : few)
        if (roomy) CHECK(atlas.isResident(brick) == (brick != 101 && brick != 105 && brick != 139));
      CHECK(compare(context->gl(), atlas, volume).value == 0);
      atlas.require(allOf(atlas));
      CHECK(atlas.uploadedBricks() == (roomy ? 216u + 3u : 216u + 40u));
      CHECK(compare(context->gl(), atlas, volume).value == 0);
    }
}

TEST_CASE("Bricks that were required longest ago make room", "[atlas][gl]") {
  const auto context = testContext();
  if (!context) return;
  const FieldBricks volume(scattered, {glm::ivec3(0), glm::ivec3(47)}, {});
  AtlasOptions options;
  options.budgetBytes = 10 * volume.layout.voxels() * 4;
  BrickAtlas atlas(*context, volume, volume.bricks, options);
  REQUIRE(atlas.slots() == 10);
  const auto require = [&](std::vector<std::int32_t> bricks) { atlas.require(bricks); };
  require({0, 1, 2, 3, 4});
  require({5, 6, 7, 8, 9});
  require({0, 2});
  require({10, 11, 12});  // 1, 3 and 4 leave
  for (const std::int32_t brick : {0, 2, 5, 6, 7, 8, 9, 10, 11, 12}) CHECK(atlas.isResident(brick));
  for (const std::int32_t brick : {1, 3, 4}) CHECK_FALSE(atlas.isResident(brick));
  CHECK(compare(context->gl(), atlas, volume).value == 0);
  CHECK_THROWS_AS(require({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}), InvalidArgument);
  CHECK(atlas.isResident(12));
  CHECK(compare(context->gl(), atlas, volume).value == 0);
}

TEST_CASE("What does not fit is refused with what is needed and what there is", "[atlas][gl]") {
  const auto context = testContext();
  if (!context) return;
  const FieldBricks volume(scattered, {glm::ivec3(0), glm::ivec3(127)}, {.interior = 64});
  AtlasOptions options;
  options.budgetBytes = 1 << 20;
  CHECK_THAT(complaint<InvalidArgument>([&] { BrickAtlas(*context, volume, volume.bricks, options); }),
             Contains("1.1 MiB") && Contains(" 1 MiB"));
  options = {};
  options.maxTextureEdge = 64;
  CHECK_THAT(complaint<InvalidArgument>([&] { BrickAtlas(*context, volume, volume.bricks, options); }),
             Contains("66 x 66 x 66") && Contains("64 texels"));
  options = {};
  options.budgetBytes = 4 << 20;
  BrickAtlas atlas(*context, volume, volume.bricks, options);
  CHECK(atlas.slots() == 3);
  CHECK_THAT(complaint<InvalidArgument>([&] { atlas.require(allOf(atlas)); }),
             Contains("3 bricks") && Contains("3.3 MiB"));
  // The refused request has not spoilt the atlas: bricks that are resident are still there.
  CHECK(compare(context->gl(), atlas, volume).value == 0);
  for (const std::int32_t brick : allOf(atlas)) atlas.release(brick);
  atlas.require(std::vector<std::int32_t>{7, 1, 4});
  CHECK(compare(context->gl(), atlas, volume).value == 0);
}

// Textures have a largest number of bytes, since software drivers refuse large ones.
TEST_CASE("Slots are spread evenly over textures of bounded size", "[atlas][gl]") {
  const auto context = testContext();
  if (!context) return;
  const FieldBricks volume(scattered, {glm::ivec3(0), glm::ivec3(47)}, {});
  REQUIRE(volume.bricks.size() == 216);
  const std::uint64_t slotBytes = volume.layout.voxels() * 4;
  for (const std::uint64_t perTexture : {1, 7, 100, 108, 1000}) {
    AtlasOptions options;
    options.maxTextureBytes = perTexture * slotBytes;
    BrickAtlas atlas(*context, volume, volume.bricks, options);
    INFO(perTexture << " bricks a texture");
    CHECK(atlas.textureCount() >= static_cast<int>((216 + perTexture - 1) / perTexture) - 1);
    CHECK(atlas.textureBytes() < (216 + 30 * static_cast<std::uint64_t>(atlas.textureCount())) * slotBytes);
    atlas.require(allOf(atlas));
    CHECK(compare(context->gl(), atlas, volume).value == 0);
  }
}

TEST_CASE("Texel formats have names, and an unknown name is refused", "[atlas]") {
  FieldBricks volume(scattered, kVoxels, {});
  for (const VoxelFormat format :
       {VoxelFormat::unorm8, VoxelFormat::unorm16, VoxelFormat::half, VoxelFormat::float32}) {
    CHECK(parseVoxelFormat(voxelFormatName(format), volume) == format);
    volume.exactFormat = format;
    // 8-bit texels would be filtered with 8-bit weights.
    CHECK(parseVoxelFormat("auto", volume) == (format == VoxelFormat::unorm8 ? VoxelFormat::unorm16 : format));
  }
  CHECK_THAT(complaint<InvalidArgument>([&] { parseVoxelFormat("float64", volume); }),
             Contains("float64") && Contains("unorm16, half"));
}
