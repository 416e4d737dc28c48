// SPDX-License-Identifier: Apache-2.0
#include "umbrick/vdb/read_grid.h"

#include <openvdb/tree/LeafManager.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>

#include "umbrick/core/error.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/vdb/grid_listing.h"
#include "vdb/vdb_file.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

std::string quoted(const VdbFile::Entry& entry) { return '"' + entry.label + '"'; }

std::string listed(const VdbFile& file) {
  if (file.entries().empty()) return "the file has no grids";
  std::string text = "the file has";
  for (const VdbFile::Entry& entry : file.entries())
    text += (text.ends_with("has") ? " " : ", ") + quoted(entry) + " (" + entry.valueType + ')';
  return text;
}

const VdbFile::Entry& defaultEntry(const VdbFile& file) {
  const VdbFile::Entry *only = nullptr, *density = nullptr;
  int scalars = 0;
  for (const VdbFile::Entry& entry : file.entries()) {
    if (!isScalarType(entry.valueType)) continue;
    ++scalars;
    only = &entry;
    if (entry.name == "density" && !density) density = &entry;
  }
  if (scalars == 1) return *only;
  if (density) return *density;
  const auto isVectors = [](const VdbFile::Entry& entry) { return entry.valueType.starts_with("vec3"); };
  if (scalars == 0 && std::any_of(file.entries().begin(), file.entries().end(), isVectors))
    throw VectorGridFound(file.path().string() + ": no scalar grid: " + listed(file));
  if (scalars == 0) throw InvalidArgument(file.path().string() + ": no scalar grid: " + listed(file));
  throw SeveralGrids(file.path().string() + ": name a grid (none is called \"density\"): " + listed(file));
}

const VdbFile::Entry& findEntry(const VdbFile& file, const std::string& selector) {
  if (selector.empty()) return defaultEntry(file);
  const VdbFile::Entry* entry = file.find(selector);
  if (!entry) throw InvalidArgument(file.path().string() + ": no grid \"" + selector + "\": " + listed(file));
  if (isScalarType(entry->valueType)) return *entry;
  const std::string text =
      file.path().string() + ": grid " + quoted(*entry) + ": expected a scalar grid, found " + entry->valueType;
  if (entry->valueType.starts_with("vec3")) throw VectorGridFound(text);
  throw InvalidArgument(text);
}

template <class Value>
double roundingError(Value value) {
  const auto exact = static_cast<long double>(value);
  return std::isfinite(exact)
             ? static_cast<double>(std::abs(exact - static_cast<long double>(static_cast<float>(value))))
             : 0.0;
}

// Returns the largest rounding error over all values, active or not: of leaves in parallel, then of tiles and
// the background.
template <class Tree>
double conversionErrorOf(const Tree& tree) {
  using Leaf = typename Tree::LeafNodeType;
  openvdb::tree::LeafManager<const Tree> leaves(tree);
  const double inLeaves = tbb::parallel_reduce(
      leaves.leafRange(), 0.0,
      [](const auto& range, double error) {
        for (auto leaf = range.begin(); leaf; ++leaf)
          for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) error = std::max(error, roundingError(leaf->getValue(i)));
        return error;
      },
      [](double a, double b) { return std::max(a, b); });
  double error = std::max(inLeaves, roundingError(tree.background()));
  auto tile = tree.cbeginValueAll();
  tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) error = std::max(error, roundingError(*tile));
  return error;
}

ScalarGrid toFloat(const openvdb::GridBase::Ptr& any) {
  ScalarGrid out;
  out.name = any->getName();
  if (const auto already = openvdb::gridPtrCast<openvdb::FloatGrid>(any)) {
    out.grid = already;
    return out;
  }
  const auto convert = [&](const auto& grid) {
    out.conversionError = conversionErrorOf(grid.tree());
    const auto converted = openvdb::FloatGrid::create(std::make_shared<openvdb::FloatTree>(grid.tree()));
    converted->insertMeta(grid);
    converted->setTransform(grid.transform().copy());
    out.grid = converted;
  };
  any->apply<openvdb::TypeList<openvdb::DoubleGrid, openvdb::Int32Grid, openvdb::Int64Grid>>(convert);
  return out;
}

ScalarGrid read(const fs::path& path, const std::string& selector, bool affineOnly,
                const std::function<void(double)>& progress) {
  VdbFile file(path);
  const VdbFile::Entry& entry = findEntry(file, selector);
  const openvdb::GridBase::Ptr grid = file.read(entry, progress);
  if (affineOnly && !grid->transform().isLinear())
    throw InvalidArgument(path.string() + ": grid " + quoted(entry) + ": expected an affine transform, found " +
                          grid->transform().mapType());
  return toFloat(grid);
}

}  // namespace

ScalarGrid readScalarGrid(const fs::path& path, const std::string& selector,
                          const std::function<void(double share)>& progress) {
  return read(path, selector, true, progress);
}

ScalarGrid readScalarGridAnyTransform(const fs::path& path, const std::string& selector) {
  return read(path, selector, false, {});
}

GridListing listGrids(const fs::path& path) {
  const VdbFile file(path);
  GridListing listing;
  for (const VdbFile::Entry& entry : file.entries()) {
    listing.grids.push_back({entry.label, entry.valueType, isScalarType(entry.valueType)});
  }
  listing.metadata = file.metadata();
  return listing;
}

}  // namespace umbrick
