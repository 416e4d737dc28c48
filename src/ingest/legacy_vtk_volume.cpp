// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "ingest/array_name.h"
#include "ingest/header_text.h"
#include "ingest/legacy_vtk_head.h"
#include "ingest/parts.h"
#include "ingest/place.h"
#include "ingest/provenance.h"
#include "ingest/streams/dense_source.h"
#include "ingest/streams/text_stream.h"
#include "ingest/volume_time.h"
#include "umbrick/core/error.h"
// Own code for legacy VTK files, since VTK's vtkStructuredPointsReader reads whole arrays and not slabs.
#include "umbrick/ingest/vtk_volume.h"

namespace umbrick {
namespace fs = std::filesystem;
std::unique_ptr<VoxelSource> openLegacyVtk(const fs::path& named, const PartChoice& parts) {
  const auto [path, array] = splitArrayName(named, ".vtk");
  VolumeInfo info;
  info.name = named.string();
  info.fileBytes = checkedFileSize(path);
  if (info.fileBytes < 0) throw IoError(path.string() + ": expected a file, found a pipe or device");
  const LegacyHead head = readLegacyHead(path, array);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis);
    info.dims[a] = head.points[axis] - (head.cells ? 1 : 0);
    info.indexToWorld[a][a] = head.spacing[axis];
    info.indexToWorld[3][a] = head.origin[axis] + (head.cells ? 0.5 * head.spacing[axis] : 0.0);
  }
  info.type = head.type;
  info.components = head.components;
  info.meaning = head.meaning;
  const auto bytes = arrayBytes(info);
  if (!bytes)
    failField(
        path, "DIMENSIONS", "1 to 2147483647 voxels along each axis and less than 2^63 bytes in all",
        std::to_string(head.points[0]) + ' ' + std::to_string(head.points[1]) + ' ' + std::to_string(head.points[2]));
  checkPlace(info, "ORIGIN and SPACING");
  addProvenance(info, path, "VTK structured points");
  if (!head.array.empty()) info.metadata["array_name"] = head.array;
  stateTime(info, {.first = head.time}, {});
  if (head.cycle) info.metadata["cycle"] = std::to_string(*head.cycle);
  VoxelLayout layout;
  layout.type = info.type;
  layout.endian = head.ascii ? std::endian::native : std::endian::big;
  const std::int64_t left = info.fileBytes - head.bytes;
  // Text has at least a digit and a blank for each voxel, but for the last blank.
  if (const std::int64_t least = head.ascii ? *bytes / voxelBytes(info.type) * 2 - 1 : *bytes; left < least)
    throw IoError(path.string() + ": expected " + describeBytes(info) + " after a header of " +
                  std::to_string(head.bytes) + ", found " + std::to_string(left) + (head.ascii ? " of text" : ""));
  guessMeaning(info);
  const auto open = [path = path, head, type = info.type, bytes = *bytes] {
    auto rest = openPlain(path, head.bytes);
    return firstBytes(head.ascii ? decimalStream(std::move(rest), type, path.string()) : std::move(rest), bytes);
  };
  return openParts(std::move(info), PartAxes{}, layout, parts, open);
}

}  // namespace umbrick
