// SPDX-License-Identifier: Apache-2.0
#include "ingest/provenance.h"

namespace umbrick {

void addProvenance(VolumeInfo& info, const std::filesystem::path& path, std::string_view format) {
  info.metadata["source_format"] = format;
  info.metadata["source_file"] = (path.has_filename() ? path : path.parent_path()).filename().string();
}

}  // namespace umbrick
