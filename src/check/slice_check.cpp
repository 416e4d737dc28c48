// SPDX-License-Identifier: Apache-2.0
#include "check/slice_check.h"

#include <openvdb/tools/Interpolation.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <unordered_set>

#include "check/result.h"
#include "check/sampler_precision.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/scene/resolve.h"
#include "umbrick/shade/slice_renderer.h"
#include "umbrick/slice/proxy_slices.h"

namespace umbrick {
namespace {

// Tells which cells of the lattice are drawn.
class DrawnCells {
 public:
  explicit DrawnCells(const Bricks& bricks, bool complete) : interior_(bricks.layout.interior) {
    if (bricks.bricks.empty()) return;
    // A lattice of one cell does not begin at 0.
    phase_ = bricks.bricks.front().origin;
    for (const Brick& brick : bricks.bricks) cells_.insert(cellOf(glm::dvec3(brick.origin)));
    if (complete)
      for (const Brick& brick : backgroundBricks(bricks)) cells_.insert(cellOf(glm::dvec3(brick.origin)));
  }

  glm::ivec3 cellOf(const glm::dvec3& index) const {
    return glm::ivec3(glm::floor((index + 0.5 - glm::dvec3(phase_)) / glm::dvec3(interior_)));
  }
  bool contains(const glm::ivec3& cell) const { return cells_.contains(cell); }

 private:
  struct Hash {
    std::size_t operator()(const glm::ivec3& c) const {
      return static_cast<std::size_t>(c.x) * 73856093u ^ static_cast<std::size_t>(c.y) * 19349663u ^
             static_cast<std::size_t>(c.z) * 83492791u;
    }
  };
  glm::ivec3 interior_, phase_{0};
  std::unordered_set<glm::ivec3, Hash> cells_;
};

struct Counts {
  std::size_t pixels = 0, excluded = 0, gaps = 0, doubleHits = 0;
  std::size_t values = 0;
  double displacement = 0;  // largest displacement of a sample, voxels
  double limit = 0;         // of the displacement
  glm::ivec2 worstPixel{-1}, gapPixel{-1};

  void join(const Counts& other) {
    pixels += other.pixels;
    excluded += other.excluded;
    gaps += other.gaps;
    doubleHits += other.doubleHits;
    values += other.values;
    limit = std::max(limit, other.limit);
    if (other.gapPixel.x >= 0) gapPixel = other.gapPixel;
    if (other.displacement > displacement) {
      displacement = other.displacement;
      worstPixel = other.worstPixel;
    }
  }
};

// What one slice should look like.
class SliceExpectation {
 public:
  SliceExpectation(const ScalarGrid& grid, const Bricks& bricks, const DrawnCells& cells, const IndexBox& box,
                   const Camera& camera, double depth, double spacing, double samplerPrecision, const BrickAtlas& atlas)
      : grid_(grid),
        bricks_(bricks),
        cells_(cells),
        box_(box),
        camera_(camera),
        frame_(cameraFrame(camera)),
        screen_(screenPlane(camera)),
        view_(indexView(camera, bricks.indexToWorld)),
        depth_(depth),
        spacing_(spacing),
        scale_(camera.projection == Projection::perspective ? depth : 1.0),
        samplerPrecision_(samplerPrecision),
        textureEdge_(std::max({atlas.textureSize().x, atlas.textureSize().y, atlas.textureSize().z})),
        formatError_(atlas.formatError()),
        centre_(view_.eyeIndex + depth * view_.toIndex[2]) {}

  // Compares rows [first, last) of a probed image. @param stride  of the pixels whose values are compared
  Counts compare(const Image& probe, int first, int last, int stride) const {
    Counts counts;
    const auto accessor = grid_.grid->getConstUnsafeAccessor();
    for (int y = first; y < last; ++y)
      for (int x = 0; x < probe.width; ++x) {
        const glm::dvec2 p = (glm::dvec2(x, y) + 0.5) * screen_.pixelSize - screen_.halfExtent;
        const glm::dvec3 index = centre_ + scale_ * (p.x * view_.toIndex[0] + p.y * view_.toIndex[1]);
        const float* pixel = probe.at(x, y);
        compareHits(index, static_cast<int>(std::lround(pixel[1])), {x, y}, counts);
        if (pixel[1] == 1.0f && (y * probe.width + x) % stride == 0)
          compareValue(accessor, p, pixel[0], {x, y}, counts);
      }
    return counts;
  }

 private:
  using Accessor = openvdb::FloatGrid::ConstUnsafeAccessor;

  void compareHits(const glm::dvec3& index, int hits, const glm::ivec2& pixel, Counts& counts) const {
    ++counts.pixels;
    // The rasteriser snaps vertices to 1/256 pixel, after rounding them to 24 bits: an outer edge may be wrong
    // by so much.
    const double pixels = 1.0 / kSubpixels + 0x1p-23 * std::max(camera_.width, camera_.height);
    glm::dvec3 perPixel, slack;
    for (int axis = 0; axis < 3; ++axis) {
      perPixel[axis] = scale_ * screen_.pixelSize.x * std::hypot(view_.toIndex[0][axis], view_.toIndex[1][axis]);
      slack[axis] = pixels * perPixel[axis] + 1e-10 * (1 + std::abs(index[axis]));
    }
    bool all = true, any = false;
    const glm::ivec3 low = cells_.cellOf(index - slack), high = cells_.cellOf(index + slack);
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
          const bool drawn = cells_.contains({x, y, z});
          all = all && drawn;
          any = any || drawn;
        }
    // Polygons are cut at the faces of the medium's box, with half a slab and a margin to spare. The margin is measured
    // at the back of the slab.
    const double growth = 1 + 0.5 * spacing_ / depth_;
    const glm::dvec3 spare = slabReach(view_, spacing_) + growth * kPlaneMargin * perPixel + slack;
    for (int axis = 0; axis < 3; ++axis) {
      all = all && index[axis] > box_.min[axis] + slack[axis] && index[axis] < box_.max[axis] - slack[axis];
      any = any && index[axis] > box_.min[axis] - spare[axis] && index[axis] < box_.max[axis] + spare[axis];
    }
    counts.excluded += any && !all;
    if ((all && hits < 1) || hits > (any ? 1 : 0)) counts.gapPixel = pixel;
    counts.gaps += all && hits < 1;
    counts.doubleHits += hits > (any ? 1 : 0);
  }

  // Measures the displacement that explains how far a value is off, by the steepest slope of the cells around.
  void compareValue(const Accessor& accessor, const glm::dvec2& p, double value, const glm::ivec2& pixel,
                    Counts& counts) const {
    const bool perspective = camera_.projection == Projection::perspective;
    const glm::dvec3 world =
        camera_.eye + depth_ * frame_.forward + (perspective ? depth_ : 1.0) * (p.x * frame_.right + p.y * frame_.up);
    const openvdb::Vec3d index = grid_.grid->worldToIndex(openvdb::Vec3d(world.x, world.y, world.z));
    float expected = 0;
    openvdb::tools::BoxSampler::sample(accessor, index, expected);
    if (!std::isfinite(expected)) return;  // voxels that are not finite count as background
    ++counts.values;
    const glm::dvec3 at(index.x(), index.y(), index.z());
    double sideways = 0;
    for (int axis = 0; axis < 3; ++axis) sideways = std::max(sideways, std::abs(at[axis] - centre_[axis]));
    const double limit = coordinateError(textureEdge_, sideways) + samplerPrecision_;
    counts.limit = std::max(counts.limit, limit);
    // Interpolation rounds in three steps, each of numbers as large as the largest voxel.
    const double largest = std::max(std::abs(bricks_.value.min), std::abs(bricks_.value.max));
    const double off = std::abs(value - expected) - formatError_ - 0x1p-21 * largest;
    if (!(off > 0)) return;
    const double slope = steepest(accessor, at);
    const double displacement = slope > 0 ? off / slope : std::numeric_limits<double>::infinity();
    if (displacement > counts.displacement) {
      counts.displacement = displacement;
      counts.worstPixel = pixel;
    }
  }

  // Returns the largest change of the interpolated value for a step of one voxel along all three axes, in
  // the cells around.
  static double steepest(const Accessor& accessor, const glm::dvec3& index) {
    const glm::ivec3 low = glm::ivec3(glm::floor(index)) - 1;
    Range range;
    for (int z = 0; z < 4; ++z)
      for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) range.include(accessor.getValue(openvdb::Coord(low.x + x, low.y + y, low.z + z)));
    return 3 * static_cast<double>(range.extent());
  }

  const ScalarGrid& grid_;
  const Bricks& bricks_;
  const DrawnCells& cells_;
  const IndexBox box_;  // the box of the medium
  const Camera& camera_;
  CameraFrame frame_;
  ScreenPlane screen_;
  IndexView view_;
  double depth_, spacing_, scale_;
  const double samplerPrecision_;  // voxels
  const int textureEdge_;
  const double formatError_;  // of the texels that are resident, grid units
  glm::dvec3 centre_;         // centre of the slice, index coordinates
};

// Returns a medium that is nowhere seen, or everywhere: then the background's cells are drawn, too.
TransferFunction constantMedium(double sigma_t, bool is2d) {
  const Medium medium{glm::dvec3(1), sigma_t};
  return is2d ? TransferFunction({0}, {0}, {medium}) : TransferFunction({{0, medium}});
}

std::string printPixel(const glm::ivec2& pixel) {
  return pixel.x < 0 ? "" : ", pixel " + std::to_string(pixel.x) + " " + std::to_string(pixel.y);
}

}  // namespace

void SliceChecker::check(const ResolvedScene& scene, const std::string& view, bool complete,
                         const SliceResults& results, const std::function<void(double share)>& progress) {
  const Bricks& bricks = resident_.volume();
  ResolvedScene drawn = scene;
  drawn.transfer = constantMedium(complete ? 1e-9 : 0, scene.transfer.is2d());
  drawn.model = Model::emission;
  drawn.bricks.culling = false;
  drawn.sampling.saturation = 0;
  drawn.sampling.pixelSamples = 1;  // what is probed are the rays through the centres of pixels
  drawn.clipPlanes.clear();
  drawn.clipBox.reset();
  drawn.camera.nearDistance = 0;
  const DrawnCells cells(bricks, complete);
  if (renderer_)
    renderer_->setScene(drawn);
  else
    renderer_.emplace(resident_, drawn);
  renderer_->cut();
  const std::vector<double> depths = renderer_->sliceDepths();
  const auto count = static_cast<std::int64_t>(depths.size());
  const std::int64_t probes = std::min<std::int64_t>(slices_, count);
  const int stride = std::max(1, drawn.camera.width * drawn.camera.height / 8192) | 1;
  for (std::int64_t i = 0; i < probes; ++i) {
    progress(static_cast<double>(i) / static_cast<double>(probes));
    // The first slice is probed, the last one, and others between them.
    const std::int64_t slice = probes > 1 ? i * (count - 1) / (probes - 1) : 0;
    const Image probe = renderer_->probe(slice);
    const SliceExpectation expected(grid_, bricks, cells, mediumBox(drawn.transfer, bricks.domain), drawn.camera,
                                    depths[static_cast<std::size_t>(slice)], drawn.sampling.spacing, samplerPrecision_,
                                    resident_.atlas());
    const Counts counts = tbb::parallel_reduce(
        tbb::blocked_range<int>(0, probe.height, 8), Counts{},
        [&](const auto& rows, Counts sum) {
          sum.join(expected.compare(probe, rows.begin(), rows.end(), results.values ? stride : 1 << 30));
          return sum;
        },
        [](Counts a, const Counts& b) {
          a.join(b);
          return a;
        });
    const std::string where =
        view + ", bricks of " + std::to_string(bricks.layout.interior.x) + ", slice " + std::to_string(slice);
    for (InvariantResult* result : {results.gaps, results.doubleHits}) result->excluded += counts.excluded;
    addMeasurement(*results.gaps, static_cast<double>(counts.gaps), 0, counts.pixels,
                   where + printPixel(counts.gapPixel));
    addMeasurement(*results.doubleHits, static_cast<double>(counts.doubleHits), 0, counts.pixels,
                   where + printPixel(counts.gapPixel));
    if (results.values && counts.values > 0)
      addMeasurement(*results.values, counts.displacement, counts.limit, counts.values,
                     where + printPixel(counts.worstPixel));
  }
}

}  // namespace umbrick
