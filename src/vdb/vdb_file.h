// A .vdb file opened for reading: its table of grids, and the grids one by one.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <istream>
#include <string>
#include <vector>

#include "umbrick/grid/float_grid.h"
#include "vdb/mapped_file.h"

namespace umbrick {

/// A .vdb file. OpenVDB trusts what it reads: wrong lengths in a broken file make it allocate gigabytes or write beyond
/// its buffers, and a short read goes unnoticed. So everything is checked (vdb_check.h) before OpenVDB sees it, and the
/// stream throws when it is read past its end. Each grid is read when it is asked for, and then as a whole, not later
/// by need. A .nvdb file is read as a whole when it is opened.
class VdbFile : private openvdb::io::Archive {
 public:
  struct Entry {
    /// The grid's name, with "[k]" behind it when several grids share the name or it is empty.
    std::string label;
    std::string name;
    std::string valueType;       // "float", "vec3s", ...
    std::int64_t fileBytes = 0;  // bytes that the grid takes in the file
    openvdb::io::GridDescriptor descriptor;
    openvdb::GridBase::Ptr loaded;  // set for files without a table, which are read whole
  };

  /// @throw IoError  the file cannot be read
  explicit VdbFile(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  const std::vector<Entry>& entries() const { return entries_; }
  std::int64_t fileBytes() const { return std::int64_t(file_.bytes().size()); }
  /// Returns the version of the file format, or that of NanoVDB for a .nvdb file.
  std::string version() const { return nano_.empty() ? std::to_string(fileVersion()) : nano_; }
  /// Returns the version of the library that wrote the file; "NanoVDB 32.4" for a .nvdb file.
  std::string writtenBy() const { return nano_.empty() ? openvdb::io::Archive::version() : "NanoVDB " + nano_; }
  const openvdb::MetaMap& metadata() const { return metadata_; }

  /// Returns the entry of a selector: a label, a name (the first of that name) or "name[k]"; null when there is none.
  const Entry* find(const std::string& selector) const;
  /// Reads a grid. It has its tree where the voxels are of a type that vdb_check.h knows, else only metadata
  /// and transform.
  /// @param progress  may be empty; is called now and then with the share of its bytes that is read. What it throws
  ///   ends the reading.
  /// @return null for a type that OpenVDB does not know
  /// @throw IoError  the file is corrupt
  openvdb::GridBase::Ptr read(const Entry& entry, const std::function<void(double)>& progress = {});

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

/// Returns the type of the values as people call it, "float" for "Tree_float_5_4_3". Other types stay as they are.
std::string valueTypeName(const std::string& treeType);
/// Returns true for the types that readScalarGrid turns into float.
bool isScalarType(const std::string& valueType);

}  // namespace umbrick
