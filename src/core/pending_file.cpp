// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/pending_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;

PendingFile::PendingFile(fs::path target) : target_(std::move(target)) {
  std::error_code ignored;
  if (target_.filename().empty() || fs::is_directory(target_, ignored))
    throw IoError(target_.string() + ": cannot write: is a directory");
  // mkstemps fills in a writable template. The extension stays last, since some writers choose the format by it.
  std::string name =
      (target_.parent_path() / ("." + target_.stem().string() + ".XXXXXX" + target_.extension().string())).string();
  std::vector<char> chars(name.begin(), name.end());
  chars.push_back('\0');
  const int file = mkstemps(chars.data(), static_cast<int>(target_.extension().string().size()));
  if (file < 0) throw IoError(target_.string() + ": cannot write: " + std::strerror(errno));
  temporary_ = chars.data();
  // mkstemps makes a private file, which gets the permissions that an ordinary new file would have.
  const mode_t mask = umask(0);
  umask(mask);
  fchmod(file, 0666 & ~mask);
  close(file);
}

PendingFile::~PendingFile() {
  std::error_code ignored;
  if (!kept_) fs::remove(temporary_, ignored);
}

void PendingFile::write(std::string_view text) {
  std::ofstream out(temporary_, std::ios::binary);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (!out)
    throw IoError(target_.string() + ": cannot write " + std::to_string(text.size()) +
                  " bytes: " + std::strerror(errno));
}

void PendingFile::flush() {
  const int file = open(temporary_.c_str(), O_RDONLY);
  const bool flushed = file >= 0 && fsync(file) == 0;
  if (file >= 0) close(file);
  if (!flushed) throw IoError(target_.string() + ": cannot write: " + std::strerror(errno));
}

void PendingFile::commit() {
  flush();
  std::error_code error;
  fs::rename(temporary_, target_, error);
  if (error) throw IoError(target_.string() + ": cannot write: " + error.message());
  kept_ = true;
}

void writeTextFile(const fs::path& path, std::string_view text) {
  PendingFile pending(path);
  pending.write(text);
  pending.commit();
}

}  // namespace umbrick
