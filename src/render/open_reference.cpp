// SPDX-License-Identifier: Apache-2.0
#include "umbrick/render/open_reference.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <string>

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

// The part of a volume that "[3].x", "[3]" or ".x" names.
PartChoice partOf(const VolumeReference& reference) {
  PartChoice parts;
  const std::string& selector = reference.grid;
  if (selector.empty()) return parts;
  const std::size_t dot = selector.rfind('.');
  const std::string frame = selector.substr(0, std::min(dot, selector.size()));
  if (dot != std::string::npos) chooseComponent(selector.substr(dot + 1), parts);
  if (frame.empty()) return parts;
  std::int64_t number = 0;
  const char *begin = frame.data() + 1, *end = frame.data() + frame.size() - 1;
  if (frame.size() < 3 || frame.front() != '[' || frame.back() != ']' || std::from_chars(begin, end, number).ptr != end)
    throw InvalidArgument(reference.file.string() +
                          ": volume.grid is for files of grids, and this is a volume: found '" + selector + "'");
  parts.frame = number;
  return parts;
}

}  // namespace

OpenOptions openOptions(const VolumeReference& reference) {
  OpenOptions open;
  open.parts = partOf(reference);
  open.series = reference.series;
  open.besideOnly = reference.besideOnly;
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
