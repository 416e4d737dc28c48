#include "grid/vdb_file.h"

#include <map>
#include <new>
#include <system_error>

#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

constexpr std::uint32_t kOldestVersion = openvdb::OPENVDB_FILE_VERSION_BOOST_UUID;
constexpr const char* kHalfSuffix = "_HalfFloat";

// What the stream or the checks found wrong, without the name of the file.
struct Broken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

std::int64_t regularFileSize(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) throw IoError(path.string() + ": no such file");
  if (status.type() == fs::file_type::directory) throw IoError(path.string() + ": expected a file, found a directory");
  const auto size = fs::file_size(path, error);
  if (error) throw IoError(path.string() + ": cannot read: " + error.message());
  return static_cast<std::int64_t>(size);
}

}  // namespace

// Every failure inside `action` becomes one IoError that names the file.
template <class Action>
auto VdbFile::guarded(const std::string& what, const Action& action) {
  try {
    return action();
  } catch (const Error&) {
    throw;
  } catch (const Broken& error) {
    throw IoError(path_.string() + ": " + what + error.what());
  } catch (const std::ios_base::failure&) {
    throw IoError(path_.string() + ": " + what + "truncated or corrupt, the data run past the end of the file at " +
                  std::to_string(fileBytes_) + " bytes");
  } catch (const std::bad_alloc&) {
    throw IoError(path_.string() + ": " + what + "corrupt, or too large for the memory");
  } catch (const std::exception& error) {
    throw IoError(path_.string() + ": " + what + "truncated or corrupt: " + error.what());
  }
}

VdbFile::VdbFile(const fs::path& path) : path_(path), fileBytes_(regularFileSize(path)) {
  openvdb::initialize();
  stream_.open(path, std::ios::binary);
  if (!stream_) throw IoError(path.string() + ": cannot read");
  stream_.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
  guarded("", [&] { readHead(); });
  nameEntries();
}

void VdbFile::readHead() {
  if (fileBytes_ < 8 || number<std::int64_t>() != openvdb::OPENVDB_MAGIC) throw Broken("not a .vdb file");
  const auto fileVersion = number<std::uint32_t>();
  if (fileVersion < kOldestVersion || fileVersion > openvdb::OPENVDB_FILE_VERSION)
    throw Broken("file version: expected " + std::to_string(kOldestVersion) + " to " +
                 std::to_string(openvdb::OPENVDB_FILE_VERSION) + ", found " + std::to_string(fileVersion));
  stream_.seekg(0);
  readHeader(stream_);
  streamMetadata_ = std::make_shared<openvdb::io::StreamMetadata>();
  streamMetadata_->setSeekable(inputHasGridOffsets());
  openvdb::io::setStreamMetadataPtr(stream_, streamMetadata_, /*transfer=*/false);
  setFormatVersion(stream_);
  setLibraryVersion(stream_);
  setDataCompression(stream_);
  checkMetadata();
  metadata_.readMeta(stream_);

  const auto count = number<std::int32_t>();
  if (count < 0) throw Broken("corrupt: the file says that it has " + std::to_string(count) + " grids");
  for (std::int32_t i = 0; i < count; ++i) entries_.push_back(readEntry());
}

VdbFile::Entry VdbFile::readEntry() {
  const std::string uniqueName = checkedString();
  std::string type = checkedString();
  const bool half = type.ends_with(kHalfSuffix);
  if (half) type.resize(type.size() - std::string_view(kHalfSuffix).size());
  openvdb::io::GridDescriptor descriptor(uniqueName, type, half);
  descriptor.setInstanceParentName(checkedString());
  const auto gridPos = number<std::int64_t>(), blockPos = number<std::int64_t>(), endPos = number<std::int64_t>();
  descriptor.setGridPos(gridPos);
  descriptor.setBlockPos(blockPos);
  descriptor.setEndPos(endPos);
  Entry entry{{}, descriptor.gridName(), type, endPos - gridPos, descriptor, {}};
  if (inputHasGridOffsets()) {
    const std::int64_t here = stream_.tellg();
    if (gridPos < here || blockPos < gridPos || endPos < blockPos || endPos > fileBytes_)
      throw Broken("truncated or corrupt: grid \"" + entry.name + "\" should end at byte " + std::to_string(endPos) +
                   ", the file has " + std::to_string(fileBytes_));
    stream_.seekg(endPos);
  } else {
    const std::int64_t start = stream_.tellg();
    entry.loaded = readTree(entry);
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

openvdb::GridBase::Ptr VdbFile::read(const Entry& entry) {
  return guarded("grid \"" + entry.label + "\": ", [&] {
    openvdb::GridBase::Ptr grid = entry.loaded;
    if (!grid) {
      stream_.clear();
      stream_.seekg(entry.descriptor.getGridPos());
      grid = readTree(entry);
    }
    if (!entry.descriptor.isInstance()) return grid;
    // An instance shares the tree of another grid.
    for (const Entry& parent : entries_)
      if (parent.descriptor.uniqueName() == entry.descriptor.instanceParentName() && &parent != &entry &&
          !parent.descriptor.isInstance()) {
        const openvdb::GridBase::Ptr other = read(parent);
        if (other->type() == grid->type()) {
          grid->setTree(other->baseTreePtr());
          return grid;
        }
      }
    throw Broken("corrupt: the grid whose voxels it shares is missing");
  });
}

openvdb::GridBase::Ptr VdbFile::readTree(const Entry& entry) {
  if (!openvdb::GridBase::isRegistered(entry.type)) throw Broken("unknown type of grid \"" + entry.type + '"');
  // The lengths are checked in a first pass; OpenVDB then reads the same bytes.
  const std::streampos start = stream_.tellg();
  number<std::uint32_t>();  // compression
  checkMetadata();
  checkedString();  // the type of the transform
  stream_.seekg(start);
  const openvdb::GridBase::Ptr grid = openvdb::GridBase::createGrid(entry.type);
  readGrid(grid, entry.descriptor, stream_);
  return grid;
}

// Walks over a map of metadata and comes back to its start.
void VdbFile::checkMetadata() {
  const std::streampos start = stream_.tellg();
  const auto count = number<std::int32_t>();
  for (std::int32_t i = 0; i < count; ++i) {
    checkedString();  // name
    checkedString();  // type
    const auto bytes = number<std::uint32_t>();
    checkLeft(bytes);
    stream_.seekg(bytes, std::ios::cur);
  }
  stream_.seekg(start);
}

std::string VdbFile::checkedString() {
  const auto length = number<std::uint32_t>();
  checkLeft(length);
  std::string text(length, '\0');
  stream_.read(text.data(), length);
  return text;
}

template <class T>
T VdbFile::number() {
  T value{};
  stream_.read(reinterpret_cast<char*>(&value), sizeof(T));
  return value;
}

void VdbFile::checkLeft(std::int64_t bytes) {
  const std::int64_t left = fileBytes_ - static_cast<std::int64_t>(stream_.tellg());
  if (bytes > left)
    throw Broken("truncated or corrupt: a field of " + std::to_string(bytes) + " bytes begins " + std::to_string(left) +
                 " bytes before the end of the file");
}

std::string valueTypeName(const std::string& treeType) {
  constexpr std::string_view kPrefix = "Tree_";
  if (!treeType.starts_with(kPrefix)) return treeType;
  std::string name = treeType.substr(kPrefix.size());
  while (!name.empty() && (std::isdigit(static_cast<unsigned char>(name.back())) || name.back() == '_')) {
    // Only "_5_4_3" goes: "int32_5_4_3" keeps its 32.
    const std::size_t underscore = name.rfind('_');
    if (underscore == std::string::npos) break;
    name.resize(underscore);
  }
  return name;
}

}  // namespace umbrick
