// SPDX-License-Identifier: Apache-2.0
#include "shade/gl_light_sweep.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <optional>

#include "shade/constants.h"
#include "shade/ray_frame.h"

namespace umbrick {
namespace {

// No buffer is larger than this, so that directions are taken in several goes through large volumes.
constexpr std::int64_t kMostBytes = std::int64_t{256} << 20;
// Planes are uniforms, of which every driver has more than these.
constexpr std::size_t kMostPlanes = 64;
// Every driver takes so many groups of a compute shader along an axis.
constexpr std::uint32_t kGroupsAlong = 32768;
constexpr int kBlocksTogether = 64;  // in a group of light_blocks.comp

std::int64_t mostBytes(const GlFunctions& gl) {
  GLint64 most = 0;
  gl.GetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
  return std::min<std::int64_t>(most, kMostBytes);
}

void dispatch(const GlFunctions& gl, std::uint32_t groups) {
  const std::uint32_t rows = (groups + kGroupsAlong - 1) / kGroupsAlong;
  gl.DispatchCompute(std::min(groups, kGroupsAlong), rows, 1);
}

std::vector<std::int32_t> allOf(const BrickSelection& bricks) {
  std::vector<std::int32_t> positions(bricks.size());
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = static_cast<std::int32_t>(i);
  return positions;
}

int largestCode(VoxelFormat format) {
  return format == VoxelFormat::unorm8 ? 255 : format == VoxelFormat::unorm16 ? 65535 : 0;
}

std::int64_t productOf(const glm::i64vec3& v) { return v.x * v.y * v.z; }

}  // namespace

/// The resident bricks, and the medium in them.
struct GlLightSweep::Volume {
  const ResidentVolume& resident;
  const BrickSelection& bricks;
  const LightMedium& medium;
  const TransferLookup& transfer;
  const LightTextures& light;
  std::vector<std::int32_t> positions;
  std::vector<int> textures;  // of the atlas, that bricks lie in
  CellBox cells;
  ExtinctionTable table;
  glm::dvec3 whole;
  glm::dmat3 toIndex;
  ShaderConstants constants;

  const BrickLayout& layout() const { return resident.volume().layout; }
};

std::string GlLightSweep::refusal(const ResidentVolume& resident, const BrickSelection& bricks,
                                  const LightMedium& medium) {
  const BrickAtlas& atlas = resident.atlas();
  if (medium.spacing == 2) return "OpenGL computes it at every voxel alone";
  if (medium.emitted) return "light that is emitted is computed on the CPU";
  if (medium.mesh) return "the light around a mesh is computed on the CPU";
  if (medium.planes.size() > kMostPlanes) return "too many planes cut the medium";
  if (bricks.slots() > atlas.slots()) return "the textures of bricks do not hold the visible ones at once";
  if (atlas.textureCount() > kRayTextures)
    return "the bricks lie in more than " + std::to_string(kRayTextures) + " textures";
  if (bricks.size() == 0) return {};
  const glm::ivec3 interior = resident.volume().layout.interior;
  const CellBox cells = cellsAround(bricks.origins(), interior);
  const glm::i64vec3 extent = cells.count * glm::i64vec3(interior);
  const std::int64_t longest = std::max({extent.x, extent.y, extent.z}), most = mostBytes(resident.context().gl());
  const std::string sparse = "the box of the visible bricks, " + std::to_string(extent.x) + " x " +
                             std::to_string(extent.y) + " x " + std::to_string(extent.z) + " voxels, is too large";
  if (!SlotTable::fits(cells) || longest > std::int64_t{kMostPathTiles} * kPathTile / 2) return sparse;
  // Of one direction, whose paths move across by at most a voxel from slice to slice.
  const auto larger = [](std::int64_t voxels) { return voxels + 64; };
  for (int axis = 0; axis < 3; ++axis) {
    const SweepAxes axes = kSweepAxes[axis];
    const std::int64_t u = larger(extent[axes.u]), v = larger(extent[axes.v]), n = larger(extent[axes.n]);
    if ((u + n) * (v + n) * 4 > most || u * v * 4 * kSlabSlices > most) return sparse;
  }
  // A block is listed for each slab that it has voxels on.
  const std::int64_t blocks = productOf(glm::i64vec3(interior) / std::int64_t{kLitBlock} + std::int64_t{1});
  if (static_cast<std::int64_t>(bricks.size()) * blocks * 16 > most) return "there are too many visible bricks";
  return {};
}

std::uint64_t GlLightSweep::bytes() const {
  std::uint64_t sum = slots_.bytes();
  for (const Buffer* buffer :
       {&table_, &bricks_, &lit_, &blocks_, &tiles_, &places_, &directions_, &depths_, &through_})
    sum += buffer->bytes;
  return sum;
}

// Brings data to a buffer and binds it. Buffers do not shrink. @param data  null: what it holds does not matter
void GlLightSweep::fill(Buffer& buffer, GLuint unit, std::uint64_t bytes, const void* data) {
  constexpr std::uint64_t kLeast = 16;  // a buffer of nothing cannot be bound
  if (!buffer.buffer) buffer.buffer = GlBuffer(*gl_);
  if (buffer.bytes < std::max(bytes, kLeast)) {
    buffer.bytes = 0;
    gl_->NamedBufferData(buffer.buffer.name(), static_cast<GLsizeiptr>(std::max(bytes, kLeast)), nullptr,
                         GL_DYNAMIC_DRAW);
    checkGl(*gl_, "buffers of light");
    buffer.bytes = std::max(bytes, kLeast);
  }
  if (data && bytes > 0) gl_->NamedBufferSubData(buffer.buffer.name(), 0, static_cast<GLsizeiptr>(bytes), data);
  gl_->BindBufferBase(GL_SHADER_STORAGE_BUFFER, unit, buffer.buffer.name());
}

void GlLightSweep::sweep(const ResidentVolume& resident, const BrickSelection& bricks, const LightMedium& medium,
                         const TransferLookup& transfer, const LightTextures& light) {
  updates_ = 0;
  if (bricks.size() == 0) return;
  gl_ = &resident.context().gl();
  const std::vector<std::int32_t> positions = allOf(bricks);
  const Bricks& all = resident.volume();
  const glm::dvec3 whole = wholeLight(medium.directions);
  // Where empty space shows something, medium goes on beyond the bricks, up to the planes that end it.
  const bool continued = !medium.planes.empty() && !medium.transfer.isTransparent({all.background, all.background});
  Volume volume{resident,
                bricks,
                medium,
                transfer,
                light,
                positions,
                SlotTable::texturesOf(bricks, positions),
                cellsAround(bricks.origins(), all.layout.interior),
                ExtinctionTable(medium.transfer),
                whole,
                glm::inverse(glm::dmat3(all.indexToWorld)),
                {{"kTableSteps", ExtinctionTable::kSteps},
                 {"kTableEnds", ExtinctionTable::kEnds},
                 {"kCodes", largestCode(resident.format())},
                 {"kPlanes", static_cast<int>(medium.planes.size())},
                 {"kContinued", continued},
                 {"kColoured", isColoured(medium.directions)}}};
  volume.constants["kTextures"] = static_cast<int>(volume.textures.size());
  // A 1D function comes from the table.
  for (const char* name : {"kQuadrature", "kUniformStretches"}) volume.constants[name] = 0;
  for (const char* name : {"kValueSteps", "kGradientSteps"}) volume.constants[name] = 1;
  if (medium.transfer.is2d()) transfer.setConstants(volume.constants);
  volume.constants["kEmission"] = 0;  // nothing of it is light
  makeTables(volume);
  const LitBricks lit = findBlocks(volume);
  std::array<std::optional<LightSlabs>, 3> slabs;
  for (const SweepSide& side : sweepSides(medium.directions, whole, all.indexToWorld)) {
    std::optional<LightSlabs>& along = slabs[static_cast<std::size_t>(side.axis)];
    if (!along) along.emplace(side.axis, lit);
    sweepSide(volume, *along, lit.first, side);
  }
  gl_->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  checkGl(*gl_, "light");
}

// The transfer function, the slots of bricks, and textures.
void GlLightSweep::makeTables(const Volume& volume) {
  const GlFunctions& gl = *gl_;
  constexpr std::size_t kSteps = ExtinctionTable::kSteps;
  std::vector<float> numbers(volume.table.integrals(), volume.table.integrals() + kSteps + 2);
  numbers.insert(numbers.end(), volume.table.means(), volume.table.means() + kSteps + 1);
  for (const std::int32_t steps : volume.table.opaqueSteps()) numbers.push_back(static_cast<float>(steps));
  fill(table_, kExtinctionBuffer, numbers.size() * sizeof(float), numbers.data());
  const std::vector<std::uint8_t> shown(volume.positions.size(), 1);
  // The key of a table counts parts of bricks that show something, which are always whole ones here.
  slots_.fill(gl, volume.bricks, {volume.positions, volume.cells, glm::ivec3(1), shown, {}, 0, true, volume.textures});
  std::vector<glm::ivec4> places;
  for (const std::int32_t position : volume.positions) {
    const BrickAtlas::Slot slot = volume.bricks.slot(position);
    const auto number = std::ranges::find(volume.textures, slot.texture) - volume.textures.begin();
    places.emplace_back(slot.origin, static_cast<int>(number));
    const glm::i64vec3 origin(volume.bricks.origins()[static_cast<std::size_t>(position)]);
    places.emplace_back(glm::ivec3(origin - volume.cells.first), 0);
  }
  fill(bricks_, kLitBricksBuffer, places.size() * sizeof(glm::ivec4), places.data());
  gl.BindTextureUnit(kSlotsUnit, slots_.texture());
  gl.BindTextureUnit(kTransferUnit, volume.transfer.texture());
  const GLenum format = volume.constants.at("kColoured") ? GL_RGBA32F : GL_R32F;
  for (std::size_t i = 0; i < volume.textures.size(); ++i) {
    const auto unit = static_cast<GLuint>(i);
    gl.BindTextureUnit(i == 0 ? kAtlasUnit : kMoreAtlasUnit + unit - 1,
                       volume.resident.atlas().texture(volume.textures[i]));
    gl.BindImageTexture(kLightImage + unit, volume.light.texture(volume.textures[i]), 0, GL_TRUE, 0, GL_READ_WRITE,
                        format);
  }
  // Codes are texels, or what texels of fixed point stand for.
  const TexelScale scale = volume.resident.atlas().valueScale();
  const double codes = std::max(volume.constants.at("kCodes"), 1);
  for (SpecialisedProgram* each : {&blocksProgram_, &carryProgram_}) {
    GlProgram& program = each->get(gl, volume.constants);
    program.set("lowest_code", static_cast<float>(scale.toTexel(volume.table.low()) * codes));
    const bool is2d = volume.medium.transfer.is2d();
    program.set("steps_per_code", static_cast<float>(volume.table.perUnit() * (is2d ? 1 : scale.scale / codes)));
    if (is2d) volume.transfer.setUniforms(program, volume.resident.atlas());
    program.set("sigma_ends", glm::vec2(volume.table.below(), volume.table.above()));
    program.set("empty_ends", glm::vec2(volume.table.emptyBelow(), volume.table.emptyAbove()));
    program.set("apron", volume.layout().apron);
    program.set("interior", volume.layout().interior);
    program.set("per_interior", glm::vec3(1.0 / glm::dvec3(volume.layout().interior)));
  }
}

LitBricks GlLightSweep::findBlocks(const Volume& volume) {
  const GlFunctions& gl = *gl_;
  LitBricks lit;
  lit.layout = volume.layout();
  lit.first = volume.cells.first;
  lit.extent = glm::ivec3(volume.cells.count * glm::i64vec3(lit.layout.interior));
  for (const glm::ivec3& origin : volume.bricks.origins())
    lit.places.emplace_back(glm::ivec3(glm::i64vec3(origin) - lit.first));
  lit.lit.resize(lit.places.size() * lit.blocksPerBrick());
  const auto count = static_cast<int>(lit.lit.size());
  fill(lit_, kBlocksBuffer, lit.lit.size() * sizeof(std::uint32_t), nullptr);
  GlProgram& program = blocksProgram_.current();
  program.set("block_count", lit.blocks());
  program.set("count", count);
  program.use();
  for (int first = 0; first < count; first += static_cast<int>(kGroupsAlong) * kBlocksTogether) {
    program.set("first", first);
    const int groups = (count - first + kBlocksTogether - 1) / kBlocksTogether;
    dispatch(gl, std::min(static_cast<std::uint32_t>(groups), kGroupsAlong));
  }
  gl.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  gl.GetNamedBufferSubData(lit_.buffer.name(), 0, static_cast<GLsizeiptr>(lit.lit.size() * sizeof(std::uint32_t)),
                           lit.lit.data());
  return lit;
}

void GlLightSweep::sweepSide(const Volume& volume, const LightSlabs& slabs, const glm::i64vec3& first,
                             const SweepSide& side) {
  fill(blocks_, kBlocksBuffer, slabs.blocks().size_bytes(), slabs.blocks().data());
  // As many directions together as buffers have room for.
  const SidePaths all(slabs, first, side.directions);
  const std::int64_t plane = std::int64_t{slabs.planeSize().x} * slabs.planeSize().y * kSlabSlices;
  const std::int64_t paths = std::int64_t{all.size().x} * all.size().y;
  const auto room = static_cast<std::size_t>(mostBytes(*gl_) / (4 * std::max(plane, paths)));
  const std::size_t count = side.directions.size(), most = std::clamp<std::size_t>(room, 1, kMostSweptTogether);
  const std::size_t parts = (count + most - 1) / most;
  for (std::size_t part = 0; part < parts; ++part)
    sweepTogether(
        volume, slabs, first,
        std::span(side.directions).subspan(count * part / parts, count * (part + 1) / parts - count * part / parts));
}

// Sets what tells where voxels of bricks are in planes.
void GlLightSweep::setPlace(GlProgram& program, const Volume& volume, const LightSlabs& slabs) const {
  const SweepAxes axes = kSweepAxes[slabs.axis()];
  const auto unit = [](int axis) {
    glm::ivec3 vector(0);
    vector[axis] = 1;
    return vector;
  };
  program.set("axis_u", unit(axes.u));
  program.set("axis_v", unit(axes.v));
  program.set("axis_n", unit(axes.n));
  program.set("margin", slabs.margin());
  program.set("plane_size", slabs.planeSize());
  program.set("apron", volume.layout().apron);
  program.set("interior", volume.layout().interior);
}

void GlLightSweep::sweepTogether(const Volume& volume, const LightSlabs& slabs, const glm::i64vec3& first,
                                 std::span<const SweptDirection> directions) {
  const GlFunctions& gl = *gl_;
  const int sign = directions.front().sign;
  const SweepAxes axes = kSweepAxes[slabs.axis()];
  SidePaths paths(slabs, first, directions);
  paths.findTiles(slabs, sign);
  fill(tiles_, kTilesBuffer, paths.tiles().size_bytes(), paths.tiles().data());
  fill(places_, kPlacesBuffer, paths.places().size_bytes(), paths.places().data());
  std::vector<glm::vec4> numbers;
  for (const SweptDirection& direction : directions) {
    numbers.emplace_back(direction.weight[0], direction.weight[1], direction.weight[2],
                         static_cast<float>(direction.length));
    for (const glm::dvec4& plane : volume.medium.planes) {
      const PathCut cut = pathCut(plane, direction, volume.toIndex, 1);
      numbers.emplace_back(cut.rate, cut.slicesPerPlace, cut.cosine, 0);
    }
  }
  fill(directions_, kDirectionsBuffer, numbers.size() * sizeof(glm::vec4), numbers.data());
  const std::uint64_t plane = static_cast<std::uint64_t>(slabs.planeSize().x) *
                              static_cast<std::uint64_t>(slabs.planeSize().y) * directions.size() * sizeof(float);
  fill(depths_, kDepthsBuffer,
       static_cast<std::uint64_t>(paths.size().x) * static_cast<std::uint64_t>(paths.size().y) * directions.size() *
           sizeof(float),
       nullptr);
  gl.ClearNamedBufferData(depths_.buffer.name(), GL_R32F, GL_RED, GL_FLOAT, nullptr);
  fill(through_, kThroughBuffer, plane * kSlabSlices, nullptr);
  std::vector<glm::vec4> planes;
  for (const glm::dvec4& one : volume.medium.planes)
    planes.emplace_back(one[axes.u], one[axes.v], one[axes.n], one.w + glm::dot(glm::dvec3(one), glm::dvec3(first)));

  GlProgram &carry = carryProgram_.current(), &add = addProgram_.get(gl, volume.constants);
  for (GlProgram* program : {&carry, &add}) {
    setPlace(*program, volume, slabs);
    program->set("direction_count", static_cast<int>(directions.size()));
    program->set("step_n", -sign);
  }
  carry.set("path_size", paths.size());
  carry.set("planes", planes);
  add.set("block_count", glm::ivec3((volume.layout().interior + kLitBlock - 1) / kLitBlock));
  for (int place = 0; place < slabs.count(); ++place) {
    const int slab = slabs.slab(sign, place), slice = place * kSlabSlices;
    if (paths.tileCount(place) == 0) continue;
    for (GlProgram* program : {&carry, &add}) {
      program->set("first_slice", slice);
      program->set("first_n", slabs.slice(sign, slice));
    }
    carry.set("first_tile", static_cast<int>(paths.firstTile(place)));
    carry.set("tile_count", static_cast<int>(paths.tileCount(place)));
    carry.use();
    gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    dispatch(gl, paths.tileCount(place));
    add.set("first_block", static_cast<int>(slabs.firstBlock(slab)));
    add.set("slab_blocks", static_cast<int>(slabs.blockCount(slab)));
    add.use();
    gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    dispatch(gl, slabs.blockCount(slab));
    updates_ += std::uint64_t{paths.tileCount(place)} * kPathTile * kPathTile * kSlabSlices;
  }
}

}  // namespace umbrick
