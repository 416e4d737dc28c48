#include "umbrick/grid/build_grid.h"

#include <openvdb/tools/Prune.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <future>
#include <memory>
#include <sstream>
#include <vector>

#include "grid/sparse_rule.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

constexpr int kEdge = Leaf::DIM;                             // 8 voxels
constexpr std::int64_t kSlabVoxels = std::int64_t(1) << 23;  // enough work for all cores, 32 MB of floats

openvdb::math::Transform::Ptr makeTransform(const std::string& name, const glm::dmat4& indexToWorld) {
  using namespace openvdb::math;
  const glm::dmat4& m = indexToWorld;
  Mat4d map;
  bool diagonal = true;
  for (int axis = 0; axis < 4; ++axis)
    for (int i = 0; i < 4; ++i) {
      map(axis, i) = m[axis][i];
      if (axis < 3 && i < 3 && axis != i && m[axis][i] != 0) diagonal = false;
    }
  // Programs that know only scale and translation can place the grid when it needs no more than that.
  const Vec3d scale(m[0][0], m[1][1], m[2][2]), origin(m[3][0], m[3][1], m[3][2]);
  try {
    MapBase::Ptr base;
    if (diagonal && scale[0] == scale[1] && scale[1] == scale[2])
      base = std::make_shared<UniformScaleTranslateMap>(scale[0], origin);
    else if (diagonal)
      base = std::make_shared<ScaleTranslateMap>(scale, origin);
    else
      base = std::make_shared<AffineMap>(map);
    return std::make_shared<Transform>(base);
  } catch (const openvdb::Exception&) {
    std::ostringstream text;
    text << name << ": spacing: expected voxels of at least 3e-15 cubed world units (OpenVDB allows no less), found "
         << std::abs(map.getMat3().det()) << "; use a smaller unit of length";
    throw InvalidArgument(text.str());
  }
}

openvdb::FloatGrid::Ptr emptyGrid(const VolumeInfo& info, const BuildOptions& options, float background) {
  auto grid = openvdb::FloatGrid::create(background);
  for (const auto& [key, value] : info.metadata)
    if (!key.empty()) grid->insertMeta(key, openvdb::StringMetadata(value));
  grid->setName(options.name);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->setTransform(makeTransform(info.name, info.indexToWorld));
  grid->setSaveFloatAsHalf(options.half);
  return grid;
}

// One layer or more of leaves: the slices [firstSlice, firstSlice + slices) as floats, x fastest.
struct Slab {
  std::int64_t firstSlice = 0, slices = 0;
  std::vector<float> voxels;
};

// What stands in the place of one leaf; neither: background.
struct Place {
  std::unique_ptr<Leaf> leaf;
  std::optional<float> tile;
};

class SlabBuilder {
 public:
  SlabBuilder(const glm::i64vec3& dims, const SparseRule& rule) : dims_(dims), rule_(rule) {}

  /// Builds the leaves of a slab on all cores and adds them to the tree.
  SparseTally addTo(openvdb::FloatTree& tree, const Slab& slab) {
    leavesX_ = (dims_.x + kEdge - 1) / kEdge;
    leavesY_ = (dims_.y + kEdge - 1) / kEdge;
    const std::int64_t layers = (slab.slices + kEdge - 1) / kEdge;
    places_.clear();
    places_.resize(static_cast<std::size_t>(leavesX_ * leavesY_ * layers));
    const SparseTally tally = tbb::parallel_deterministic_reduce(
        tbb::blocked_range<std::size_t>(0, places_.size(), 16), SparseTally{},
        [&](const tbb::blocked_range<std::size_t>& range, SparseTally sum) {
          for (std::size_t i = range.begin(); i != range.end(); ++i) places_[i] = build(slab, origin(i, slab), sum);
          return sum;
        },
        [](SparseTally a, const SparseTally& b) {
          a.add(b);
          return a;
        });
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (places_[i].leaf)
        tree.addLeaf(places_[i].leaf.release());
      else if (places_[i].tile)
        tree.addTile(1, origin(i, slab), *places_[i].tile, true);
    }
    return tally;
  }

 private:
  openvdb::Coord origin(std::size_t place, const Slab& slab) const {
    const auto i = static_cast<std::int64_t>(place);
    return openvdb::Coord(static_cast<int>(i % leavesX_ * kEdge), static_cast<int>(i / leavesX_ % leavesY_ * kEdge),
                          static_cast<int>(slab.firstSlice + i / (leavesX_ * leavesY_) * kEdge));
  }

  Place build(const Slab& slab, const openvdb::Coord& at, SparseTally& tally) const {
    LeafVoxels voxels;
    const auto nx = static_cast<int>(std::min<std::int64_t>(kEdge, dims_.x - at.x()));
    const auto ny = static_cast<int>(std::min<std::int64_t>(kEdge, dims_.y - at.y()));
    const auto nz = static_cast<int>(std::min<std::int64_t>(kEdge, slab.firstSlice + slab.slices - at.z()));
    if (nx < kEdge || ny < kEdge || nz < kEdge) {  // voxels beyond the volume
      std::fill(std::begin(voxels.value), std::end(voxels.value), rule_.background());
      for (int x = 0; x < nx; ++x)
        for (int y = 0; y < ny; ++y)
          for (int z = 0; z < nz; ++z) voxels.active.setOn(static_cast<openvdb::Index>((x << 6) | (y << 3) | z));
    } else {
      voxels.active.setOn();
    }
    for (int z = 0; z < nz; ++z)
      for (int y = 0; y < ny; ++y) {
        const float* row =
            slab.voxels.data() + ((at.z() - slab.firstSlice + z) * dims_.y + at.y() + y) * dims_.x + at.x();
        for (int x = 0; x < nx; ++x) voxels.value[(x << 6) | (y << 3) | z] = row[x];
      }
    Place place;
    place.tile = rule_.apply(voxels, tally);
    if (place.tile || voxels.active.isOff()) return place;
    place.leaf = std::make_unique<Leaf>(at, rule_.background());
    std::copy(std::begin(voxels.value), std::end(voxels.value), place.leaf->buffer().data());
    place.leaf->setValueMask(voxels.active);
    return place;
  }

  glm::i64vec3 dims_;
  const SparseRule& rule_;
  std::int64_t leavesX_ = 0, leavesY_ = 0;
  std::vector<Place> places_;
};

}  // namespace

BuiltGrid buildGrid(VoxelSource& source, const BuildOptions& options) {
  openvdb::initialize();
  const VolumeInfo& info = source.info();
  const SparseRule rule(info.name, options, 0);
  BuiltGrid built{emptyGrid(info, options, rule.background()), {}};
  const std::int64_t sliceVoxels = info.dims.x * info.dims.y;
  const std::int64_t slabSlices = std::max<std::int64_t>(kSlabVoxels / sliceVoxels / kEdge, 1) * kEdge;

  // The next slab is read while the leaves of this one are built.
  const auto readAt = [&](std::int64_t first, Slab& slab) {
    slab.firstSlice = first;
    slab.slices = std::clamp<std::int64_t>(info.dims.z - first, 0, slabSlices);
    slab.voxels.resize(static_cast<std::size_t>(slab.slices * sliceVoxels));
    return slab.slices > 0 ? source.readSlab(slab.slices, slab.voxels) : 0.0;
  };
  SlabBuilder builder(info.dims, rule);
  SparseTally tally;
  Slab slab, next;
  built.report.conversionError = readAt(0, slab);
  while (slab.slices > 0) {
    auto reading = std::async(std::launch::async, readAt, slab.firstSlice + slab.slices, std::ref(next));
    tally.add(builder.addTo(built.grid->tree(), slab));
    built.report.conversionError = std::max(built.report.conversionError, reading.get());
    std::swap(slab, next);
    if (options.progress) options.progress(static_cast<double>(slab.firstSlice) / static_cast<double>(info.dims.z));
  }
  BuildOptions stored = options;
  if (options.maxError) {
    stored = storageWithin(built.grid->tree(), options);
    tally.add(sparsifyTree(built.grid->tree(), SparseRule(info.name, stored, rule.background())));
    built.grid->setSaveFloatAsHalf(stored.half);
  }
  checkTally(info.name, tally);
  // Equal neighbours become larger tiles: no error beyond what the leaves had.
  openvdb::tools::prune(built.grid->tree());
  built.report.voxels = static_cast<std::uint64_t>(sliceVoxels) * static_cast<std::uint64_t>(info.dims.z);
  describe(*built.grid, tally, stored, built.report);
  return built;
}

}  // namespace umbrick
