// SPDX-License-Identifier: Apache-2.0
#include "umbrick/convert/holds_grids.h"

#include <fstream>
#include <string_view>

#include "umbrick/convert/options_error.h"
#include "umbrick/ingest/open_volume.h"

namespace umbrick {
namespace fs = std::filesystem;

bool holdsGrids(const fs::path& path) {
  if (path.extension() == ".vdb" || path.extension() == ".nvdb") return true;
  if (formatOfName(path) || !fs::is_regular_file(path)) return false;
  char magic[8]{};
  std::ifstream(path, std::ios::binary).read(magic, sizeof magic);
  const std::string_view first(magic, sizeof magic);
  return first.starts_with(" BDV") || first == "NanoVDB0";
}

bool holdGrids(const std::vector<fs::path>& inputs, const SourceOptions& source) {
  if (source.open.raw || source.open.array) return false;
  for (const fs::path& input : inputs) {
    if (!holdsGrids(input)) continue;
    if (inputs.size() == 1) return true;
    throw OptionsError(input.string() +
                       ": expected volumes where there are several inputs, found a file of grids; convert it alone");
  }
  return false;
}

}  // namespace umbrick
