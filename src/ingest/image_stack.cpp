// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/image_stack.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/input_file.h"
#include "ingest/header_text.h"
#include "ingest/length_unit.h"
#include "ingest/parts.h"
#include "ingest/place.h"
#include "ingest/provenance.h"
#include "ingest/slice_files.h"
#include "ingest/slice_image.h"
#include "ingest/stack_place.h"
#include "ingest/streams/byte_stream.h"
#include "ingest/streams/dense_source.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

// A slice by the number of its file and of its page there.
struct Slice {
  std::size_t file = 0;
  std::int64_t page = 0;
};

struct Stack {
  std::vector<fs::path> files;
  std::vector<Slice> slices;
  StackPlace place;  // by the first file
};

// Opens a file, and finds the slices that have no directories.
std::unique_ptr<SliceImages> openPages(const fs::path& file) {
  auto images = openSliceImages(file);
  if (!images->description.starts_with("ImageJ=")) return images;
  if (const StackPlace place = placeByImageJ(file, *images); place.promisedPages > 0)
    images->promise(place.promisedPages);
  return images;
}

// Takes the slices in the order that the first file states, in whatever files they are.
void takeStated(const fs::path& path, Stack& stack) {
  std::map<fs::path, std::size_t> numbers;
  std::vector<fs::path> files;
  const fs::path own = stack.files.front();
  for (const SlicePage& slice : stack.place.slices) {
    const fs::path file = slice.file.empty() ? own : own.parent_path() / slice.file;
    const auto [at, isNew] = numbers.emplace(file, files.size());
    if (isNew) files.push_back(file);
    stack.slices.push_back({at->second, slice.page});
  }
  if (stack.files.size() > 1)
    for (const fs::path& file : stack.files)
      if (!numbers.contains(own.parent_path() / file.filename()))
        throw IoError(path.string() + ": expected the files that the " + stack.place.writer + " of " +
                      own.filename().string() + " names, found " + file.filename().string() + " too");
  stack.files = std::move(files);
}

// All heads are looked at before the first voxel is read.
void checkFiles(const SliceImages& first, Stack& stack, VolumeInfo& info) {
  const fs::path firstName = stack.files.front().filename();
  const bool stated = !stack.slices.empty();
  std::vector<std::int64_t> pages;
  for (std::size_t i = 0; i < stack.files.size(); ++i) {
    const fs::path& file = stack.files[i];
    const auto images = openPages(file);
    const auto size = [](const SliceImages& of) {
      return std::to_string(of.width) + " x " + std::to_string(of.height) + " " +
             std::string(voxelTypeName(of.layout.type)) +
             (of.components > 1 ? " of " + std::to_string(of.components) + " components" : "");
    };
    if (size(*images) != size(first))
      throw IoError(file.string() + ": expected " + size(first) + " as in " + firstName.string() + ", found " +
                    size(*images));
    pages.push_back(images->pages);
    info.fileBytes += checkedFileSize(file);
    for (std::int64_t page = 0; !stated && page < images->pages; ++page) stack.slices.push_back({i, page});
  }
  for (const Slice& slice : stack.slices)
    if (slice.page >= pages[slice.file])
      throw IoError(stack.files[slice.file].string() + ": expected page " + std::to_string(slice.page + 1) + " of " +
                    stack.place.writer + ", found " + std::to_string(pages[slice.file]));
}

// Places the voxels as the first file says. A distance of slices that nobody states is that of pixels, so that voxels
// are not a thousand times as long as wide.
void placeStack(const StackPlace& place, VolumeInfo& info) {
  info.notes.insert(info.notes.end(), place.notes.begin(), place.notes.end());
  if (!place.spacing[0] || !place.spacing[1]) {
    if (place.spacing[2] && *place.spacing[2] != 1) info.indexToWorld[2][2] = *place.spacing[2];
    return;
  }
  std::array<double, 3> spacing{*place.spacing[0], *place.spacing[1], place.spacing[2].value_or(*place.spacing[0])};
  std::array<std::string, 3> unit = place.unit;
  if (!place.spacing[2] || (unit[2].empty() && !unit[0].empty())) {
    spacing[2] = spacing[0];
    unit[2] = unit[0];
    if (info.dims.z > 1)
      info.notes.push_back("the distance of slices is not stated: it is taken to be that of pixels along x");
  }
  const auto x = millimetresPer(unit[0]), y = millimetresPer(unit[1]), z = millimetresPer(unit[2]);
  const bool known = x && y && z;
  for (int axis = 0; axis < 3; ++axis) info.indexToWorld[axis][axis] = spacing[static_cast<std::size_t>(axis)];
  checkPlace(info, place.writer + " spacing");
  if (known) {
    useLengthUnit(info, glm::dvec3(*x, *y, *z));
  } else if (!trimmed(unit[0]).empty()) {
    info.metadata["length_unit"] = std::string(trimmed(unit[0]));
    info.notes.push_back("the unit " + shortened(unit[0]) + " is no known unit of length: its numbers are kept");
  }
}

class StackSource : public VoxelSource {
 public:
  StackSource(VolumeInfo info, Stack stack) : stack_(std::move(stack)) { info_ = std::move(info); }

  double readSlab(std::int64_t count, std::span<float> out) override {
    const auto voxels = static_cast<std::size_t>(info_.dims.x * info_.dims.y * info_.components);
    slice_.resize(voxels * static_cast<std::size_t>(voxelBytes(info_.type)));
    double error = 0;
    for (std::int64_t i = 0; i < count; ++i) {
      const Slice& slice = stack_.slices[next_++];
      if (!open_ || slice.file != file_) open_ = openPages(stack_.files[file_ = slice.file]);
      open_->read(slice.page, slice_);
      error = std::max(error,
                       decodeVoxels(open_->layout, slice_, out.subspan(static_cast<std::size_t>(i) * voxels, voxels)));
    }
    return error;
  }
  void skipSlices(std::int64_t count) override { next_ += static_cast<std::size_t>(count); }
  bool skipsFast() const override { return true; }

 private:
  Stack stack_;
  std::unique_ptr<SliceImages> open_;
  std::size_t file_ = 0, next_ = 0;
  std::vector<std::byte> slice_;
};

}  // namespace

std::unique_ptr<SliceImages> openSliceImages(const fs::path& path) {
  checkedFileSize(path);
  std::array<char, 4> bytes{};
  openPlain(path)->read(std::as_writable_bytes(std::span(bytes)));
  const std::string_view magic(bytes.data(), bytes.size());
  if (magic == "\x89PNG") return openPng(path);
  if (magic.starts_with("II") || magic.starts_with("MM")) return openTiff(path);
  throw IoError(path.string() + ": expected a TIFF or PNG image, found other first bytes");
}

void SliceImages::promise(std::int64_t count) {
  throw IoError("expected an image for each of " + std::to_string(count) + " slices");
}

std::unique_ptr<VoxelSource> openImageStack(const fs::path& path, const PartChoice& parts, bool besideOnly) {
  VolumeInfo info;
  info.name = path.string();
  Stack stack;
  stack.files = sliceFiles(path, info.notes);
  const fs::path firstFile = stack.files.front();
  const auto first = openPages(firstFile);
  stack.place = stackPlace(firstFile, *first);
  const bool elsewhere = std::any_of(stack.place.slices.begin(), stack.place.slices.end(),
                                     [](const SlicePage& slice) { return !slice.file.empty(); });
  if (!stack.place.slices.empty() && (stack.files.size() == 1 || elsewhere)) takeStated(path, stack);
  if (besideOnly)
    for (const fs::path& file : stack.files) requireBeside(file, firstFile);
  checkFiles(*first, stack, info);
  info.type = first->layout.type;
  info.dims = {first->width, first->height, std::ssize(stack.slices)};
  info.components = info.valuesPerVoxel = first->components;
  if (info.components > 1) info.meaning = VoxelMeaning::colour;
  const auto bytes = arrayBytes(info);
  // No packing of images makes a hundred thousand pixels of one byte, so such a head is false.
  if (!bytes || *bytes / 100000 > info.fileBytes * 8)
    throw IoError(info.name + ": expected images that their files can hold, found " + describeBytes(info) + " in " +
                  std::to_string(info.fileBytes));
  addProvenance(info, path, lower(firstFile.extension().string()) == ".png" ? "PNG" : "TIFF");
  if (first->whiteIsZero) {
    info.metadata["photometric"] = "white is zero";
    info.notes.push_back("0 stands for white: values are kept as they are stored");
  }
  placeStack(stack.place, info);
  return pickComponents(std::make_unique<StackSource>(std::move(info), std::move(stack)), parts);
}

}  // namespace umbrick
