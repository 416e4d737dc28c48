// A .vdb file opened for reading: its table of grids, and the grids one by one.
#pragma once
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace umbrick {

/// OpenVDB trusts what it reads: lengths in a broken file make it allocate gigabytes, and a short read goes unnoticed.
/// So the table of grids and all lengths of the metadata are checked against the size of the file first, and the
/// stream throws when it is read past its end. Nothing is loaded later than it is asked for.
class VdbFile : private openvdb::io::Archive {
 public:
  struct Entry {
    std::string label;  // the grid's name, with "[k]" behind it when several grids share it or it is empty
    std::string name;
    std::string type;        // as OpenVDB spells it: "Tree_float_5_4_3"
    std::int64_t fileBytes;  // of the grid in the file
    openvdb::io::GridDescriptor descriptor;
    openvdb::GridBase::Ptr loaded;  // files without a table are read whole
  };

  /// @throw IoError
  explicit VdbFile(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  const std::vector<Entry>& entries() const { return entries_; }
  std::int64_t fileBytes() const { return fileBytes_; }
  std::uint32_t version() const { return fileVersion(); }
  const openvdb::MetaMap& metadata() const { return metadata_; }

  /// The entry of a selector: a label, a name (the first of that name) or "name[k]".
  /// @return null when there is none
  const Entry* find(const std::string& selector) const;
  /// Reads a grid with its tree. @throw IoError  corrupt, or of a type that OpenVDB does not know
  openvdb::GridBase::Ptr read(const Entry& entry);

 private:
  template <class Action>
  auto guarded(const std::string& what, const Action& action);
  void readHead();
  Entry readEntry();
  void nameEntries();
  openvdb::GridBase::Ptr readTree(const Entry& entry);
  void checkMetadata();
  std::string checkedString();
  template <class T>
  T number();
  void checkLeft(std::int64_t bytes);

  std::filesystem::path path_;
  std::int64_t fileBytes_ = 0;
  std::ifstream stream_;
  openvdb::io::StreamMetadata::Ptr streamMetadata_;
  openvdb::MetaMap metadata_;
  std::vector<Entry> entries_;
};

/// "float" for "Tree_float_5_4_3": the type of the values, as people call it.
std::string valueTypeName(const std::string& treeType);

}  // namespace umbrick
