// SPDX-License-Identifier: Apache-2.0
#include "view/uploaded_file.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <utility>

#include "umbrick/core/error.h"
#include "umbrick/core/printable.h"
#include "view/open_folder.h"

namespace umbrick::view {

namespace fs = std::filesystem;

bool isUploadName(const std::string& name) {
  constexpr std::size_t kLongest = 100;
  const auto allowed = [](unsigned char c) { return std::isalnum(c) || c == '-' || c == '_' || c == '.'; };
  return !name.empty() && name.size() <= kLongest && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), allowed) && kindOfName(name) == EntryKind::volume;
}

UploadedFile::UploadedFile(std::string name) : name_(std::move(name)) {
  if (!isUploadName(name_))
    throw InvalidArgument("open: '" + printable(name_.substr(0, 100)) + "' is no name of a volume");
  std::error_code failed;
  std::string folder = (fs::temp_directory_path(failed) / "umbrick-view.XXXXXX").string();
  if (failed || !::mkdtemp(folder.data())) throw IoError("open: no temporary folder can be made for " + name_);
  folder_ = folder;
}

UploadedFile::~UploadedFile() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

}  // namespace umbrick::view
