// A header and the data file that it names, which change together.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <string>

#include "umbrick/core/pending_file.h"

namespace umbrick {

/// Replaces a header and its data. No rename changes two files at once, so there are three steps. Between any two of
/// them, also when the program is killed there, the header at its name describes the data that it names:
/// 1. the header is replaced by one that names the temporary data file,
/// 2. the data file takes its name, and keeps the temporary one beside it,
/// 3. the header is replaced by one that names the data by its name; then the temporary name goes.
/// Where the file system has no second names (hard links), a header whose data are missing stands there after step
/// 2 and until step 3.
class PendingPair {
 public:
  /// @throw IoError  either file is one that PendingFile refuses
  PendingPair(const std::filesystem::path& header, const std::filesystem::path& data);

  /// Returns where the data are to be written.
  const std::filesystem::path& dataPath() const { return data_.path(); }
  /// @param text  returns the text of a header that names a data file `dataName` in its own folder
  /// @throw IoError  not writable
  void writeHeader(const std::function<std::string(const std::string& dataName)>& text);
  /// Returns the path of a header that names dataPath(), so that the pair can be read before it takes its place.
  const std::filesystem::path& headerPath() const { return interim_.path(); }
  /// Flushes both files to the disk and puts them in their places. @throw IoError  also then a whole pair stands there
  void commit();

 private:
  std::filesystem::path dataTarget_;
  PendingFile data_, interim_, header_;
};

}  // namespace umbrick
