// SPDX-License-Identifier: Apache-2.0
#include "vdb/vdb_check.h"

#include <openvdb/Metadata.h>
#include <openvdb/io/Compression.h>

#include <algorithm>
#include <array>
#include <bit>
#include <tuple>
#include <vector>

namespace umbrick {
namespace {

constexpr std::int64_t kRootEdge = 4096;  // voxels along the edge of a child of the root

class TreeWalk {
 public:
  TreeWalk(VdbCursor& cursor, const VdbLayout& layout, std::uint32_t compression, bool savedAsHalf)
      : cursor_(cursor), layout_(layout), compression_(compression), half_(savedAsHalf) {}

  void run() {
    if (cursor_.number<std::int32_t>() != 1) throw BrokenVdb("corrupt: a tree of several buffers");
    cursor_.take(layout_.valueBytes);  // background
    const auto tiles = cursor_.number<std::uint32_t>(), children = cursor_.number<std::uint32_t>();
    for (std::uint32_t i = 0; i < tiles; ++i) {
      const Key key = rootKey();
      cursor_.take(layout_.valueBytes);
      if (cursor_.number<std::uint8_t>() > 1) throw BrokenVdb("corrupt: a tile is neither active nor inactive");
      keys_.push_back(key);
    }
    for (std::uint32_t i = 0; i < children; ++i) {
      Child child{rootKey(), {}};
      keys_.push_back(child.key);
      upperNode(child);
      children_.push_back(std::move(child));
    }
    std::sort(keys_.begin(), keys_.end());
    if (std::adjacent_find(keys_.begin(), keys_.end()) != keys_.end())
      throw BrokenVdb("corrupt: two nodes in one place");
    // The buffers of the leaves come in the order in which the root keeps its children.
    std::sort(children_.begin(), children_.end(), [](const Child& a, const Child& b) { return a.key < b.key; });
    for (const Child& child : children_)
      for (const char* mask : child.leafMasks) leafBuffer(mask);
  }

 private:
  using Key = std::array<std::int32_t, 3>;
  struct Child {
    Key key;
    std::vector<const char*> leafMasks;
  };

  Key rootKey() {
    const Key key{cursor_.number<std::int32_t>(), cursor_.number<std::int32_t>(), cursor_.number<std::int32_t>()};
    for (const std::int32_t coordinate : key)
      if (coordinate % kRootEdge != 0) throw BrokenVdb("corrupt: a node that lies across others");
    return key;
  }

  static std::int64_t bitsOn(const char* mask, std::int64_t bytes) {
    std::int64_t count = 0;
    for (std::int64_t at = 0; at < bytes; at += 8) {
      std::uint64_t word;
      std::memcpy(&word, mask + at, 8);
      count += std::popcount(word);
    }
    return count;
  }

  void upperNode(Child& child) {
    constexpr std::int64_t kValues = 32 * 32 * 32;
    const std::int64_t lowerNodes = bitsOn(innerNode(kValues), kValues / 8);
    for (std::int64_t i = 0; i < lowerNodes; ++i) lowerNode(child);
  }

  void lowerNode(Child& child) {
    constexpr std::int64_t kValues = 16 * 16 * 16;
    const std::int64_t leaves = bitsOn(innerNode(kValues), kValues / 8);
    for (std::int64_t i = 0; i < leaves; ++i) child.leafMasks.push_back(cursor_.take(64));
  }

  // Checks an inner node with so many values. @return the mask of its children
  const char* innerNode(std::int64_t values) {
    const char* childMask = cursor_.take(values / 8);
    const char* valueMask = cursor_.take(values / 8);
    for (std::int64_t i = 0; i < values / 8; ++i)
      if (childMask[i] & valueMask[i]) throw BrokenVdb("corrupt: a node that is a tile as well");
    compressedValues(values, valueMask);
    return childMask;
  }

  void leafBuffer(const char* mask) {
    if (std::memcmp(cursor_.take(64), mask, 64) != 0) throw BrokenVdb("corrupt: a leaf with two masks");
    if (layout_.leaves == VdbLayout::Leaves::values) {
      compressedValues(512, mask);
      return;
    }
    cursor_.take(12);  // origin
    if (layout_.leaves == VdbLayout::Leaves::bools) cursor_.take(64);
  }

  // Checks what openvdb::io::readCompressedValues reads.
  void compressedValues(std::int64_t count, const char* mask) {
    const auto kind = cursor_.number<std::int8_t>();
    using namespace openvdb::io;
    if (kind < NO_MASK_OR_INACTIVE_VALS || kind > NO_MASK_AND_ALL_VALS)
      throw BrokenVdb("corrupt: an unknown kind of node");
    if (kind == NO_MASK_AND_ONE_INACTIVE_VAL || kind == MASK_AND_ONE_INACTIVE_VAL) cursor_.take(layout_.valueBytes);
    if (kind == MASK_AND_TWO_INACTIVE_VALS) cursor_.take(2 * std::int64_t(layout_.valueBytes));
    if (kind == MASK_AND_NO_INACTIVE_VALS || kind == MASK_AND_ONE_INACTIVE_VAL || kind == MASK_AND_TWO_INACTIVE_VALS)
      cursor_.take(count / 8);
    if ((compression_ & COMPRESS_ACTIVE_MASK) && kind != NO_MASK_AND_ALL_VALS) count = bitsOn(mask, count / 8);
    const bool shortened = half_ && layout_.halfBytes != layout_.valueBytes;
    if (shortened && count == 0) return;
    block(count * (shortened ? layout_.halfBytes : layout_.valueBytes));
  }

  // Checks a block of bytes. If values are packed, a length stands in front of it, which is negative for a block that
  // is not packed.
  void block(std::int64_t bytes) {
    using namespace openvdb::io;
    if (!(compression_ & (COMPRESS_BLOSC | COMPRESS_ZIP))) {
      cursor_.take(bytes);
      return;
    }
    const auto length = cursor_.number<std::int64_t>();
    if (length <= 0) {
      if (length != -bytes)
        throw BrokenVdb("corrupt: expected a block of " + std::to_string(bytes) + " bytes, found a length of " +
                        std::to_string(length));
      cursor_.take(bytes);
      return;
    }
    const char* packed = cursor_.take(length);
    if (!(compression_ & COMPRESS_BLOSC)) return;
    // Blosc is not told the length, so its header must not claim more bytes than there are.
    std::int32_t claimed = 0;
    if (length >= 16) std::memcpy(&claimed, packed + 12, sizeof claimed);
    if (claimed < 16 || claimed > length) throw BrokenVdb("corrupt: a Blosc block of the wrong length");
  }

  VdbCursor& cursor_;
  VdbLayout layout_;
  std::uint32_t compression_;
  bool half_;
  std::vector<Key> keys_;
  std::vector<Child> children_;
};

}  // namespace

VdbCursor::VdbCursor(std::span<char> bytes, std::int64_t position) : bytes_(bytes), position_(position) {
  if (position < 0 || left() < 0) throw BrokenVdb("corrupt: a position outside the file");
}

char* VdbCursor::take(std::int64_t count) {
  if (count < 0 || count > left())
    throw BrokenVdb("truncated or corrupt: " + std::to_string(count) + " bytes expected at byte " +
                    std::to_string(position_) + ", found " + std::to_string(left()));
  char* const start = bytes_.data() + position_;
  position_ += count;
  return start;
}

std::string VdbCursor::string() {
  const auto length = number<std::uint32_t>();
  return std::string(take(length), length);
}

void checkMetadata(VdbCursor& cursor) {
  const auto count = cursor.number<std::int32_t>();
  for (std::int32_t i = 0; i < count; ++i) {
    cursor.string();  // name
    const auto typeLength = cursor.number<std::uint32_t>();
    char* const type = cursor.take(typeLength);
    std::string typeName(type, typeLength);
    if (typeName == "__delayedload") typeName.back() = type[typeLength - 1] = '?';
    const auto bytes = cursor.number<std::uint32_t>();
    const char* value = cursor.take(bytes);
    if (typeName == "bool" && bytes == 1 && static_cast<unsigned char>(*value) > 1)
      throw BrokenVdb("corrupt: a truth value of " + std::to_string(static_cast<unsigned char>(*value)));
    // OpenVDB reads as many bytes as the type has, whatever the length says.
    if (typeName != "string" && openvdb::Metadata::isRegisteredType(typeName) &&
        openvdb::Metadata::createMetadata(typeName)->size() != bytes)
      throw BrokenVdb("corrupt: metadata of type " + typeName + " with " + std::to_string(bytes) + " bytes");
  }
}

const VdbLayout* layoutOf(const std::string& valueType) {
  using enum VdbLayout::Leaves;
  static constexpr std::array<std::pair<std::string_view, VdbLayout>, 9> kLayouts{{
      {"float", {values, 4, 2}},
      {"double", {values, 8, 2}},
      {"int32", {values, 4, 4}},
      {"int64", {values, 8, 8}},
      {"vec3s", {values, 12, 6}},
      {"vec3d", {values, 24, 6}},
      {"vec3i", {values, 12, 12}},
      {"bool", {bools, 1, 1}},
      {"mask", {masks, 1, 1}},
  }};
  for (const auto& [name, layout] : kLayouts)
    if (name == valueType) return &layout;
  return nullptr;
}

void checkTree(VdbCursor& cursor, const VdbLayout& layout, std::uint32_t compression, bool savedAsHalf) {
  TreeWalk(cursor, layout, compression, savedAsHalf).run();
}

}  // namespace umbrick
