// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/hdf5_volume.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/input_file.h"
#include "ingest/array_lists.h"
#include "ingest/hdf5_axes.h"
#include "ingest/hdf5_file.h"
#include "ingest/hdf5_handle.h"
#include "ingest/hdf5_meaning.h"
#include "ingest/hdf5_types.h"
#include "ingest/header_text.h"
#include "ingest/parts.h"
#include "ingest/provenance.h"
#include "ingest/streams/dense_source.h"
#include "ingest/volume_time.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kMagic{"\x89HDF\r\n\x1a\n", 8};
constexpr std::size_t kMaxListed = 20;
constexpr std::int64_t kMaxCacheBytes = std::int64_t(1) << 30;

// libhdf5 prints its errors unless told not to.
class Quiet {
 public:
  Quiet() {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Quiet() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

// libhdf5 stacks its complaints: the innermost one is the first and says most.
std::string complaint() {
  std::string text;
  const auto take = [](unsigned n, const H5E_error2_t* error, void* out) -> herr_t {
    if (n == 0 && error->desc) *static_cast<std::string*>(out) = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take, &text);
  return text.empty() ? "an unreadable file" : text;
}

using Handle = Hdf5Handle;

struct Place {
  fs::path file;
  std::string dataset;  // empty: the only one
};

bool beginsAs(const fs::path& path, std::string_view magic) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return false;
  std::array<char, 8> bytes{};
  openPlain(path)->read(std::as_writable_bytes(std::span(bytes)));
  return std::string_view(bytes.data(), bytes.size()).starts_with(magic);
}

Place split(const fs::path& path) {
  const std::string text = path.string();
  for (std::size_t at = text.find(":/"); at != text.npos; at = text.find(":/", at + 1))
    if (beginsAs(text.substr(0, at), kMagic)) return {text.substr(0, at), text.substr(at + 1)};
  return {path, {}};
}

struct Found {
  std::vector<std::string> volumes;  // of three axes and numbers
  std::vector<std::string> parts;    // that have axes of frames or of components, too
  std::string other;                 // the first volume whose type is not read, and that type
};

herr_t onObject(hid_t file, const char* name, const H5O_info_t* info, void* user) {
  if (info->type != H5O_TYPE_DATASET) return 0;
  const Handle dataset(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose);
  if (!dataset.good()) return 0;
  const Hdf5Axes axes = hdf5Axes(dataset.get());
  const bool parts = axes.isVolume() && (axes.frames || axes.components);
  if (!axes.isPlain() && !parts) return 0;
  auto& found = *static_cast<Found*>(user);
  const std::string path = std::string("/") + name;
  if (hdf5Number(dataset.get()))
    (parts ? found.parts : found.volumes).push_back(path);
  else if (found.other.empty())
    found.other = path + " holds " + hdf5TypeText(dataset.get());
  return 0;
}

// @param why  gets a line that says which dataset is taken
std::string onlyVolume(const fs::path& path, hid_t file, std::string& why) {
  Found found;
  if (H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, onObject, &found, H5O_INFO_BASIC) < 0)
    throw IoError(path.string() + ": expected an HDF5 file, found: " + complaint());
  if (found.volumes.size() == 1) {
    why = "dataset " + found.volumes.front() + " is taken, the only one of three axes";
    return found.volumes.front();
  }
  if (found.volumes.empty() && found.parts.size() == 1) {
    why = "dataset " + found.parts.front() + " is taken, the only one with axes of frames or of components";
    return found.parts.front();
  }
  std::string list;
  found.volumes.insert(found.volumes.end(), found.parts.begin(), found.parts.end());
  for (std::size_t i = 0; i < std::min(found.volumes.size(), kMaxListed); ++i)
    list += (i == 0 ? "" : ", ") + found.volumes[i];
  if (found.volumes.size() > kMaxListed) list += ", ...";
  throw IoError(path.string() + ": expected one dataset of three axes, or its name as in " + path.filename().string() +
                ":/name, found " +
                (!list.empty()         ? list
                 : found.other.empty() ? "none"
                                       : "none of numbers: " + found.other));
}

std::string fileNameOf(hid_t object) {
  std::string name(4096, '\0');
  const ssize_t length = H5Fget_name(object, name.data(), name.size());
  name.resize(length > 0 ? std::min(static_cast<std::size_t>(length), name.size()) : 0);
  return name;
}

// A dataset may lie in another file (a link), have its bytes in one of any kind (external storage) or be put together
// from datasets of other files (a virtual dataset).
void refuseOtherFiles(const std::string& name, hid_t file, hid_t dataset) {
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose);
  const bool linked = fileNameOf(dataset) != fileNameOf(file);
  if (linked || H5Pget_external_count(creation.get()) != 0 || H5Pget_layout(creation.get()) == H5D_VIRTUAL)
    throw IoError(name + ": expected a dataset with its bytes in the same file, found one that names other files");
}

// Chunks are unpacked whole, so those of one layer are kept until the slabs have passed them.
Handle openDataset(hid_t file, const std::string& name) {
  Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.good()) return dataset;
  const std::vector<hsize_t> shape = hdf5Shape(dataset.get());
  const Handle creation(H5Dget_create_plist(dataset.get()), H5Pclose);
  std::vector<hsize_t> chunk(shape.size());
  if (shape.empty() || H5Pget_layout(creation.get()) != H5D_CHUNKED ||
      H5Pget_chunk(creation.get(), static_cast<int>(chunk.size()), chunk.data()) < 0)
    return dataset;
  const Handle type(H5Dget_type(dataset.get()), H5Tclose);
  double chunks = 1, bytes = static_cast<double>(H5Tget_size(type.get()));
  for (const hsize_t length : chunk) bytes *= static_cast<double>(length);
  const Hdf5Axes sorted = hdf5Axes(dataset.get());
  std::vector<std::size_t> axes = sorted.space;
  if (axes.size() > 2) axes.erase(axes.begin());
  if (sorted.components) axes.push_back(*sorted.components);
  for (const std::size_t axis : axes)
    chunks *= static_cast<double>((shape[axis] + chunk[axis] - 1) / std::max<hsize_t>(chunk[axis], 1));
  if (chunks * bytes > static_cast<double>(kMaxCacheBytes)) return dataset;
  const Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  H5Pset_chunk_cache(access.get(), static_cast<std::size_t>(chunks) * 10 + 1, static_cast<std::size_t>(chunks * bytes),
                     1.0);
  return {H5Dopen2(file, name.c_str(), access.get()), H5Dclose};
}

class Hdf5Source : public VoxelSource {
 public:
  /// @param choice  was checked
  Hdf5Source(VolumeInfo info, Handle file, Handle dataset, Hdf5Axes axes, const PartChoice& choice, Hdf5Meaning meaning)
      : file_(std::move(file)),
        dataset_(std::move(dataset)),
        shape_(hdf5Shape(dataset_.get())),
        axes_(std::move(axes)),
        choice_(choice),
        meaning_(std::move(meaning)) {
    info_ = std::move(info);
    info_.valuesPerVoxel = choice_.component && !choice_.magnitude ? 1 : info_.components;
  }

  double readSlab(std::int64_t count, std::span<float> out) override {
    const Quiet quiet;
    slab_.resize(out.size() * static_cast<std::size_t>(voxelBytes(meaning_.layout.type)));
    std::vector<hsize_t> start(shape_.size()), extent = shape_;
    const auto only = [&](std::size_t axis, std::int64_t first, std::int64_t length) {
      start[axis] = static_cast<hsize_t>(first);
      extent[axis] = static_cast<hsize_t>(length);
    };
    if (axes_.space.size() == 3) only(axes_.space[0], next_, count);
    if (axes_.frames) only(*axes_.frames, choice_.frame.value_or(0), 1);
    if (axes_.components && info_.valuesPerVoxel == 1) only(*axes_.components, choice_.component.value_or(0), 1);
    const Handle from(H5Dget_space(dataset_.get()), H5Sclose);
    const Handle to(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose);
    if (H5Sselect_hyperslab(from.get(), H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr) < 0 ||
        H5Dread(dataset_.get(), hdf5MemoryType(meaning_.read), to.get(), from.get(), H5P_DEFAULT, slab_.data()) < 0)
      throw IoError(info_.name + ": expected " + describeBytes(info_) + ", found from slice " +
                    std::to_string(next_ + 1) + " on: " + complaint());
    next_ += count;
    const bool sideBySide = info_.valuesPerVoxel == 1 || *axes_.components > axes_.space.back();
    if (sideBySide) return meaning_.decode(slab_, out);
    apart_.resize(out.size());
    const double error = meaning_.decode(slab_, apart_);
    putSideBySide(count, out);
    return error;
  }

  void skipSlices(std::int64_t count) override { next_ += count; }
  bool skipsFast() const override { return true; }

 private:
  // Components that vary slower than x become those that vary fastest.
  void putSideBySide(std::int64_t count, std::span<float> out) const {
    const std::int64_t components = info_.valuesPerVoxel;
    std::int64_t inner = 1;  // voxels of the axes behind that of components
    for (std::size_t i = 0; i < axes_.space.size(); ++i)
      if (axes_.space[i] > *axes_.components) inner *= static_cast<std::int64_t>(shape_[axes_.space[i]]);
    // The slowest axis of space is read in part.
    if (axes_.space.size() == 3 && axes_.space[0] > *axes_.components) inner = info_.dims.x * info_.dims.y * count;
    const std::int64_t outer = std::ssize(out) / (inner * components);
    const float* value = apart_.data();
    for (std::int64_t o = 0; o < outer; ++o)
      for (std::int64_t c = 0; c < components; ++c)
        for (std::int64_t i = 0; i < inner; ++i)
          out[static_cast<std::size_t>((o * inner + i) * components + c)] = *value++;
  }

  Handle file_, dataset_;
  std::vector<hsize_t> shape_;
  Hdf5Axes axes_;
  PartChoice choice_;
  Hdf5Meaning meaning_;
  std::int64_t next_ = 0;
  std::vector<std::byte> slab_;
  std::vector<float> apart_;  // components one after the other, as the file has them
};

// The sizes of a dataset as a volume. @throw IoError  it is none
void describeShape(hid_t dataset, const Hdf5Axes& axes, VolumeInfo& info) {
  const std::vector<hsize_t> shape = hdf5Shape(dataset);
  if (!axes.isVolume())
    failField(info.name, "shape",
              "two or three axes of space that are longer than 1, beside which may stand one of frames and one of "
              "components",
              shape.empty() ? "none" : hdf5ShapeText(shape));
  const auto length = [&](std::size_t axis) { return static_cast<std::int64_t>(shape[axis]); };
  info.dims = glm::i64vec3(1);
  for (std::size_t i = 0; i < axes.space.size(); ++i)
    info.dims[static_cast<int>(i)] = length(axes.space[axes.space.size() - 1 - i]);
  if (axes.frames) info.frames = length(*axes.frames);
  if (axes.components) info.components = length(*axes.components);
  info.meaning = axes.meaning;
  if (!arrayBytes(info))
    failField(info.name, "shape", "each from 1 to 2147483647 and less than 2^63 bytes in all", hdf5ShapeText(shape));
  // A slice is held as a whole. Chunks that nobody wrote take no bytes, so this leaves much room.
  const std::int64_t sliceBytes = info.dims.x * info.dims.y * info.components * voxelBytes(info.type);
  const auto storedBytes = static_cast<std::int64_t>(H5Dget_storage_size(dataset));
  if (sliceBytes / 100000 > storedBytes)
    failField(info.name, "shape", "slices that the " + std::to_string(storedBytes) + " stored bytes can fill",
              hdf5ShapeText(shape));
}

}  // namespace

std::vector<ArrayRow> listHdf5Arrays(const fs::path& path) {
  const Quiet quiet;
  const Handle file = openHdf5File(path);
  std::vector<ArrayRow> rows;
  const auto add = [](hid_t in, const char* name, const H5O_info_t* info, void* user) -> herr_t {
    if (info->type != H5O_TYPE_DATASET) return 0;
    const Handle dataset(H5Dopen2(in, name, H5P_DEFAULT), H5Dclose);
    if (!dataset.good()) return 0;
    const std::vector<hsize_t> shape = hdf5Shape(dataset.get());
    const auto type = hdf5Number(dataset.get());
    static_cast<std::vector<ArrayRow>*>(user)->push_back(
        {std::string("/") + name, shape.empty() ? "one value" : hdf5ShapeText(shape),
         type ? std::string(voxelTypeName(type->stored)) : hdf5TypeText(dataset.get()),
         type.has_value() && hdf5Axes(dataset.get()).isVolume()});
    return 0;
  };
  if (!file.good() || H5Ovisit2(file.get(), H5_INDEX_NAME, H5_ITER_INC, add, &rows, H5O_INFO_BASIC) < 0)
    throw IoError(path.string() + ": expected an HDF5 file, found: " + complaint());
  return rows;
}

bool isHdf5Dataset(const fs::path& path) { return !split(path).dataset.empty(); }

std::unique_ptr<VoxelSource> openHdf5(const fs::path& path, const PartChoice& parts, bool besideOnly) {
  const Quiet quiet;
  Place place = split(path);
  VolumeInfo info;
  info.fileBytes = ordinaryFileSize(place.file);
  Handle file = openHdf5File(place.file);
  if (!file.good())
    throw IoError(place.file.string() + ": expected an HDF5 file, found" +
                  (beginsAs(place.file, "CDF") ? " netCDF 3, which is not read; nccopy -k nc4 makes HDF5 of it"
                                               : ": " + complaint()));
  std::string why;
  const bool chosen = place.dataset.empty();
  if (chosen) place.dataset = onlyVolume(place.file, file.get(), why);
  info.name = place.file.string() + ':' + place.dataset;
  Handle dataset = openDataset(file.get(), place.dataset);
  if (!dataset.good()) throw IoError(info.name + ": expected a dataset, found: " + complaint());
  if (besideOnly) refuseOtherFiles(info.name, file.get(), dataset.get());

  const auto type = hdf5Number(dataset.get());
  if (!type)
    throw IoError(info.name + ": type: expected integers of 8 to 64 bits or floats of 16 to 64, found " +
                  hdf5TypeText(dataset.get()));
  info.type = type->stored;
  Hdf5Axes axes = hdf5Axes(dataset.get());
  describeShape(dataset.get(), axes, info);
  addProvenance(info, place.file, "HDF5");
  info.metadata["source_dataset"] = place.dataset;
  stateTime(info, axes.times, parts.frame);
  if (chosen) info.notes.push_back(std::move(why));
  info.notes.insert(info.notes.end(), axes.notes.begin(), axes.notes.end());
  guessMeaning(info);
  const std::size_t rank = hdf5Shape(dataset.get()).size();
  Hdf5Meaning meaning = readHdf5Meaning(dataset.get(), type->read, axes.space, rank, info);
  checkChoice(info, parts);
  return pickComponents(std::make_unique<Hdf5Source>(std::move(info), std::move(file), std::move(dataset),
                                                     std::move(axes), parts, std::move(meaning)),
                        parts);
}

}  // namespace umbrick
