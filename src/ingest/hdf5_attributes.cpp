// SPDX-License-Identifier: Apache-2.0
#include "ingest/hdf5_attributes.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ingest/hdf5_handle.h"
#include "ingest/header_text.h"
#include "umbrick/core/short_number.h"

namespace umbrick {
namespace {

constexpr hssize_t kMostNumbers = 64;
constexpr std::size_t kMostText = 4096;

}  // namespace

std::vector<double> Hdf5Attributes::numbers(const char* key, std::size_t count) const {
  if (!has(key)) return {};
  const Hdf5Handle attribute(H5Aopen(object_, key, H5P_DEFAULT), H5Aclose);
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

bool Hdf5Attributes::isForAxes(const char* key, std::size_t axes, std::size_t rank) const {
  if (!has(key)) return false;
  const Hdf5Handle attribute(H5Aopen(object_, key, H5P_DEFAULT), H5Aclose);
  const Hdf5Handle type(H5Aget_type(attribute.get()), H5Tclose), space(H5Aget_space(attribute.get()), H5Sclose);
  const H5T_class_t kind = H5Tget_class(type.get());
  const hssize_t found = H5Sget_simple_extent_npoints(space.get());
  return (kind == H5T_INTEGER || kind == H5T_FLOAT) &&
         (found == static_cast<hssize_t>(axes) || found == static_cast<hssize_t>(rank));
}

std::optional<double> Hdf5Attributes::number(const char* key) const {
  const std::vector<double> found = numbers(key, 1);
  if (found.empty()) return std::nullopt;
  if (!std::isfinite(found[0])) failField(name_, key, "a finite number", shortNumber(found[0], 9));
  return found[0];
}

std::string Hdf5Attributes::string(const char* key) const {
  if (!has(key)) return {};
  const Hdf5Handle attribute(H5Aopen(object_, key, H5P_DEFAULT), H5Aclose);
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

}  // namespace umbrick
