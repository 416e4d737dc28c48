// One image of a stack. Only the .cpp files see libtiff and libpng.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ingest/streams/decode.h"

namespace umbrick {

/// The pages of one image file.
class SliceImages {
 public:
  virtual ~SliceImages() = default;
  std::int64_t width = 0, height = 0, pages = 1;
  std::int64_t components = 1;  // 1 grey, 2 grey and opacity, 3 RGB, 4 RGB and opacity; side by side
  VoxelLayout layout;
  bool whiteIsZero = false;
  std::string description;                 // of the first page
  std::optional<double> pixelsPerUnit[2];  // along x and y
  int resolutionUnit = 0;                  // of these: 2 inches, 3 centimetres, else none
  /// The pixels of a page, rows from the top. Pages must be read in order. @throw IoError
  virtual void read(std::int64_t page, std::span<std::byte> out) = 0;
  /// Takes the only page for the first of `count` that lie behind each other without directories of their own.
  /// @throw IoError  it is packed, or the file ends before
  virtual void promise(std::int64_t count);
};

/// By the first bytes. @throw IoError  neither, unreadable, or an image of another kind
std::unique_ptr<SliceImages> openSliceImages(const std::filesystem::path& path);
std::unique_ptr<SliceImages> openTiff(const std::filesystem::path& path);
std::unique_ptr<SliceImages> openPng(const std::filesystem::path& path);

}  // namespace umbrick
