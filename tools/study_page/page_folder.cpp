// SPDX-License-Identifier: Apache-2.0
#include "study_page/page_folder.h"

#include <system_error>

#include "umbrick/core/error.h"

namespace umbrick::tools {
namespace fs = std::filesystem;

fs::path PageFolder::thumbnail(const std::string& id) const {
  std::error_code ignored;
  return fs::exists(smallPicture(id), ignored) ? smallPicture(id) : picture(id);
}

void PageFolder::create() const {
  for (const fs::path& folder : {root_ / "pictures" / "small", plots()}) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw IoError(folder.string() + ": cannot make the folder: " + error.message());
  }
}

}  // namespace umbrick::tools
