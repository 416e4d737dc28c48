// A header and the data file that it names, which change together.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "umbrick/core/pending_file.h"

namespace umbrick {

/// Replaces a header and its data. No rename changes two files at once, so there are three steps. Between any two of
/// them, also when the program is killed there, the header at its name describes the data that it names:
/// 1. the header is replaced by one that names the temporary data file,
/// 2. the data file takes its name, and keeps the temporary one beside it,
/// 3. the header is replaced by one that names the data by its name; then the temporary name goes.
/// Where step 2 fails, the old header is put back, which names the old data. The folder is locked (flock) meanwhile, so
/// that the steps of two writers do not mix.
/// Where the file system has no second names (hard links), a header whose data are missing stands there after step
/// 2 and until step 3, and a failed step 2 leaves the new pair under the temporary name. Where it has no locks, two
/// writers at once may leave the header of the one and the data of the other.
class PendingPair {
 public:
  /// Links are followed. @throw IoError  either is a stream, or one that PendingFile refuses
  PendingPair(const std::filesystem::path& header, const std::filesystem::path& data);

  /// Returns the file for the data.
  PendingFile& data() { return data_; }
  /// @param text  returns the text of a header that names a data file `dataName`, which is one in the header's own
  ///              folder or a whole path
  /// @throw IoError  not writable
  void writeHeader(const std::function<std::string(const std::string& dataName)>& text);
  /// Returns the path of a header that names the data, so that the pair can be read before it takes its place.
  std::filesystem::path headerPath() { return interim_.path(); }
  /// Flushes both files to the disk and puts them in their places. @throw IoError  also then a whole pair stands there
  void commit();

 private:
  std::filesystem::path headerTarget_, dataTarget_;
  // Of the folder. Where abandoned files are looked for, no other writer is amid its steps.
  std::shared_ptr<const void> lock_;
  PendingFile data_, interim_, header_;
};

}  // namespace umbrick
