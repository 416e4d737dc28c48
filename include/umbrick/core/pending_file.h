// A file that appears whole or not at all.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <string_view>

namespace umbrick {

/// Takes the place of a file once it is whole. Write to stream() or descriptor(), then call commit(). Without a commit
/// what was written goes with this object, and a file that stood at `target` is untouched.
///
/// A regular file is replaced: the new one keeps mode and owner of the old one, as far as the system allows; symbolic
/// links lead to what is replaced; other names of the old file (hard links) keep the old content. Until then the new
/// file has no name where the file system can do that (O_TMPFILE), else a name of core/temporary_name.h.
///
/// A stream (OutputKind) is written to by commit(), which copies all that was written before to a file without a name
/// in the folder for temporary files.
class PendingFile {
 public:
  enum class Naming { unnamed, named };  // named: has a name from the beginning

  /// @throw IoError  the folder does not exist or is not writable, or `target` is a folder
  explicit PendingFile(const std::filesystem::path& target, Naming naming = Naming::unnamed);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  /// Returns a stream to the file, which can seek. It throws IoError, which says why it cannot be written.
  std::ostream& stream();
  /// Returns the open file, for writers that take no stream. Do not mix both.
  int descriptor() const;
  /// Returns where what is written so far can be read: the temporary name of a file that has one, else one in /proc.
  std::filesystem::path path();
  /// Writes the whole file. @throw IoError
  void write(std::string_view text);
  /// Returns when what was written is on the disk. @throw IoError
  void flush();
  /// Flushes the written file to the disk and puts it in its place, or copies it to its stream.
  /// @throw IoError  @throw PipeClosed  a stream that nobody reads any more
  void commit();

 private:
  friend class PendingPair;
  struct State;
  // Tells which of the files that a killed program has left are still in use, by their names.
  using Spared = std::function<bool(const std::string& name)>;
  PendingFile(const std::filesystem::path& target, Naming naming, const Spared& spared);

  std::unique_ptr<State> state_;
};

/// A check of a file that is written but has not taken its name. When it throws, what stood there is untouched.
using WrittenCheck = std::function<void(const std::filesystem::path& written)>;

/// Writes a whole text file through a PendingFile. @throw IoError
void writeTextFile(const std::filesystem::path& path, std::string_view text);

/// Removes the pending files of this process that have a name, and lets no other get one. For a program that is about
/// to end by a signal: a thread that commits a file waits from then on.
void abandonPendingFiles();

}  // namespace umbrick
