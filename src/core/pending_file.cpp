// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/pending_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include "core/pending_state.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail(const Output& output) {
  throw IoError(output.given.string() + ": cannot write: " + std::strerror(errno));
}

// Opens a file without a name, if the system can give it one later.
Descriptor openUnnamed(const fs::path& folder, unsigned mode) {
  if (access("/proc/self/fd", X_OK) != 0) {
    errno = EOPNOTSUPP;
    return {};
  }
  return Descriptor(open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, mode));
}

// File systems and kernels that have no files without a name say so in one of these ways.
bool isUnsupported(int error) { return error == EOPNOTSUPP || error == EISDIR || error == EINVAL; }

// Returns a file for what is copied to a stream later.
Descriptor openScratch(const Output& output) {
  // A stream that cannot be written is refused before anything is computed, but not opened: the other end would notice.
  if (output.descriptor < 0 && faccessat(AT_FDCWD, output.path.c_str(), W_OK, AT_EACCESS) != 0) fail(output);
  std::error_code none;
  const fs::path folder = fs::temp_directory_path(none);
  const auto refuse = [&] {
    throw IoError(output.given.string() + ": cannot write: no temporary file in " + folder.string() + ": " +
                  std::strerror(errno));
  };
  if (none) refuse();
  Descriptor file = openUnnamed(folder, 0600);
  if (file) return file;
  std::string name = (folder / "umbrick.XXXXXX").string();
  file = Descriptor(mkostemp(name.data(), O_CLOEXEC));
  if (!file) refuse();
  unlink(name.c_str());
  return file;
}

// Makes the new file look like the one that it replaces, as far as the system allows.
void copyOwner(int file, const StandingFile& standing) {
  struct stat now {};
  fstat(file, &now);
  mode_t mode = standing.mode;
  if (now.st_uid != standing.user && fchown(file, standing.user, static_cast<gid_t>(-1)) != 0) errno = 0;
  const bool sameGroup = now.st_gid == standing.group || fchown(file, static_cast<uid_t>(-1), standing.group) == 0;
  // Another group may do no more than everybody. Nothing new runs as another user, as after any write to a file.
  if (!sameGroup) mode = (mode & ~070u) | ((mode & 07u) << 3);
  fchmod(file, mode & 0777u);
}

void writeThrough(const Output& output, int file) {
  Descriptor to(output.descriptor >= 0 ? fcntl(output.descriptor, F_DUPFD_CLOEXEC, 3)
                                       : open(output.path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC));
  if (!to) fail(output);
  copyAll(file, to.number(), output.given.string());
  if ((errno = to.close()) != 0) fail(output);
}

}  // namespace

void PendingFile::State::finishStream() {
  if (!buffer) return;
  buffer->rethrow();
  stream.flush();
}

void PendingFile::State::settle() {
  finishStream();
  if (output.standing) copyOwner(file.number(), *output.standing);
  if (fsync(file.number()) != 0) fail(output);
}

PendingFile::PendingFile(const fs::path& target, Naming naming) : PendingFile(target, naming, {}) {}

PendingFile::PendingFile(const fs::path& target, Naming naming, const Spared& spared)
    : state_(std::make_unique<State>()) {
  Output& output = state_->output = outputAt(target);
  if (output.isStream()) {
    state_->file = openScratch(output);
    return;
  }
  removeAbandoned(output.path, spared);
  // What replaces a private file is private from the beginning. Any other file gets what the user's mask leaves.
  const unsigned mode = output.standing ? 0600 : 0666;
  if (naming == Naming::unnamed) {
    state_->file = openUnnamed(folderOf(output.path), mode);
    if (!state_->file && !isUnsupported(errno)) fail(output);
  }
  if (state_->file)
    lockAsOwn(state_->file);
  else
    state_->name = TemporaryName::make(output.path, mode, state_->file);
}

PendingFile::~PendingFile() = default;

std::ostream& PendingFile::stream() {
  State& state = *state_;
  if (!state.buffer) {
    state.buffer.emplace(state.file.number(), state.output.given.string());
    state.stream.rdbuf(&*state.buffer);
    state.stream.exceptions(std::ios::failbit | std::ios::badbit);
  }
  return state.stream;
}

int PendingFile::descriptor() const { return state_->file.number(); }

fs::path PendingFile::path() {
  state_->finishStream();
  return state_->name ? state_->name.path() : state_->file.procPath();
}

void PendingFile::write(std::string_view text) {
  stream().write(text.data(), static_cast<std::streamsize>(text.size()));
  stream().flush();
}

void PendingFile::flush() {
  state_->finishStream();
  if (!state_->output.isStream() && fsync(descriptor()) != 0) fail(state_->output);
}

void PendingFile::commit() {
  State& state = *state_;
  if (state.output.isStream()) {
    flush();
    return writeThrough(state.output, descriptor());
  }
  state.settle();
  const fs::path& target = state.output.path;
  if (!state.name) {
    // Nothing stands there, mostly, and then no temporary name is needed.
    if (!state.output.standing && linkNew(state.file.procPath(), target)) return;
    state.name = TemporaryName::link(state.file.procPath(), target);
    if (!state.name) fail(state.output);
  }
  state.name.renameTo(target);
}

void writeTextFile(const fs::path& path, std::string_view text) {
  PendingFile pending(path);
  pending.write(text);
  pending.commit();
}

}  // namespace umbrick
