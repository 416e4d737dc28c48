// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/hdf5_volume.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/input_file.h"
#include "ingest/array_lists.h"
#include "ingest/hdf5_file.h"
#include "ingest/hdf5_handle.h"
#include "ingest/hdf5_meaning.h"
#include "ingest/header_text.h"
#include "ingest/provenance.h"
#include "ingest/streams/dense_source.h"
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

std::vector<hsize_t> shapeOf(hid_t dataset) {
  const Handle space(H5Dget_space(dataset), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space.get());
  std::vector<hsize_t> shape(static_cast<std::size_t>(std::max(rank, 0)));
  if (rank > 0) H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr);
  return shape;
}

// The axes that count: of more than three, those of length 1 are dropped, the first ones first.
std::vector<std::size_t> axesOf(const std::vector<hsize_t>& shape) {
  std::vector<std::size_t> axes;
  std::size_t spare = shape.size() > 3 ? shape.size() - 3 : 0;
  for (std::size_t i = 0; i < shape.size(); ++i)
    if (shape[i] == 1 && spare > 0)
      --spare;
    else
      axes.push_back(i);
  return axes;
}

std::string shapeText(const std::vector<hsize_t>& shape) {
  std::string text;
  for (const hsize_t length : shape) text += (text.empty() ? "" : " x ") + std::to_string(length);
  return text;
}

// The type in memory that a dataset is read as, and how it is stored.
struct NumberType {
  VoxelType stored = VoxelType::u8, read = VoxelType::u8;
};
std::optional<NumberType> numberType(hid_t dataset) {
  using enum VoxelType;
  const Handle type(H5Dget_type(dataset), H5Tclose);
  const std::size_t bytes = H5Tget_size(type.get());
  const H5T_class_t kind = H5Tget_class(type.get());
  const int power = bytes == 1 ? 0 : bytes == 2 ? 1 : bytes == 4 ? 2 : bytes == 8 ? 3 : -1;
  if (power < 0) return std::nullopt;
  const auto at = static_cast<std::size_t>(power);
  if (kind == H5T_INTEGER) {
    const VoxelType found =
        H5Tget_sign(type.get()) == H5T_SGN_2 ? std::array{i8, i16, i32, i64}[at] : std::array{u8, u16, u32, u64}[at];
    return NumberType{found, found};
  }
  if (kind != H5T_FLOAT || power < 1) return std::nullopt;
  const VoxelType found = std::array{f16, f16, f32, f64}[at];
  return NumberType{found, found == f16 ? f32 : found};  // libhdf5 widens halves, exactly
}

// Names a type that is not read, in the words of those who write such files.
std::string typeText(hid_t dataset) {
  const Handle type(H5Dget_type(dataset), H5Tclose);
  const std::string bits = std::to_string(8 * H5Tget_size(type.get())) + " bits";
  switch (H5Tget_class(type.get())) {
    case H5T_INTEGER:
      return "an integer of " + bits;
    case H5T_FLOAT:
      return "a float of " + bits;
    case H5T_ENUM:
      return "an enumeration, which is not read; bool of h5py and PyTables is one: store it as uint8";
    case H5T_STRING:
      return "text";
    case H5T_BITFIELD:
      return "a bit field of " + bits;
    case H5T_COMPOUND:
      return "a compound; complex numbers are stored so";
    case H5T_REFERENCE:
      return "references";
    case H5T_ARRAY:
      return "an array in each voxel";
    case H5T_VLEN:
      return "a sequence of its own length in each voxel";
    default:
      return "another type";
  }
}

hid_t memoryType(VoxelType type) {
  switch (type) {
    case VoxelType::u8:
      return H5T_NATIVE_UINT8;
    case VoxelType::i8:
      return H5T_NATIVE_INT8;
    case VoxelType::u16:
      return H5T_NATIVE_UINT16;
    case VoxelType::i16:
      return H5T_NATIVE_INT16;
    case VoxelType::u32:
      return H5T_NATIVE_UINT32;
    case VoxelType::i32:
      return H5T_NATIVE_INT32;
    case VoxelType::u64:
      return H5T_NATIVE_UINT64;
    case VoxelType::i64:
      return H5T_NATIVE_INT64;
    case VoxelType::f64:
      return H5T_NATIVE_DOUBLE;
    default:
      return H5T_NATIVE_FLOAT;
  }
}

struct Found {
  std::vector<std::string> volumes;  // of three axes and numbers
  std::string other;                 // the first one of three axes whose type is not read, and that type
};

herr_t onObject(hid_t file, const char* name, const H5O_info_t* info, void* user) {
  if (info->type != H5O_TYPE_DATASET) return 0;
  const Handle dataset(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose);
  if (!dataset.good() || axesOf(shapeOf(dataset.get())).size() != 3) return 0;
  auto& found = *static_cast<Found*>(user);
  const std::string path = std::string("/") + name;
  if (numberType(dataset.get()))
    found.volumes.push_back(path);
  else if (found.other.empty())
    found.other = path + " holds " + typeText(dataset.get());
  return 0;
}

std::string onlyVolume(const fs::path& path, hid_t file) {
  Found found;
  if (H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, onObject, &found, H5O_INFO_BASIC) < 0)
    throw IoError(path.string() + ": expected an HDF5 file, found: " + complaint());
  if (found.volumes.size() == 1) return found.volumes.front();
  std::string list;
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
  const std::vector<hsize_t> shape = shapeOf(dataset.get());
  const Handle creation(H5Dget_create_plist(dataset.get()), H5Pclose);
  std::vector<hsize_t> chunk(shape.size());
  if (shape.empty() || H5Pget_layout(creation.get()) != H5D_CHUNKED ||
      H5Pget_chunk(creation.get(), static_cast<int>(chunk.size()), chunk.data()) < 0)
    return dataset;
  const Handle type(H5Dget_type(dataset.get()), H5Tclose);
  double chunks = 1, bytes = static_cast<double>(H5Tget_size(type.get()));
  for (const hsize_t length : chunk) bytes *= static_cast<double>(length);
  const std::vector<std::size_t> axes = axesOf(shape);
  for (std::size_t i = axes.size() > 2 ? axes.size() - 2 : 0; i < axes.size(); ++i)
    chunks *= static_cast<double>((shape[axes[i]] + chunk[axes[i]] - 1) / std::max<hsize_t>(chunk[axes[i]], 1));
  if (chunks * bytes > static_cast<double>(kMaxCacheBytes)) return dataset;
  const Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  H5Pset_chunk_cache(access.get(), static_cast<std::size_t>(chunks) * 10 + 1, static_cast<std::size_t>(chunks * bytes),
                     1.0);
  return {H5Dopen2(file, name.c_str(), access.get()), H5Dclose};
}

class Hdf5Source : public VoxelSource {
 public:
  Hdf5Source(VolumeInfo info, Handle file, Handle dataset, Hdf5Meaning meaning)
      : file_(std::move(file)),
        dataset_(std::move(dataset)),
        shape_(shapeOf(dataset_.get())),
        meaning_(std::move(meaning)) {
    info_ = std::move(info);
  }

  double readSlab(std::int64_t count, std::span<float> out) override {
    const Quiet quiet;
    slab_.resize(out.size() * static_cast<std::size_t>(voxelBytes(meaning_.layout.type)));
    std::vector<hsize_t> start(shape_.size()), extent = shape_;
    if (const std::vector<std::size_t> axes = axesOf(shape_); axes.size() == 3) {
      start[axes[0]] = static_cast<hsize_t>(next_);
      extent[axes[0]] = static_cast<hsize_t>(count);
    }
    const Handle from(H5Dget_space(dataset_.get()), H5Sclose);
    const Handle to(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose);
    if (H5Sselect_hyperslab(from.get(), H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr) < 0 ||
        H5Dread(dataset_.get(), memoryType(meaning_.read), to.get(), from.get(), H5P_DEFAULT, slab_.data()) < 0)
      throw IoError(info_.name + ": expected " + describeBytes(info_) + ", found from slice " +
                    std::to_string(next_ + 1) + " on: " + complaint());
    next_ += count;
    return meaning_.decode(slab_, out);
  }

  void skipSlices(std::int64_t count) override { next_ += count; }
  bool skipsFast() const override { return true; }

 private:
  Handle file_, dataset_;
  std::vector<hsize_t> shape_;
  Hdf5Meaning meaning_;
  std::int64_t next_ = 0;
  std::vector<std::byte> slab_;
};

}  // namespace

std::vector<ArrayRow> listHdf5Arrays(const fs::path& path) {
  const Quiet quiet;
  const Handle file = openHdf5File(path);
  std::vector<ArrayRow> rows;
  const auto add = [](hid_t in, const char* name, const H5O_info_t* info, void* user) -> herr_t {
    if (info->type != H5O_TYPE_DATASET) return 0;
    const Handle dataset(H5Dopen2(in, name, H5P_DEFAULT), H5Dclose);
    if (!dataset.good()) return 0;
    const std::vector<hsize_t> shape = shapeOf(dataset.get());
    const auto type = numberType(dataset.get());
    const std::size_t axes = axesOf(shape).size();
    static_cast<std::vector<ArrayRow>*>(user)->push_back(
        {std::string("/") + name, shape.empty() ? "one value" : shapeText(shape),
         type ? std::string(voxelTypeName(type->stored)) : typeText(dataset.get()),
         type.has_value() && (axes == 2 || axes == 3)});
    return 0;
  };
  if (!file.good() || H5Ovisit2(file.get(), H5_INDEX_NAME, H5_ITER_INC, add, &rows, H5O_INFO_BASIC) < 0)
    throw IoError(path.string() + ": expected an HDF5 file, found: " + complaint());
  return rows;
}

bool isHdf5Dataset(const fs::path& path) { return !split(path).dataset.empty(); }

std::unique_ptr<VoxelSource> openHdf5(const fs::path& path, bool besideOnly) {
  const Quiet quiet;
  Place place = split(path);
  VolumeInfo info;
  info.fileBytes = ordinaryFileSize(place.file);
  Handle file = openHdf5File(place.file);
  if (!file.good())
    throw IoError(place.file.string() + ": expected an HDF5 file, found" +
                  (beginsAs(place.file, "CDF") ? " netCDF 3, which is not read; nccopy -k nc4 makes HDF5 of it"
                                               : ": " + complaint()));
  const bool chosen = place.dataset.empty();
  if (chosen) place.dataset = onlyVolume(place.file, file.get());
  info.name = place.file.string() + ':' + place.dataset;
  Handle dataset = openDataset(file.get(), place.dataset);
  if (!dataset.good()) throw IoError(info.name + ": expected a dataset, found: " + complaint());
  if (besideOnly) refuseOtherFiles(info.name, file.get(), dataset.get());

  const auto type = numberType(dataset.get());
  if (!type)
    throw IoError(info.name + ": type: expected integers of 8 to 64 bits or floats of 16 to 64, found " +
                  typeText(dataset.get()));
  const std::vector<hsize_t> shape = shapeOf(dataset.get());
  const std::vector<std::size_t> axes = axesOf(shape);
  if (axes.size() < 2 || axes.size() > 3)
    failField(info.name, "shape", "two or three axes that are longer than 1",
              shape.empty() ? "none" : shapeText(shape));
  info.type = type->stored;
  info.dims = glm::i64vec3(1);
  for (std::size_t i = 0; i < axes.size(); ++i)
    info.dims[static_cast<int>(i)] = static_cast<std::int64_t>(shape[axes[axes.size() - 1 - i]]);
  if (!volumeBytes(info.dims, info.type))
    failField(info.name, "shape", "each from 1 to 2147483647 and less than 2^63 bytes in all", shapeText(shape));
  // A slice is held as a whole. Chunks that nobody wrote take no bytes, so this leaves much room.
  const std::int64_t sliceBytes = info.dims.x * info.dims.y * voxelBytes(info.type);
  const auto storedBytes = static_cast<std::int64_t>(H5Dget_storage_size(dataset.get()));
  if (sliceBytes / 100000 > storedBytes)
    failField(info.name, "shape", "slices that the " + std::to_string(storedBytes) + " stored bytes can fill",
              shapeText(shape));
  addProvenance(info, place.file, "HDF5");
  info.metadata["source_dataset"] = place.dataset;
  if (chosen) info.notes.push_back("dataset " + place.dataset + " is taken, the only one of three axes");
  Hdf5Meaning meaning = readHdf5Meaning(dataset.get(), type->read, axes, shape.size(), info);
  return std::make_unique<Hdf5Source>(std::move(info), std::move(file), std::move(dataset), std::move(meaning));
}

}  // namespace umbrick
