// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/image_stack.h"

#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "ingest/header_text.h"
#include "ingest/length_unit.h"
#include "ingest/place.h"
#include "ingest/provenance.h"
#include "ingest/slice_image.h"
#include "ingest/streams/byte_stream.h"
#include "ingest/streams/dense_source.h"
#include "umbrick/core/error.h"
#include "umbrick/ingest/frame_sequence.h"

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
    if (each.is_regular_file()) out.push_back(folder / each.path().filename());
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
std::vector<fs::path> numberedFiles(const fs::path& path) {
  const std::vector<NumberedFile> files = listFrames(path);
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

std::vector<fs::path> slicesOf(const fs::path& path) {
  std::error_code ignored;
  const std::string name = path.filename().string();
  if (fs::is_regular_file(path, ignored)) return {path};
  if (namePattern(name)) return numberedFiles(path);
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

// What ImageJ writes into the description: lines of "key=value".
std::map<std::string, std::string> imageJ(const std::string& description) {
  std::map<std::string, std::string> out;
  if (!description.starts_with("ImageJ=")) return out;
  std::string_view rest = description;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    if (const std::size_t sign = line.find('='); sign != line.npos)
      out[std::string(line.substr(0, sign))] = std::string(trimmed(line.substr(sign + 1)));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return out;
}

void placeByImageJ(const fs::path& path, const SliceImages& images, VolumeInfo& info) {
  auto fields = imageJ(images.description);
  for (const char* key : {"channels", "frames"})
    if (fields.contains(key) && fields[key] != "1") failField(path, key, "1", fields[key]);
  if (const auto count = fields.contains("images") ? integer(fields["images"]) : std::nullopt;
      count && *count != images.pages)
    failField(path, "ImageJ images", std::to_string(images.pages) + ", one for each page", fields["images"]);
  const std::string unit = fields["unit"] == "\\u00B5m" ? "um" : fields["unit"];
  const auto millimetres = millimetresPer(unit);
  if (!millimetres) return;
  for (int axis = 0; axis < 2; ++axis)
    if (images.pixelsPerUnit[axis]) info.indexToWorld[axis][axis] = *millimetres / *images.pixelsPerUnit[axis];
  if (const auto spacing = number(fields["spacing"])) info.indexToWorld[2][2] = *millimetres * *spacing;
  info.metadata["length_unit"] = "mm";
  checkPlace(info, "resolution and spacing of ImageJ");
}

class StackSource : public VoxelSource {
 public:
  StackSource(VolumeInfo info, std::vector<fs::path> files, std::unique_ptr<SliceImages> first)
      : files_(std::move(files)), open_(std::move(first)), layout_(open_->layout) {
    info_ = std::move(info);
  }

  double readSlab(std::int64_t count, std::span<float> out) override {
    const auto voxels = static_cast<std::size_t>(info_.dims.x * info_.dims.y);
    slice_.resize(voxels * static_cast<std::size_t>(voxelBytes(info_.type)));
    double error = 0;
    for (std::int64_t i = 0; i < count; ++i) {
      if (page_ == open_->pages) {
        open_ = openSliceImages(files_[++file_]);
        page_ = 0;
      }
      open_->read(page_++, slice_);
      error = std::max(error, decodeVoxels(layout_, slice_, out.subspan(static_cast<std::size_t>(i) * voxels, voxels)));
    }
    return error;
  }

 private:
  std::vector<fs::path> files_;
  std::unique_ptr<SliceImages> open_;
  VoxelLayout layout_;
  std::size_t file_ = 0;
  std::int64_t page_ = 0;
  std::vector<std::byte> slice_;
};

}  // namespace

bool isImageStack(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_regular_file(path, ignored)) return false;
  if (!fs::is_directory(path, ignored))
    return isImageName(path) && (hasGlob(path.string()) || namePattern(path.filename().string()));
  const std::vector<fs::path> files = filesOf(path);
  return std::any_of(files.begin(), files.end(), isImageName);
}

std::unique_ptr<SliceImages> openSliceImages(const fs::path& path) {
  checkedFileSize(path);
  std::array<char, 4> bytes{};
  openPlain(path)->read(std::as_writable_bytes(std::span(bytes)));
  const std::string_view magic(bytes.data(), bytes.size());
  if (magic == "\x89PNG") return openPng(path);
  if (magic.starts_with("II") || magic.starts_with("MM")) return openTiff(path);
  throw IoError(path.string() + ": expected a TIFF or PNG image, found other first bytes");
}

std::unique_ptr<VoxelSource> openImageStack(const fs::path& path) {
  std::vector<fs::path> files = slicesOf(path);
  auto first = openSliceImages(files.front());
  VolumeInfo info;
  info.name = path.string();
  info.type = first->layout.type;
  info.dims = {first->width, first->height, 0};
  // All heads are looked at before the first voxel is read.
  for (const fs::path& file : files) {
    const auto images = file == files.front() ? nullptr : openSliceImages(file);
    const SliceImages& each = images ? *images : *first;
    const auto size = [](const SliceImages& i) {
      return std::to_string(i.width) + " x " + std::to_string(i.height) + " " +
             std::string(voxelTypeName(i.layout.type));
    };
    if (size(each) != size(*first))
      throw IoError(file.string() + ": expected " + size(*first) + " as in " + files.front().filename().string() +
                    ", found " + size(each));
    info.dims.z += each.pages;
    info.fileBytes += checkedFileSize(file);
  }
  const auto bytes = volumeBytes(info.dims, info.type);
  // No packing of images makes a hundred thousand pixels of one byte, so such a head is false.
  if (!bytes || *bytes / 100000 > info.fileBytes * 8)
    throw IoError(info.name + ": expected images that their files can hold, found " + describeBytes(info) + " in " +
                  std::to_string(info.fileBytes));
  addProvenance(info, path, lower(files.front().extension().string()) == ".png" ? "PNG" : "TIFF");
  if (first->whiteIsZero) info.metadata["photometric"] = "white is zero";
  if (files.size() == 1) placeByImageJ(path, *first, info);
  return std::make_unique<StackSource>(std::move(info), std::move(files), std::move(first));
}

}  // namespace umbrick
