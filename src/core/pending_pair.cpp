// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/pending_pair.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>

#include "core/pending_state.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

fs::path fileAt(const fs::path& target) {
  const Output output = outputAt(target);
  if (output.isStream()) throw IoError(target.string() + ": cannot write: is one file, where a pair has two");
  return output.path;
}

// Keeps other pairs of the folder from changing until it is closed.
std::shared_ptr<const void> lockedFolder(const fs::path& file) {
  auto folder = std::make_shared<Descriptor>(open(folderOf(file).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  while (*folder && flock(folder->number(), LOCK_EX) != 0 && errno == EINTR) {
  }
  return folder;
}

// Returns the beginning of a header, which names its data, or nothing where there is none.
std::string beginOf(const fs::path& header) {
  std::string text(std::size_t(1) << 16, '\0');
  std::ifstream in(header, std::ios::binary);
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

// A pair whose writer was killed between two steps is whole, and its header names a temporary data file.
std::function<bool(const std::string&)> namedBy(const fs::path& header) {
  return [text = beginOf(header)](const std::string& name) { return text.find(name) != std::string::npos; };
}

// Returns the name by which a header finds a file.
std::string nameFrom(const fs::path& header, const fs::path& file) {
  std::error_code error;
  const bool beside = fs::equivalent(folderOf(header), folderOf(file), error);
  return beside ? file.filename().string() : fs::absolute(file).string();
}

}  // namespace

PendingPair::PendingPair(const fs::path& header, const fs::path& data)
    : headerTarget_(fileAt(header)),
      dataTarget_(fileAt(data)),
      lock_(lockedFolder(headerTarget_)),
      data_(dataTarget_, PendingFile::Naming::named, namedBy(headerTarget_)),
      interim_(headerTarget_, PendingFile::Naming::named),
      header_(headerTarget_, PendingFile::Naming::named) {
  lock_.reset();
}

void PendingPair::writeHeader(const std::function<std::string(const std::string& dataName)>& text) {
  interim_.write(text(nameFrom(headerTarget_, data_.path())));
  header_.write(text(nameFrom(headerTarget_, dataTarget_)));
}

void PendingPair::commit() {
  PendingFile::State& data = *data_.state_;
  data.settle();
  header_.flush();
  interim_.flush();
  const auto lock = lockedFolder(headerTarget_);
  const auto held = holdNames();
  TemporaryName old, second;
  std::error_code none;
  if (fs::exists(headerTarget_, none)) old = TemporaryName::link(headerTarget_, headerTarget_);
  second = TemporaryName::link(data.name.path(), dataTarget_);
  const bool linked = bool(second);
  interim_.commit();
  try {
    (linked ? second : data.name).renameTo(dataTarget_);
  } catch (const IoError&) {
    if (old)
      old.renameTo(headerTarget_);
    else if (linked)
      ::unlink(headerTarget_.c_str());
    else
      data.name.keep();  // the header names it
    throw;
  }
  if (!linked) return header_.commit();
  // The header names the first name until it is replaced.
  const fs::path first = data.name.path();
  data.name.keep();
  header_.commit();
  ::unlink(first.c_str());
  removeAbandoned(dataTarget_);
}

}  // namespace umbrick
