// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/dicom_volume.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "ingest/dicom/dicom_colours.h"
#include "ingest/dicom/dicom_pick.h"
#include "ingest/dicom/dicom_pixels.h"
#include "ingest/dicom/dicom_series.h"
#include "ingest/dicom/dicom_stack.h"
#include "ingest/header_text.h"
#include "ingest/parts.h"
#include "ingest/place.h"
#include "ingest/provenance.h"
#include "ingest/streams/byte_stream.h"
#include "ingest/streams/dense_source.h"
#include "ingest/volume_time.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

using Bytes = std::vector<std::byte>;

// Pixels of slices, for several threads at once. The last file of which several slices are had at once, a mosaic or one
// that is unpacked as a whole, is kept.
class SlicePixels {
 public:
  /// @return the pixels of the slice, as file.pixels.layout says, or its colours as coloursOf gives them
  Bytes read(const DicomSlice& slice) {
    const DicomPixelData& pixels = slice.file->pixels;
    if (pixels.colours != DicomColours::grey) return coloursOf(pixels, stored(slice));
    return stored(slice);
  }

 private:
  Bytes stored(const DicomSlice& slice) {
    const DicomPixelData& pixels = slice.file->pixels;
    const bool whole = pixels.columns == slice.file->columns && pixels.rows == slice.file->rows;
    if (pixels.single() && whole) return readDicomPixels(*slice.file, slice.frame->image);
    const std::shared_ptr<const Bytes> kept = keptPixels(*slice.file);
    return cut(slice, *kept);
  }

  std::shared_ptr<const Bytes> keptPixels(const DicomFile& file) {
    const std::scoped_lock lock(mutex_);
    if (keptOf_ != &file) {
      kept_.reset();
      keptOf_ = nullptr;
      kept_ = std::make_shared<const Bytes>(readDicomPixels(file, 0));
      keptOf_ = &file;
    }
    return kept_;
  }

  static Bytes cut(const DicomSlice& slice, const Bytes& from) {
    const DicomPixelData& pixels = slice.file->pixels;
    const auto voxel = static_cast<std::int64_t>(voxelBytes(pixels.layout.type)) * pixels.samples;
    const std::int64_t row = slice.file->columns * voxel, wide = pixels.columns * voxel;
    const std::int64_t image = pixels.single() ? 0 : static_cast<std::int64_t>(slice.frame->image);
    const std::int64_t first = (image * pixels.rows + slice.frame->corner.y) * wide + slice.frame->corner.x * voxel;
    Bytes out(static_cast<std::size_t>(row * slice.file->rows));
    for (std::int64_t y = 0; y < slice.file->rows; ++y)
      std::memcpy(out.data() + y * row, from.data() + first + y * wide, static_cast<std::size_t>(row));
    return out;
  }

  std::mutex mutex_;
  const DicomFile* keptOf_ = nullptr;
  std::shared_ptr<const Bytes> kept_;
};

// How the numbers lie that SlicePixels gives.
VoxelLayout layoutOf(const DicomPixelData& pixels) {
  if (pixels.colours == DicomColours::grey) return pixels.layout;
  return {valueType(pixels), std::endian::native};
}

bool isRescaled(const DicomFrame& frame) { return frame.slope != 1 || frame.intercept != 0; }

class DicomSource : public VoxelSource {
 public:
  DicomSource(VolumeInfo info, DicomStack stack) : stack_(std::move(stack)) {
    info_ = std::move(info);
    using enum VoxelType;
    asStored_ = info_.type == u8 || info_.type == i8 || info_.type == u16 || info_.type == i16;
    for (const DicomSlice& slice : stack_.slices())
      asStored_ = asStored_ && (info_.components > 1 || !isRescaled(*slice.frame));
    for (const DicomBlend& blend : stack_.blends()) asStored_ = asStored_ && blend.share == 0;
  }

  double readSlab(std::int64_t count, std::span<float> out) override {
    const std::vector<std::size_t> needed = blendedSlices(count);
    std::map<std::size_t, std::vector<float>> held;
    for (const std::size_t slice : needed) held[slice].resize(voxels());
    std::vector<double> errors(static_cast<std::size_t>(count) + needed.size(), 0.0);
    // All cores: slices of the slab that are there, and those between which others lie.
    tbb::parallel_for(std::size_t(0), errors.size(), [&](std::size_t i) {
      if (i >= static_cast<std::size_t>(count)) {
        const std::size_t slice = needed[i - static_cast<std::size_t>(count)];
        errors[i] = decode(slice, held.at(slice));
      } else if (const DicomBlend& blend = stack_.blends()[next_ + i]; blend.share == 0) {
        errors[i] = decode(blend.slice, out.subspan(i * voxels(), voxels()));
      }
    });
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      const DicomBlend& blend = stack_.blends()[next_ + i];
      if (blend.share == 0) continue;
      const std::vector<float>&a = held.at(blend.slice), &b = held.at(blend.slice + 1);
      for (std::size_t k = 0; k < voxels(); ++k)
        out[i * voxels() + k] = static_cast<float>((1 - blend.share) * double(a[k]) + blend.share * double(b[k]));
    }
    next_ += static_cast<std::size_t>(count);
    return *std::max_element(errors.begin(), errors.end());
  }

  void skipSlices(std::int64_t count) override { next_ += static_cast<std::size_t>(count); }
  bool skipsFast() const override { return true; }

  std::optional<VoxelType> storedType() const override { return asStored_ ? std::optional(info_.type) : std::nullopt; }
  void readStored(std::int64_t count, std::span<std::byte> out) override {
    const std::size_t bytes = voxels() * static_cast<std::size_t>(voxelBytes(info_.type));
    tbb::parallel_for(std::size_t(0), static_cast<std::size_t>(count), [&](std::size_t i) {
      const DicomSlice& slice = stack_.slices()[stack_.blends()[next_ + i].slice];
      const Bytes raw = pixels_.read(slice);
      const std::span<std::byte> to = out.subspan(i * bytes, bytes);
      std::memcpy(to.data(), raw.data(), bytes);
      normaliseVoxels(layoutOf(slice.file->pixels), to);
    });
    next_ += static_cast<std::size_t>(count);
  }

 private:
  std::size_t voxels() const { return static_cast<std::size_t>(info_.dims.x * info_.dims.y * info_.valuesPerVoxel); }

  double decode(std::size_t index, std::span<float> out) {
    const DicomSlice& slice = stack_.slices()[index];
    VoxelLayout layout = layoutOf(slice.file->pixels);
    if (info_.components == 1) {
      layout.slope = slice.frame->slope;
      layout.intercept = slice.frame->intercept;
    }
    return decodeVoxels(layout, pixels_.read(slice), out);
  }

  // The slices of the series that the next ones of the volume lie between.
  std::vector<std::size_t> blendedSlices(std::int64_t count) const {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
      if (const DicomBlend& blend = stack_.blends()[next_ + i]; blend.share != 0)
        for (const std::size_t slice : {blend.slice, blend.slice + 1})
          if (std::find(out.begin(), out.end(), slice) == out.end()) out.push_back(slice);
    return out;
  }

  DicomStack stack_;
  SlicePixels pixels_;
  std::size_t next_ = 0;
  bool asStored_ = false;
};

// What files say in the same words is said once.
void joinNotes(const std::vector<DicomFile>& files, std::vector<std::string>& notes) {
  std::map<std::string, std::pair<std::size_t, std::string>> all;
  for (const DicomFile& file : files)
    for (const auto& [what, found] : file.notes)
      if (auto& [count, first] = all[what]; count++ == 0) first = file.path.filename().string() + ": " + found;
  for (const auto& [what, said] : all) {
    const auto& [count, first] = said;
    notes.push_back(what + " (" + first +
                    (count > 1 ? ", and " + std::to_string(count - 1) + " more files)" : std::string(")")));
  }
}

// Returns the text that all slices have for a tag; empty where they differ or one has none.
std::string commonValue(const DicomStack& stack, std::uint32_t tag) {
  const std::string* common = nullptr;
  for (const DicomSlice& slice : stack.slices()) {
    const std::string* value = valueOf(*slice.file, *slice.frame, tag);
    if (!value || (common && *value != *common)) return {};
    common = value;
  }
  return common ? std::string(trimmed(*common)) : std::string();
}

void describe(const DicomStack& stack, VolumeInfo& info) {
  const DicomFile& file = stack.files().front();
  info.metadata["space"] = "LPS";
  info.metadata["length_unit"] = "mm";
  const auto keep = [&](const char* key, const std::string& value) {
    if (!value.empty()) info.metadata[key] = value;
  };
  keep("modality", file.modality);
  keep("series_uid", file.seriesUid);
  keep("series_description", file.seriesDescription);
  // DICOM PS3.3 C.7.6.17 and C.7.6.18.1: when in a cycle the volume is, and when it was acquired.
  constexpr std::uint32_t kPosition = 0x00200100, kTrigger = 0x00181060, kDate = 0x00080022, kTime = 0x00080032;
  keep("frame", commonValue(stack, kPosition));
  if (const auto trigger = number(commonValue(stack, kTrigger)))
    stateTime(info, {.first = *trigger, .unit = "ms"}, {});  // TriggerTime
  keep("acquisition_date", commonValue(stack, kDate));
  keep("acquisition_time", commonValue(stack, kTime));
  const bool grey = info.components == 1;
  keep("value_unit", !grey ? "" : file.valueUnit.empty() && file.modality == "CT" ? "HU" : file.valueUnit);
  if (!grey) keep("photometric", file.pixels.photometric);
  if (file.pixels.photometric == "MONOCHROME1") keep("photometric", "MONOCHROME1: the lowest value is white");
  if (file.gantryTilt != 0) keep("gantry_tilt", std::to_string(file.gantryTilt) + " degrees");
  const DicomFrame& first = *stack.slices().front().frame;
  bool alike = true;
  for (const DicomSlice& slice : stack.slices())
    alike = alike && slice.frame->slope == first.slope && slice.frame->intercept == first.intercept;
  if (!grey) return;
  VoxelLayout layout;
  layout.slope = first.slope;
  layout.intercept = first.intercept;
  keep("rescale", alike ? describeRescale(layout).value_or("") : "its own for each slice");
}

std::string listing(const std::vector<DicomSeriesFiles>& all) {
  std::string out;
  for (std::size_t i = 0; i < all.size(); ++i)
    out += (i ? "; " : "") + std::to_string(i + 1) + ": " + all[i].series.modality + " \"" + all[i].series.description +
           "\", " + std::to_string(all[i].files.size()) + " files, " + all[i].series.uid;
  return out;
}

// The one that the options pick.
std::vector<DicomFile> pickSeries(const fs::path& path, DicomFolder folder, const std::string& wanted,
                                  std::vector<std::string>& notes) {
  std::vector<DicomSeriesFiles>& all = folder.series;
  if (wanted.empty()) {
    if (all.size() > 1)
      throw SeveralSeries(path.string() + ": " + std::to_string(all.size()) +
                          " series, pick one by number or UID: " + listing(all));
    if (!folder.damaged.empty() && !all.empty())
      throw OddSlices(messageOf(folder.damaged.front().refused) + "; beside it there is series " + listing(all));
    if (!folder.damaged.empty()) std::rethrow_exception(folder.damaged.front().refused);
    if (all.empty()) throw IoError(path.string() + ": expected DICOM images, found none");
    return std::move(all.front().files);
  }
  const auto place = integer(wanted);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].series.uid != wanted && !(place && *place == static_cast<std::int64_t>(i) + 1)) continue;
    for (const DicomFile& file : folder.damaged)
      if (file.seriesUid.empty()) notes.push_back("left out, of whatever series it is: " + messageOf(file.refused));
    return std::move(all[i].files);
  }
  throw InvalidArgument(path.string() + ": no series \"" + wanted + "\": there are " + listing(all));
}

// Files whose pixels cannot be those of a volume end it, or are left out of a series that is picked where they are few.
void dropRefused(std::vector<DicomFile>& files, bool picked, std::vector<std::string>& notes) {
  const auto refused = [](const DicomFile& file) { return file.refused != nullptr; };
  const auto first = std::find_if(files.begin(), files.end(), refused);
  if (first == files.end()) return;
  const auto count = std::count_if(files.begin(), files.end(), refused);
  if (2 * count >= std::ssize(files)) std::rethrow_exception(first->refused);
  if (!picked) throw OddSlices(messageOf(first->refused));
  for (const DicomFile& file : files)
    if (file.refused) notes.push_back(file.path.filename().string() + " is left out: " + messageOf(file.refused));
  std::erase_if(files, refused);
}

[[noreturn]] void refuseSegments(const DicomFile& file, const std::string& why) {
  const std::size_t count = file.segments.size();
  throw SegmentsFound(file.path.string() + ": a DICOM segmentation of " + std::to_string(count) +
                      (count == 1 ? " segment" : " segments") + ", whose frames are no volume: " + why);
}

// Frames of a segment are a volume where they follow each other. Those of several are none together.
void checkSegments(const std::vector<DicomFile>& files) {
  for (const DicomFile& file : files)
    for (const DicomFrame& frame : file.frames)
      if (frame.segment != files.front().frames.front().segment)
        refuseSegments(file, "expected one segment, found frames of " +
                                 std::to_string(files.front().frames.front().segment) + " and " +
                                 std::to_string(frame.segment));
}

DicomStack stacked(const std::string& name, std::vector<DicomFile> files, const DicomOptions& options,
                   std::vector<std::string>& notes) {
  const DicomFile first = files.front();
  try {
    return {name, std::move(files), options, notes};
  } catch (const IoError& error) {
    if (first.segments.empty()) throw;
    refuseSegments(first, error.what());
  }
}

}  // namespace

std::unique_ptr<VoxelSource> openDicomFolder(const fs::path& path, DicomFolder folder, const DicomOptions& options) {
  VolumeInfo info;
  info.name = path.string();
  std::vector<DicomFile> files = pickSeries(path, std::move(folder), options.series, info.notes);
  dropRefused(files, !options.series.empty() || !options.where.empty(), info.notes);
  keepWhere(info.name, files, options.where);
  checkSegments(files);
  joinNotes(files, info.notes);
  DicomStack stack = stacked(info.name, std::move(files), options, info.notes);
  for (const DicomFile& file : stack.files()) info.fileBytes += checkedFileSize(file.path);
  const DicomFile& first = stack.files().front();
  info.dims = {first.columns, first.rows, std::ssize(stack.blends())};
  info.type = valueType(first.pixels);
  if (first.pixels.colours != DicomColours::grey) {
    info.components = info.valuesPerVoxel = 3;
    info.meaning = VoxelMeaning::colour;
  }
  if (!arrayBytes(info)) failField(path, "frames", "less than 2^31", std::to_string(info.dims.z));
  info.indexToWorld = stack.indexToWorld();
  addProvenance(info, path, "DICOM");
  describe(stack, info);
  checkPlace(info, "ImagePositionPatient, ImageOrientationPatient and PixelSpacing");
  return pickComponents(std::make_unique<DicomSource>(std::move(info), std::move(stack)), options.parts);
}

std::unique_ptr<VoxelSource> openDicom(const fs::path& path, const DicomOptions& options) {
  return openDicomFolder(path, readDicomFolder(path).value_or(DicomFolder()), options);
}

}  // namespace umbrick
