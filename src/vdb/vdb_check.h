// Walks over a .vdb file as OpenVDB would read it, and checks every length on the way.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>

namespace umbrick {

/// Says what is wrong with a file, without its name.
struct BrokenVdb : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A place in the bytes of a file, which cannot be moved out of them.
class VdbCursor {
 public:
  VdbCursor(std::span<char> bytes, std::int64_t position);
  std::int64_t position() const { return position_; }
  std::int64_t left() const { return std::int64_t(bytes_.size()) - position_; }
  /// Returns the next `count` bytes. @throw BrokenVdb  there are not so many
  char* take(std::int64_t count);
  template <class T>
  T number() {
    T value;
    std::memcpy(&value, take(sizeof(T)), sizeof(T));
    return value;
  }
  /// Reads a length and as many characters.
  std::string string();

 private:
  std::span<char> bytes_;
  std::int64_t position_;
};

/// Checks a map of metadata. One kind of entry OpenVDB cannot read safely; the name of its type is changed in memory,
/// so that OpenVDB takes it for an unknown type.
/// @throw BrokenVdb  the map is not what it claims to be
/// @pre openvdb::initialize() has been called
void checkMetadata(VdbCursor& cursor);

/// How the values of a type of grid lie in a file.
struct VdbLayout {
  enum class Leaves { values, bools, masks };
  Leaves leaves = Leaves::values;
  int valueBytes = 4;
  int halfBytes = 4;  // bytes of a value when saved as half floats
};
/// Returns null for types that are not read voxel by voxel, such as points.
const VdbLayout* layoutOf(const std::string& valueType);

/// Checks the tree of a grid, nodes 5-4-3, from its start on. This is needed since OpenVDB 10 writes beyond its
/// buffers when the length of an uncompressed block is wrong, allocates what a length says, and counts by masks that
/// are stored twice.
/// @throw BrokenVdb  the tree is not what it claims to be
void checkTree(VdbCursor& cursor, const VdbLayout& layout, std::uint32_t compression, bool savedAsHalf);

}  // namespace umbrick
