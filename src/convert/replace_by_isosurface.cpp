// SPDX-License-Identifier: Apache-2.0
#include "convert/replace_by_isosurface.h"

#include <new>

#include "umbrick/core/error.h"
#include "umbrick/core/memory.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {

IsosurfaceReport replaceByIsosurface(const std::filesystem::path& input, const IsosurfaceOptions& options,
                                     BuiltGrid& built) try {
  const Isosurface surface = makeIsosurface({built.grid, built.grid->getName()}, options);
  built.grid = surface.grid;
  built.report.activeVoxels = surface.report.activeVoxels;
  return surface.report;
} catch (const InvalidArgument& error) {
  throw InvalidArgument(input.string() + ": " + error.what());
} catch (const MemoryError& error) {
  throw MemoryError(input.string() + ": " + error.what());
} catch (const std::bad_alloc&) {
  throw outOfMemory(input.string() + ": isosurface");
}

}  // namespace umbrick
