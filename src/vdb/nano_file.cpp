// SPDX-License-Identifier: Apache-2.0
#include "vdb/nano_file.h"

#include <blosc.h>
#include <zlib.h>

#define NANOVDB_USE_TBB
#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/GridHandle.h>
#include <nanovdb/util/IO.h>
#include <nanovdb/util/NanoToOpenVDB.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>

#include "umbrick/grid/float_grid.h"
#include "vdb/vdb_check.h"

namespace umbrick {
namespace {

constexpr std::uint64_t kMaxDeflate = 1032;  // largest ratio of packing, https://zlib.net/zlib_tech.html
constexpr std::uint64_t kBloscChunk = std::uint64_t(1) << 30;  // of one call of Blosc, before packing

[[noreturn]] void fail(const std::string& field, const std::string& expected, const std::string& found) {
  throw BrokenVdb(field + ": expected " + expected + ", found " + found);
}

// Reads the file from front to back.
class Cursor {
 public:
  explicit Cursor(std::span<const char> bytes) : rest_(bytes) {}
  bool atEnd() const { return rest_.empty(); }
  std::span<const char> take(std::uint64_t count, const std::string& what) {
    if (count > rest_.size())
      fail(what, std::to_string(count) + " bytes", std::to_string(rest_.size()) + " up to the end of the file");
    const auto out = rest_.first(static_cast<std::size_t>(count));
    rest_ = rest_.subspan(out.size());
    return out;
  }
  template <class T>
  T value(const std::string& what) {
    T out;
    std::memcpy(static_cast<void*>(&out), take(sizeof(T), what).data(), sizeof(T));
    return out;
  }

 private:
  std::span<const char> rest_;
};

nanovdb::GridHandle<> unpack(std::span<const char> packed, std::uint64_t size, nanovdb::io::Codec codec) {
  Cursor cursor(packed);
  const auto allocated = [&] { return nanovdb::GridHandle<>(nanovdb::HostBuffer::create(size)); };
  if (codec == nanovdb::io::Codec::NONE) {
    const auto bytes = cursor.take(size, "voxels");
    auto out = allocated();
    std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
  }
  if (codec == nanovdb::io::Codec::ZIP) {
    const auto bytes = cursor.take(cursor.value<std::uint64_t>("ZIP"), "ZIP");
    if (size / kMaxDeflate > bytes.size())
      fail("ZIP", "packed bytes for " + std::to_string(size), std::to_string(bytes.size()));
    auto out = allocated();
    uLongf got = size;
    if (uncompress(out.data(), &got, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()) != Z_OK || got != size)
      fail("ZIP", std::to_string(size) + " bytes after unpacking", "corrupt data");
    return out;
  }
  // Blosc says how large each chunk becomes, so this is checked before anything is allocated for it.
  std::vector<std::span<const char>> chunks;
  for (std::uint64_t left = size; left > 0;) {
    const auto bytes = cursor.take(cursor.value<std::uint64_t>("Blosc"), "Blosc");
    std::size_t unpacked = 0;
    const std::uint64_t expected = std::min(left, kBloscChunk);
    if (blosc_cbuffer_validate(bytes.data(), bytes.size(), &unpacked) < 0 || unpacked != expected)
      fail("Blosc", "a chunk of " + std::to_string(expected) + " bytes", std::to_string(unpacked));
    chunks.push_back(bytes);
    left -= expected;
  }
  auto out = allocated();
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    const std::uint64_t from = i * kBloscChunk, want = std::min(size - from, kBloscChunk);
    const int got = blosc_decompress_ctx(chunks[i].data(), out.data() + from, static_cast<std::size_t>(want), 1);
    if (got < 0 || static_cast<std::uint64_t>(got) != want)
      fail("Blosc", std::to_string(want) + " bytes after unpacking", "corrupt data");
  }
  return out;
}

// Follows every pointer from the root to the leaves, and checks it.
class TreeCheck {
 public:
  explicit TreeCheck(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <class Build>
  void check() const {
    using Tree = nanovdb::NanoTree<Build>;
    using Root = typename Tree::RootType;
    const std::int64_t treeAt = sizeof(nanovdb::GridData);
    const auto* tree = at<nanovdb::TreeData<3>>(treeAt);
    const std::int64_t rootAt = sum(treeAt, static_cast<std::int64_t>(tree->mNodeOffset[3]));
    const auto* root = at<typename Root::DataType>(rootAt);
    using Tile = typename Root::DataType::Tile;
    for (std::uint32_t i = 0; i < root->mTableSize; ++i) {
      const auto* tile = at<Tile>(rootAt + std::int64_t(sizeof(*root)) + std::int64_t(i) * std::int64_t(sizeof(Tile)));
      if (tile->isChild()) checkNode<typename Root::ChildNodeType>(sum(rootAt, tile->child));
    }
  }

 private:
  static std::int64_t sum(std::int64_t a, std::int64_t b) {
    std::int64_t out = 0;
    return __builtin_add_overflow(a, b, &out) ? -1 : out;
  }

  template <class T>
  const T* at(std::int64_t offset) const {
    const auto size = std::ssize(bytes_);
    if (offset < 0 || offset > size - std::int64_t(sizeof(T)) || offset % std::int64_t(alignof(T)) != 0)
      fail("nodes", "each within the " + std::to_string(size) + " bytes of the grid",
           "one at " + std::to_string(offset));
    return reinterpret_cast<const T*>(bytes_.data() + offset);
  }

  template <class Node>
  void checkNode(std::int64_t offset) const {
    const auto* data = at<typename Node::DataType>(offset);
    if constexpr (Node::LEVEL == 0) {
      if constexpr (!Node::DataType::FIXED_SIZE) {
        if (data->bitWidth() > 32) fail("leaf", "at most 32 bits a voxel", std::to_string(data->bitWidth()));
        at<std::uint8_t>(sum(offset, static_cast<std::int64_t>(data->memUsage()) - 1));
      }
    } else {
      for (auto child = data->mChildMask.beginOn(); child; ++child)
        checkNode<typename Node::ChildNodeType>(sum(offset, data->mTable[*child].child));
    }
  }

  std::span<const std::uint8_t> bytes_;
};

template <class Build>
openvdb::GridBase::Ptr converted(const nanovdb::GridHandle<>& handle) {
  TreeCheck({handle.data(), static_cast<std::size_t>(handle.size())}).check<Build>();
  const auto grid = nanovdb::nanoToOpenVDB(*reinterpret_cast<const nanovdb::NanoGrid<Build>*>(handle.data()));
  // NanoVDB multiplies matrices with columns, and OpenVDB with rows. The conversion in OpenVDB 10.0.1 forgets to
  // transpose, so the transform is set here.
  const nanovdb::Map& map = reinterpret_cast<const nanovdb::GridData*>(handle.data())->mMap;
  openvdb::Mat4d matrix = openvdb::Mat4d::identity();
  matrix.setMat3(openvdb::Mat3d(map.mMatD).transpose());
  matrix.setTranslation(openvdb::Vec3d(map.mVecD));
  grid->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
  return grid;
}

openvdb::GridBase::Ptr toOpenVdb(nanovdb::GridHandle<>& handle, nanovdb::GridType type) {
  if (handle.size() < sizeof(nanovdb::GridData) + sizeof(nanovdb::TreeData<3>))
    fail("grid size", "room for a grid", std::to_string(handle.size()));
  auto* data = reinterpret_cast<nanovdb::GridData*>(handle.data());
  if (data->mMagic != NANOVDB_MAGIC_NUMBER || data->mGridType != type)
    fail("grid", "the type that the table says", "another one");
  // The table of the file has the name. The name in the grid itself might not end, or lie elsewhere, so it is cut off
  // and no pointer to it is followed.
  data->mGridName[nanovdb::GridData::MaxNameSize - 1] = '\0';
  data->setLongGridNameOn(false);
  using nanovdb::GridType;
  switch (type) {
    case GridType::Float:
      return converted<float>(handle);
    case GridType::Double:
      return converted<double>(handle);
    case GridType::Int32:
      return converted<std::int32_t>(handle);
    case GridType::Int64:
      return converted<std::int64_t>(handle);
    case GridType::Fp4:
      return converted<nanovdb::Fp4>(handle);
    case GridType::Fp8:
      return converted<nanovdb::Fp8>(handle);
    case GridType::Fp16:
      return converted<nanovdb::Fp16>(handle);
    default:
      return converted<nanovdb::FpN>(handle);
  }
}

// Returns the name of a scalar type, or nothing for other types.
std::optional<std::string> scalarName(nanovdb::GridType type) {
  using nanovdb::GridType;
  if (type == GridType::Float || (type >= GridType::Fp4 && type <= GridType::FpN)) return "float";
  if (type == GridType::Double) return "double";
  if (type == GridType::Int32) return "int32";
  if (type == GridType::Int64) return "int64";
  return std::nullopt;
}

NanoGridEntry readGrid(const nanovdb::io::MetaData& meta, std::string name, std::span<const char> packed,
                       nanovdb::io::Codec codec) {
  NanoGridEntry entry{std::move(name), {}, std::ssize(packed), {}};
  const auto scalar = scalarName(meta.gridType);
  if (!scalar) {
    entry.valueType = meta.gridType < nanovdb::GridType::End ? nanovdb::toStr(meta.gridType) : "unknown";
    return entry;
  }
  entry.valueType = *scalar;
  nanovdb::GridHandle<> handle = unpack(packed, meta.gridSize, codec);
  entry.grid = toOpenVdb(handle, meta.gridType);
  entry.grid->setName(entry.name);
  return entry;
}

}  // namespace

bool isNanoVdb(std::span<const char> file) { return file.size() >= 8 && std::memcmp(file.data(), "NanoVDB0", 8) == 0; }

std::vector<NanoGridEntry> readNanoGrids(std::span<const char> file, std::string& version) {
  std::vector<NanoGridEntry> out;
  for (Cursor cursor(file); !cursor.atEnd();) {
    const auto header = cursor.value<nanovdb::io::Header>("segment");
    if (header.magic != NANOVDB_MAGIC_NUMBER) fail("segment", "first bytes NanoVDB0", "others");
    if (header.version.getMajor() != NANOVDB_MAJOR_VERSION_NUMBER)
      fail("NanoVDB version", std::to_string(NANOVDB_MAJOR_VERSION_NUMBER), std::to_string(header.version.getMajor()));
    if (header.codec >= nanovdb::io::Codec::END)
      fail("codec", "0 to 2 (none, ZIP or Blosc)", std::to_string(static_cast<int>(header.codec)));
    version = std::to_string(header.version.getMajor()) + '.' + std::to_string(header.version.getMinor());
    std::vector<std::pair<nanovdb::io::MetaData, std::string>> table;
    for (int i = 0; i < header.gridCount; ++i) {
      const auto meta = cursor.value<nanovdb::io::MetaData>("table of grids");
      const auto name = cursor.take(meta.nameSize, "name of a grid");
      table.emplace_back(meta, std::string(name.begin(), std::find(name.begin(), name.end(), '\0')));
    }
    for (const auto& [meta, name] : table)
      out.push_back(readGrid(meta, name, cursor.take(meta.fileSize, "grid \"" + name + '"'), header.codec));
  }
  return out;
}

}  // namespace umbrick
