// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/frame_sequence.h"

#include <algorithm>
#include <optional>
#include <string>

#include "ingest/header_text.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

// "run/file_%04d.h5:/density": a folder, a pattern, and what stands behind the file.
struct FrameNames {
  fs::path folder;
  NamePattern pattern;
  std::string dataset;
  fs::path path(const std::string& name) const { return (folder / name).string() + dataset; }
};

std::optional<FrameNames> parse(const fs::path& path) {
  const std::string text = path.string();
  for (const std::size_t end : {text.find(":/"), text.size()}) {
    if (end == text.npos) continue;
    const fs::path file = text.substr(0, end);
    if (const auto pattern = namePattern(file.filename().string()))
      return FrameNames{file.parent_path(), *pattern, text.substr(end)};
  }
  return std::nullopt;
}

}  // namespace

bool isFramePattern(const fs::path& path) {
  std::error_code ignored;
  return !fs::exists(path, ignored) && parse(path).has_value();
}

fs::path framePath(const fs::path& pattern, std::int64_t number) {
  const auto names = parse(pattern);
  return names ? names->path(names->pattern.name(number)) : pattern;
}

std::vector<NumberedFile> listFrames(const fs::path& path) {
  const auto names = parse(path);
  if (!names)
    throw InvalidArgument(path.string() + ": expected a name with one %d or %04d, found " + path.filename().string());
  const NamePattern& pattern = names->pattern;
  std::vector<NumberedFile> frames;
  std::error_code error;
  for (const auto& each : fs::directory_iterator(names->folder.empty() ? "." : names->folder, error)) {
    const std::string name = each.path().filename().string();
    if (name.size() <= pattern.before.size() + pattern.after.size() || !name.starts_with(pattern.before) ||
        !name.ends_with(pattern.after))
      continue;
    const std::string_view digits = trimmed(std::string_view(name).substr(
        pattern.before.size(), name.size() - pattern.before.size() - pattern.after.size()));
    if (const auto number = integer(digits); number && *number >= 0 && pattern.name(*number) == name)
      frames.push_back({*number, names->path(name)});
  }
  if (error) throw IoError(names->folder.string() + ": cannot read: " + error.message());
  if (frames.empty()) throw IoError(path.string() + ": expected files of that pattern, found none");
  std::sort(frames.begin(), frames.end(),
            [](const NumberedFile& a, const NumberedFile& b) { return a.number < b.number; });
  return frames;
}

}  // namespace umbrick
