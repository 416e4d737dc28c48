// SPDX-License-Identifier: Apache-2.0
#include "ingest/hdf5_meaning.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>

#include "ingest/hdf5_attributes.h"
#include "ingest/header_text.h"
#include "ingest/length_unit.h"
#include "ingest/place.h"
#include "ingest/streams/dense_source.h"
#include "umbrick/core/short_number.h"

namespace umbrick {
namespace {

// The default of netCDF for floats that were never written.
constexpr float kNetcdfFill = 9.9692099683868690e+36f;

VoxelType unsignedOf(VoxelType type) {
  using enum VoxelType;
  return type == i8 ? u8 : type == i16 ? u16 : type == i32 ? u32 : type == i64 ? u64 : type;
}

// Attributes of a dataset whose signed integers stand for unsigned ones are signed too.
double asStored(double value, const Hdf5Attributes& attributes, VoxelType type) {
  const bool wraps = value < 0 && lower(attributes.string("_Unsigned")) == "true";
  return wraps ? value + std::ldexp(1.0, 8 * voxelBytes(type)) : value;
}

void readMissing(const Hdf5Attributes& attributes, bool isNetcdf, Hdf5Meaning& meaning, VolumeInfo& info) {
  std::string said;
  for (const char* key : {"_FillValue", "missing_value"})
    for (const double number : attributes.numbers(key, 0)) {
      const double value = asStored(number, attributes, meaning.layout.type);
      if (std::isnan(value)) continue;  // is no number as it is
      if (std::find(meaning.missing.begin(), meaning.missing.end(), value) != meaning.missing.end()) continue;
      meaning.missing.push_back(value);
      said += (said.empty() ? "" : ", ") + shortNumber(value, 9) + " (" + key + ')';
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
    said += (said.empty() ? "" : ", and ") + std::string("what is not from ") + shortNumber(meaning.least, 9) + " to " +
            shortNumber(meaning.most, 9) + " (valid_min, valid_max or valid_range)";
  if (said.empty()) return;
  info.metadata["missing_value"] = said;
  info.notes.push_back("stored values of " + said +
                       " are missing: such voxels become background, counted as not finite");
}

// Numbers for the axes of the dataset, or for those three that count.
std::optional<glm::dvec3> alongAxes(const Hdf5Attributes& attributes, const std::string& name, const char* key,
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

void place(const Hdf5Attributes& attributes, const std::vector<std::size_t>& axes, std::size_t rank, VolumeInfo& info) {
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
    if (!(step > 0)) failField(info.name, sizeKey, "positive numbers", shortNumber(step, 9));
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
  const Hdf5Attributes attributes(dataset, info.name);
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
