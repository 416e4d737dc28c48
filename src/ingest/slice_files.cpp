// SPDX-License-Identifier: Apache-2.0
#include "ingest/slice_files.h"

#include <fnmatch.h>

#include <algorithm>

#include "ingest/header_text.h"
#include "ingest/streams/byte_stream.h"
#include "umbrick/core/error.h"
#include "umbrick/ingest/frame_sequence.h"
#include "umbrick/ingest/image_stack.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

bool hasGlob(const std::string& name) { return name.find_first_of("*?[") != std::string::npos; }

bool isImageName(const fs::path& path) {
  const std::string extension = lower(path.extension().string());
  return extension == ".tif" || extension == ".tiff" || extension == ".png";
}

std::vector<fs::path> filesOf(const fs::path& folder) {
  std::vector<fs::path> out;
  std::error_code error;
  for (const auto& each : fs::directory_iterator(folder.empty() ? "." : folder, error))
    if (each.is_regular_file() && !each.path().filename().string().starts_with('.'))
      out.push_back(folder / each.path().filename());
  if (error) throw IoError(folder.string() + ": cannot read: " + error.message());
  return out;
}

// Digits compare as numbers, so that "s9" comes before "s10".
bool beforeByNumbers(const std::string& a, const std::string& b) {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (!digit(a[i]) || !digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
      continue;
    }
    const auto take = [&](const std::string& text, std::size_t& at) {
      while (at < text.size() && text[at] == '0') ++at;
      const std::size_t start = at;
      while (at < text.size() && digit(text[at])) ++at;
      return text.substr(start, at - start);
    };
    const std::string x = take(a, i), y = take(b, j);
    if (x.size() != y.size()) return x.size() < y.size();
    if (x != y) return x < y;
  }
  return a.size() - i != b.size() - j ? a.size() - i < b.size() - j : a < b;
}

// Finds all numbers that there are; they must follow each other.
std::vector<fs::path> numberedFiles(const fs::path& path, std::vector<std::string>& notes) {
  std::vector<fs::path> leftOut;
  const std::vector<NumberedFile> files = listFrames(path, &leftOut);
  for (const fs::path& file : leftOut)
    notes.push_back(file.filename().string() + " is left out: another file has its number, or it is too large");
  // "slice%d" with slice-1, slice-2, ...: the dash is no sign, and the slices would come in the wrong order.
  if (files.back().number < 0 && files.size() > 1)
    throw IoError(path.string() + ": expected numbers from 0 on, found only negative ones, from " +
                  std::to_string(files.front().number) + " to " + std::to_string(files.back().number) +
                  "; a dash that is no sign stands before the number in the pattern");
  std::vector<fs::path> out;
  for (const NumberedFile& file : files) {
    if (!out.empty() && file.number != files[out.size() - 1].number + 1)
      throw IoError(path.string() + ": expected a file for each number from " + std::to_string(files.front().number) +
                    " to " + std::to_string(files.back().number) + ", found no " +
                    framePath(path, files[out.size() - 1].number + 1).filename().string());
    out.push_back(file.path);
  }
  return out;
}

}  // namespace

std::vector<fs::path> sliceFiles(const fs::path& path, std::vector<std::string>& notes) {
  std::error_code ignored;
  const std::string name = path.filename().string();
  if (fs::is_regular_file(path, ignored)) return {path};
  if (namePattern(name)) return numberedFiles(path, notes);
  std::vector<fs::path> out;
  const bool folder = fs::is_directory(path, ignored);
  if (!folder && !hasGlob(name)) checkedFileSize(path);
  for (const fs::path& file : filesOf(folder ? path : path.parent_path()))
    if (folder ? isImageName(file) : fnmatch(name.c_str(), file.filename().c_str(), FNM_PERIOD) == 0)
      out.push_back(file);
  if (out.empty()) throw IoError(path.string() + ": expected images of that name, found none");
  std::sort(out.begin(), out.end(), [](const fs::path& a, const fs::path& b) {
    return beforeByNumbers(a.filename().string(), b.filename().string());
  });
  if (folder)
    for (const fs::path& file : out)
      if (lower(file.extension().string()) != lower(out.front().extension().string()))
        throw IoError(path.string() + ": expected images of one kind, found " + out.front().filename().string() +
                      " and " + file.filename().string());
  return out;
}

bool isImageStack(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_regular_file(path, ignored)) return false;
  if (!fs::is_directory(path, ignored))
    return isImageName(path) && (hasGlob(path.string()) || namePattern(path.filename().string()));
  const std::vector<fs::path> files = filesOf(path);
  return std::any_of(files.begin(), files.end(), isImageName);
}

}  // namespace umbrick
