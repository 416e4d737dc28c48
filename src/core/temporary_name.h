// Names of files that are not whole yet: beside what they are going to replace, and known for what they are.
//
// A temporary name is .umbrick-HASH-K.ext. HASH stands for the name that the file is going to take, so that a target
// may have a name as long as the file system allows. K is one of 16, so that a few calls tell whether something is left
// of an earlier program. Who writes such a file keeps it locked (flock), and the lock goes with the program however
// that ends: what is not locked belongs to nobody, and the next one that writes the same target removes it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <mutex>

#include "core/descriptor.h"

namespace umbrick {

/// Owns a temporary name for `target`. The names of this process are in a list, for removeTemporaryNames.
class TemporaryName {
 public:
  TemporaryName() = default;
  /// Makes an empty file of that name. @param mode  of the file, less the process's mask  @throw IoError
  static TemporaryName make(const std::filesystem::path& target, unsigned mode, Descriptor& file);
  /// Gives a name to a file that has none, or another one. @param from  a path that leads to it
  /// @return an empty one where the file system has no second names  @throw IoError
  static TemporaryName link(const std::filesystem::path& from, const std::filesystem::path& target);
  ~TemporaryName() { remove(); }
  TemporaryName(TemporaryName&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  TemporaryName& operator=(TemporaryName&& other) noexcept {
    std::swap(path_, other.path_);
    return *this;
  }

  const std::filesystem::path& path() const { return path_; }
  explicit operator bool() const { return !path_.empty(); }
  /// Renames the file to what it is for. @throw IoError
  void renameTo(const std::filesystem::path& target);
  /// Leaves the file where it is; the next writer of the target removes it.
  void keep();
  void remove();

 private:
  explicit TemporaryName(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path path_;
};

/// Removes what programs that were killed have left of writing `target`.
/// @param spared  tells of a name, without its folder, whether to let it be; may be empty
void removeAbandoned(const std::filesystem::path& target,
                     const std::function<bool(const std::string& name)>& spared = {});

/// Takes the lock that says that somebody writes the file. Where there are no locks, nothing is ever abandoned.
void lockAsOwn(const Descriptor& file);

/// Lets no signal end the program between two changes of names, as long as what it returns lives.
std::unique_lock<std::recursive_mutex> holdNames();

/// Creates the name `target` for a file that has none. @param from  a path that leads to it
/// @return false when the name is taken  @throw IoError
bool linkNew(const std::filesystem::path& from, const std::filesystem::path& target);

}  // namespace umbrick
