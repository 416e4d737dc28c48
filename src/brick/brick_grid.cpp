// SPDX-License-Identifier: Apache-2.0
#include "umbrick/brick/brick_grid.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "brick/gradient.h"
#include "brick/voxel_reader.h"
#include "brick/voxel_survey.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;

std::string print(const glm::i64vec3& v) {
  return "(" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) + ")";
}

// Returns the box of voxels from first to last, both included, if 32 bits hold their coordinates.
CoordBBox checkedBox(const glm::i64vec3& first, const glm::i64vec3& last, const char* what) {
  using Limits = std::numeric_limits<std::int32_t>;
  for (int axis = 0; axis < 3; ++axis)
    if (first[axis] < Limits::min() || last[axis] > Limits::max())
      throw InvalidArgument(std::string(what) + " needs voxels " + print(first) + " to " + print(last) +
                            ": coordinate " + "xyz"[axis] + " = " +
                            std::to_string(first[axis] < Limits::min() ? first[axis] : last[axis]) +
                            " is beyond the limits of 32-bit indices");
  const auto coord = [](const glm::i64vec3& v) {
    return Coord(static_cast<int>(v.x), static_cast<int>(v.y), static_cast<int>(v.z));
  };
  return {coord(first), coord(last)};
}

/// The bricks of a grid: what the regular lattice and the lattice of a single cell have in common.
class GridBricks final : public Bricks {
 public:
  GridBricks(const ScalarGrid& grid, const BrickOptions& options)
      : grid_(grid.grid),
        name_(grid.name),
        reader_(grid_->tree(), finiteOrZero(grid_->background())),
        emissionGrid_(grid.emission),
        worldGradient_(grid.indexToWorld(), options.gradientFilter) {
    layout.interior = glm::ivec3(options.interior);
    layout.apron = options.apron;
    indexToWorld = grid.indexToWorld();
    background = finiteOrZero(grid_->background());
    hasGradients = options.gradients;
    gradientFilter = options.gradientFilter;
    gradient = {0, 0};
    VoxelSurvey survey = surveyVoxels(grid_->tree(), background, options.interior, margin());
    value = survey.value;
    anchor = survey.anchor;
    exactFormat = survey.exactFormat;
    nonFiniteVoxels = survey.nonFiniteVoxels;
    if (!survey.hasNonFinite) reader_.setAllFinite();
    if (emissionGrid_) addEmission(survey);
    if (survey.extent.empty()) return;
    setDomain(survey.extent);
    collectBricks(survey.cells);
  }

  // Makes one brick of all that slabs may reach the domain from.
  void unite() {
    if (domain.empty()) return;
    const IndexBox box = reach();
    const glm::i64vec3 extent = box.extent();
    const glm::dvec3 edge = glm::dvec3(extent) + 2.0 * layout.apron;
    if (edge.x * edge.y * edge.z > 2147483648.0)
      throw InvalidArgument("one brick of the whole grid would have " + print(glm::i64vec3(edge)) +
                            " voxels, more than 2^31 = 2147483648");
    layout.interior = glm::ivec3(extent);
    // The brick begins and ends with a layer of background, so its ranges include all values and a gradient of zero.
    bricks = {{box.min, value, gradient, emission}};
  }

  void readEmission(const glm::ivec3& origin, std::span<float> values) const override {
    if (!emissionReader_) return Bricks::readEmission(origin, values);
    if (values.size() != layout.voxels())
      throw InvalidArgument("brick: " + std::to_string(values.size()) + " values of emission to fill, must be " +
                            std::to_string(layout.voxels()));
    withGridErrors([&] { emissionReader_->copy(brickBox(origin, layout.apron), values.data()); });
  }

  void read(const glm::ivec3& origin, std::span<float> values, std::span<float> gradients) const override {
    const std::size_t voxels = layout.voxels();
    if (values.size() != voxels)
      throw InvalidArgument("brick: " + std::to_string(values.size()) + " values to fill, must be " +
                            std::to_string(voxels));
    if (!gradients.empty() && !hasGradients) throw InvalidArgument("brick: made without gradients");
    if (!gradients.empty() && gradients.size() != voxels)
      throw InvalidArgument("brick: " + std::to_string(gradients.size()) + " gradients to fill, must be " +
                            std::to_string(voxels));
    withGridErrors([&] {
      if (gradients.empty()) return reader_.copy(brickBox(origin, layout.apron), values.data());
      std::vector<float> slab;
      float *nextValue = values.data(), *nextGradient = gradients.data();
      forEachRow(brickBox(origin, layout.apron), slab,
                 [&](const float* row, std::ptrdiff_t y, std::ptrdiff_t z, int n) {
                   nextValue = std::copy_n(row, n, nextValue);
                   worldGradient_.magnitudes(row, y, z, n, nextGradient);
                   nextGradient += n;
                 });
    });
  }

  /// Runs `work` and turns OpenVDB's errors into ours, such as those of a file whose voxels are loaded late.
  template <class Work>
  void withGridErrors(const Work& work) const {
    try {
      work();
    } catch (const openvdb::Exception& error) {
      throw IoError("grid \"" + name_ + "\": " + error.what());
    }
  }

 private:
  // Takes the second grid, whose voxels are as much a reason for bricks as those of the first.
  void addEmission(VoxelSurvey& survey) {
    hasEmission = true;
    emissionBackground = finiteOrZero(emissionGrid_->background());
    emissionReader_.emplace(emissionGrid_->tree(), emissionBackground);
    const VoxelSurvey second = surveyVoxels(emissionGrid_->tree(), emissionBackground, layout.interior.x, layout.apron);
    if (!second.hasNonFinite) emissionReader_->setAllFinite();
    emission = second.value;
    nonFiniteVoxels += second.nonFiniteVoxels;
    if (second.extent.empty()) return;
    survey.extent = survey.extent.empty() ? second.extent
                                          : IndexBox{glm::min(survey.extent.min, second.extent.min),
                                                     glm::max(survey.extent.max, second.extent.max)};
    std::vector<glm::ivec3> cells;
    std::ranges::set_union(survey.cells, second.cells, std::back_inserter(cells), comesBefore);
    survey.cells = std::move(cells);
  }

  static float finiteOrZero(float value) { return std::isfinite(value) ? value : 0.0f; }

  CoordBBox brickBox(const glm::ivec3& origin, int margin) const {
    const glm::i64vec3 first(origin);
    return checkedBox(first - std::int64_t(margin), first + glm::i64vec3(layout.interior) + std::int64_t(margin - 1),
                      "a brick with its apron");
  }

  void setDomain(const IndexBox& extent) {
    const glm::i64vec3 first = glm::i64vec3(extent.min) - std::int64_t(1);
    const glm::i64vec3 last = glm::i64vec3(extent.max) + std::int64_t(1);
    checkedBox(first, last, "the grid, grown by one voxel,");
    domain = {glm::ivec3(first), glm::ivec3(last)};
    // Every cell from which slabs may reach the domain must be readable.
    const std::int64_t interior = layout.interior.x, seen = margin();
    glm::i64vec3 lowest, highest;
    for (int axis = 0; axis < 3; ++axis) {
      lowest[axis] = cellOf(first[axis] - seen, interior) * interior - seen;
      highest[axis] = (cellOf(last[axis] + seen, interior) + 1) * interior - 1 + seen;
    }
    checkedBox(lowest, highest, "the lattice of bricks with their aprons");
  }

  // Keeps the cells that hold anything but background, with their ranges.
  void collectBricks(const std::vector<glm::ivec3>& cells) {
    std::vector<Brick> found(cells.size());
    std::vector<char> keep(cells.size(), 0);
    tbb::enumerable_thread_specific<std::vector<float>> slabs;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cells.size(), 4), [&](const auto& range) {
      std::vector<float>& slab = slabs.local();
      for (std::size_t i = range.begin(); i != range.end(); ++i) {
        const glm::ivec3 origin = cells[i] * layout.interior;
        const CoordBBox box = brickBox(origin, layout.apron);
        found[i] = {origin, reader_.range(box), gradientRange(origin, slab)};
        if (emissionReader_) found[i].emission = emissionReader_->range(box);
        keep[i] = found[i].value != Range{background, background} || found[i].gradient.max > 0 ||
                  (emissionReader_ && found[i].emission != Range{emissionBackground, emissionBackground});
      }
    });
    bricks.reserve(static_cast<std::size_t>(std::count(keep.begin(), keep.end(), 1)));
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (keep[i]) {
        bricks.push_back(found[i]);
        gradient.include(found[i].gradient);
      }
  }

  Range gradientRange(const glm::ivec3& origin, std::vector<float>& slab) const {
    if (!hasGradients) return {0, 0};
    const Range seen = reader_.range(brickBox(origin, layout.apron + 1));
    if (seen.min == seen.max) return {0, 0};
    Range range;
    std::vector<float> magnitudes(static_cast<std::size_t>(layout.edge().x));
    forEachRow(brickBox(origin, layout.apron), slab, [&](const float* row, std::ptrdiff_t y, std::ptrdiff_t z, int n) {
      worldGradient_.magnitudes(row, y, z, n, magnitudes.data());
      for (const float magnitude : magnitudes) range.include(magnitude);
    });
    return range;
  }

  // Calls visit(row, strideY, strideZ, count) for each row of voxels along x in `box`, in ascending order of y, then z.
  // Each voxel has its 26 neighbours. The voxels are read in voxel slabs, so that a huge box needs little memory.
  template <class Visit>
  void forEachRow(const CoordBBox& box, std::vector<float>& slab, const Visit& visit) const {
    const glm::i64vec3 first(box.min().x(), box.min().y(), box.min().z());
    const glm::i64vec3 last(box.max().x(), box.max().y(), box.max().z());
    const std::int64_t one = 1;
    checkedBox(first - one, last + one, "the gradient at a brick's apron");
    const std::int64_t width = last.x - first.x + 3, height = last.y - first.y + 3;
    const std::int64_t planes = std::max<std::int64_t>(8, (1 << 18) / (width * height));
    for (std::int64_t z = first.z; z <= last.z; z += planes) {
      const std::int64_t end = std::min(z + planes - 1, last.z);
      slab.resize(static_cast<std::size_t>(width * height * (end - z + 3)));
      reader_.copy(checkedBox({first.x - 1, first.y - 1, z - 1}, {last.x + 1, last.y + 1, end + 1}, "a brick"),
                   slab.data());
      for (std::int64_t k = 1; k <= end - z + 1; ++k)
        for (std::int64_t j = 1; j < height - 1; ++j)
          visit(slab.data() + (k * height + j) * width + 1, width, width * height, static_cast<int>(width - 2));
    }
  }

  openvdb::FloatGrid::ConstPtr grid_;
  std::string name_;
  VoxelReader reader_;
  openvdb::FloatGrid::ConstPtr emissionGrid_;  // none: nothing emits
  std::optional<VoxelReader> emissionReader_;
  WorldGradient worldGradient_;
};

void checkOptions(const ScalarGrid& grid, const BrickOptions& options) {
  if (!grid.grid) throw InvalidArgument("bricks: there is no grid");
  if (options.interior < 8 || options.interior > 256 || options.interior % 8 != 0)
    throw InvalidArgument("brick interior is " + std::to_string(options.interior) +
                          " voxels, must be a multiple of 8 from 8 to 256");
  if (options.apron < 1 || options.apron > options.interior)
    throw InvalidArgument("brick apron is " + std::to_string(options.apron) +
                          " voxels, must be from 1 to the interior, " + std::to_string(options.interior));
}

std::unique_ptr<GridBricks> makeBricks(const ScalarGrid& grid, const BrickOptions& options) {
  checkOptions(grid, options);
  try {
    return std::make_unique<GridBricks>(grid, options);
  } catch (const openvdb::Exception& error) {
    throw IoError("grid \"" + grid.name + "\": " + error.what());
  }
}

}  // namespace

std::unique_ptr<Bricks> brickGrid(const ScalarGrid& grid, const BrickOptions& options) {
  return makeBricks(grid, options);
}

std::unique_ptr<Bricks> unbrickedGrid(const ScalarGrid& grid, const BrickOptions& options) {
  std::unique_ptr<GridBricks> bricks = makeBricks(grid, options);
  bricks->unite();
  return bricks;
}

std::unique_ptr<Bricks> cutGrid(const ScalarGrid& grid, const BrickOptions& options, bool bricked) {
  return bricked ? brickGrid(grid, options) : unbrickedGrid(grid, options);
}

}  // namespace umbrick
