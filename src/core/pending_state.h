// What a PendingFile knows of its file, which a PendingPair has to know, too.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include <optional>
#include <ostream>

#include "core/descriptor.h"
#include "core/temporary_name.h"
#include "umbrick/core/output.h"
#include "umbrick/core/pending_file.h"

namespace umbrick {

/// The folder that a file is in.
inline std::filesystem::path folderOf(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

struct PendingFile::State {
  Output output;
  Descriptor file;
  TemporaryName name;  // empty: the file has none
  std::optional<DescriptorBuffer> buffer;
  std::ostream stream{nullptr};

  /// Hands on what the stream still holds. @throw IoError  also when that failed before
  void finishStream();
  /// Gives the file its mode and owner, and returns when it is on the disk. @throw IoError
  void settle();
};

}  // namespace umbrick
