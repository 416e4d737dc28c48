// SPDX-License-Identifier: Apache-2.0
#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/tree/LeafManager.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "umbrick/core/error.h"
#include "umbrick/core/pending_file.h"
#include "umbrick/vdb/write_volume.h"

namespace umbrick {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

using openvdb::FloatGrid;

QuantiseError sum(QuantiseError a, const QuantiseError& b) {
  a.max = std::max(a.max, b.max);
  a.squares += b.squares;
  a.activeSquares += b.activeSquares;
  return a;
}

template <class Build>
QuantiseError errorOf(const FloatGrid& grid, const nanovdb::NanoGrid<Build>& stored) {
  const openvdb::tree::LeafManager<const openvdb::FloatTree> leaves(grid.tree());
  return tbb::parallel_deterministic_reduce(
      leaves.leafRange(64), QuantiseError{},
      [&](const auto& range, QuantiseError error) {
        const auto access = stored.getAccessor();
        for (auto leaf = range.begin(); leaf; ++leaf) {
          const openvdb::Coord at = leaf->origin();
          const auto* other = access.probeLeaf(nanovdb::Coord(at.x(), at.y(), at.z()));
          if (!other) throw std::runtime_error("a leaf is missing");
          for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
            const double off = std::abs(double(leaf->getValue(i)) - double(other->getValue(i)));
            // Values that are too far apart for a step in 32 bits come back as NaN.
            const double difference = std::isnan(off) ? std::numeric_limits<double>::infinity() : off;
            error.max = std::max(error.max, difference);
            error.squares += difference * difference;
            if (leaf->isValueOn(i)) error.activeSquares += difference * difference;
          }
        }
        return error;
      },
      sum);
}

struct NanoGridData {
  nanovdb::GridHandle<> handle;
  QuantiseError error;
};

template <class Build>
NanoGridData quantised(const FloatGrid& grid, float tolerance = 0) {
  nanovdb::OpenToNanoVDB<float, Build> convert;
  convert.oracle().setTolerance(tolerance);
  NanoGridData out{convert(grid), {}};
  out.error = errorOf(grid, *out.handle.template grid<Build>());
  if (!std::isfinite(out.error.max))
    throw InvalidArgument("grid \"" + grid.getName() +
                          "\": quantise: expected values of a leaf that differ by what a 32-bit float holds");
  return out;
}

NanoGridData adaptive(const FloatGrid& grid, float maxError) {
  // NanoVDB's adaptive conversion reads the sizes of leaves even where there are none.
  if (grid.tree().leafCount() == 0) return quantised<nanovdb::Fp16>(grid);
  // NanoVDB chooses the number of bits with codes that are rounded a little differently from those that it then stores.
  constexpr float kRounding = 0.999f;
  NanoGridData out = quantised<nanovdb::FpN>(grid, kRounding * maxError);
  if (out.error.max > static_cast<double>(maxError)) {
    std::ostringstream text;
    text.precision(9);
    text << "grid \"" << grid.getName() << "\": 16 bits a value are too few: expected a maximum error of at most "
         << maxError << ", found " << out.error.max;
    throw InvalidArgument(text.str());
  }
  return out;
}

NanoGridData toNano(const FloatGrid& grid, const NanoOptions& options) {
  switch (options.values) {
    case NanoValues::bits4:
      return quantised<nanovdb::Fp4>(grid);
    case NanoValues::bits8:
      return quantised<nanovdb::Fp8>(grid);
    case NanoValues::bits16:
      return quantised<nanovdb::Fp16>(grid);
    case NanoValues::adaptive:
      return adaptive(grid, options.maxError);
    default:
      return {nanovdb::openToNanoVDB(grid), {}};
  }
}

}  // namespace

std::vector<QuantiseError> writeNanoVdb(const std::filesystem::path& path,
                                        const std::vector<FloatGrid::ConstPtr>& grids, const NanoOptions& options,
                                        const NanoCheck& check) {
  PendingFile pending(path);
  std::vector<QuantiseError> errors;
  try {
    // Each grid is a segment of its own, so that no more than one is in memory twice.
    for (const auto& grid : grids) {
      const NanoGridData nano = toNano(*grid, options);
      errors.push_back(nano.error);
      nanovdb::io::writeGrid(pending.stream(), nano.handle);
    }
    pending.stream().flush();
  } catch (const IoError&) {
    throw;
  } catch (const Error& error) {
    throw InvalidArgument(path.string() + ": " + error.what());
  } catch (const openvdb::Exception& error) {
    throw InvalidArgument(path.string() + ": cannot be NanoVDB: " + error.what());
  } catch (const std::runtime_error& error) {
    throw InvalidArgument(path.string() + ": cannot be NanoVDB: " + error.what());
  }
  if (check) check(pending.path(), errors);
  pending.commit();
  return errors;
}

}  // namespace umbrick
