// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <utility>

#include "umbrick/ingest/voxel_source.h"

namespace umbrick {
namespace {

struct TypeRow {
  VoxelType type;
  std::string_view name;
  int bytes;
};
constexpr std::array kTypes{
    TypeRow{VoxelType::u8, "u8", 1},   TypeRow{VoxelType::i8, "i8", 1},   TypeRow{VoxelType::u16, "u16", 2},
    TypeRow{VoxelType::i16, "i16", 2}, TypeRow{VoxelType::u32, "u32", 4}, TypeRow{VoxelType::i32, "i32", 4},
    TypeRow{VoxelType::i64, "i64", 8}, TypeRow{VoxelType::u64, "u64", 8}, TypeRow{VoxelType::f16, "f16", 2},
    TypeRow{VoxelType::f32, "f32", 4}, TypeRow{VoxelType::f64, "f64", 8},
};

const TypeRow& row(VoxelType type) { return kTypes[static_cast<std::size_t>(type)]; }

}  // namespace

std::string_view voxelTypeName(VoxelType type) { return row(type).name; }

std::optional<VoxelType> voxelTypeFromName(std::string_view name) {
  for (const TypeRow& each : kTypes)
    if (each.name == name) return each.type;
  return std::nullopt;
}

int voxelBytes(VoxelType type) { return row(type).bytes; }

bool isFloat(VoxelType type) { return type == VoxelType::f16 || type == VoxelType::f32 || type == VoxelType::f64; }

}  // namespace umbrick
