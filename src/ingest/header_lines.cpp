// SPDX-License-Identifier: Apache-2.0
#include "ingest/header_lines.h"

#include "ingest/header_text.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

constexpr std::int64_t kMostHeader = 1 << 22;

}  // namespace

HeaderLines::HeaderLines(const std::filesystem::path& path, std::size_t mostLine)
    : path_(path), in_(path, std::ios::binary), mostLine_(mostLine) {
  if (!in_) throw IoError(path.string() + ": cannot read");
}

bool HeaderLines::next(std::string& text) {
  text.clear();
  bool ended = false;
  for (int c; !ended && (c = in_.get()) != std::ifstream::traits_type::eof();) {
    ++bytes_;
    ended = c == '\n';
    if (!ended && (text.size() >= mostLine_ || bytes_ > kMostHeader))
      throw IoError(path_.string() + ": header: expected lines of text, found " + std::to_string(bytes_) +
                    " bytes without an end");
    if (!ended) text.push_back(static_cast<char>(c));
  }
  if (text.ends_with('\r')) text.pop_back();
  return ended || !text.empty();
}

std::vector<std::string> HeaderLines::rest() {
  std::vector<std::string> lines;
  for (std::string text; next(text);)
    if (!trimmed(text).empty()) lines.emplace_back(trimmed(text));
  return lines;
}

}  // namespace umbrick
