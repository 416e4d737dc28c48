// SPDX-License-Identifier: Apache-2.0
#include "vdb/vdb_file.h"

#include <algorithm>
#include <map>
#include <new>

#include "umbrick/core/error.h"
#include "vdb/nano_file.h"
#include "vdb/vdb_check.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

// Files from before OpenVDB 1.0.1 of 2012 lay out their nodes in other ways, and are refused.
constexpr std::uint32_t kOldestVersion = openvdb::OPENVDB_FILE_VERSION_NODE_MASK_COMPRESSION;
constexpr std::string_view kHalfSuffix = "_HalfFloat";

}  // namespace

// Runs `action` and turns every failure inside it into one IoError that names the file.
template <class Action>
auto VdbFile::guarded(const std::string& what, const Action& action) {
  try {
    return action();
  } catch (const Error&) {
    throw;
  } catch (const BrokenVdb& error) {
    throw IoError(path_.string() + ": " + what + error.what());
  } catch (const std::ios_base::failure&) {
    throw IoError(path_.string() + ": " + what + "truncated or corrupt, the data run past the end of the file at " +
                  std::to_string(fileBytes()) + " bytes");
  } catch (const std::bad_alloc&) {
    throw IoError(path_.string() + ": " + what + "corrupt, or too large for the memory");
  } catch (const std::exception& error) {
    throw IoError(path_.string() + ": " + what + "truncated or corrupt: " + error.what());
  }
}

VdbFile::VdbFile(const fs::path& path) : path_(path), file_(path), buffer_(file_.bytes()), stream_(&buffer_) {
  openvdb::initialize();
  stream_.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
  guarded("", [&] { isNanoVdb(file_.bytes()) ? readNano() : readHead(); });
  nameEntries();
}

void VdbFile::readHead() {
  VdbCursor head(file_.bytes(), 0);
  if (fileBytes() < 8 || head.number<std::int64_t>() != openvdb::OPENVDB_MAGIC)
    throw BrokenVdb("expected a .vdb file, found other first bytes");
  const auto found = head.number<std::uint32_t>();
  if (found < kOldestVersion || found > openvdb::OPENVDB_FILE_VERSION)
    throw BrokenVdb("file version: expected " + std::to_string(kOldestVersion) + " to " +
                    std::to_string(openvdb::OPENVDB_FILE_VERSION) + ", found " + std::to_string(found));
  readHeader(stream_);
  streamMetadata_ = std::make_shared<openvdb::io::StreamMetadata>();
  streamMetadata_->setSeekable(inputHasGridOffsets());
  openvdb::io::setStreamMetadataPtr(stream_, streamMetadata_, /*transfer=*/false);
  setFormatVersion(stream_);
  setLibraryVersion(stream_);
  setDataCompression(stream_);
  VdbCursor metadata(file_.bytes(), stream_.tellg());
  checkMetadata(metadata);
  metadata_.readMeta(stream_);

  const auto count = VdbCursor(file_.bytes(), stream_.tellg()).number<std::int32_t>();
  if (count < 0) throw BrokenVdb("corrupt: the file says that it has " + std::to_string(count) + " grids");
  stream_.seekg(sizeof count, std::ios::cur);
  for (std::int32_t i = 0; i < count; ++i) entries_.push_back(readEntry());
}

void VdbFile::readNano() {
  for (NanoGridEntry& grid : readNanoGrids(file_.bytes(), nano_))
    entries_.push_back({{},
                        grid.name,
                        grid.valueType,
                        grid.fileBytes,
                        openvdb::io::GridDescriptor(grid.name, grid.valueType),
                        grid.grid});
}

// Reads one row of the table of grids. Each row stands in front of the data of its grid.
VdbFile::Entry VdbFile::readEntry() {
  VdbCursor row(file_.bytes(), stream_.tellg());
  const std::string uniqueName = row.string();
  std::string type = row.string();
  const bool saved = type.ends_with(kHalfSuffix);
  if (saved) type.resize(type.size() - kHalfSuffix.size());
  Entry entry{{}, {}, valueTypeName(type), 0, openvdb::io::GridDescriptor(uniqueName, type, saved), {}};
  entry.name = entry.descriptor.gridName();
  entry.descriptor.setInstanceParentName(row.string());
  const auto gridPos = row.number<std::int64_t>(), blockPos = row.number<std::int64_t>(),
             endPos = row.number<std::int64_t>();
  const std::int64_t start = row.position();
  stream_.seekg(start);
  if (inputHasGridOffsets()) {
    if (gridPos < start || blockPos < gridPos || endPos < blockPos || endPos > fileBytes())
      throw BrokenVdb("truncated or corrupt: grid \"" + entry.name + "\" should end at byte " + std::to_string(endPos) +
                      ", the file has " + std::to_string(fileBytes()));
    entry.descriptor.setGridPos(gridPos);
    entry.fileBytes = endPos - gridPos;
    stream_.seekg(endPos);
  } else {
    if (!layoutOf(entry.valueType))
      throw BrokenVdb("grid \"" + entry.name + "\": expected a type that can be read from a stream, found " +
                      entry.valueType);
    entry.loaded = readHere(entry);
    entry.fileBytes = static_cast<std::int64_t>(stream_.tellg()) - start;
  }
  return entry;
}

void VdbFile::nameEntries() {
  std::map<std::string, int> total, seen;
  for (const Entry& entry : entries_) ++total[entry.name];
  for (Entry& entry : entries_) {
    const int index = seen[entry.name]++;
    entry.label =
        total[entry.name] > 1 || entry.name.empty() ? entry.name + '[' + std::to_string(index) + ']' : entry.name;
  }
}

const VdbFile::Entry* VdbFile::find(const std::string& selector) const {
  for (const Entry& entry : entries_)
    if (entry.label == selector || entry.name == selector || entry.name + "[0]" == selector) return &entry;
  return nullptr;
}

openvdb::GridBase::Ptr VdbFile::read(const Entry& entry, const std::function<void(double)>& progress) {
  if (progress) {
    const auto begin = static_cast<double>(entry.descriptor.getGridPos());
    const double bytes = std::max(1.0, static_cast<double>(entry.fileBytes));
    buffer_.tell([&progress, begin, bytes](std::size_t position) {
      progress(std::clamp((static_cast<double>(position) - begin) / bytes, 0.0, 1.0));
    });
    try {
      const openvdb::GridBase::Ptr grid = read(entry);
      buffer_.tell({});
      return grid;
    } catch (...) {
      buffer_.tell({});
      throw;
    }
  }
  return guarded("grid \"" + entry.label + "\": ", [&] {
    openvdb::GridBase::Ptr grid = entry.loaded;
    if (!nano_.empty()) return grid;
    if (!grid) {
      stream_.clear();
      stream_.seekg(entry.descriptor.getGridPos());
      grid = readHere(entry);
    }
    if (!entry.descriptor.isInstance()) return grid;
    // An instance shares the tree of another grid.
    for (const Entry& parent : entries_)
      if (parent.descriptor.uniqueName() == entry.descriptor.instanceParentName() && !parent.descriptor.isInstance()) {
        const openvdb::GridBase::Ptr other = read(parent);
        if (other && other->type() == grid->type()) {
          grid->setTree(other->baseTreePtr());
          return grid;
        }
      }
    throw BrokenVdb("corrupt: the grid whose voxels it shares is missing");
  });
}

// Reads the grid at whose data the stream stands.
openvdb::GridBase::Ptr VdbFile::readHere(const Entry& entry) {
  const std::string& type = entry.descriptor.gridType();
  if (!openvdb::GridBase::isRegistered(type)) return nullptr;
  const std::int64_t start = stream_.tellg();
  // At first metadata and transform are read here, and the tree behind them is checked.
  readGridCompression(stream_);
  VdbCursor cursor(file_.bytes(), stream_.tellg());
  checkMetadata(cursor);
  cursor.string();  // the type of the transform, the only part of it that has a length
  openvdb::GridBase::Ptr grid = openvdb::GridBase::createGrid(type);
  grid->setSaveFloatAsHalf(entry.descriptor.saveFloatAsHalf());
  grid->readMeta(stream_);  // the metadata have the last word on half floats
  grid->readTransform(stream_);
  const VdbLayout* layout = layoutOf(entry.valueType);
  if (!layout) return grid;
  if (!entry.descriptor.isInstance()) {
    VdbCursor tree(file_.bytes(), stream_.tellg());
    checkTree(tree, *layout, openvdb::io::getDataCompression(stream_), grid->saveFloatAsHalf());
  }
  // Then OpenVDB reads the same bytes.
  stream_.seekg(start);
  grid = openvdb::GridBase::createGrid(type);
  readGrid(grid, entry.descriptor, stream_);
  return grid;
}

std::string valueTypeName(const std::string& treeType) {
  constexpr std::string_view kPrefix = "Tree_", kNodes = "_5_4_3";
  if (!treeType.starts_with(kPrefix) || !treeType.ends_with(kNodes)) return treeType;
  return treeType.substr(kPrefix.size(), treeType.size() - kPrefix.size() - kNodes.size());
}

bool isScalarType(const std::string& valueType) {
  return valueType == "float" || valueType == "double" || valueType == "int32" || valueType == "int64";
}

}  // namespace umbrick
