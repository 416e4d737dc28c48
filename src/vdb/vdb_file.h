// A .vdb file opened for reading: its table of grids, and the grids one by one.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>

#include <cstdint>
#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "umbrick/grid/float_grid.h"
#include "vdb/mapped_file.h"

namespace umbrick {

/// OpenVDB trusts what it reads: wrong lengths in a broken file make it allocate gigabytes or write beyond its buffers,
/// and a short read goes unnoticed. So everything is checked (vdb_check.h) before OpenVDB sees it, and the stream
/// throws when it is read past its end. Nothing is loaded later than it is asked for. A .nvdb file is read as a whole.
class VdbFile : private openvdb::io::Archive {
 public:
  struct Entry {
    std::string label;  // the grid's name, with "[k]" behind it when several grids share it or it is empty
    std::string name;
    std::string valueType;       // "float", "vec3s", ...
    std::int64_t fileBytes = 0;  // of the grid in the file
    openvdb::io::GridDescriptor descriptor;
    openvdb::GridBase::Ptr loaded;  // files without a table are read whole
  };

  /// @throw IoError
  explicit VdbFile(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  const std::vector<Entry>& entries() const { return entries_; }
  std::int64_t fileBytes() const { return std::int64_t(file_.bytes().size()); }
  /// Of the file format, that of NanoVDB for a .nvdb file.
  std::string version() const { return nano_.empty() ? std::to_string(fileVersion()) : nano_; }
  /// Of the library; "NanoVDB 32.4" for a .nvdb file.
  std::string writtenBy() const { return nano_.empty() ? openvdb::io::Archive::version() : "NanoVDB " + nano_; }
  const openvdb::MetaMap& metadata() const { return metadata_; }

  /// The entry of a selector: a label, a name (the first of that name) or "name[k]".
  /// @return null when there is none
  const Entry* find(const std::string& selector) const;
  /// Reads a grid: with its tree where the voxels are of a type that vdb_check.h knows, else metadata and transform.
  /// @return null for a type that OpenVDB does not know  @throw IoError  corrupt
  openvdb::GridBase::Ptr read(const Entry& entry);

 private:
  template <class Action>
  auto guarded(const std::string& what, const Action& action);
  void readHead();
  void readNano();
  Entry readEntry();
  void nameEntries();
  openvdb::GridBase::Ptr readHere(const Entry& entry);

  std::filesystem::path path_;
  MappedFile file_;
  MemoryStreamBuffer buffer_;
  std::istream stream_;
  openvdb::io::StreamMetadata::Ptr streamMetadata_;
  openvdb::MetaMap metadata_;
  std::vector<Entry> entries_;
  std::string nano_;  // version of NanoVDB; empty for a .vdb file
};

/// "float" for "Tree_float_5_4_3": the type of the values, as people call it; others as they are.
std::string valueTypeName(const std::string& treeType);
/// True for the types that readScalarGrid turns into float.
bool isScalarType(const std::string& valueType);

}  // namespace umbrick
