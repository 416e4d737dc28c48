// SPDX-License-Identifier: Apache-2.0
#include "ingest/hdf5_types.h"

#include <array>

#include "ingest/hdf5_handle.h"

namespace umbrick {

std::optional<Hdf5Number> hdf5Number(hid_t dataset) {
  using enum VoxelType;
  const Hdf5Handle type(H5Dget_type(dataset), H5Tclose);
  const std::size_t bytes = H5Tget_size(type.get());
  const H5T_class_t kind = H5Tget_class(type.get());
  const int power = bytes == 1 ? 0 : bytes == 2 ? 1 : bytes == 4 ? 2 : bytes == 8 ? 3 : -1;
  if (power < 0) return std::nullopt;
  const auto at = static_cast<std::size_t>(power);
  if (kind == H5T_INTEGER) {
    const VoxelType found =
        H5Tget_sign(type.get()) == H5T_SGN_2 ? std::array{i8, i16, i32, i64}[at] : std::array{u8, u16, u32, u64}[at];
    return Hdf5Number{found, found};
  }
  if (kind != H5T_FLOAT || power < 1) return std::nullopt;
  const VoxelType found = std::array{f16, f16, f32, f64}[at];
  return Hdf5Number{found, found == f16 ? f32 : found};  // libhdf5 widens halves, exactly
}

std::string hdf5TypeText(hid_t dataset) {
  const Hdf5Handle type(H5Dget_type(dataset), H5Tclose);
  const std::string bits = std::to_string(8 * H5Tget_size(type.get())) + " bits";
  switch (H5Tget_class(type.get())) {
    case H5T_INTEGER:
      return "an integer of " + bits;
    case H5T_FLOAT:
      return "a float of " + bits;
    case H5T_ENUM:
      return "an enumeration, which is not read; bool of h5py and PyTables is one: store it as uint8";
    case H5T_STRING:
      return "text";
    case H5T_BITFIELD:
      return "a bit field of " + bits;
    case H5T_COMPOUND:
      return "a compound; complex numbers are stored so";
    case H5T_REFERENCE:
      return "references";
    case H5T_ARRAY:
      return "an array in each voxel";
    case H5T_VLEN:
      return "a sequence of its own length in each voxel";
    default:
      return "another type";
  }
}

hid_t hdf5MemoryType(VoxelType type) {
  switch (type) {
    case VoxelType::u8:
      return H5T_NATIVE_UINT8;
    case VoxelType::i8:
      return H5T_NATIVE_INT8;
    case VoxelType::u16:
      return H5T_NATIVE_UINT16;
    case VoxelType::i16:
      return H5T_NATIVE_INT16;
    case VoxelType::u32:
      return H5T_NATIVE_UINT32;
    case VoxelType::i32:
      return H5T_NATIVE_INT32;
    case VoxelType::u64:
      return H5T_NATIVE_UINT64;
    case VoxelType::i64:
      return H5T_NATIVE_INT64;
    case VoxelType::f64:
      return H5T_NATIVE_DOUBLE;
    default:
      return H5T_NATIVE_FLOAT;
  }
}

}  // namespace umbrick
