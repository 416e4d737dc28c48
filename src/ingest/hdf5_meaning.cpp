// SPDX-License-Identifier: Apache-2.0
#include "ingest/hdf5_meaning.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <sstream>
#include <string>

#include "ingest/hdf5_handle.h"
#include "ingest/header_text.h"
#include "ingest/length_unit.h"
#include "ingest/place.h"
#include "ingest/streams/dense_source.h"

namespace umbrick {
namespace {

constexpr hssize_t kMostNumbers = 64;
constexpr std::size_t kMostText = 4096;

// The default of netCDF for floats that were never written.
constexpr float kNetcdfFill = 9.9692099683868690e+36f;

std::string text(double number) {
  std::ostringstream out;
  out.precision(9);
  out << number;
  return out.str();
}

class Attributes {
 public:
  Attributes(hid_t dataset, const std::string& name) : dataset_(dataset), name_(name) {}

  bool has(const char* key) const { return H5Aexists(dataset_, key) > 0; }

  // All numbers of an attribute; none where it is not there. @param count  that there must be; 0: any
  std::vector<double> numbers(const char* key, std::size_t count) const {
    if (!has(key)) return {};
    const Hdf5Handle attribute(H5Aopen(dataset_, key, H5P_DEFAULT), H5Aclose);
    const Hdf5Handle type(H5Aget_type(attribute.get()), H5Tclose), space(H5Aget_space(attribute.get()), H5Sclose);
    const H5T_class_t kind = H5Tget_class(type.get());
    const hssize_t found = H5Sget_simple_extent_npoints(space.get());
    std::vector<double> out(static_cast<std::size_t>(std::clamp<hssize_t>(found, 0, kMostNumbers)));
    const std::string expected = count == 1 ? "a number" : count > 0 ? std::to_string(count) + " numbers" : "numbers";
    if ((kind != H5T_INTEGER && kind != H5T_FLOAT) || found < 1 || found > kMostNumbers ||
        H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, out.data()) < 0)
      failField(name_, key, expected, kind == H5T_STRING ? "text" : "something else");
    if (count > 0 && out.size() != count) failField(name_, key, expected, std::to_string(out.size()));
    return out;
  }

  // Whether there is a number for each axis that counts, or for each of the dataset.
  bool isForAxes(const char* key, std::size_t axes, std::size_t rank) const {
    if (!has(key)) return false;
    const Hdf5Handle attribute(H5Aopen(dataset_, key, H5P_DEFAULT), H5Aclose);
    const Hdf5Handle type(H5Aget_type(attribute.get()), H5Tclose), space(H5Aget_space(attribute.get()), H5Sclose);
    const H5T_class_t kind = H5Tget_class(type.get());
    const hssize_t found = H5Sget_simple_extent_npoints(space.get());
    return (kind == H5T_INTEGER || kind == H5T_FLOAT) &&
           (found == static_cast<hssize_t>(axes) || found == static_cast<hssize_t>(rank));
  }

  std::optional<double> number(const char* key) const {
    const std::vector<double> found = numbers(key, 1);
    if (found.empty()) return std::nullopt;
    if (!std::isfinite(found[0])) failField(name_, key, "a finite number", text(found[0]));
    return found[0];
  }

  // A text of fixed or of its own length; empty where there is none, or several.
  std::string string(const char* key) const {
    if (!has(key)) return {};
    const Hdf5Handle attribute(H5Aopen(dataset_, key, H5P_DEFAULT), H5Aclose);
    const Hdf5Handle type(H5Aget_type(attribute.get()), H5Tclose), space(H5Aget_space(attribute.get()), H5Sclose);
    if (H5Tget_class(type.get()) != H5T_STRING || H5Sget_simple_extent_npoints(space.get()) != 1) return {};
    if (H5Tis_variable_str(type.get()) > 0) {
      char* found = nullptr;
      if (H5Aread(attribute.get(), type.get(), &found) < 0 || !found) return {};
      const std::string out(found, strnlen(found, kMostText));
      H5free_memory(found);
      return out;
    }
    std::string out(H5Tget_size(type.get()), '\0');
    if (out.size() > kMostText || H5Aread(attribute.get(), type.get(), out.data()) < 0) return {};
    return std::string(trimmed(out.substr(0, out.find('\0'))));
  }

 private:
  hid_t dataset_;
  std::string name_;
};

VoxelType unsignedOf(VoxelType type) {
  using enum VoxelType;
  return type == i8 ? u8 : type == i16 ? u16 : type == i32 ? u32 : type == i64 ? u64 : type;
}

// Attributes of a dataset whose signed integers stand for unsigned ones are signed too.
double asStored(double value, const Attributes& attributes, VoxelType type) {
  const bool wraps = value < 0 && lower(attributes.string("_Unsigned")) == "true";
  return wraps ? value + std::ldexp(1.0, 8 * voxelBytes(type)) : value;
}

void readMissing(const Attributes& attributes, bool isNetcdf, Hdf5Meaning& meaning, VolumeInfo& info) {
  std::string said;
  for (const char* key : {"_FillValue", "missing_value"})
    for (const double number : attributes.numbers(key, 0)) {
      const double value = asStored(number, attributes, meaning.layout.type);
      if (std::isnan(value)) continue;  // is no number as it is
      if (std::find(meaning.missing.begin(), meaning.missing.end(), value) != meaning.missing.end()) continue;
      meaning.missing.push_back(value);
      said += (said.empty() ? "" : ", ") + text(value) + " (" + key + ')';
    }
  if (isNetcdf && isFloat(meaning.layout.type) && !attributes.has("_FillValue"))
    meaning.missing.push_back(static_cast<double>(kNetcdfFill));
  if (const std::vector<double> range = attributes.numbers("valid_range", 2); !range.empty()) {
    meaning.least = asStored(range[0], attributes, meaning.layout.type);
    meaning.most = asStored(range[1], attributes, meaning.layout.type);
  }
  if (const auto least = attributes.number("valid_min")) meaning.least = *least;
  if (const auto most = attributes.number("valid_max")) meaning.most = *most;
  if (std::isfinite(meaning.least) || std::isfinite(meaning.most))
    said += (said.empty() ? "" : ", and ") + std::string("what is not from ") + text(meaning.least) + " to " +
            text(meaning.most) + " (valid_min, valid_max or valid_range)";
  if (said.empty()) return;
  info.metadata["missing_value"] = said;
  info.notes.push_back("stored values of " + said +
                       " are missing: such voxels become background, counted as not finite");
}

// Numbers for the axes of the dataset, or for those three that count.
std::optional<glm::dvec3> alongAxes(const Attributes& attributes, const std::string& name, const char* key,
                                    const std::vector<std::size_t>& axes, std::size_t rank) {
  const std::vector<double> found = attributes.numbers(key, 0);
  if (found.empty()) return std::nullopt;
  if (found.size() != rank && found.size() != axes.size())
    failField(name, key, "a number for each of " + std::to_string(axes.size()) + " axes",
              std::to_string(found.size()) + " numbers");
  glm::dvec3 out(0);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::size_t axis = axes.size() - 1 - i;  // x is the last one
    out[static_cast<int>(i)] = found[found.size() == rank ? axes[axis] : axis];
  }
  return out;
}

void place(const Attributes& attributes, const std::vector<std::size_t>& axes, std::size_t rank, VolumeInfo& info) {
  const auto along = [&](const char* key) { return alongAxes(attributes, info.name, key, axes, rank); };
  const bool micrometres = attributes.has("element_size_um");
  const char* sizeKey = micrometres ? "element_size_um" : "resolution";
  // Other programs call other things a resolution: a text, or one number.
  if (!micrometres && !attributes.isForAxes(sizeKey, axes.size(), rank)) return;
  const auto size = along(sizeKey);
  const char* offsetKey = micrometres ? "offset_um" : "offset";
  const auto offset = attributes.isForAxes(offsetKey, axes.size(), rank) ? along(offsetKey) : std::nullopt;
  if (!size) return;
  for (int axis = 0; axis < 3; ++axis) {
    const bool there = axis < static_cast<int>(axes.size());
    const double step = there ? (*size)[axis] : size->x;
    if (!(step > 0)) failField(info.name, sizeKey, "positive numbers", text(step));
    info.indexToWorld[axis][axis] = step;
    if (offset && there) info.indexToWorld[3][axis] = (*offset)[axis];
  }
  checkPlace(info, sizeKey);
  std::string unit = micrometres ? "um" : attributes.string("resolution_unit");
  if (const auto millimetres = millimetresPer(unit))
    useLengthUnit(info, *millimetres);
  else
    info.notes.push_back("the attribute resolution states no unit of length: its numbers are kept");
}

template <class T>
void markMissing(const Hdf5Meaning& meaning, std::span<const std::byte> stored, std::span<float> out) {
  std::vector<T> missing;
  for (const double value : meaning.missing) {
    const T cast = static_cast<T>(std::clamp(value, static_cast<double>(std::numeric_limits<T>::lowest()),
                                             static_cast<double>(std::numeric_limits<T>::max()) *
                                                 (sizeof(T) == 8 && std::is_integral_v<T> ? 0.9999999999999998 : 1)));
    if (!std::is_integral_v<T> || static_cast<double>(cast) == value) missing.push_back(cast);
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    T value;
    std::memcpy(&value, stored.data() + i * sizeof(T), sizeof(T));
    const auto number = static_cast<double>(value);
    if (number < meaning.least || number > meaning.most ||
        std::find(missing.begin(), missing.end(), value) != missing.end())
      out[i] = std::numeric_limits<float>::quiet_NaN();
  }
}

}  // namespace

double Hdf5Meaning::decode(std::span<const std::byte> stored, std::span<float> out) const {
  const double error = decodeVoxels(layout, stored, out);
  if (missing.empty() && std::isinf(least) && std::isinf(most)) return error;
  switch (layout.type) {
    case VoxelType::u8:
      markMissing<std::uint8_t>(*this, stored, out);
      break;
    case VoxelType::i8:
      markMissing<std::int8_t>(*this, stored, out);
      break;
    case VoxelType::u16:
      markMissing<std::uint16_t>(*this, stored, out);
      break;
    case VoxelType::i16:
      markMissing<std::int16_t>(*this, stored, out);
      break;
    case VoxelType::u32:
      markMissing<std::uint32_t>(*this, stored, out);
      break;
    case VoxelType::i32:
      markMissing<std::int32_t>(*this, stored, out);
      break;
    case VoxelType::u64:
      markMissing<std::uint64_t>(*this, stored, out);
      break;
    case VoxelType::i64:
      markMissing<std::int64_t>(*this, stored, out);
      break;
    case VoxelType::f64:
      markMissing<double>(*this, stored, out);
      break;
    default:
      markMissing<float>(*this, stored, out);
  }
  return error;
}

Hdf5Meaning readHdf5Meaning(hid_t dataset, VoxelType read, const std::vector<std::size_t>& axes, std::size_t rank,
                            VolumeInfo& info) {
  const Attributes attributes(dataset, info.name);
  Hdf5Meaning meaning;
  meaning.read = meaning.layout.type = read;
  meaning.layout.endian = std::endian::native;  // libhdf5 swaps
  if (lower(attributes.string("_Unsigned")) == "true") info.type = meaning.layout.type = unsignedOf(read);
  meaning.layout.slope = attributes.number("scale_factor").value_or(1);
  meaning.layout.intercept = attributes.number("add_offset").value_or(0);
  if (meaning.layout.slope == 0) failField(info.name, "scale_factor", "a number other than 0", "0");
  if (const auto rescale = describeRescale(meaning.layout)) info.metadata["rescale"] = *rescale;
  readMissing(attributes, attributes.has("DIMENSION_LIST") || attributes.has("_Netcdf4Dimid"), meaning, info);
  if (const std::string units = attributes.string("units"); !units.empty()) info.metadata["value_unit"] = units;
  place(attributes, axes, rank, info);
  return meaning;
}

}  // namespace umbrick
