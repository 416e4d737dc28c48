// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/list_arrays.h"

#include "ingest/array_lists.h"
#include "ingest/legacy_vtk_head.h"
#include "umbrick/ingest/hdf5_volume.h"
#include "umbrick/ingest/open_volume.h"
#include "umbrick/ingest/vtk_volume.h"

namespace umbrick {

std::vector<ArrayRow> listArrays(const std::filesystem::path& path) {
  if (isHdf5Dataset(path) || !vtkArrayName(path).empty()) return {};
  const std::string format = formatOfFile(path).value_or("");
  if (format == "HDF5") return listHdf5Arrays(path);
  if (format == "VTK ImageData") return listVtiArrays(path);
  if (format == "legacy VTK") return listLegacyArrays(path);
  return {};
}

}  // namespace umbrick
