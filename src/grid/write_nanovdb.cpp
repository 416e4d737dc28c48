#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "umbrick/core/error.h"
#include "umbrick/core/pending_file.h"
#include "umbrick/grid/write_volume.h"

namespace umbrick {

void writeNanoVdb(const std::filesystem::path& path, const std::vector<openvdb::FloatGrid::ConstPtr>& grids) {
  PendingFile pending(path);
  try {
    std::ofstream out;
    out.exceptions(std::ios::failbit | std::ios::badbit);
    out.open(pending.path(), std::ios::binary | std::ios::trunc);
    // A segment of its own for each grid, so that no more than one is in memory twice.
    for (const auto& grid : grids) nanovdb::io::writeGrid(out, nanovdb::openToNanoVDB(*grid));
    out.close();
  } catch (const std::ios_base::failure&) {
    throw IoError(path.string() + ": cannot write: " + std::strerror(errno));
  } catch (const openvdb::Exception& error) {
    throw InvalidArgument(path.string() + ": cannot be NanoVDB: " + error.what());
  } catch (const std::runtime_error& error) {
    throw InvalidArgument(path.string() + ": cannot be NanoVDB: " + error.what());
  }
  pending.commit();
}

}  // namespace umbrick
