// SPDX-License-Identifier: Apache-2.0
#include "ingest/array_name.h"

#include "ingest/header_text.h"
#include "umbrick/ingest/vtk_volume.h"

namespace umbrick {
namespace fs = std::filesystem;

NamedArray splitArrayName(const fs::path& path, std::string_view extension) {
  std::error_code ignored;
  if (fs::exists(path, ignored)) return {path, {}};
  const std::string text = path.string(), lowered = lower(text), mark = std::string(extension) + ':';
  for (std::size_t at = lowered.find(mark); at != lowered.npos; at = lowered.find(mark, at + 1)) {
    const fs::path file = text.substr(0, at + extension.size());
    if (fs::is_regular_file(file, ignored)) return {file, text.substr(at + mark.size())};
  }
  return {path, {}};
}

std::string vtkArrayName(const fs::path& path) {
  for (const char* extension : {".vti", ".vtk"})
    if (NamedArray named = splitArrayName(path, extension); !named.array.empty()) return named.array;
  return {};
}

}  // namespace umbrick
