// SPDX-License-Identifier: Apache-2.0
#include "umbrick/render/open_reference.h"

#include <bit>

#include "umbrick/core/error.h"

namespace umbrick {
namespace {

RawOptions rawOptions(const VolumeReference& reference) {
  const RawLayout& layout = *reference.raw;
  RawOptions raw;
  raw.dims = layout.dims;
  const std::optional<VoxelType> type = voxelTypeFromName(layout.type);
  if (!type)
    throw InvalidArgument(
        "volume.raw.type: expected one of u8, i8, u16, i16, u32, i32, i64, u64, f16, f32 or f64, found '" +
        layout.type + "'");
  raw.type = *type;
  raw.endian = layout.bigEndian ? std::endian::big : std::endian::little;
  raw.headerBytes = layout.headerBytes;
  raw.bitsStored = layout.bitsStored;
  raw.spacing = reference.spacing.value_or(raw.spacing);
  raw.origin = reference.origin.value_or(raw.origin);
  return raw;
}

}  // namespace

OpenOptions openOptions(const VolumeReference& reference) {
  OpenOptions open;
  open.series = reference.series;
  open.where = reference.where;
  if (reference.raw) {
    open.raw = rawOptions(reference);
  } else {
    open.spacing = reference.spacing;
    open.origin = reference.origin;
  }
  return open;
}

}  // namespace umbrick
