// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/frame_sequence.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "ingest/header_text.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

// "run/file_%04d.h5:/density" or "file_%04d.vti:density": a folder, a pattern, and what stands behind the file.
struct FrameNames {
  fs::path folder;
  NamePattern pattern;
  std::string dataset;
  fs::path path(const std::string& name) const { return (folder / name).string() + dataset; }
};

std::optional<FrameNames> parse(const fs::path& path) {
  const std::string text = path.string();
  const std::string lowered = lower(text);
  const auto behind = [&](const char* extension) {
    const std::size_t at = lowered.find(extension);
    return at == text.npos ? at : at + 4;
  };
  for (const std::size_t end : {text.find(":/"), behind(".vti:"), behind(".vtk:"), text.size()}) {
    if (end == text.npos) continue;
    const fs::path file = text.substr(0, end);
    if (const auto pattern = namePattern(file.filename().string()))
      return FrameNames{file.parent_path(), *pattern, text.substr(end)};
  }
  return std::nullopt;
}

// Digits, with or without a minus sign.
bool isNumber(std::string_view text) {
  if (text.starts_with('-')) text.remove_prefix(1);
  return !text.empty() && text.find_first_not_of("0123456789") == text.npos;
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

std::vector<NumberedFile> listFrames(const fs::path& path, std::vector<fs::path>* leftOut) {
  const auto names = parse(path);
  if (!names)
    throw InvalidArgument(path.string() + ": expected a name with one %d or %04d, found " + path.filename().string());
  const NamePattern& pattern = names->pattern;
  std::map<std::int64_t, std::string> found;
  const auto leave = [&](const std::string& name) {
    if (leftOut) leftOut->push_back(names->path(name));
  };
  std::error_code error;
  for (const auto& each : fs::directory_iterator(names->folder.empty() ? "." : names->folder, error)) {
    const std::string name = each.path().filename().string();
    if (name.size() <= pattern.before.size() + pattern.after.size() || !name.starts_with(pattern.before) ||
        !name.ends_with(pattern.after))
      continue;
    const std::string_view digits = trimmed(std::string_view(name).substr(
        pattern.before.size(), name.size() - pattern.before.size() - pattern.after.size()));
    if (!isNumber(digits)) continue;
    const auto number = integer(digits);
    // Names of other widths count too: frame_9 beside frame_10, or frame_009. The one that fits the pattern goes first.
    const auto [at, isNew] = number ? found.emplace(*number, name) : std::pair(found.end(), false);
    if (isNew) continue;
    const bool better = number && pattern.name(*number) == name;
    leave(better ? at->second : name);
    if (better) at->second = name;
  }
  std::vector<NumberedFile> frames;
  for (const auto& [number, name] : found) frames.push_back({number, names->path(name)});
  if (leftOut) std::sort(leftOut->begin(), leftOut->end());
  if (error) throw IoError(names->folder.string() + ": cannot read: " + error.message());
  if (frames.empty()) throw IoError(path.string() + ": expected files of that pattern, found none");
  return frames;
}

}  // namespace umbrick
