// What TIFF files say of themselves in their descriptions, beside their tags: which pages are slices, and how far
// pixels and slices lie apart.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ingest/slice_image.h"

namespace umbrick {

/// One slice: a page of a file beside the one that says so. An empty name is that file itself.
struct SlicePage {
  std::string file;
  std::int64_t page = 0;
};

struct StackPlace {
  std::string writer;                            // what messages call the description; empty: there is none
  std::vector<SlicePage> slices;                 // in order of z; empty: all pages in their order
  std::int64_t promisedPages = 0;                // pages that lie behind the only directory; 0: each has its own
  std::array<std::optional<double>, 3> spacing;  // in `unit`
  std::array<std::string, 3> unit;               // as it is spelt; empty: none is stated
  std::vector<std::string> notes;
};

/// @throw IoError  the description speaks of several channels or times, which are no slices, or is malformed
StackPlace placeByOme(const std::filesystem::path& path, const SliceImages& images);
StackPlace placeByImageJ(const std::filesystem::path& path, const SliceImages& images);
StackPlace placeByTags(const std::filesystem::path& path, const SliceImages& images);
/// By the description that the file has.
StackPlace stackPlace(const std::filesystem::path& path, const SliceImages& images);

}  // namespace umbrick
