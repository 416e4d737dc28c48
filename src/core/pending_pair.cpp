// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/pending_pair.h"

#include <unistd.h>

#include <system_error>

#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

// Gives the file at `from` a second name, `target`, in place of what stands there. Where a file cannot have two names,
// it loses its first one.
void nameAlso(const fs::path& from, const fs::path& target) {
  const fs::path second = from.parent_path() / (from.stem().string() + "-2" + from.extension().string());
  const bool linked = link(from.c_str(), second.c_str()) == 0;
  std::error_code error;
  fs::rename(linked ? second : from, target, error);
  if (!error) return;
  if (linked) unlink(second.c_str());
  throw IoError(target.string() + ": cannot write: " + error.message());
}

}  // namespace

PendingPair::PendingPair(const fs::path& header, const fs::path& data)
    : dataTarget_(data), data_(data), interim_(header), header_(header) {}

void PendingPair::writeHeader(const std::function<std::string(const std::string& dataName)>& text) {
  interim_.write(text(data_.path().filename().string()));
  header_.write(text(dataTarget_.filename().string()));
}

void PendingPair::commit() {
  data_.flush();
  header_.flush();
  interim_.commit();
  data_.keep();  // the interim header names this file
  nameAlso(data_.path(), dataTarget_);
  header_.commit();
  unlink(data_.path().c_str());
}

}  // namespace umbrick
